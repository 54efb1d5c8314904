/** Encode a problem and a linkage in the fragment of an address: deflated JSON in base64url (RFC 4648, section 5). */

import { t } from "./messages.js";
import { findMismatch } from "./schema.js";

/** @import { Linked, Problem } from "../types/values.js" */

const FRAGMENT_PREFIX = "#statement=";

/** Maximum length of an address, and of the unpacked problem, characters. */
const MAX_ADDRESS_LENGTH = 100_000;
const MAX_STATEMENT_LENGTH = 1_000_000;

/**
 * The content of an address. The linkage is not trusted: the page that opens the address simulates it.
 * @typedef {object} SharedContent
 * @property {Problem} problem
 * @property {string} label of the task
 * @property {Linked | null} mechanism
 * @property {boolean} placed whether the linkage was shifted, rotated and scaled to the given points; it then need not
 *   pass through them as they were drawn
 */

/** An address that cannot be read; the message says why. */
export class UnreadableAddress extends Error {}

/** Return the address of this page with a shared content. @param {SharedContent} sent @returns {Promise<string>} */
export async function encodeAddress(sent) {
  const stream = new Blob([JSON.stringify(sent)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  const coded = btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return `${location.origin}${location.pathname}${FRAGMENT_PREFIX}${coded}`;
}

/** Return true if a fragment has a shared content. @param {string} fragment */
export function holdsStatement(fragment) {
  return fragment.startsWith(FRAGMENT_PREFIX);
}

/**
 * Decode a fragment. Only its form is checked here; the service validates the problem.
 * @param {string} fragment @param {import("./api.js").Kind[]} kinds @returns {Promise<SharedContent>}
 */
export async function decodeFragment(fragment, kinds) {
  if (fragment.length > MAX_ADDRESS_LENGTH)
    throw new UnreadableAddress(
      t`The address is longer than ${MAX_ADDRESS_LENGTH} characters; no problem needs that many.`,
    );
  const text = await unpack(fragment.slice(FRAGMENT_PREFIX.length));
  /**
   * The expected form; an address from elsewhere may contain anything.
   * @type {{problem?: Problem, label?: unknown, mechanism?: Linked | null, placed?: unknown} | null}
   */
  let told;
  try {
    told = JSON.parse(text);
  } catch {
    throw new UnreadableAddress(t`The address contains no problem: its content is not JSON.`);
  }
  const { problem, label = "", mechanism = null, placed = false } = told ?? {};
  const kind = kinds.find((one) => one.kind === problem?.kind);
  if (!problem || !kind)
    throw new UnreadableAddress(t`The address contains a kind of problem that this service does not know.`);
  const wrong = findMismatch(problem, kind.schema, kind.schema);
  if (wrong !== null)
    throw new UnreadableAddress(
      t`The address contains an invalid value at ${wrong.slice(1, 100) || t`an unknown place`}.`,
    );
  if (typeof label !== "string" || typeof placed !== "boolean")
    throw new UnreadableAddress(t`The address contains more than a problem and a linkage.`);
  if (mechanism !== null && typeof mechanism?.skeleton !== "object")
    throw new UnreadableAddress(t`The design in the address is not a linkage.`);
  return { problem, label: label.slice(0, 200), mechanism, placed };
}

/** @param {string} coded */
async function unpack(coded) {
  try {
    const bytes = Uint8Array.from(atob(coded.replaceAll("-", "+").replaceAll("_", "/")), (one) => one.charCodeAt(0));
    const reader = new Blob([bytes])
      .stream()
      .pipeThrough(new DecompressionStream("deflate-raw"))
      .pipeThrough(new TextDecoderStream("utf-8", { fatal: true }))
      .getReader();
    let text = "";
    for (let part; !(part = await reader.read()).done;) {
      text += part.value;
      if (text.length <= MAX_STATEMENT_LENGTH) continue;
      await reader.cancel();
      throw new UnreadableAddress(
        t`The problem in the address is longer than ${MAX_STATEMENT_LENGTH} characters; no problem needs that many.`,
      );
    }
    return text;
  } catch (error) {
    if (error instanceof UnreadableAddress) throw error;
    throw new UnreadableAddress(t`The address cannot be read: it is truncated or was altered.`);
  }
}
