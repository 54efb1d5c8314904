/** Styles of the areas of a workspace: outline, hatch and colour for each role, and their legend. */

import { createElement, createSvg } from "../core/dom.js";

/** @typedef {[number, number]} Point */
/** @typedef {import("./workspace.js").Role} Role */

/**
 * Lines of the hatch in a tile of 8 px; roles that share a colour have different ones.
 * @type {Record<string, string>}
 */
const HATCH_LINES = {
  o2: "M-2 6l4 4M-2 -2l12 12M6 -2l4 4",
  o4: "M-2 2l4 -4M-2 10l12 -12M6 10l4 -4",
  a: "M-2 6l4 4M-2 -2l12 12M6 -2l4 4",
  b: "M-2 2l4 -4M-2 10l12 -12M6 10l4 -4",
  obstacle: "M-2 2l4 -4M-2 6l8 -8M-2 10l12 -12M2 10l8 -8M6 10l4 -4",
  body: "M0 4h8",
};

/** The patterns stand in the page once. @param {Document} page */
function addPatterns(page) {
  if (page.getElementById("hatches")) return;
  page.body.append(
    createSvg(
      "svg",
      { id: "hatches", class: "hidden", width: 0, height: 0, "aria-hidden": "true" },
      createSvg(
        "defs",
        {},
        ...Object.entries(HATCH_LINES).map(([name, d]) =>
          createSvg(
            "pattern",
            { id: `hatch-${name}`, width: 8, height: 8, patternUnits: "userSpaceOnUse" },
            createSvg("path", { class: `hatch ${name}`, d }),
          ),
        ),
      ),
    ),
  );
}

/**
 * A path that is filled and hatched as the role is.
 * @param {string} role
 * @param {string} [d]
 * @param {Record<string, string>} [attributes]
 */
export function createHatch(role, d, attributes = {}) {
  addPatterns(document);
  return createSvg("path", {
    class: `area ${role}`,
    fill: HATCH_LINES[role] ? `url(#hatch-${role})` : "none",
    d,
    ...attributes,
  });
}

/**
 * The outline of an area as the data of a path.
 * @param {import("../core/view.js").View} view
 * @param {{circle: {center: Point, radius: number} | null, corners: Point[]}} area
 */
export function outlinePath(view, { circle, corners }) {
  if (!circle) return `${view.pathData(corners)}Z`;
  const [u, v] = view.toPicture(...circle.center);
  const r = view.scale * circle.radius;
  return `M${u - r} ${v}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;
}

/** What the hatches mean. @param {Role[]} roles */
export function createLegend(roles) {
  return createElement(
    "ul",
    { class: "legend", "aria-label": "Areas in the picture" },
    ...roles.map((role) =>
      createElement(
        "li",
        {},
        createSvg(
          "svg",
          { viewBox: "0 0 26 16", width: 26, height: 16, "aria-hidden": "true" },
          createHatch(role.name, "M1 1h24v14h-24Z"),
        ),
        role.text,
      ),
    ),
  );
}
