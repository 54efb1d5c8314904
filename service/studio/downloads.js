/** The files of a design, to take home. */

import * as api from "./api.js";
import { el } from "./dom.js";

const FORMS = ["svg", "dxf", "csv", "gif"];

/** @param {api.Job} job @param {number} n @param {HTMLElement} drawing where the labelled drawing stands */
export function downloads(job, n, drawing) {
  const place = el("p", { class: "row", id: "downloads" }, el("span", {}, "Take home"));
  place.append(...FORMS.map((form) => el("button", { type: "button", class: "small", onclick: async (/** @type {any} */ event) => {
    const button = event.currentTarget;
    button.disabled = true;
    const url = await api.file(job.id, n, form).catch((error) => place.append(el("span", { class: "error" }, ` ${error.message}`)));
    button.disabled = false;
    if (url) save(url, `${job.kind}-${n}.${form}`);
  } }, form.toUpperCase())), el("button", { type: "button", class: "small", onclick: async () => {
    const image = drawing.querySelector("img");
    const url = image && await raster(image);
    if (url) save(url, `${job.kind}-${n}.png`);
  } }, "PNG"), el("button", { type: "button", class: "small", onclick: () => {
    const parts = [JSON.stringify({ problem: job.problem, result: job.result }, null, 1)];
    save(URL.createObjectURL(new Blob(parts, { type: "application/json" })), `${job.kind}.json`);
  } }, "JSON"));
  return place;
}

/** The drawing in pixels, two for one of its own. @param {HTMLImageElement} image @returns {Promise<string | null>} */
async function raster(image) {
  await image.decode();
  const canvas = el("canvas", { width: 2 * image.naturalWidth, height: 2 * image.naturalHeight });
  const pen = canvas.getContext("2d");
  pen.fillStyle = "white";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done) => canvas.toBlob((/** @type {Blob | null} */ blob) => done(blob && URL.createObjectURL(blob)), "image/png"));
}

/** @param {string} url @param {string} name */
function save(url, name) {
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
