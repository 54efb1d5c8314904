/** Store the pinned designs of each job in this browser. */

const STORAGE_NAME = "mechsynth.pins";

/** Maximum number of jobs whose pins are stored. */
const MAX_JOBS = 100;

/** @returns {[string, number[]][]} jobs, the oldest first */
function readPins() {
  const kept = JSON.parse(localStorage.getItem(STORAGE_NAME) ?? "[]");
  return Array.isArray(kept) ? kept : [];
}

/**
 * Return the indices of the pinned designs of a job, in the order of pinning.
 * @param {string} job
 * @returns {number[]}
 */
export function listPinned(job) {
  return readPins().find(([id]) => id === job)?.[1] ?? [];
}

/**
 * Pin or unpin a design.
 * @param {string} job
 * @param {number} n
 * @param {boolean} is
 * @returns {number[]} all that are pinned then
 */
export function setPinned(job, n, is) {
  const others = listPinned(job).filter((one) => one !== n);
  const now = is ? [...others, n] : others;
  const jobs = readPins().filter(([id]) => id !== job);
  if (now.length) jobs.push([job, now]);
  localStorage.setItem(STORAGE_NAME, JSON.stringify(jobs.slice(-MAX_JOBS)));
  return now;
}
