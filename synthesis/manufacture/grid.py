"""Search for the best linkages near a design on the grid of a shop, or with links in stock.

Rounding each dimension separately is far from optimal, because the errors of several dimensions can cancel. Every
combination of grid values within :data:`REACH_STEPS` steps of the design is driven to all targets, or until it can no
longer be among the best. No linearization is used, and no combination is omitted. A fourbar that guides a body has nine
dimensions and two million combinations.

Links in stock may differ much from those of a design. For each choice of links, the other dimensions are found by the
Gauss-Newton method with exact derivatives, starting from those of the design, while the links change in steps. If a
grid is requested as well, the other dimensions are then searched on the grid around the result.
"""

from __future__ import annotations

import dataclasses
import math
from itertools import product as combined
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.errors import DimensionError
from kinematics.linkage import Fourbar, SliderCrank, fourbar, slider_crank
from kinematics.linkage.variation import Task, measure_deviations, measure_shares, measure_squares
from kinematics.linkage.variation.sensitivities import compute_sensitivities
from synthesis.manufacture.linkage import LIMIT_SLACK, Linkage, find_target_inputs
from synthesis.model.linkage.answer import (
    CouplerPoint,
    FixedPivots,
    FourbarLinks,
    FourbarMechanism,
    SliderCrankLinks,
    SliderCrankMechanism,
)
from synthesis.model.linkage.conversion import (
    FourbarConfiguration,
    build_fourbar,
    build_slider_crank,
    remove_coupler_point,
)
from synthesis.model.manufacture.request import Manufacture, RequiredTargets

Limits = tuple[float, float]
"""Limit of the distance from a target, and limit of the angle, radians."""

REACH_STEPS = 2
"""Number of grid steps to either side of a design that are searched, in all dimensions at once."""

MAX_KEPT = 256
"""Maximum number of linkages that a search keeps: those with the smallest errors at the targets."""

BATCH_DIMENSIONS = 6
"""Number of dimensions covered by one batch: 5⁶ = 15,625 combinations fit the cache."""

MAX_CHOICES = 64
"""Maximum number of choices of links in stock, those most similar to the design first."""

MAX_REFINED_CHOICES = 6
"""Maximum number of choices of links around which a grid is searched, the best first."""

STEP_COUNT, NEWTON_STEPS = 6, 3
"""Number of steps in which the links change to those in stock, and number of Gauss-Newton steps at each of them."""


class NearbyLinkages(NamedTuple):
    """Linkages near a design, those with the smallest errors first.

    Attributes
    ----------
    task : Task
        Targets of the linkages. Inputs are adjusted if they are free. The units of errors are the size of the task and
        the radian.
    rows : float, shape (v, n)
        Dimensions of the v linkages.
    squares : float, shape (v,)
        Sums of the squares of their errors at the targets.
    body : float or None
        Angle from A → B to the body's line, radians; None if no body is carried.
    """

    task: Task
    rows: Real
    squares: Real
    body: float | None

    def compute_body_angle(self, coupler: float) -> float | None:
        """Return the body's angle, degrees, if the direction of A → B is ``coupler``, radians."""
        return None if self.body is None else math.degrees(coupler + self.body)


def find_nearest_on_grid(
    linkage: Linkage,
    held: RequiredTargets,
    block: Manufacture,
    used: tuple[float, float] | None,
    limits: Limits = (math.inf, math.inf),
) -> NearbyLinkages | str:
    """Find the linkages on the grid, or from the stock, that best satisfy a design's requirements.

    Parameters
    ----------
    linkage : Linkage
        The design before rounding.
    held : RequiredTargets
        Requirements on the design at its targets.
    block : Manufacture
        The block of the problem, with ``round`` or ``stock``.
    used : pair of float or None
        Range of the input, radians, on which the linkages must stay on their branch; None without this requirement.
    limits : pair of float, optional
        Maximum errors: distance, and angle in radians. They are ignored if some targets have tolerances of their own.

    Returns
    -------
    NearbyLinkages or str
        At most :data:`MAX_KEPT` linkages; only the best one if none satisfies the limits. A message if the search is
        impossible.
    """
    found = find_target_inputs(linkage, held, (held.size, 1.0), used)
    if isinstance(found, str):
        return found
    task, _ = found
    ground = complex(linkage.row[2] - linkage.row[0], linkage.row[3] - linkage.row[1])
    task = dataclasses.replace(
        task,
        adjusted=held.free,
        greatest=False,
        # A slide lies on its line for every offset; a ground line may have to keep a given point or direction.
        on_ground=(False, False) if task.slides else held.on_ground,
        ground_angle=float(np.angle(ground)),
    )
    row = linkage.row[: task.dimensions]
    names = linkage.list_names(guides=task.guides)
    # The limits can reject linkages only if they apply to every target.
    kept = None if has_own_tolerances(held) or limits == (math.inf, math.inf) else limits
    body = None
    if task.sort == "poses" and held.angles is not None and task.angles is not None:
        body = float(held.angles[0] - task.angles[0])
    if block.stock is None:
        values = _list_candidates(row, names, block, held.kept)
        rows, taken = _search_combinations(linkage, task, values, kept, screened=block.quality is not None)
        if not len(rows):
            # No linkage satisfies the limits: return the best one, whose error shows how coarse the grid is.
            rows, taken = (part[:1] for part in _search_combinations(linkage, task, values, None))
        return NearbyLinkages(task, rows, taken, body)
    # Otherwise the links are taken from the stock.
    moving = [k for k, name in enumerate(names) if name.startswith("links.")]
    rows, taken = _search_stock(linkage, task, row, np.array(sorted(set(block.stock.links))), names, held.kept)
    if block.round is not None:
        parts = [(np.empty((0, len(row))), np.empty(0))]
        for centre in rows[:MAX_REFINED_CHOICES]:
            # The links remain those in stock; only the other dimensions are searched on the grid.
            values = _list_candidates(centre, names, block, held.kept)
            for k in moving:
                values[k] = centre[k : k + 1]
            parts.append(_search_combinations(linkage, task, values, None))
        rows, taken = np.concatenate([of for of, _ in parts]), np.concatenate([of for _, of in parts])
    order = np.argsort(taken, kind="stable")[:MAX_KEPT]
    return NearbyLinkages(task, rows[order], taken[order], body)


def has_own_tolerances(held: RequiredTargets) -> bool:
    """Return whether some targets have tolerances of their own, given by the task."""
    return held.limits is not None and bool(((held.limits > 0.0) & np.isfinite(held.limits)).any())


def _list_candidates(row: Real, names: list[str], block: Manufacture, kept: frozenset[str]) -> list[Real]:
    """Return the grid values of each dimension; only the given value for a fixed dimension."""
    assert block.round is not None
    values = []
    for at, name in zip(row, names, strict=True):
        link = name.startswith("links.")
        step = block.round.length if link or name.startswith("coupler_point") else block.round.coordinates
        if name in kept:
            values.append(np.array([at]))
            continue
        # Grid values around the nearest one.
        counts = np.arange(-REACH_STEPS, REACH_STEPS + 1) + round(float(at) / step)
        # In binary, 3 · 0.1 is not 0.3: round to 12 digits to get the decimal multiple that a user expects.
        listed = np.array([float(f"{count * step:.12g}") for count in counts])
        # Links need positive lengths. A link much shorter than a step gets the length of one step.
        if link:
            listed = listed[listed > 0.0] if (listed > 0.0).any() else np.array([step])
        # The nearest values come first, so that good combinations are found early and shorten the rest of the search.
        values.append(listed[np.argsort(np.abs(listed - at), kind="stable")])
    return values


def _list_dial_settings(linkage: Linkage, task: Task, rows: Real) -> Real | None:
    """Return the dial settings of a slider for each row of dimensions; None for other tasks.

    The positions of a slider are counted from the foot of the fixed pivot on its line, which moves with the pivot.
    """
    if task.guides or not task.slides:
        return None
    moved = (rows[:, 0] - linkage.row[0]) + 1j * (rows[:, 1] - linkage.row[1])
    return np.stack([np.zeros(len(rows)), (moved * np.conj(task.slide_direction)).real], axis=1)


def _search_combinations(
    linkage: Linkage, task: Task, values: list[Real], limits: Limits | None, *, screened: bool = False
) -> tuple[Real, Real]:
    """Drive all combinations of values and return the best ones: rows (v, n) and sums of squares (v,), smallest first.

    With ``limits``, only combinations that satisfy them are returned. ``screened`` means that the limits are tight, so
    that it is faster to test them first.
    """
    # The last dimensions form a batch, and the first ones are enumerated around it; this limits the memory.
    split = max(len(values) - BATCH_DIMENSIONS, 0)
    inner = np.stack(np.meshgrid(*values[split:], indexing="ij"), axis=-1).reshape(-1, len(values) - split)
    batch = np.empty((len(inner), len(values)))
    batch[:, split:] = inner
    rows, taken, most = np.empty((0, len(values))), np.empty(0), math.inf
    if limits is not None:
        # No combination within the limits at every target has a larger sum of squares.
        most = len(task.inputs) * ((limits[0] / task.units[0]) ** 2 + (limits[1] / task.units[1]) ** 2)
    for outer in combined(*values[:split]):
        batch[:, :split] = outer
        settings = _list_dial_settings(linkage, task, batch)
        some: slice | NDArray[np.intp] = slice(None)
        if limits is not None and screened:
            near = measure_shares(dataclasses.replace(task, greatest=True, units=limits), batch, settings)
            some = np.flatnonzero(near <= 1.0 + LIMIT_SLACK)
            settings = None if settings is None else settings[some]
        # A combination is driven only until its sum exceeds `most`, the largest sum of those kept so far.
        square = measure_squares(task, batch[some], most, settings)
        good = np.flatnonzero(np.isfinite(square))
        if limits is not None:
            off = measure_deviations(task, batch[some][good], None if settings is None else settings[good])
            kept = (off.distances <= limits[0] * (1.0 + LIMIT_SLACK)) & (off.angles <= limits[1] * (1.0 + LIMIT_SLACK))
            good = good[kept.all(axis=1)]
        if not len(good):
            continue
        rows, taken = np.concatenate([rows, batch[some][good]]), np.concatenate([taken, square[good]])
        # Discard the worst as soon as there are too many; the lower threshold speeds up the rest of the search.
        if len(taken) > MAX_KEPT:
            first = np.argpartition(taken, MAX_KEPT)[:MAX_KEPT]
            rows, taken = rows[first], taken[first]
            most = float(taken.max())
    order = np.argsort(taken, kind="stable")
    return rows[order], taken[order]


def _search_stock(
    linkage: Linkage, task: Task, row: Real, stock: Real, names: list[str], kept: frozenset[str]
) -> tuple[Real, Real]:
    """Return linkages with links in stock, whose other dimensions are fitted to the task.

    Return rows of dimensions and sums of squares, smallest first.
    """
    moving = [k for k, name in enumerate(names) if name.startswith("links.")]
    free = np.array([k for k, name in enumerate(names) if k not in moving and name not in kept], np.intp)
    # Try the most similar links first, by the sum of logarithmic differences.
    away = np.abs(np.log(stock[None] / row[moving][:, None]))
    choices = sorted(combined(range(len(stock)), repeat=len(moving)), key=lambda c: sum(away[range(len(c)), c]))
    rows = [_bring_to_lengths(task, row, moving, stock[list(choice)], free) for choice in choices[:MAX_CHOICES]]
    found = np.array([one for one in rows if one is not None]).reshape(-1, len(row))
    taken = measure_squares(task, found, math.inf, _list_dial_settings(linkage, task, found))
    order = [n for n in np.argsort(taken, kind="stable") if math.isfinite(taken[n])]
    return found[order], taken[order]


def _bring_to_lengths(task: Task, row: Real, moving: list[int], links: Real, free: NDArray[np.intp]) -> Real | None:
    """Return the dimensions of a linkage with other links, reached in steps from the design; None if a step fails."""
    weights = np.array([1.0 / task.units[0]] * 2 + [1.0 / task.units[1]])
    # On the way, the linkages need not stay on their branch; the caller verifies the result.
    loose = dataclasses.replace(task, used=None)
    at = row.copy()
    for share in np.linspace(0.0, 1.0, STEP_COUNT + 1)[1:]:
        # Change the links in steps, so that the Gauss-Newton method stays near its solution.
        at[moving] = row[moving] + share * (links - row[moving])
        for _ in range(NEWTON_STEPS):
            off = compute_sensitivities(loose, at)
            if not (np.isfinite(off.rates).all() and np.isfinite(off.offsets).all()):
                return None
            slopes = (off.rates[:, :, free] * weights[:, None]).reshape(-1, len(free))
            # Take the least-squares solution of minimum norm, because few targets may leave dimensions undetermined.
            at[free] -= np.linalg.lstsq(slopes, (off.offsets * weights).ravel(), rcond=1e-9)[0]
    at[moving] = links
    return at


def build_mechanism(linkage: Linkage, near: NearbyLinkages, n: int) -> FourbarMechanism | SliderCrankMechanism | None:
    """Build linkage ``n`` near a design as a mechanism of an answer, at the first target; None if it is impossible."""
    try:
        return _build_mechanism(linkage, near, n)
    except DimensionError:  # on the grid both fixed pivots may coincide
        return None


def _build_mechanism(linkage: Linkage, near: NearbyLinkages, n: int) -> FourbarMechanism | SliderCrankMechanism | None:
    row, task = near.rows[n], near.task
    driven = measure_deviations(task, row[None], _list_dial_settings(linkage, task, row[None]))
    theta, sign = float(driven.inputs[0, 0]), int(task.assemblies[0])
    if not math.isfinite(theta):
        return None
    # Linkages that guide no point keep the point of the design, which has no effect.
    point = complex(row[-2], row[-1]) if task.guides else complex(linkage.row[-2], linkage.row[-1])
    o2 = complex(row[0], row[1])
    if task.slide_angle is None:
        o4 = complex(row[2], row[3])
        at = fourbar.positions(Fourbar(o2, o4, row[4], row[5], row[6], point), theta, sign)
        body = near.compute_body_angle(float(at.coupler_angle))
        joints = FourbarConfiguration(o2, complex(at.a), complex(at.b), o4, complex(at.p))
        made = build_fourbar(joints, body)
        # The mechanism is built from computed joints, but its dimensions must be exactly the grid values.
        return replace_dimensions(made if task.guides else remove_coupler_point(made), row)
    line = o2 - 1j * row[2] * task.slide_direction
    sliding = SliderCrank(o2, line, task.slide_angle, row[3], row[4], point)
    stands = slider_crank.positions(sliding, theta, sign)
    body = near.compute_body_angle(float(stands.coupler_angle))
    slid = build_slider_crank(
        o2, complex(stands.a), complex(stands.b), task.slide_angle, complex(stands.p), body_angle=body
    )
    return replace_dimensions(slid if task.guides else remove_coupler_point(slid), row)


def replace_dimensions(
    mechanism: FourbarMechanism | SliderCrankMechanism, row: Real
) -> FourbarMechanism | SliderCrankMechanism:
    """Return a mechanism with exactly the dimensions ``row``; its joints agree with them to rounding."""
    at = [float(value) for value in row]
    update: dict[str, object]
    if isinstance(mechanism, FourbarMechanism):
        ground = math.hypot(at[2] - at[0], at[3] - at[1])
        update = {
            "fixed_pivots": FixedPivots(input=(at[0], at[1]), output=(at[2], at[3])),
            "links": FourbarLinks(ground=ground, input=at[4], coupler=at[5], output=at[6]),
        }
        place = at[7:]
    else:
        update = {
            "fixed_pivot": (at[0], at[1]),
            "links": SliderCrankLinks(crank=at[3], coupler=at[4]),
            "offset": at[2],
        }
        place = at[5:]
    if place:
        angle = math.degrees(math.atan2(place[1], place[0]))
        update["coupler_point"] = CouplerPoint(distance=math.hypot(*place), angle=angle)
    return mechanism.model_copy(update=update)
