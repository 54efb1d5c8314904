/** List the keyboard shortcuts of the page. */

import { byId } from "../core/dom.js";
import { scrubBy, scrubTo, findVisible } from "./keyboard.js";
import { t } from "../core/messages.js";

/** @import { Workbench } from "../design/workbench.js" */
/** @import { CopyLink } from "./copy_link.js" */
/** @import { Store } from "../core/store.js" */

/** @param {string} name of a button on the board that is shown */
const pressButton = (name) => () => findVisible(`.board button[aria-label="${name}"]`)?.click();

/**
 * What the keys do, in the order of the sheet; one without a text belongs to the one before.
 * @param {object} page
 * @param {typeof import("../answers/answers.js")} page.answers
 * @param {Workbench} page.desk
 * @param {Store} page.store
 * @param {() => void} page.solve
 * @param {() => void} page.browse shows the gallery
 * @param {CopyLink} page.link
 * @param {() => void} page.sheet shows these keys
 * @returns {import("./keyboard.js").Binding[]}
 */
export function listBindings({ answers, desk, store, solve, browse, link, sheet }) {
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
    { keys: [" "], shown: t`Space`, text: t`Play and pause`, act: () => findVisible(".player button")?.click() },
    { keys: ["ArrowLeft"], shown: t`← or →`, text: t`One degree back or on; ten with Shift`, act: () => scrubBy(-1) },
    { keys: ["ArrowRight"], shown: "", text: "", act: () => scrubBy(1) },
    { keys: ["Shift+ArrowLeft"], shown: "", text: "", act: () => scrubBy(-10) },
    { keys: ["Shift+ArrowRight"], shown: "", text: "", act: () => scrubBy(10) },
    { keys: ["Home"], shown: t`Home or End`, text: t`Beginning and end of the motion`, act: () => scrubTo(0) },
    { keys: ["End"], shown: "", text: "", act: () => scrubTo(1) },
    {
      keys: [..."123456789"],
      shown: "1 … 9",
      text: t`Choose a design`,
      act: (event) => answers.selectDesign(Number(event.key)),
    },
    { keys: ["["], shown: t`[ or ]`, text: t`Previous or next design`, act: () => answers.moveSelection(-1) },
    { keys: ["]"], shown: "", text: "", act: () => answers.moveSelection(1) },
    { keys: ["c"], shown: "C", text: t`Compare designs`, act: () => desk.drawer.pressTab("compare") },
    { keys: ["k"], shown: "K", text: t`Pin the chosen design, or unpin it`, act: () => answers.togglePin() },
    { keys: ["+", "="], shown: t`+ or −`, text: t`Zoom in or out`, act: pressButton(t`Zoom in`) },
    { keys: ["-"], shown: "", text: "", act: pressButton(t`Zoom out`) },
    { keys: ["f"], shown: "F", text: t`Fit everything`, act: pressButton(t`Fit everything`) },
    { keys: ["r"], shown: "R", text: t`Ruler`, act: () => findVisible('[data-tool="ruler"]')?.click() },
    {
      keys: ["s"],
      shown: t`S or W`,
      text: t`Show the problem, or the motion`,
      act: () => desk.stage.showMode("state"),
    },
    { keys: ["w"], shown: "", text: "", act: () => desk.stage.showMode("watch") },
    {
      keys: ["t"],
      shown: "T",
      text: t`Fold the task in a narrow window`,
      act: () => findVisible("#fold")?.click(),
    },
    { keys: ["n"], shown: "N", text: t`Numbers`, act: () => desk.drawer.pressTab("numbers") },
    { keys: ["p"], shown: "P", text: t`Plots`, act: () => desk.drawer.pressTab("plots") },
    { keys: ["e"], shown: "E", text: t`Explore`, act: () => desk.drawer.pressTab("explore") },
    {
      keys: ["l"],
      shown: "L",
      text: t`Copy a link to the problem and the linkage shown`,
      act: () => link.copy(),
    },
    { keys: ["g"], shown: "G", text: t`Gallery`, act: () => browse() },
    { keys: ["?"], shown: "?", text: t`These keys`, act: () => sheet() },
    { keys: [], shown: t`Esc`, text: t`Close a panel over the stage; put the pen away`, act: () => {} },
  ];
}
