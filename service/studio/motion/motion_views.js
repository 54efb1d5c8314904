/** Choose the view of a moving mechanism by its type. */

import { BarrelCamView } from "./barrel_cam.js";
import { DiscCamView } from "./cam.js";
import { PistonEngineView } from "./piston_engine.js";
import { FlywheelView } from "./flywheel.js";
import { GearsView } from "./gears.js";
import { GenevaView } from "./geneva.js";
import { RatchetView } from "./ratchet.js";
import { RotorView } from "./rotor.js";

/** @import { MovingView } from "../types/values.js" */

/** @typedef {{stop: () => void, pause?: () => void, player: import("../core/player.js").Player}} Moving */

/** Samples of a cycle of a linkage. */
export const STEP_COUNT = 240;

/** Number of samples of a full turn without toggles: one per degree. */
export const TURN_STEP_COUNT = 360;

/**
 * What shows a mechanism that is no linkage.
 * @type {Record<string, typeof MovingView>}
 */
export const VIEWS = {
  cam: DiscCamView,
  barrel_cam: BarrelCamView,
  gear_train: GearsView,
  planetary_train: GearsView,
  train_series: GearsView,
  gearbox: GearsView,
  layshaft_gearbox: GearsView,
  rotor: RotorView,
  flywheel: FlywheelView,
  engine: PistonEngineView,
  geneva_external: GenevaView,
  geneva_internal: GenevaView,
  geneva_spherical: GenevaView,
  ratchet: RatchetView,
};
