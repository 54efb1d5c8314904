/** The files of a design, to take home. */

import * as api from "./api.js";
import { el } from "./dom.js";

/** @param {api.Job} job @param {number} n @param {HTMLElement} drawing where the labelled drawing stands */
export function downloads(job, n, drawing) {
  const place = el("div", { class: "row", id: "downloads", role: "group", "aria-label": "Files to take home" }, el("span", {}, "Take home"));
  const fault = el("span", { class: "error", role: "alert" });
  const button = (/** @type {string} */ title, /** @type {string} */ name, /** @type {() => Promise<string>} */ make) =>
    el("button", { type: "button", class: "small", onclick: async (/** @type {any} */ event) => {
      const pressed = event.currentTarget;
      pressed.disabled = true;
      fault.replaceChildren();
      try {
        save(await make(), name);
      } catch (error) {
        fault.replaceChildren(/** @type {Error} */ (error).message);
      }
      pressed.disabled = false;
    } }, title);
  place.append(
    ...api.files(job.kind, job.result.designs[n].mechanism.type).map((form) =>
      button(form.toUpperCase(), `${job.kind}-${n}.${form}`, () => api.file(job.id, n, form))),
    button("PNG", `${job.kind}-${n}.png`, async () => {
      const image = drawing.querySelector("img");
      if (!image) throw new Error("The drawing is not there yet.");
      return raster(image);
    }),
    button("JSON", `${job.kind}.json`, async () => {
      const parts = [JSON.stringify({ problem: job.problem, result: job.result }, null, 1)];
      return URL.createObjectURL(new Blob(parts, { type: "application/json" }));
    }),
    button("Report", `${job.kind}.html`, () => api.report(job.id)),
    // A link cannot send a key.
    api.key() ? "" : el("a", { href: api.reportAt(job.id), target: "_blank", rel: "noopener" }, "Open the report"),
    fault);
  return place;
}

/** The drawing in pixels, two for one of its own. @param {HTMLImageElement} image @returns {Promise<string>} */
async function raster(image) {
  await image.decode();
  const canvas = el("canvas", { width: 2 * image.naturalWidth, height: 2 * image.naturalHeight });
  const pen = canvas.getContext("2d");
  pen.fillStyle = "white";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  const blob = /** @type {Blob | null} */ (await new Promise((done) => canvas.toBlob(done, "image/png")));
  if (!blob) throw new Error("The drawing is too large for a picture in pixels; the SVG has it whole.");
  return URL.createObjectURL(blob);
}

/** @param {string} url @param {string} name */
function save(url, name) {
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
