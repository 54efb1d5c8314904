/** The button that copies an address, and says what the address holds. */

import { addressOf } from "../core/address_fragment.js";
import { el } from "../core/dom.js";
import { t } from "../core/messages.js";

/** How long it says so. */
const TOLD_MS = 5000;

export class Link {
  /**
   * @param {HTMLElement} button
   * @param {HTMLElement} place for what is said
   * @param {() => import("../core/address_fragment.js").Sent} sent what is to be sent
   */
  constructor(button, place, sent) {
    this.place = place;
    this.sent = sent;
    this.telling = 0;
    button.addEventListener("click", () => this.copy());
  }

  async copy() {
    const sent = this.sent();
    const address = await addressOf(sent);
    const held = sent.mechanism ? t`the statement and the linkage that is shown` : t`the statement`;
    try {
      await navigator.clipboard.writeText(address);
      this.tell(t`Link copied. It holds ${held}, and opens on any service.`);
      this.telling = setTimeout(() => this.tell(), TOLD_MS);
    } catch {
      // Only pages of this machine and those by HTTPS may write there.
      const text = el("input", {
        readonly: true,
        value: address,
        "aria-label": t`The link`,
        onblur: () => this.tell(),
      });
      this.tell(t`Copy this link. It holds ${held}, and opens on any service.`, text);
      text.select();
    }
  }

  /** @param {...(string | HTMLElement)} said */
  tell(...said) {
    clearTimeout(this.telling);
    this.place.replaceChildren(...said);
  }
}
