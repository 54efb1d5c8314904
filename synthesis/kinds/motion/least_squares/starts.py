"""Starting dyads for a fit to many positions.

If an RR dyad is open, the starts are all dyads through sets of five positions, and linear fits to larger sets
(:mod:`synthesis.kinds.motion.least_squares.linear_fit`). If positions have tolerances, sets with random perturbations
within the tolerances are added. For a given pivot a circle is fitted to its images, for a slider a line; both fits are
linear.
"""

from __future__ import annotations

import math
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Mask, Real
from synthesis.kinds.motion.least_squares.constraint_manifold import DYAD_NUMBER_COUNT, Surface, make_surface
from synthesis.kinds.motion.least_squares.linear_fit import fit_dyads
from synthesis.kinds.motion.least_squares.pose_fit import PoseConstraints
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.positions import MotionTask, find_given_pivot

MAX_SETS = 160
"""Maximum number of sets of five positions."""

LARGER_SET_COUNT = 40
"""Number of sets of more than five positions, each of random size."""

MAX_REACH = 300.0
"""Maximum distance of a starting pivot, in task sizes; farther pivots approximate a slider."""

MIN_LENGTH = 1e-3
"""Minimum link length of a starting dyad, in task sizes."""


class Start(NamedTuple):
    """A starting dyad: its type (RR, PR or RP), surface and numbers, and the mask of numbers fixed by the client."""

    dyad: str
    surface: Surface
    numbers: Real
    fixed: Mask


def list_starts(
    task: MotionTask, demands: PoseConstraints, choices: DyadChoices, rng: np.random.Generator
) -> list[Start]:
    """Return the starting dyads of one side."""
    if choices.dyad == "PR":
        return _fit_slider(task, demands, choices, inverted=False)
    if choices.dyad == "RP":
        return _fit_slider(task, demands, choices, inverted=True)
    stated = _select_given_pivot(task, choices)
    if stated is not None:
        inverted, point = stated
        return _fit_circle(demands, inverted, point)
    fixed, moving = _find_dyads(demands, rng)
    found = []
    for o, a in zip(fixed, moving, strict=True):
        surface, numbers = make_surface(complex(o), complex(a))
        found.append(Start("RR", surface, numbers, np.zeros(DYAD_NUMBER_COUNT, np.bool_)))
    return found


def as_slider(start: Start) -> Start:
    """Return the slider that approximates an RR dyad with a distant pivot."""
    numbers = start.numbers.copy()
    numbers[4] = 0.0
    surface = start.surface._replace(curved=False)
    return Start("RP" if surface.inverted else "PR", surface, numbers, start.fixed)


def _select_given_pivot(task: MotionTask, choices: DyadChoices) -> tuple[bool, complex] | None:
    """Return the given pivot as (whether it is the fixed one, position in task coordinates); None without one."""
    fixed, moving = (find_given_pivot(task, choices, fixed=side) for side in (True, False))
    if fixed is not None:
        return True, fixed
    return None if moving is None else (False, moving)


def _compute_images(demands: PoseConstraints, inverted: bool, point: complex) -> Complex:
    """Return the positions of a body point (or of a fixed point relative to the body) in the target poses."""
    p, spin = demands.poses[:, 0] + 1j * demands.poses[:, 1], np.exp(1j * demands.poses[:, 2])
    return np.asarray(np.conj(spin) * (point - p) if inverted else p + spin * point)


def _fit_circle(demands: PoseConstraints, inverted: bool, point: complex) -> list[Start]:
    """Fit a circle to the images of a given pivot, by linear least squares of |z|² − 2Re(conj(m)z) + k."""
    images = _compute_images(demands, inverted, point)
    rows = np.stack([2.0 * images.real, 2.0 * images.imag, np.ones(len(images))], axis=1)
    solution, *_ = np.linalg.lstsq(rows, np.abs(images) ** 2, rcond=None)
    centre = complex(solution[0], solution[1])
    radius = math.sqrt(max(float(solution[2]) + abs(centre) ** 2, 0.0))
    if not radius > MIN_LENGTH:
        return []
    arm = images[0] - centre
    numbers = np.array([point.real, point.imag, math.atan2(arm.imag, arm.real), 0.0, 1.0 / radius])
    foot = centre + radius * arm / abs(arm)
    fixed = np.array([True, True, False, False, False])
    return [Start("RR", Surface(inverted, complex(foot), True), numbers, fixed)]


def _fit_slider(task: MotionTask, demands: PoseConstraints, choices: DyadChoices, *, inverted: bool) -> list[Start]:
    """Fit a line to the images of the best point, or of the given point."""
    fixed = np.zeros(DYAD_NUMBER_COUNT, np.bool_)
    normal = None
    if choices.slide_angle is not None:
        normal = math.radians(choices.slide_angle) - 0.5 * math.pi
        fixed[2] = True
    stated = _select_given_pivot(task, choices)
    if stated is not None:
        point, angle = stated[1], normal
        fixed[:2] = True
        if angle is None:
            images = _compute_images(demands, inverted, point)
            # Squaring doubles the angles, so the mean gives the principal direction, which is defined modulo π.
            gaps = images - images.mean()
            angle = 0.5 * float(np.angle(np.sum(gaps * gaps))) + 0.5 * math.pi
    else:
        point, angle = _find_best_slider(demands, inverted, normal)
    images = _compute_images(demands, inverted, point)
    origin = complex(images.mean())
    surface = Surface(inverted, origin, False)
    numbers = np.array([point.real, point.imag, angle, 0.0, 0.0])
    return [Start("RP" if inverted else "PR", surface, numbers, fixed)]


def _find_best_slider(demands: PoseConstraints, inverted: bool, normal: float | None) -> tuple[complex, float]:
    """Find the point whose images lie nearest to a line, and the normal's angle; linear, with n on the unit circle.

    PR: Re(conj(n) p) + Re(c e^{iφ}) = d with c = conj(n) α. RP: Re(conj(n) p e^{−iφ}) + Re(c e^{iφ}) = −d with
    c = −n conj(O).
    """
    p, spin = demands.poses[:, 0] + 1j * demands.poses[:, 1], np.exp(1j * demands.poses[:, 2])
    q = np.conj(np.conj(p) * spin) if inverted else p
    with_n = np.stack([q.real, q.imag], axis=1)
    rest = np.stack([spin.real, -spin.imag, np.ones(len(p))], axis=1)
    # Eliminate c and d first; the normal is then the smallest singular vector of the remaining 2-column system.
    left = with_n - rest @ np.linalg.lstsq(rest, with_n, rcond=None)[0]
    if normal is None:
        n = np.linalg.svd(left)[2][-1]
        normal = math.atan2(n[1], n[0])
    else:
        n = np.array([math.cos(normal), math.sin(normal)])
    c = np.linalg.lstsq(rest, -with_n @ n, rcond=None)[0]
    unit = complex(n[0], n[1])
    point = complex(c[0], c[1])
    return (-unit * point.conjugate() if inverted else unit * point), normal


def _find_dyads(demands: PoseConstraints, rng: np.random.Generator) -> tuple[Complex, Complex]:
    """Find RR dyads through sets of five poses and near larger sets; drop those of extreme size."""
    poses = demands.poses
    n, held = len(poses), demands.exact_count
    # Every set contains the exact poses, which all starts should meet.
    kept = [k for k in np.argsort(-held, kind="stable") if held[k] == 3][:5]
    others = [k for k in range(n) if k not in kept]
    wanted = 5 - len(kept)
    if math.comb(len(others), wanted) <= MAX_SETS:
        fives = [[*kept, *some] for some in combinations(others, wanted)]
    else:
        fives = [[*kept, *rng.choice(others, wanted, replace=False)] for _ in range(MAX_SETS)]
    sets = np.array(fives, np.int64)
    listed = [poses[sets]]
    if np.any((demands.tolerances > 0.0) & np.isfinite(demands.tolerances)):
        moved = rng.uniform(-1.0, 1.0, (MAX_SETS, 5, 3)) * demands.tolerances[sets[np.arange(MAX_SETS) % len(sets)]]
        listed.append(poses[sets[np.arange(MAX_SETS) % len(sets)]] + moved)
    fixed, moving = [], []
    for batch in [
        *listed,
        *(poses[None, _sample_indices(n, rng)] for _ in range(LARGER_SET_COUNT if n > 6 else 0)),
        poses[None],
    ]:
        o, a = fit_dyads(batch[..., 0] + 1j * batch[..., 1], batch[..., 2])
        fixed.append(o)
        moving.append(a)
    o, a = np.concatenate(fixed), np.concatenate(moving)
    good = (np.abs(o) < MAX_REACH) & (np.abs(a) < MAX_REACH) & (np.abs(a - o) > MIN_LENGTH)
    return o[good], a[good]


def _sample_indices(n: int, rng: np.random.Generator) -> NDArray[np.int64]:
    return np.asarray(rng.choice(n, int(rng.integers(6, n)), replace=False))
