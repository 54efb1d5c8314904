"""Cams: how exactly a follower laid against a finished profile gives its program back, and what it costs.

    python -m benchmarks.cam_core [--cams 40]

Random programs of smooth laws and followers of ordinary proportions, those of the tests. Deviations are the worst over
all cams, as shares of the lift (displacement), of the peak (velocity) and in degrees (pressure angle); times are
processor time.
"""

from __future__ import annotations

import argparse
import math
import time

import numpy as np

from kinematics.cam.finished.contact import Contour
from kinematics.cam.profile import space_angles
from tests.kinematics.cam.sampling import FOLLOWERS, sound_cam

POINTS = (360, 720, 1440, 2880)
ANGLES = 720


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cams", type=int, default=40)
    count = parser.parse_args().cams
    angles = space_angles(ANGLES) + 1e-3
    print(f"{'follower':20} {'points':>6} {'s/lift':>9} {'v/peak':>9} {'pressure':>9} {'ms':>7}   ({count} cams each)")
    for kind in FOLLOWERS:
        cams = [sound_cam(np.random.default_rng(seed), kind) for seed in range(count)]
        Contour(cams[0].profile(space_angles(POINTS[0]))).follow(cams[0].follower, angles[:2], cams[0].rotation)
        for points in POINTS:
            worst, spent = np.zeros(3), 0.0
            for cam in cams:
                start = time.process_time()
                found = Contour(cam.profile(space_angles(points))).follow(cam.follower, angles, cam.rotation)
                spent += time.process_time() - start
                motion, size = cam.program.motion(angles), cam.program.peaks[1].largest
                off = (
                    np.abs(found.s - motion.s).max() / cam.program.lift,
                    np.abs(found.v - motion.v).max() / size,
                    math.degrees(np.abs(found.pressure_angle - np.abs(cam.pressure_angle(angles))).max()),
                )
                worst = np.maximum(worst, off)
            row = " ".join(f"{value:9.1e}" for value in worst)
            print(f"{kind:20} {points:6d} {row} {1e3 * spent / count:7.1f}")


if __name__ == "__main__":
    main()
