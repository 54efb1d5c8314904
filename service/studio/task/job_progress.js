/** Show the progress of a job and a button to cancel it. */

import * as api from "../core/api.js";
import { createElement } from "../core/dom.js";
import { t, term, translate } from "../core/messages.js";

/** @type {AbortController | null} */
let following = null;

/** Follow no job any more. @param {HTMLElement} place */
export function stopFollowing(place) {
  following?.abort();
  following = null;
  place.replaceChildren();
}

/**
 * Show a job until it ends.
 * @param {HTMLElement} place @param {string} id
 * @returns {Promise<api.Job | null>} the job as it ended; null where it is not followed any more, or is gone
 */
export async function showJob(place, id) {
  stopFollowing(place);
  const control = (following = new AbortController());
  const bar = createElement("progress", { max: 1, value: 0, "aria-label": t`Progress of the job` });
  const message = createElement("span", { class: "note" }, term("queued"));
  const cancel = createElement(
    "button",
    {
      type: "button",
      id: "cancel",
      onclick: async () => {
        cancel.disabled = true;
        await api.removeJob(id).catch((error) => message.replaceChildren(error.message));
      },
    },
    t`Cancel`,
  );
  place.replaceChildren(createElement("div", { class: "row running" }, bar, cancel, message));
  let removed = false;
  await api.followJob(
    id,
    (event, data) => {
      if (event === "removed") removed = true;
      else {
        const progress = data.progress ?? data;
        bar.value = progress.fraction;
        message.replaceChildren(`${Math.round(100 * progress.fraction)} %, ${translate(progress.message)}`);
      }
    },
    control.signal,
  );
  if (control.signal.aborted) return null;
  place.replaceChildren();
  return removed ? null : api.fetchJob(id);
}
