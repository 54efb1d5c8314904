"""Code that several tests share: triad dwells."""

from __future__ import annotations

import numpy as np

from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.kinds.dwell.refine import stephenson_2
from synthesis.kinds.dwell.refine.refinement import STEPHENSON_2_LINKS


def built(shape: np.ndarray) -> Mechanism:
    return Mechanism(stephenson_2.name_joints(shape), dict(STEPHENSON_2_LINKS), "input")


ELSEWHERE = [2.2396606322535577, -0.334575861525666, 0.24544745321698264, 0.7194190943844678, -0.6621867552800142]
ELSEWHERE += [
    -0.7538952564402432,
    -2.6042454162426814,
    0.04380469911357842,
    -0.2120167410675391,
    0.02,
    1.0496245076460904,
]
