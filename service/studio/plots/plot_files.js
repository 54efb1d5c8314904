/** Export a plot as a table or a picture. */

import { t } from "../core/messages.js";

/** Pixels of a picture for one of the plot. */
const PICTURE_SCALE = 4;

/** What a picture has of the styles of the page. */
const COPIED_STYLES = [
  "fill",
  "stroke",
  "stroke-width",
  "stroke-dasharray",
  "opacity",
  "font-size",
  "font-family",
  "text-anchor",
];

/**
 * Return an object URL with all numbers of a plot, for a download; the caller revokes it.
 * @param {string} title
 * @param {Record<string, (number | null)[]>} lines
 * @param {number[] | undefined} input
 * @param {string} unit of the input
 */
export function exportCsv(title, lines, input, unit) {
  const quoted = (/** @type {string} */ text) => `"${text.replaceAll('"', '""')}"`;
  const names = Object.keys(lines);
  const heads = [
    input ? t`Input (${unit})` : t`Sample`,
    ...names.map((name) => (names.length > 1 ? `${title}: ${name}` : title)),
  ];
  const count = Object.values(lines)[0].length;
  const rows = Array.from({ length: count }, (_, k) =>
    [input ? input[k] : k, ...Object.values(lines).map((series) => series[k] ?? "")].join(","),
  );
  return URL.createObjectURL(
    new Blob([`${[heads.map(quoted).join(","), ...rows].join("\r\n")}\r\n`], { type: "text/csv" }),
  );
}

/**
 * A plot in pixels, as it stands on the page, with its title above it.
 * @param {SVGSVGElement} picture @param {string} title @returns {Promise<string>}
 */
export async function exportPicture(picture, title) {
  const { width, height } = picture.viewBox.baseVal;
  const copy = /** @type {SVGSVGElement} */ (picture.cloneNode(true));
  const [drawn, copied] = [picture, copy].map((one) => [...one.querySelectorAll("*")]);
  drawn.forEach((one, k) => {
    const styles = getComputedStyle(one);
    for (const name of COPIED_STYLES) copied[k].setAttribute(name, styles.getPropertyValue(name));
  });
  copy.querySelector(".cursor")?.remove();
  copy.setAttribute("width", String(PICTURE_SCALE * width));
  copy.setAttribute("height", String(PICTURE_SCALE * height));
  const image = new Image();
  image.src = URL.createObjectURL(new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" }));
  await image.decode().finally(() => URL.revokeObjectURL(image.src));
  const canvas = document.createElement("canvas");
  const head = 20 * PICTURE_SCALE;
  Object.assign(canvas, { width: PICTURE_SCALE * width, height: PICTURE_SCALE * height + head });
  const pen = canvas.getContext("2d");
  if (!pen) throw new Error(t`This browser cannot draw pictures.`);
  const style = getComputedStyle(document.body);
  pen.fillStyle = style.getPropertyValue("--sheet");
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = style.color;
  pen.font = `${13 * PICTURE_SCALE}px ${style.fontFamily}`;
  pen.fillText(title, 8 * PICTURE_SCALE, 15 * PICTURE_SCALE);
  pen.drawImage(image, 0, head);
  const blob = /** @type {Blob | null} */ (await new Promise((done) => canvas.toBlob(done, "image/png")));
  if (!blob) throw new Error(t`The picture could not be created.`);
  return URL.createObjectURL(blob);
}
