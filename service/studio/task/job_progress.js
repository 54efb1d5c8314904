/** A job under way: its progress, and a button to cancel it. */

import * as api from "../core/api.js";
import { el } from "../core/dom.js";
import { t, term, translated } from "../core/messages.js";

/** @type {AbortController | null} */
let following = null;

/** Follow no job any more. @param {HTMLElement} place */
export function leave(place) {
  following?.abort();
  following = null;
  place.replaceChildren();
}

/**
 * Show a job until it ends.
 * @param {HTMLElement} place @param {string} id
 * @returns {Promise<api.Job | null>} the job as it ended; null where it is not followed any more, or is gone
 */
export async function run(place, id) {
  leave(place);
  const control = (following = new AbortController());
  const bar = el("progress", { max: 1, value: 0, "aria-label": t`Progress of the job` });
  const message = el("span", { class: "note" }, term("queued"));
  const cancel = el(
    "button",
    {
      type: "button",
      id: "cancel",
      onclick: async () => {
        cancel.disabled = true;
        await api.remove(id).catch((error) => message.replaceChildren(error.message));
      },
    },
    t`Cancel`,
  );
  place.replaceChildren(el("div", { class: "row running" }, bar, cancel, message));
  let removed = false;
  await api.follow(
    id,
    (event, data) => {
      if (event === "removed") removed = true;
      else {
        const progress = data.progress ?? data;
        bar.value = progress.fraction;
        message.replaceChildren(`${Math.round(100 * progress.fraction)} %, ${translated(progress.message)}`);
      }
    },
    control.signal,
  );
  if (control.signal.aborted) return null;
  place.replaceChildren();
  return removed ? null : api.job(id);
}
