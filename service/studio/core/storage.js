/** Store values in the browser. If it refuses, as in some private windows, they are kept until the page is closed. */

export class Storage {
  /** @param {() => globalThis.Storage} of which a browser may refuse */
  constructor(of) {
    this.of = of;
    /** What the browser has not taken. @type {Map<string, string>} */
    this.own = new Map();
  }

  /** @param {string} name @returns {string | null} */
  read(name) {
    try {
      return this.own.get(name) ?? this.of().getItem(name);
    } catch {
      return this.own.get(name) ?? null;
    }
  }

  /** @param {string} name @param {string | null} value null to forget it */
  write(name, value) {
    this.own.delete(name);
    try {
      if (value === null) this.of().removeItem(name);
      else this.of().setItem(name, value);
    } catch {
      if (value !== null) this.own.set(name, value);
    }
  }
}

/** Permanent storage, and storage for this tab. */
export const localStore = new Storage(() => localStorage);
export const tabStore = new Storage(() => sessionStorage);
