"""Code that several tests share: mechanism laws."""

from __future__ import annotations

import numpy as np

from kinematics.linkage.planar.drive import MechanismMotion, drive, is_reachable
from kinematics.linkage.planar.mechanism import Mechanism
from tests.kinematics.mechanism_sampling import CLASS_THREE, EVERY, take
from tests.oracles.constraints import Constraints
from tests.oracles.differences import derivative

CLOSURE = 1e-12
"""Misfit of a constraint as a share of the mechanism's size."""

AT_TOGGLE = 1e-6
"""Least singular value of the constraints at a reference: the input's distance from the toggle goes with its square."""
DESIGNS = {name: 20 if name in CLASS_THREE else 500 for name in EVERY}


def batch(name: str, seed: int, n: int | None = None) -> tuple[np.random.Generator, Mechanism]:
    """Designs of a type; of class III without those, one in 100 000, whose reference is at a toggle and so refused."""
    rng = np.random.default_rng([seed, list(EVERY).index(name)])
    mechanism = EVERY[name](rng, n or DESIGNS[name])
    if name in CLASS_THREE:
        every = Constraints.of(mechanism)
        slope = every.evaluate(every.start())[1][:, :, :-1]
        away = np.linalg.svd(slope, compute_uv=False)[:, -1] > AT_TOGGLE
        mechanism = mechanism if away.all() else take(mechanism, np.flatnonzero(away))
    return rng, mechanism


def ways(rng: np.random.Generator, mechanism: Mechanism, m: int, reach: float = np.pi) -> np.ndarray:
    """Inputs up to half a turn from the reference, or up to the mechanism's size along the slide."""
    return rng.uniform(-reach, reach, (*mechanism.shape, m))


def misfits(mechanism: Mechanism, found: MechanismMotion, way: np.ndarray) -> np.ndarray:
    """Largest misfit of a rigid length, a slide or a gear, as a share of the size, designs × inputs."""
    m = way.shape[1]
    every = Constraints.of(mechanism).take(np.repeat(np.arange(mechanism.shape[0]), m))
    unit = every.size if mechanism.has_slide_input else 1.0
    joints = {name: z[0].ravel() for name, z in found.joints.items()}
    return every.misfit(joints, way.ravel() / unit).reshape(way.shape)


# -- position ----------------------------------------------------------------------------------------------------------


def closes(name: str, seed: int, n: int, m: int) -> int:
    """How many positions of designs × inputs exist; all of them keep the constraints."""
    rng, mechanism = batch(name, seed, n)
    way = ways(rng, mechanism, m)
    found = drive(mechanism, mechanism.reference_input[:, None] + way, order=0)
    assert 0.2 < found.valid.mean() < 0.99
    assert misfits(mechanism, found, way)[found.valid].max() <= CLOSURE
    for values in (*found.joints.values(), *found.angles.values(), *found.slides.values()):
        np.testing.assert_array_equal(np.isfinite(values[0]), found.valid)
    return int(found.valid.sum())


def orders(name: str, seed: int, n: int) -> int:
    """q(t) = q + w t + α t²/2 + j t³/6, with its rates at each time: differences of one order give the next.

    The number of designs on which this was measured: those that have a configuration there and are not near a limit.
    """
    rng, mechanism = batch(name, seed, n)
    unit = Constraints.of(mechanism).size if mechanism.has_slide_input else np.ones(mechanism.shape[0])
    way = rng.uniform(-1.0, 1.0, mechanism.shape[0]) * 0.5 * unit
    at = (mechanism.reference_input + way)[:, None]
    w, alpha, jerk = 0.8, -0.6, 0.9
    first = drive(mechanism, at)
    calm = first.smooth[:, 0].copy()
    for sine in first.sines.values():
        calm &= np.nan_to_num(np.abs(sine[:, 0])) > 0.1
    # Per radian, or per size along the slide, no link may rush: there differences fail before derivatives do.
    for order in (1, 2, 3):
        fast = [np.abs(angle[order, :, 0]) * unit**order for angle in first.angles.values()]
        calm = calm & (np.nan_to_num(np.max(fast, axis=0), nan=np.inf) < 4.0**order)
    step = 2e-3
    times = step * np.arange(-4, 5)
    use = np.flatnonzero(calm)
    if name in CLASS_THREE:
        # Beyond a toggle a branch of more than a turn has the input elsewhere: no difference leads over from there.
        ends = at + w * times[[0, -1]]
        use = use[[bool(is_reachable(take(mechanism, k), ends[k]).all()) for k in use]]
    assert len(use) > mechanism.shape[0] // 8
    mechanism, at, unit = take(mechanism, use), at[use], unit[use]
    scale = unit[:, None] if mechanism.has_slide_input else 1.0
    every = drive(
        mechanism,
        at + scale * (w * times + alpha * times**2 / 2 + jerk * times**3 / 6),
        speed=scale * (w + alpha * times + jerk * times**2 / 2),
        acceleration=scale * (alpha + jerk * times),
        jerk=scale * jerk,
    )

    def moved(kind: str, key: str, time: float) -> np.ndarray:
        return np.asarray(getattr(every, kind)[key][..., 4 + round(time / step)])

    size = Constraints.of(mechanism).size
    kinds: list[tuple[str, float | np.ndarray]] = [("joints", size), ("angles", 1.0), ("slides", size)]
    for kind, whole in kinds:
        for key in getattr(every, kind):
            now = moved(kind, key, 0.0)

            def unwrapped(time: float, kind: str = kind, key: str = key, now: np.ndarray = now) -> np.ndarray:
                found = moved(kind, key, time).copy()
                if kind == "angles":
                    found[0] = now[0] + np.remainder(found[0] - now[0] + np.pi, 2.0 * np.pi) - np.pi
                return found

            measured = derivative(unwrapped, 1, step)
            for order in (1, 2, 3):
                error = np.abs(now[order] - measured[order - 1]) / (whole + np.abs(now[order]))
                assert error.max() < 1e-7, (kind, key, order, error.max())
                assert np.median(error) < 1e-10, (kind, key, order, np.median(error))
    return len(use)
