/** Offer the files of a design for download. */

import * as api from "../core/api.js";
import { createElement } from "../core/dom.js";
import { t } from "../core/messages.js";

/** @import { Solved } from "../types/values.js" */

/** @type {Record<string, [string, string]>} */
const SIMULATION_FORMATS = {
  mjcf: ["MuJoCo", t`MuJoCo model with closed loops and a driven input`],
  urdf: ["URDF", t`Tree of links and joints for robotics programs; loops are listed separately`],
  mo: ["Modelica", t`Model for Modelica's MultiBody library`],
  "sim.py": [t`Simulation`, t`Python script that runs the design in MuJoCo and compares it with the analysis`],
};

/** @param {Solved} job @param {number} n @param {HTMLElement} drawing where the labelled drawing stands */
export function createDownloads(job, n, drawing) {
  const place = createElement(
    "div",
    { class: "row", id: "downloads", role: "group", "aria-label": t`Files` },
    createElement("span", {}, t`Download`),
  );
  const fault = createElement("span", { class: "error", role: "alert" });
  const button = (/** @type {string} */ title, /** @type {string} */ name, /** @type {() => Promise<string>} */ make) =>
    createElement(
      "button",
      {
        type: "button",
        class: "small",
        onclick: async (/** @type {MouseEvent} */ event) => {
          const pressed = /** @type {HTMLButtonElement} */ (event.currentTarget);
          pressed.disabled = true;
          fault.replaceChildren();
          try {
            const done = await make();
            if (done) {
              saveFile(done, name);
              place.dataset.taken = title;
            }
          } catch (error) {
            const reasons = error instanceof api.Refusal ? error.errors.map((one) => one.detail) : [];
            fault.replaceChildren(reasons.join(" ") || /** @type {Error} */ (error).message);
          }
          pressed.disabled = false;
        },
      },
      title,
    );
  place.append(
    ...api.fileFormats(job.kind, job.result.designs[n].mechanism.type).map((form) => {
      const [title, told] = SIMULATION_FORMATS[form] ?? [form.toUpperCase(), ""];
      const one = button(title, `${job.kind}-${n + 1}.${form}`, () => api.downloadFile(job.id, n, form));
      if (told) one.title = told;
      return one;
    }),
    button("PNG", `${job.kind}-${n + 1}.png`, async () => {
      const image = drawing.querySelector("img");
      if (!image) throw new Error(t`The drawing is not ready yet.`);
      return rasterize(image);
    }),
    button("JSON", `${job.kind}.json`, async () => {
      const parts = [JSON.stringify({ problem: job.problem, result: job.result }, null, 1)];
      return URL.createObjectURL(new Blob(parts, { type: "application/json" }));
    }),
    ...(api.hasParts(job.result.designs[n].mechanism) ? createPartsFields(job, n, button) : []),
    ...(job.result.designs[n].mechanism.skeleton ? [createPmksButton(job, n, button)] : []),
    button(t`Report`, `${job.kind}.html`, () => api.downloadReport(job.id)),
    // A link cannot send a key.
    api.readKey()
      ? ""
      : createElement("a", { href: api.reportAddress(job.id), target: "_blank", rel: "noopener" }, t`Open the report`),
    fault,
  );
  return place;
}

/**
 * Create the fields for parts to cut and to print.
 * @param {Solved} job @param {number} n
 * @param {(title: string, name: string, make: () => Promise<string>) => HTMLElement} button
 */
function createPartsFields(job, n, button) {
  const cut = button(t`Parts`, `${job.kind}-${n + 1}-parts.zip`, () =>
    api.downloadParts(job.id, n, { process: "laser" }),
  );
  cut.title = t`Plates to cut, fasteners, an assembly drawing and a bill of materials`;
  const printed = button(t`Printed parts`, `${job.kind}-${n + 1}-printed.zip`, () =>
    api.downloadParts(job.id, n, { process: "print" }),
  );
  printed.title = t`STL and 3MF files of all parts, and their assembly`;
  if (!api.makesSolids()) {
    printed.setAttribute("disabled", "");
    printed.title = t`This service cannot make solids; it runs without its extra cad (MECHSYNTH_CAD=1 make serve)`;
  }
  return [cut, printed];
}

/**
 * Create the button that opens a linkage in PMKS+.
 * @param {Solved} job @param {number} n
 * @param {(title: string, name: string, make: () => Promise<string>) => HTMLElement} button
 */
function createPmksButton(job, n, button) {
  const there = button("PMKS+", "", async () => {
    const url = await api.fetchPmksAddress(job.id, n);
    createElement("a", { href: url, target: "_blank", rel: "noopener noreferrer" }).click();
    return "";
  });
  there.title = t`Open it in PMKS+. The link contains the whole design and sends it to app.pmksplus.com`;
  return there;
}

/** Rasterize the drawing at twice its size. @param {HTMLImageElement} image @returns {Promise<string>} */
async function rasterize(image) {
  await image.decode();
  const canvas = createElement("canvas", { width: 2 * image.naturalWidth, height: 2 * image.naturalHeight });
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  pen.fillStyle = "white";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  const blob = /** @type {Blob | null} */ (await new Promise((done) => canvas.toBlob(done, "image/png")));
  if (!blob) throw new Error(t`The drawing is too large for a PNG; use the SVG.`);
  return URL.createObjectURL(blob);
}

/** Save a file. @param {string} url @param {string} name */
export function saveFile(url, name) {
  createElement("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
