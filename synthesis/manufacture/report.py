"""Manufacturing report of a design: yield, worst case, sensitivities, and the most important tolerances."""

from __future__ import annotations

import math
from itertools import product as combined
from typing import NamedTuple

import numpy as np
from pydantic import BaseModel

from kinematics.arrays import Real
from kinematics.linkage.variation import measure_deviations
from kinematics.linkage.variation.sensitivities import Sensitivities, compute_sensitivities
from kinematics.message import compose
from synthesis.manufacture.linkage import ManufacturedLinkage, build_product, extract_linkage
from synthesis.manufacture.play import compute_plays
from synthesis.manufacture.widest_tolerances import find_widest_tolerances
from synthesis.manufacture.yield_sampling import get_clearance, list_errors, sample_yield
from synthesis.model.manufacture.answer import Allocation, ManufactureReport, Sensitivity, WorstCase, Yield
from synthesis.model.manufacture.request import Exactness, Manufacture, RequiredTargets

IMPORTANT_SHARE = 0.8
"""Share of the sum of squares of all errors that the tolerances reported as important cause together."""


class ManufactureResult(NamedTuple):
    """Manufacturing results of a design, and its yield if it is sampled."""

    manufactured: ManufactureReport
    yield_: Yield | None


def report_manufacture(
    mechanism: BaseModel, held: RequiredTargets, block: Exactness, seed: int, used: tuple[float, float] | None
) -> ManufactureResult:
    """Compute all manufacturing results of a design.

    Parameters
    ----------
    mechanism : a model of a mechanism
        The mechanism, as drawn.
    held : RequiredTargets
        Requirements on the design at its targets.
    block : Exactness
        The block of the request.
    seed : int
        Seed of the problem, used if the block has none.
    used : pair of float or None
        Range of the input, radians, on which the design must stay on its branch; None without this requirement.
    """
    linkage = extract_linkage(mechanism)
    if linkage is None:
        mechanism_type = mechanism.model_dump(include={"type"})["type"]
        return ManufactureResult(
            ManufactureReport(remark=compose("manufacture-type-not-supported", mechanism=mechanism_type)), None
        )
    made = build_product(linkage, held, block, used)
    if isinstance(made, str):
        return ManufactureResult(ManufactureReport(remark=made), None)
    off = list_errors(block, linkage.mark_pivots(guides=made.task.guides))
    share, rates = _compute_shares(made, off)
    # Sensitivities are listed by decreasing contribution, also in the answer.
    listed = [
        _describe_sensitivity(made, rates, k, float(off[k]), float(share[k])) for k in np.argsort(-share, kind="stable")
    ]
    remark = None if np.isfinite(rates.rates).all() else compose("manufacture-toggle-at-target")
    clearance = get_clearance(block)
    play = compute_plays(made, clearance) if clearance > 0.0 else []
    # None means that the clearances let the linkage reach a toggle, not that its play is zero.
    if play is None:
        remark = compose("manufacture-toggle-within-clearances")
    allocated: list[Allocation] = []
    if isinstance(block, Manufacture) and block.widest:
        allocated = find_widest_tolerances(
            made, block, seed if block.seed is None else block.seed, _compute_squares(made, rates), off
        )
    # The seed of the block has precedence, so that a client can vary the samples without changing the search.
    seeded = seed if block.seed is None else block.seed
    report = ManufactureReport(
        seed=seeded if block.is_sampled else None,
        worst_case=_find_worst_case(made, off),
        matter=_select_important(listed),
        sensitivities=[one for one in listed if one is not None],
        play=play or [],
        widest=allocated,
        remark=remark,
    )
    return ManufactureResult(report, sample_yield(made, block, seeded) if block.is_sampled else None)


def _compute_shares(made: ManufacturedLinkage, off: Real) -> tuple[Real, Sensitivities]:
    """Return the share of each tolerance in the sum of squares of all errors, shape (n,), and the derivatives.

    The shares are 0 if the derivatives are not finite.
    """
    rates = compute_sensitivities(made.task, made.nominal_dimensions)
    added = _compute_squares(made, rates) * off * off
    whole = float(added.sum())
    return (added / whole if 0.0 < whole < math.inf else np.zeros(len(off))), rates


def _compute_squares(made: ManufacturedLinkage, rates: Sensitivities) -> Real:
    """Return the contribution of each dimension to the sum of squares of all errors, shape (n,).

    The contributions are per square of the tolerance of the dimension.
    """
    # Derivatives of distances and of angles are comparable only in units of their limits.
    units = np.array([made.task.units[0]] * 2 + [made.task.units[1]])
    return np.asarray(np.square(rates.rates / units[:, None]).sum(axis=(0, 1)))


def _describe_sensitivity(
    made: ManufacturedLinkage, rates: Sensitivities, k: int, off: float, share: float
) -> Sensitivity | None:
    """Describe the derivatives by dimension ``k``; None if they are not finite."""
    x, y, turned = rates.rates[:, :, k].T
    if not np.isfinite(rates.rates[:, :, k]).all():
        return None
    sort = made.task.sort
    degrees = np.degrees(turned).tolist()
    turns = sort == "poses" or (sort == "outputs" and not made.task.slides)
    least = rates.least is not None and math.isfinite(rates.least_rates[k])
    return Sensitivity(
        dimension=made.list_names[k],
        tolerance=off,
        x=x.tolist() if made.task.guides else None,
        y=y.tolist() if made.task.guides else None,
        travel=x.tolist() if sort == "outputs" and made.task.slides else None,
        angle=degrees if turns else None,
        transmission=math.degrees(rates.least_rates[k]) if least else None,
        share=share,
    )


def _select_important(listed: list[Sensitivity | None]) -> list[str]:
    """Return the fewest dimensions whose tolerances cause :data:`IMPORTANT_SHARE` of the errors, in order of share."""
    named: list[str] = []
    left = IMPORTANT_SHARE
    for one in listed:
        # The list is sorted, so the first dimension without a share ends it.
        if left <= 0.0 or one is None or one.share <= 0.0:
            break
        named.append(one.dimension)
        left -= one.share
    return named


def _find_worst_case(made: ManufacturedLinkage, off: Real) -> WorstCase:
    """Find the maximum errors over all corners of the tolerances, by driving each of them."""
    # Only dimensions with a tolerance vary, so there are at most 2⁹ corners.
    open_ones = np.flatnonzero(off > 0.0)
    corners = np.tile(made.nominal_dimensions, (2 ** len(open_ones), 1))
    corners[:, open_ones] += np.array(list(combined((-1.0, 1.0), repeat=len(open_ones)))) * off[open_ones]
    driven = measure_deviations(made.task, corners)
    # One corner that cannot be assembled makes the worst case unbounded.
    if not np.isfinite(driven.offsets).all():
        return WorstCase(assembles=False)
    sort, slides = made.task.sort, made.task.slides
    return WorstCase(
        assembles=True,
        max_error=float(driven.distances.max()) if sort != "outputs" or slides else None,
        max_angle_error=math.degrees(driven.angles.max())
        if sort == "poses" or (not slides and sort == "outputs")
        else None,
    )
