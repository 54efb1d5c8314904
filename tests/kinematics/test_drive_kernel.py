"""The compiled sweep against its plain twin, on random mechanisms of every type that closes by dyads."""

import numpy as np
import pytest

from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import drive, find_assembly_signs
from tests.kinematics import drive_twin
from tests.kinematics.mechanism_sampling import DYADIC


def assert_same(found, expected, scale=1.0, limit=1e-9):
    """Equal to rounding; orders of a jet are compared beside the greatest of each, as they grow near toggles."""
    assert (np.isnan(found) == np.isnan(expected)).all()
    known = np.isfinite(expected)
    assert np.allclose(found[known], expected[known], rtol=limit, atol=limit * scale)


@pytest.mark.parametrize("name", DYADIC)
@pytest.mark.parametrize("order", [0, 1, 3])
def test_the_kernel_and_the_plain_formulas_agree(name, order):
    rng = np.random.default_rng(7)
    mechanism = DYADIC[name](rng, 20)
    at = mechanism.reference_input[:, None] + rng.uniform(-2.0, 2.0, (20, 9))
    rates = [rng.uniform(0.5, 2.0, (20, 9)) for _ in range(order)]
    named = dict(zip(("speed", "acceleration", "jerk"), rates, strict=False))
    steps = decompose(mechanism).steps
    signs = tuple(
        sign * (rng.choice([1, -1], sign.shape) if step.has_two_solutions else 1)
        for sign, step in zip(find_assembly_signs(mechanism, steps), steps, strict=True)
    )
    found = drive(mechanism, at, signs=signs, order=order, **named)
    expected = drive_twin.drive(mechanism, at, rates, signs)
    assert found.valid.sum() > 0
    assert (found.valid == expected.valid).all()
    assert (found.smooth == expected.smooth).all()
    sound = found.valid & np.all([np.abs(s) > 1e-2 for s in expected.sines.values()], axis=0)
    for group in ("angles", "joints", "slides"):
        ours, theirs = getattr(found, group), getattr(expected, group)
        assert ours.keys() == theirs.keys()
        for key in ours:
            there, here = theirs[key][:, sound], ours[key][:, sound]
            if group == "angles":
                there, here = (np.concatenate([np.exp(1j * jet[:1]), jet[1:]]) for jet in (there, here))
            for k in range(order + 1):
                assert_same(here[k], there[k], scale=max(1.0, np.abs(there[k]).max()))
    for key, sine in expected.sines.items():
        assert_same(found.sines[key][sound], sine[sound])
        assert_same(found.margins[key], expected.margins[key], scale=max(1.0, np.nanmax(np.abs(expected.margins[key]))))
