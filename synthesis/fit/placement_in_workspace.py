"""Placement of a fourbar with free position, direction and size in a workspace.

Similarities z → o + w z are sampled with pivots in their zones. Those with the best zone margins are evaluated over the
motion, and the best of these are improved until they satisfy all margins of the workspace
(:mod:`synthesis.fit.workspace_margins`). The improvement uses the simplex method of Nelder and Mead (Computer Journal
7, 1965, 308–313), because the margin is a function of four numbers with kinks.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.fourbar_workspace import NO_BODY, find_crank_interval, trace_joints
from synthesis.fit.workspace import O2, O4, PLACES, A, B, pack_workspace, select_zones
from synthesis.fit.workspace_margins import ROW_SIZE, compute_margins, count_margins, count_steps
from synthesis.model.linkage.workspace import Space
from synthesis.model.linkage.zones import AnyZone, Zone
from synthesis.numerics.box_placement import Boxes, Placement

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult


SAMPLED_COUNT, SWEPT_COUNT, OPTIMIZED_COUNT = 3000, 60, 3
"""Numbers of placements that are sampled, of those evaluated over the motion, and of those then improved."""

MAX_ITERATIONS = 120
"""Maximum number of iterations of the simplex method."""

EDGE_MARGIN = 0.1
"""Edge of the first simplex: a share of the size for lengths, radians for the direction."""

SIZE_SPREAD = 0.7
"""Standard deviation of the logarithm of a sampled size, if no two zones determine it."""

CENTER_SPREAD = 2.0
"""Standard deviation of a sampled position from the origin, in ground links, without zones and box."""


class MovingFourbar(NamedTuple):
    """A fourbar in its own frame, O2 at 0 and O4 at 1.

    Attributes
    ----------
    lengths : float, shape (4,)
        Lengths of ground (1), input, coupler and output.
    sign : float
        Assembly.
    ends : float, shape (2,)
        Crank angles from the ground line at the ends of the used range.
    first : float
        Crank angle from the ground line at the first target.
    """

    lengths: Real
    sign: float
    ends: Real
    first: float


def place_in_workspace(
    space: Space, linkage: MovingFourbar, boxes: Boxes, sizes: tuple[float, float], preferred: Placement
) -> Placement | None:
    """Find a placement that satisfies all margins of the workspace, or None.

    A placement that violates limits of size or boxes is not accepted, because it would be rejected later in any case.

    Parameters
    ----------
    space : Space
        The workspace, in length units.
    linkage : MovingFourbar
        The fourbar.
    boxes : Boxes
        Additional boxes of O2, O4, A and B at the first target.
    sizes : pair of float
        Minimum and maximum length of the ground link.
    preferred : Placement
        A placement that ignores the workspace: returned if it fits, else tried with the others.
    """
    scale = abs(preferred.along)
    room = pack_workspace(space, 0j, scale)
    # No constraints in the workspace: any placement fits.
    if not len(room):
        return preferred
    # Trace the linkage once in its own frame; every placement only transforms these points.
    x = np.zeros(9)
    begin, end, ring, _ = find_crank_interval(linkage.lengths, linkage.ends, False, room)
    own, home = np.zeros((count_steps(ring), PLACES), np.complex128), np.zeros(PLACES, np.complex128)
    # A linkage that meets a toggle on the way fits nowhere.
    if not trace_joints(x, linkage.lengths, linkage.sign, begin, end, ring, linkage.first, NO_BODY, own, home):
        return None
    sides = np.stack([boxes.left, boxes.right, boxes.low, boxes.high], axis=1) / scale
    # The floor keeps the logarithm of a minimum size 0 finite.
    low, high = (math.log(max(size / scale, 1e-9)) if size < math.inf else math.inf for size in sizes)

    def compute_all_margins(tried: Real, of: Real) -> Real:
        return np.asarray(_compute_place_margins(of, own, ring, home, sides, low, high, np.ascontiguousarray(tried)))

    here = np.array([preferred.origin.real / scale, preferred.origin.imag / scale, 0.0, np.angle(preferred.along)])
    if compute_all_margins(here[None], room)[0] >= 0.0:
        return preferred
    tried = np.concatenate([here[None], _sample_places(space, scale, home)])
    # Clip samples to permitted sizes, because a rejected sample would be wasted.
    tried[:, 2] = np.clip(tried[:, 2], low, high)
    # Zones cost no motion: use them to discard most samples before the expensive margins along the motion.
    zones = select_zones(room)
    if len(zones):
        kept = compute_all_margins(tried, zones)
        # Satisfied zones count alike, so that their margins do not favour some samples; the stable sort keeps the
        # order.
        tried = tried[np.argsort(-np.minimum(kept, 0.0), kind="stable")[:SWEPT_COUNT]]
    else:
        tried = tried[:SWEPT_COUNT]
    kept = compute_all_margins(tried, room)
    order = np.argsort(-kept, kind="stable")[:OPTIMIZED_COUNT]
    best, value = tried[order[0]], float(kept[order[0]])
    # Improve only if no sample is feasible already, in the order of their margins.
    for start in tried[order] if value < 0.0 else ():
        there, margin = _improve_place(start, lambda at: float(compute_all_margins(at[None], room)[0]))
        if margin > value:
            best, value = there, margin
        if value >= 0.0:
            break
    if value < 0.0:
        return None
    along = complex(scale * math.exp(best[2]) * np.exp(1j * best[3]))
    return Placement(scale * complex(best[0], best[1]), along, True)


def _improve_place(start: Real, margin: Callable[[Real], float]) -> tuple[Real, float]:
    """Maximize a margin, stopping as soon as it is not negative; return the place and the margin there."""
    from scipy.optimize import minimize

    # Any feasible placement will do, so the maximum itself is not needed.
    def check_feasible(intermediate_result: OptimizeResult) -> None:
        if intermediate_result.fun <= 0.0:
            raise StopIteration

    simplex = start + EDGE_MARGIN * np.concatenate([np.zeros((1, 4)), np.eye(4)])
    options = {"maxiter": MAX_ITERATIONS, "initial_simplex": simplex}
    found = minimize(lambda at: -margin(at), start, method="Nelder-Mead", callback=check_feasible, options=options)
    return np.asarray(found.x), -float(found.fun)


def _sample_places(space: Space, scale: float, home: Complex) -> Real:
    """Sample places (x, y, logarithm of the size, direction) with one or two pivots in their zones, shape (n, 4)."""
    # A fixed seed: the result must not depend on the order in which linkages are placed.
    rng = np.random.default_rng(0)
    fixed, moving = space.fixed_pivots, space.moving_pivots
    stated = [
        (O2, None if fixed is None else fixed.input),
        (O4, None if fixed is None else fixed.output),
        (A, None if moving is None else moving.input),
        (B, None if moving is None else moving.output),
    ]
    drawn = [
        (home[joint], (zone if isinstance(zone, Zone) else AnyZone(zone)).sample_points(rng, SAMPLED_COUNT) / scale)
        for joint, zone in stated
        if zone is not None
    ]
    # Two pivots with sampled positions determine the similarity; with fewer, size and direction are sampled, too.
    if len(drawn) > 1:
        # A similarity with p → at and q → other.
        (p, at), (q, other) = drawn[:2]
        along = (other - at) / (q - p)
    else:
        along = np.exp(
            SIZE_SPREAD * rng.normal(size=SAMPLED_COUNT) + 1j * rng.uniform(-math.pi, math.pi, SAMPLED_COUNT)
        )
        if drawn:
            p, at = drawn[0]
        else:
            # Without zones, sample the linkage's centre instead of a pivot.
            p, at = complex(home[:4].mean()), _sample_centers(space, scale, rng)
    origin = at - along * p
    return np.stack([origin.real, origin.imag, np.log(np.abs(along)), np.angle(along)], axis=1)


def _sample_centers(space: Space, scale: float, rng: np.random.Generator) -> Complex:
    """Sample places in the box, or about the origin without one, shape (n,)."""
    if space.box is not None:
        (left, low), (right, high) = space.box
        return np.asarray(
            (rng.uniform(left, right, SAMPLED_COUNT) + 1j * rng.uniform(low, high, SAMPLED_COUNT)) / scale
        )
    return np.asarray(CENTER_SPREAD * (rng.normal(size=SAMPLED_COUNT) + 1j * rng.normal(size=SAMPLED_COUNT)))


@njit(cache=True, nogil=True)
def _compute_place_margins(
    room: Real, own: Complex, ring: bool, home: Complex, sides: Real, low: float, high: float, tried: Real
) -> Real:
    """Compute the minimum margin of each tried place, including the margins of its size and of its pivots' boxes."""
    values, rows = np.empty(count_margins(room)), np.empty((count_margins(room), ROW_SIZE))
    least = np.empty(len(tried))
    for i in range(len(tried)):
        x, y, size, turn = tried[i]
        origin, along = complex(x, y), math.exp(size) * complex(math.cos(turn), math.sin(turn))
        there = origin + along * home
        compute_margins(room, origin + along * own, ring, there, values, rows)
        least[i] = min(values.min(), size - low, high - size)
        for k, joint in enumerate((O2, O4, A, B)):
            place = there[joint]
            least[i] = min(
                least[i], place.real - sides[k, 0], sides[k, 1] - place.real,
                place.imag - sides[k, 2], sides[k, 3] - place.imag,
            )  # fmt: skip
    return least
