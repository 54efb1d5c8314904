/** What shows a mechanism in motion, by its type. */

import { Barrel } from "./barrel_cam.js";
import { Disc } from "./cam.js";
import { Engine } from "./piston_engine.js";
import { Flywheel } from "./flywheel.js";
import { Gears } from "./gears.js";
import { Geneva } from "./geneva.js";
import { Ratchet } from "./ratchet.js";
import { Rotor } from "./rotor.js";

/** @import { MovingView } from "../types/values.js" */

/** @typedef {{stop: () => void, pause?: () => void, player: import("../core/player.js").Player}} Moving */

/** Samples of a cycle of a linkage. */
export const STEPS = 240;

/** Of a turn of what has no toggles: a sample a degree. */
export const TURN_STEPS = 360;

/**
 * What shows a mechanism that is no linkage.
 * @type {Record<string, typeof MovingView>}
 */
export const VIEWS = {
  cam: Disc,
  barrel_cam: Barrel,
  gear_train: Gears,
  planetary_train: Gears,
  train_series: Gears,
  gearbox: Gears,
  layshaft_gearbox: Gears,
  rotor: Rotor,
  flywheel: Flywheel,
  engine: Engine,
  geneva_external: Geneva,
  geneva_internal: Geneva,
  geneva_spherical: Geneva,
  ratchet: Ratchet,
};
