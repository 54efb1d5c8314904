"""The best linkages on the grid of a shop, or of the links in stock: all of those near a design, driven.

Rounding each dimension by itself is far from the best, as the errors of several can cancel. Every combination of grid
values within :data:`REACH_STEPS` steps of the design is driven to all targets, or as far as it may still be among the
best; nothing about them is linear, and nothing is left out. A fourbar that guides a body has nine dimensions and two
million combinations.

Links in stock may be far from those of a design. For each choice of them the other dimensions are brought along, from
the design's, by Gauss and Newton's method with the exact derivatives, the links changing in steps; where there is a
grid as well, the others are then searched on it around that.
"""

from __future__ import annotations

import dataclasses
import math
from itertools import product as combined
from typing import NamedTuple, TypeVar

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
"""Of distance, and of angle in radians."""

REACH_STEPS = 2
"""Steps of the grid to either side of a design that are searched, in every dimension at once."""

MAX_KEPT = 256
"""Linkages that are kept of a search, the nearest to the task first."""

BATCH_DIMENSIONS = 6
"""Dimensions that one batch runs over."""

MAX_CHOICES = 64
"""Maximum number of choices of links in stock, those most similar to the design first."""

MAX_REFINED_CHOICES = 6
"""Of these, the best around which a grid is searched."""

STEP_COUNT, NEWTON_STEPS = 6, 3
"""Steps in which links become those of the stock, and steps of Gauss and Newton's method at each."""


class NearbyLinkages(NamedTuple):
    """Linkages near a design, the nearest to its task first.

    Attributes
    ----------
    task : Task
        With adjusted inputs where these are free; misses are measured by the size of the task and in radians.
    rows : float, shape (v, n)
        Their dimensions.
    squares : float, shape (v,)
        Sums of the squares of their misses.
    body : float or None
        Angle from A → B to the body's line, radians, where a body is carried.
    """

    task: Task
    rows: Real
    squares: Real
    body: float | None

    def compute_body_angle(self, coupler: float) -> float | None:
        """The body's angle where A → B has this one, radians; degrees."""
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
        The design, as exact as it was found.
    held : Held
        What it is held to.
    stated : Manufacture
        With ``round`` or ``stock``.
    used : pair of float or None
        The range of the input on which linkages must stay on their branch, radians.
    limits : pair of float, optional
        Errors up to which linkages are looked for: distance, and angle in radians. They hold for the targets that have
        no tolerance of their own, and are not looked at here where some have one.

    Returns
    -------
    Near or str
        :data:`MAX_KEPT` linkages at most; the nearest alone where none keeps the limits. In words why none can be
        looked for.
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
        on_ground=(False, False) if task.slides else held.on_ground,
        ground_angle=float(np.angle(ground)),
    )
    row = linkage.row[: task.dimensions]
    names = linkage.list_names(guides=task.guides)
    kept = None if has_own_tolerances(held) or limits == (math.inf, math.inf) else limits
    body = None
    if task.sort == "poses" and held.angles is not None and task.angles is not None:
        body = float(held.angles[0] - task.angles[0])
    if block.stock is None:
        values = _list_candidates(row, names, block, held.kept)
        rows, taken = _search_combinations(linkage, task, values, kept, screened=block.quality is not None)
        if not len(rows):
            # None keeps them; the one that comes nearest tells by how much.
            rows, taken = (part[:1] for part in _search_combinations(linkage, task, values, None))
        return NearbyLinkages(task, rows, taken, body)
    moving = [k for k, name in enumerate(names) if name.startswith("links.")]
    rows, taken = _search_stock(linkage, task, row, np.array(sorted(set(block.stock.links))), names, held.kept)
    if block.round is not None:
        parts = [(np.empty((0, len(row))), np.empty(0))]
        for centre in rows[:MAX_REFINED_CHOICES]:
            values = _list_candidates(centre, names, block, held.kept)
            for k in moving:
                values[k] = centre[k : k + 1]
            parts.append(_search_combinations(linkage, task, values, None))
        rows, taken = np.concatenate([of for of, _ in parts]), np.concatenate([of for _, of in parts])
    order = np.argsort(taken, kind="stable")[:MAX_KEPT]
    return NearbyLinkages(task, rows[order], taken[order], body)


def has_own_tolerances(held: RequiredTargets) -> bool:
    """Whether targets have tolerances of their own."""
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
        counts = np.arange(-REACH_STEPS, REACH_STEPS + 1) + round(float(at) / step)
        # 3 times 0.1 is not 0.3: a whole multiple is what is written with few digits.
        listed = np.array([float(f"{count * step:.12g}") for count in counts])
        if link:
            listed = listed[listed > 0.0] if (listed > 0.0).any() else np.array([step])
        values.append(listed[np.argsort(np.abs(listed - at), kind="stable")])
    return values


def _list_dial_settings(linkage: Linkage, task: Task, rows: Real) -> Real | None:
    """Where the dial of a slider stands: its places are counted from the foot of the pivot, which the grid moves."""
    if task.guides or not task.slides:
        return None
    moved = (rows[:, 0] - linkage.row[0]) + 1j * (rows[:, 1] - linkage.row[1])
    return np.stack([np.zeros(len(rows)), (moved * np.conj(task.slide_direction)).real], axis=1)


def _search_combinations(
    linkage: Linkage, task: Task, values: list[Real], limits: Limits | None, *, screened: bool = False
) -> tuple[Real, Real]:
    """The best of all combinations of values, driven: rows (v, n) and sums of squares (v,), the least first.

    Only those that keep the limits, where there are such; ``screened``: these are tight, and looked at first.
    """
    split = max(len(values) - BATCH_DIMENSIONS, 0)
    inner = np.stack(np.meshgrid(*values[split:], indexing="ij"), axis=-1).reshape(-1, len(values) - split)
    batch = np.empty((len(inner), len(values)))
    batch[:, split:] = inner
    rows, taken, most = np.empty((0, len(values))), np.empty(0), math.inf
    if limits is not None:
        # Nothing that keeps them has more.
        most = len(task.inputs) * ((limits[0] / task.units[0]) ** 2 + (limits[1] / task.units[1]) ** 2)
    for outer in combined(*values[:split]):
        batch[:, :split] = outer
        settings = _list_dial_settings(linkage, task, batch)
        some: slice | NDArray[np.intp] = slice(None)
        if limits is not None and screened:
            near = measure_shares(dataclasses.replace(task, greatest=True, units=limits), batch, settings)
            some = np.flatnonzero(near <= 1.0 + LIMIT_SLACK)
            settings = None if settings is None else settings[some]
        square = measure_squares(task, batch[some], most, settings)
        good = np.flatnonzero(np.isfinite(square))
        if limits is not None:
            off = measure_deviations(task, batch[some][good], None if settings is None else settings[good])
            kept = (off.distances <= limits[0] * (1.0 + LIMIT_SLACK)) & (off.angles <= limits[1] * (1.0 + LIMIT_SLACK))
            good = good[kept.all(axis=1)]
        if not len(good):
            continue
        rows, taken = np.concatenate([rows, batch[some][good]]), np.concatenate([taken, square[good]])
        if len(taken) > MAX_KEPT:
            first = np.argpartition(taken, MAX_KEPT)[:MAX_KEPT]
            rows, taken = rows[first], taken[first]
            most = float(taken.max())
    order = np.argsort(taken, kind="stable")
    return rows[order], taken[order]


def _search_stock(
    linkage: Linkage, task: Task, row: Real, stock: Real, names: list[str], kept: frozenset[str]
) -> tuple[Real, Real]:
    """Linkages of links in stock, all other dimensions as the task wants them: rows and sums, the least first."""
    moving = [k for k, name in enumerate(names) if name.startswith("links.")]
    free = np.array([k for k, name in enumerate(names) if k not in moving and name not in kept], np.intp)
    away = np.abs(np.log(stock[None] / row[moving][:, None]))
    choices = sorted(combined(range(len(stock)), repeat=len(moving)), key=lambda c: sum(away[range(len(c)), c]))
    rows = [_bring_to_lengths(task, row, moving, stock[list(choice)], free) for choice in choices[:MAX_CHOICES]]
    found = np.array([one for one in rows if one is not None]).reshape(-1, len(row))
    taken = measure_squares(task, found, math.inf, _list_dial_settings(linkage, task, found))
    order = [n for n in np.argsort(taken, kind="stable") if math.isfinite(taken[n])]
    return found[order], taken[order]


def _bring_to_lengths(task: Task, row: Real, moving: list[int], links: Real, free: NDArray[np.intp]) -> Real | None:
    """The dimensions with other links, by steps from those of the design; None where that leads nowhere."""
    weights = np.array([1.0 / task.units[0]] * 2 + [1.0 / task.units[1]])
    loose = dataclasses.replace(task, used=None)
    at = row.copy()
    for share in np.linspace(0.0, 1.0, STEP_COUNT + 1)[1:]:
        at[moving] = row[moving] + share * (links - row[moving])
        for _ in range(NEWTON_STEPS):
            off = compute_sensitivities(loose, at)
            if not (np.isfinite(off.rates).all() and np.isfinite(off.offsets).all()):
                return None
            slopes = (off.rates[:, :, free] * weights[:, None]).reshape(-1, len(free))
            at[free] -= np.linalg.lstsq(slopes, (off.offsets * weights).ravel(), rcond=1e-9)[0]
    at[moving] = links
    return at


def build_mechanism(linkage: Linkage, near: NearbyLinkages, n: int) -> FourbarMechanism | SliderCrankMechanism | None:
    """One of the linkages near a design as an answer states it, standing at the first target; None where it cannot."""
    try:
        return _build_mechanism(linkage, near, n)
    except DimensionError:  # the grid may have both fixed pivots in one place
        return None


def _build_mechanism(linkage: Linkage, near: NearbyLinkages, n: int) -> FourbarMechanism | SliderCrankMechanism | None:
    row, task = near.rows[n], near.task
    driven = measure_deviations(task, row[None], _list_dial_settings(linkage, task, row[None]))
    theta, sign = float(driven.inputs[0, 0]), int(task.assemblies[0])
    if not math.isfinite(theta):
        return None
    point = complex(row[-2], row[-1]) if task.guides else complex(linkage.row[-2], linkage.row[-1])
    o2 = complex(row[0], row[1])
    if task.slide_angle is None:
        o4 = complex(row[2], row[3])
        at = fourbar.positions(Fourbar(o2, o4, row[4], row[5], row[6], point), theta, sign)
        body = near.compute_body_angle(float(at.coupler_angle))
        joints = FourbarConfiguration(o2, complex(at.a), complex(at.b), o4, complex(at.p))
        made = build_fourbar(joints, body)
        return replace_dimensions(made if task.guides else remove_coupler_point(made), row)
    line = o2 - 1j * row[2] * task.slide_direction
    sliding = SliderCrank(o2, line, task.slide_angle, row[3], row[4], point)
    stands = slider_crank.positions(sliding, theta, sign)
    body = near.compute_body_angle(float(stands.coupler_angle))
    slid = build_slider_crank(
        o2, complex(stands.a), complex(stands.b), task.slide_angle, complex(stands.p), body_angle=body
    )
    return replace_dimensions(slid if task.guides else remove_coupler_point(slid), row)


Mechanism = TypeVar("Mechanism", FourbarMechanism, SliderCrankMechanism)


def replace_dimensions(mechanism: Mechanism, row: Real) -> Mechanism:
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
