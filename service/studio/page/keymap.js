/** The keys of the page, as the sheet of keys shows them. */

import { byId } from "../core/dom.js";
import { scrub, scrubTo, visible } from "./keyboard.js";
import { t } from "../core/messages.js";

/** @import { Desk } from "../design/workbench.js" */
/** @import { Link } from "./copy_link.js" */
/** @import { Store } from "../core/store.js" */

/** @param {string} name of a button on the board that is shown */
const press = (name) => () => visible(`.board button[aria-label="${name}"]`)?.click();

/**
 * What the keys do, in the order of the sheet; one without a text belongs to the one before.
 * @param {object} page
 * @param {typeof import("../answers/answers.js")} page.answers
 * @param {Desk} page.desk
 * @param {Store} page.store
 * @param {() => void} page.solve
 * @param {() => void} page.browse shows the gallery
 * @param {Link} page.link
 * @param {() => void} page.sheet shows these keys
 * @returns {import("./keyboard.js").Binding[]}
 */
export function keymap({ answers, desk, store, solve, browse, link, sheet }) {
  return [
    {
      keys: ["Ctrl+Enter"],
      shown: t`Ctrl Enter`,
      text: t`Solve`,
      everywhere: true,
      act: () => {
        if (!byId("solve", HTMLButtonElement).disabled) solve();
      },
    },
    {
      keys: ["Ctrl+z"],
      shown: t`Ctrl Z`,
      text: t`Undo`,
      everywhere: true,
      act: () => desk.explorer?.undo() || store.undo(),
    },
    {
      keys: ["Ctrl+Shift+z", "Ctrl+y"],
      shown: t`Ctrl Shift Z`,
      text: t`Redo`,
      everywhere: true,
      act: () => desk.explorer?.redo() || store.redo(),
    },
    { keys: [" "], shown: t`Space`, text: t`Play and pause`, act: () => visible(".player button")?.click() },
    { keys: ["ArrowLeft"], shown: t`← or →`, text: t`One degree back or on; ten with Shift`, act: () => scrub(-1) },
    { keys: ["ArrowRight"], shown: "", text: "", act: () => scrub(1) },
    { keys: ["Shift+ArrowLeft"], shown: "", text: "", act: () => scrub(-10) },
    { keys: ["Shift+ArrowRight"], shown: "", text: "", act: () => scrub(10) },
    { keys: ["Home"], shown: t`Home or End`, text: t`Beginning and end of the motion`, act: () => scrubTo(0) },
    { keys: ["End"], shown: "", text: "", act: () => scrubTo(1) },
    {
      keys: [..."123456789"],
      shown: "1 … 9",
      text: t`Choose a design`,
      act: (event) => answers.select(Number(event.key)),
    },
    { keys: ["["], shown: t`[ or ]`, text: t`The design before, the next one`, act: () => answers.further(-1) },
    { keys: ["]"], shown: "", text: "", act: () => answers.further(1) },
    { keys: ["c"], shown: "C", text: t`Compare designs`, act: () => desk.drawer.press("compare") },
    { keys: ["k"], shown: "K", text: t`Pin the chosen design, or unpin it`, act: () => answers.pin() },
    { keys: ["+", "="], shown: t`+ or −`, text: t`Nearer, farther`, act: press(t`Nearer`) },
    { keys: ["-"], shown: "", text: "", act: press(t`Farther`) },
    { keys: ["f"], shown: "F", text: t`Fit everything`, act: press(t`Fit everything`) },
    { keys: ["r"], shown: "R", text: t`Ruler`, act: () => visible('[data-tool="ruler"]')?.click() },
    { keys: ["s"], shown: t`S or W`, text: t`The stage states, or watches`, act: () => desk.stage.show("state") },
    { keys: ["w"], shown: "", text: "", act: () => desk.stage.show("watch") },
    {
      keys: ["t"],
      shown: "T",
      text: t`Fold the task, where there is little room`,
      act: () => visible("#fold")?.click(),
    },
    { keys: ["n"], shown: "N", text: t`Numbers`, act: () => desk.drawer.press("numbers") },
    { keys: ["p"], shown: "P", text: t`Plots`, act: () => desk.drawer.press("plots") },
    { keys: ["e"], shown: "E", text: t`Explore`, act: () => desk.drawer.press("explore") },
    {
      keys: ["l"],
      shown: "L",
      text: t`Copy a link to the statement, and to the linkage that is shown`,
      act: () => link.copy(),
    },
    { keys: ["g"], shown: "G", text: t`Gallery`, act: () => browse() },
    { keys: ["?"], shown: "?", text: t`These keys`, act: () => sheet() },
    { keys: [], shown: t`Esc`, text: t`Close what lies over the stage; put the pen away`, act: () => {} },
  ];
}
