/** Copy an address and report its content. */

import { encodeAddress } from "../core/address_fragment.js";
import { createElement } from "../core/dom.js";
import { t } from "../core/messages.js";

/** Duration of the note. */
const NOTE_MS = 5000;

export class CopyLink {
  /**
   * @param {HTMLElement} button
   * @param {HTMLElement} place for what is said
   * @param {() => import("../core/address_fragment.js").SharedContent} sent what is to be sent
   */
  constructor(button, place, sent) {
    this.place = place;
    this.sent = sent;
    this.telling = 0;
    button.addEventListener("click", () => this.copy());
  }

  async copy() {
    const sent = this.sent();
    const address = await encodeAddress(sent);
    const held = sent.mechanism ? t`the problem and the linkage shown` : t`the problem`;
    try {
      await navigator.clipboard.writeText(address);
      this.showNote(t`Link copied. It contains ${held} and opens on any service.`);
      this.telling = setTimeout(() => this.showNote(), NOTE_MS);
    } catch {
      // Only pages of this machine and those by HTTPS may write there.
      const text = createElement("input", {
        readonly: true,
        value: address,
        "aria-label": t`The link`,
        onblur: () => this.showNote(),
      });
      this.showNote(t`Copy this link. It contains ${held} and opens on any service.`, text);
      text.select();
    }
  }

  /** @param {...(string | HTMLElement)} said */
  showNote(...said) {
    clearTimeout(this.telling);
    this.place.replaceChildren(...said);
  }
}
