"""The program measured on a profile is the one that made it."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.cam.finished.contact import Contour
from kinematics.cam.finished.motion_program import measure_program
from kinematics.cam.follower import TranslatingRoller
from kinematics.cam.profile import Cam, space_angles
from kinematics.errors import DimensionError
from tests.kinematics.cam.sampling import FOLLOWERS, sound_cam
from tests.support.kinematics.cam.profile import double_dwell


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_the_measured_program_is_the_stated_one(kind: str) -> None:
    cam = sound_cam(np.random.default_rng(5), kind)
    program = measure_program(Contour(cam.profile(space_angles(1440))), cam.follower, cam.rotation, 720)
    angles = space_angles(1000) + 1e-3
    stated, found = cam.program.motion(angles), program.motion(angles)
    assert found.s == pytest.approx(stated.s, abs=1e-6 * cam.program.lift)
    assert found.v == pytest.approx(stated.v, abs=1e-3 * cam.program.peaks[1].largest)
    for order, slack in ((1, 1e-3), (2, 2e-2)):
        assert program.peaks[order].largest == pytest.approx(cam.program.peaks[order].largest, rel=slack)
    assert program.obeys_fundamental_law


def test_a_follower_beside_the_cam_has_no_program() -> None:
    cam = Cam(double_dwell(), TranslatingRoller(3.0, 0.5))
    with pytest.raises(DimensionError, match="touched"):
        measure_program(Contour(cam.profile(space_angles(720))), TranslatingRoller(7.0, 0.5, 6.0), "cw", 90)
