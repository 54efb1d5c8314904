/** Designs that somebody likes, by their jobs: kept in this browser. */

const KEPT = "mechsynth.pins";

/** Jobs whose pins are kept, the newest. */
const MOST = 100;

/** @returns {[string, number[]][]} jobs, the oldest first */
function all() {
  const kept = JSON.parse(localStorage.getItem(KEPT) ?? "[]");
  return Array.isArray(kept) ? kept : [];
}

/**
 * Indices of the designs of a job that are pinned, in the order in which they were.
 * @param {string} job
 * @returns {number[]}
 */
export function pinned(job) {
  return all().find(([id]) => id === job)?.[1] ?? [];
}

/**
 * Pin a design, or take its pin away.
 * @param {string} job
 * @param {number} n
 * @param {boolean} is
 * @returns {number[]} all that are pinned then
 */
export function pin(job, n, is) {
  const others = pinned(job).filter((one) => one !== n);
  const now = is ? [...others, n] : others;
  const jobs = all().filter(([id]) => id !== job);
  if (now.length) jobs.push([job, now]);
  localStorage.setItem(KEPT, JSON.stringify(jobs.slice(-MOST)));
  return now;
}
