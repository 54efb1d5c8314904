/**
 * Draw an assembly in three dimensions with three.js. Only this module imports it, when the first assembly is shown.
 */

import * as THREE from "../vendor/three.module.min.js";
import { OrbitControls } from "../vendor/OrbitControls.js";
import { AssemblyMotion } from "./assembly_motion.js";
import { Surface } from "./solids.js";

/** @typedef {import("./assembly_view.js").Assembly} Assembly */
/**
 * @typedef {{item: string, colour: string, group: THREE.Group, mesh: THREE.Mesh<THREE.BufferGeometry,
 *   THREE.MeshStandardMaterial>, lift: number, low: number, along: THREE.Vector3}} Solid
 */

/** Field of view, degrees. */
const FIELD_OF_VIEW = 30;

/** Duration of a camera movement, milliseconds. */
const TRAVEL_MS = 350;

/** Number of inputs at which the extent is measured. */
const EXTENT_SAMPLES = 12;

/** Viewing directions. @type {Record<string, [number, number, number]>} */
export const VIEWS = { Isometric: [1, -1, 0.9], Top: [0, -1e-4, 1], Front: [0, -1, 0], Side: [1, 0, 0] };

/** Return true if this browser can draw in three dimensions. */
export function canDraw() {
  return document.createElement("canvas").getContext("webgl2") !== null;
}

export class AssemblyScene {
  /**
   * @param {HTMLCanvasElement} canvas @param {Assembly} assembly
   * @param {{hover: (item: string | null) => void, choose: (item: string | null) => void}} told pointer callbacks
   */
  constructor(canvas, assembly, told) {
    this.canvas = canvas;
    this.told = told;
    this.motion = new AssemblyMotion(assembly.input, assembly.carriers);
    this.at = 0;
    this.explosion = 0;
    /** Whether the view is still fitted, not turned by the user. */
    this.fitted = true;
    this.dirty = true;
    /** @type {string | null} */
    this.chosen = null;
    /** @type {string | null} */
    this.hovered = null;
    /**
     * @type {{from: THREE.Vector3, to: THREE.Vector3, target: THREE.Vector3, aim: THREE.Vector3, began: number} | null}
     */
    this.travel = null;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.scene = new THREE.Scene();
    this.root = new THREE.Group();
    this.scene.add(this.root);
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.1, 10);
    this.camera.up.set(0, 0, 1);
    this.carriers = assembly.carriers.map(() => {
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      this.root.add(group);
      return group;
    });
    this.solids = assembly.parts.map((part) => this.createSolid(part));
    this.show(0);
    this.reach = this.measureExtent();
    this.addLights();
    this.ground = this.addFloor(assembly);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => (this.dirty = true));
    this.controls.addEventListener("start", () => {
      this.travel = null;
      this.fitted = false;
    });
    this.controls.maxDistance = 40 * this.reach.radius;
    this.controls.minDistance = 0.3 * this.reach.radius;
    this.schemes = matchMedia("(prefers-color-scheme: dark)");
    this.tint = () => this.applyColours();
    this.schemes.addEventListener("change", this.tint);
    this.applyColours();
    this.sizes = new ResizeObserver(() => this.resize());
    this.sizes.observe(canvas);
    this.listenToPointer();
    this.resize();
    this.lookFrom("Isometric", false);
    const step = (/** @type {number} */ now) => {
      this.frame = requestAnimationFrame(step);
      this.stepCamera(now);
      if (this.dirty) this.draw();
    };
    this.frame = requestAnimationFrame(step);
  }

  /** @param {import("./assembly_view.js").Part} part @returns {Solid} */
  createSolid(part) {
    const surface = new Surface((outer, holes) =>
      THREE.ShapeUtils.triangulateShape(
        outer.map(([x, y]) => new THREE.Vector2(x, y)),
        holes.map((hole) => hole.map(([x, y]) => new THREE.Vector2(x, y))),
      ),
    );
    for (const shape of part.shapes) surface.add(shape);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(surface.places, 3));
    geometry.setAttribute("normal", new THREE.Float32BufferAttribute(surface.normals, 3));
    const metal = part.sort === "pin" || part.sort === "ring" || part.sort === "washer";
    const material = new THREE.MeshStandardMaterial({
      color: part.colour,
      roughness: metal ? 0.42 : 0.62,
      metalness: metal ? 0.25 : 0.02,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.userData.item = part.item;
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", new THREE.Float32BufferAttribute(surface.edges, 3));
    const edges = new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 }));
    edges.raycast = () => {};
    const group = new THREE.Group();
    group.name = part.name;
    group.add(mesh, edges);
    this.carriers[part.carrier].add(group);
    geometry.computeBoundingBox();
    // Parts in planes of their own lie above others; the lowest are never among them.
    const frame = this.motion.carriers[part.carrier].frame;
    const along = frame ? new THREE.Vector3(...frame.normals[0]) : new THREE.Vector3(0, 0, 1);
    const low = frame ? Infinity : (geometry.boundingBox?.min.z ?? 0);
    return { item: part.item, colour: part.colour, group, mesh, lift: part.lift, low, along };
  }

  /** Add light from the upper left and ambient light; shadows cover the whole assembly. */
  addLights() {
    const { centre, radius } = this.reach;
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xc9d1da, 2.1));
    const sun = new THREE.DirectionalLight(0xffffff, 2.1);
    sun.position.copy(centre).add(new THREE.Vector3(-0.7, -0.9, 2.2).multiplyScalar(radius));
    sun.target.position.copy(centre);
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    sun.shadow.radius = 3;
    sun.shadow.normalBias = 0.002 * radius;
    Object.assign(sun.shadow.camera, {
      left: -1.6 * radius,
      right: 1.6 * radius,
      top: 1.6 * radius,
      bottom: -1.6 * radius,
      near: 0.05 * radius,
      far: 6 * radius,
    });
    const fill = new THREE.DirectionalLight(0xffffff, 0.7);
    fill.position.copy(centre).add(new THREE.Vector3(1.5, -0.6, 0.8).multiplyScalar(radius));
    fill.target.position.copy(centre);
    this.scene.add(sun, sun.target, fill, fill.target);
  }

  /** Add a grid below everything, and a plane that receives shadows. @param {Assembly} assembly */
  addFloor(assembly) {
    const { centre, radius } = this.reach;
    const step = roundStep((2 * radius) / 12);
    const lines = 2 * Math.ceil((1.25 * radius) / step);
    const grid = new THREE.GridHelper(lines * step, lines);
    grid.rotation.x = Math.PI / 2;
    const middle = new THREE.Vector2(Math.round(centre.x / step) * step, Math.round(centre.y / step) * step);
    const catcher = new THREE.Mesh(
      new THREE.PlaneGeometry(lines * step, lines * step),
      new THREE.ShadowMaterial({ opacity: 0.18 }),
    );
    catcher.receiveShadow = true;
    catcher.position.z = -1e-3 * radius;
    const ground = new THREE.Group();
    ground.add(grid, catcher);
    ground.position.set(middle.x, middle.y, assembly.low - 0.02 * radius);
    ground.traverse((one) => (one.raycast = () => {}));
    this.scene.add(ground);
    return { group: ground, grid, step };
  }

  /** Measure the extent of the assembly over its whole motion. */
  measureExtent() {
    const count = this.motion.inputs.values.length;
    /**
     * Corners of the bounding boxes of all parts, and their travel.
     * @type {{place: THREE.Vector3, lift: number, along: THREE.Vector3}[]}
     */
    const corners = [];
    for (let k = 0; k < EXTENT_SAMPLES; k++) {
      this.show(((count - 1) * k) / (EXTENT_SAMPLES - 1));
      this.root.updateMatrixWorld(true);
      for (const { mesh, lift, along } of this.solids) {
        const { min, max } = /** @type {THREE.Box3} */ (mesh.geometry.boundingBox);
        for (let n = 0; n < 8; n++) {
          const place = new THREE.Vector3(n & 1 ? max.x : min.x, n & 2 ? max.y : min.y, n & 4 ? max.z : min.z);
          corners.push({ place: place.applyMatrix4(mesh.matrixWorld), lift, along });
        }
      }
    }
    this.show(0);
    const sphere = new THREE.Box3()
      .setFromPoints(corners.map(({ place }) => place))
      .getBoundingSphere(new THREE.Sphere());
    return { corners, centre: sphere.center, radius: sphere.radius || 1 };
  }

  /** Apply the colours of the page. */
  applyColours() {
    const style = getComputedStyle(document.documentElement);
    const colour = (/** @type {string} */ name) => new THREE.Color(style.getPropertyValue(name).trim());
    this.scene.background = colour("--sheet");
    const dark = this.schemes.matches;
    const [line, ink] = [colour("--line"), colour("--ink")];
    this.ground.grid.material.dispose();
    this.ground.grid.geometry.deleteAttribute("color");
    this.ground.grid.material = new THREE.LineBasicMaterial({ color: line });
    for (const { group, mesh, colour: own } of this.solids) {
      // Lighten dark parts on a dark background.
      mesh.material.color.set(own).lerp(new THREE.Color(0xffffff), dark ? 0.05 : 0.015);
      const edges = /** @type {THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>} */ (
        group.children[1]
      );
      edges.material.color = ink;
      edges.material.opacity = dark ? 0.35 : 0.6;
    }
    this.accent = colour("--accent");
    this.showMarks();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.dirty = true;
  }

  /** Show the assembly at a fractional index of its motion. @param {number} at */
  show(at) {
    this.at = at;
    this.carriers.forEach((group, k) => {
      const carrier = this.motion.carriers[k];
      const { angle, place } = this.motion.carrierPose(carrier, at);
      const [px, py] = carrier.pivot;
      group.matrix
        .makeTranslation(place[0], place[1], 0)
        .multiply(new THREE.Matrix4().makeRotationZ(angle))
        .multiply(new THREE.Matrix4().makeTranslation(-px, -py, 0));
      if (carrier.frame) group.matrix.premultiply(createPlaneMatrix(carrier.frame, at));
      group.matrixWorldNeedsUpdate = true;
    });
    this.dirty = true;
  }

  /** Separate the planes: 0 leaves them together, 1 separates them fully. @param {number} share */
  explode(share) {
    this.explosion = share;
    for (const { group, lift } of this.solids) group.position.z = share * lift;
    const low = Math.min(...this.solids.map(({ low, lift }) => low + share * lift));
    this.ground.group.position.z = low - 0.02 * this.reach.radius;
    if (this.fitted) this.fit(false);
    this.dirty = true;
  }

  /** @param {string} name of a part @param {boolean} visible */
  hide(name, visible) {
    for (const { group } of this.solids) if (group.name === name) group.visible = visible;
    this.dirty = true;
  }

  /** @param {string | null} item */
  highlight(item) {
    this.chosen = item;
    this.showMarks();
  }

  /** @param {string | null} which of the kinds of parts, or which part */
  setHovered(which) {
    this.hovered = which;
    this.showMarks();
  }

  showMarks() {
    for (const { item, group, mesh } of this.solids) {
      const pointed = this.hovered === item || this.hovered === group.name;
      const light = item === this.chosen ? 0.5 : pointed ? 0.25 : 0;
      if (this.accent) mesh.material.emissive.copy(this.accent);
      mesh.material.emissiveIntensity = light;
    }
    this.dirty = true;
  }

  /**
   * Move the camera so that the whole assembly is visible from a direction.
   * @param {string} name
   * @param {boolean} [animated]
   */
  lookFrom(name, animated = !matchMedia("(prefers-reduced-motion: reduce)").matches) {
    this.moveCamera(new THREE.Vector3(...VIEWS[name]), animated);
  }

  /** Fit the whole assembly into the current view. @param {boolean} [animated] */
  fit(animated = !matchMedia("(prefers-reduced-motion: reduce)").matches) {
    this.moveCamera(this.camera.position.clone().sub(this.controls.target), animated);
  }

  /** @param {THREE.Vector3} direction @param {boolean} animated */
  moveCamera(direction, animated) {
    this.fitted = true;
    const corners = this.reach.corners.map(({ place, lift, along }) =>
      place.clone().addScaledVector(along, this.explosion * lift),
    );
    const toward = direction.clone().normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(toward).normalize();
    const up = toward.clone().cross(right);
    const middle = (/** @type {THREE.Vector3} */ way) => {
      const along = corners.map((corner) => corner.dot(way));
      return (along.reduce((a, b) => Math.min(a, b)) + along.reduce((a, b) => Math.max(a, b))) / 2;
    };
    const aim = new THREE.Vector3();
    for (const way of [right, up, toward]) aim.addScaledVector(way, middle(way));
    // Distance at which all corners are inside the picture.
    const high = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const wide = high * this.camera.aspect;
    const away = corners.reduce((most, corner) => {
      const from = corner.clone().sub(aim);
      return Math.max(
        most,
        from.dot(toward) + Math.max(Math.abs(from.dot(right)) / wide, Math.abs(from.dot(up)) / high),
      );
    }, 0);
    const to = aim.clone().addScaledVector(toward, 1.06 * away);
    this.camera.near = Math.max(0.02 * this.reach.radius, 0.01);
    this.camera.far = 80 * this.reach.radius;
    this.camera.updateProjectionMatrix();
    if (animated) {
      this.travel = {
        from: this.camera.position.clone(),
        to,
        target: this.controls.target.clone(),
        aim,
        began: performance.now(),
      };
      return;
    }
    this.travel = null;
    this.camera.position.copy(to);
    this.controls.target.copy(aim);
    this.controls.update();
    this.dirty = true;
  }

  /** @param {number} now */
  stepCamera(now) {
    if (!this.travel) return;
    const { from, to, target, aim, began } = this.travel;
    const share = Math.min(1, Math.max(0, (now - began) / TRAVEL_MS));
    const eased = share * share * (3 - 2 * share);
    this.controls.target.lerpVectors(target, aim, eased);
    // Orbit around the target, never through it.
    const [one, other] = [from.clone().sub(target), to.clone().sub(aim)];
    const way = one.clone().normalize().lerp(other.clone().normalize(), eased).normalize();
    this.camera.position
      .copy(this.controls.target)
      .addScaledVector(way, one.length() + eased * (other.length() - one.length()));
    if (share === 1) {
      this.camera.position.copy(to);
      this.travel = null;
    }
    this.controls.update();
    this.dirty = true;
  }

  /** Turn, zoom and move by keys; return true if the key was used. @param {KeyboardEvent} event */
  handleKey(event) {
    const by = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    this.travel = null;
    if (!event.key.match(/^(Shift|Tab)$/)) this.fitted = false;
    if (by && event.shiftKey) this.controls.pan(40 * by[0], 40 * by[1]);
    else if (by) {
      this.controls.rotateLeft((by[0] * Math.PI) / 24);
      this.controls.rotateUp((by[1] * Math.PI) / 24);
    } else if (event.key === "+" || event.key === "=") this.controls.dollyIn(1.15);
    else if (event.key === "-") this.controls.dollyOut(1.15);
    else if (event.key === "Home" || event.key === "0") this.fit();
    else return false;
    this.controls.update();
    return true;
  }

  /** Report the part under the pointer and select it by a click; a drag does not select. */
  listenToPointer() {
    /** @type {[number, number] | null} */
    let down = null;
    const under = (/** @type {PointerEvent} */ event) => {
      const { left, top, width, height } = this.canvas.getBoundingClientRect();
      const ray = new THREE.Raycaster();
      ray.setFromCamera(
        new THREE.Vector2((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height),
        this.camera,
      );
      const hit = ray.intersectObjects(
        this.solids.filter(({ group }) => group.visible).map(({ mesh }) => mesh),
        false,
      )[0];
      return hit ? String(hit.object.userData.item) : null;
    };
    this.canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0) this.told.hover(under(event));
    });
    this.canvas.addEventListener("pointerleave", () => this.told.hover(null));
    this.canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
    this.canvas.addEventListener("pointerup", (event) => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) this.told.choose(under(event));
      down = null;
    });
  }

  draw() {
    this.dirty = false;
    this.renderer.render(this.scene, this.camera);
    this.canvas.dataset.drawn = String(Number(this.canvas.dataset.drawn ?? 0) + 1);
  }

  /** Return the current view as a picture. @returns {Promise<Blob>} */
  takePicture() {
    this.draw();
    return new Promise((done, failed) =>
      this.canvas.toBlob((blob) => (blob ? done(blob) : failed(new Error("the picture is too large"))), "image/png"),
    );
  }

  stop() {
    cancelAnimationFrame(this.frame);
    this.sizes.disconnect();
    this.schemes.removeEventListener("change", this.tint);
    this.controls.dispose();
    for (const { group } of this.solids) {
      for (const one of group.children) {
        const { geometry, material } = /** @type {THREE.Mesh<THREE.BufferGeometry, THREE.Material>} */ (one);
        geometry.dispose();
        material.dispose();
      }
    }
    this.renderer.dispose();
  }
}

/**
 * Return the matrix of a plane at an index of the arrays; it is not interpolated.
 * @param {import("./assembly_motion.js").PlaneFrame} frame
 * @param {number} at
 */
function createPlaneMatrix({ origins, along, normals }, at) {
  const of = (/** @type {number[][]} */ list) =>
    new THREE.Vector3(...list[list.length === 1 ? 0 : Math.round(at) % list.length]);
  const [x, z] = [of(along), of(normals)];
  return new THREE.Matrix4().makeBasis(x, z.clone().cross(x), z).setPosition(of(origins));
}

/** Return 1, 2 or 5 times a power of ten, at least the given value. @param {number} least */
export function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((one) => one * power >= least) ?? 10);
}
