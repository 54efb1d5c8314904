"""Manufacturing report of a design: yield, worst case, sensitivities, and the tolerances that matter."""

from __future__ import annotations

import math
from itertools import product as combined
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.variation import deviations
from kinematics.linkage.variation.sensitivities import Sensitivities, sensitivities
from synthesis.manufacture.linkage import Product, linkage_of, product
from synthesis.manufacture.play import plays
from synthesis.manufacture.sampled import offs, sampled_yield
from synthesis.manufacture.widest import widest
from synthesis.model.manufacture import Exactness, Held, Manufacture
from synthesis.model.manufacture_answer import Allocation, Manufactured, Sensitivity, WorstCase, Yield

Real = NDArray[np.float64]

MATTER = 0.8
"""Share of all errors that the tolerances that matter add up to."""


class Reported(NamedTuple):
    """Manufacturing results of a design, and its yield, if sampled."""

    manufactured: Manufactured
    yield_: Yield | None


def reported(mechanism: Any, held: Held, stated: Exactness, seed: int, used: tuple[float, float] | None) -> Reported:
    """Report all manufacturing results of a design.

    Parameters
    ----------
    mechanism : a model of a mechanism
        As drawn.
    held : Held
        What it is held to.
    stated : Exactness
        The block.
    seed : int
        That of the problem; the block may have its own.
    used : pair of float or None
        The range of the input on which it must stay on its branch, radians; None where it need not.
    """
    linkage = linkage_of(mechanism)
    if linkage is None:
        return Reported(Manufactured(remark=f"not built for {mechanism.type}"), None)
    made = product(linkage, held, stated, used)
    if isinstance(made, str):
        return Reported(Manufactured(remark=made), None)
    off = offs(stated, linkage.pivots(guides=made.task.guides))
    share, rates = _shares(made, off)
    listed = [_sensitivity(made, rates, k, float(off[k]), float(share[k])) for k in np.argsort(-share, kind="stable")]
    remark = None if np.isfinite(rates.rates).all() else "the linkage is at a toggle at a target"
    clearance = 0.0 if stated.tolerances is None else stated.tolerances.pin_clearance
    play = plays(made, clearance) if clearance > 0.0 else []
    if play is None:
        remark = "within the clearances of its pins the linkage reaches a toggle at a target"
    allocated: list[Allocation] = []
    if isinstance(stated, Manufacture) and stated.widest:
        allocated = widest(made, stated, seed if stated.seed is None else stated.seed, _squares(made, rates), off)
    seeded = seed if stated.seed is None else stated.seed
    told = Manufactured(
        seed=seeded if stated.sampled else None,
        worst_case=_worst(made, off),
        matter=_matter(listed),
        sensitivities=[one for one in listed if one is not None],
        play=play or [],
        widest=allocated,
        remark=remark,
    )
    return Reported(told, sampled_yield(made, stated, seeded) if stated.sampled else None)


def _shares(made: Product, off: Real) -> tuple[Real, Sensitivities]:
    """What each tolerance adds to the squares of all errors, shape (n,); zeros where derivatives are not finite."""
    rates = sensitivities(made.task, made.nominal)
    added = _squares(made, rates) * off * off
    whole = float(added.sum())
    return (added / whole if 0.0 < whole < math.inf else np.zeros(len(off))), rates


def _squares(made: Product, rates: Sensitivities) -> Real:
    """What each dimension adds to the squares of all errors, by the square of its tolerance, shape (n,)."""
    units = np.array([made.task.units[0]] * 2 + [made.task.units[1]])
    return np.asarray(np.square(rates.rates / units[:, None]).sum(axis=(0, 1)))


def _sensitivity(made: Product, rates: Sensitivities, k: int, off: float, share: float) -> Sensitivity | None:
    """The derivatives to one dimension; None where they are not finite."""
    x, y, turned = rates.rates[:, :, k].T
    if not np.isfinite(rates.rates[:, :, k]).all():
        return None
    sort = made.task.sort
    degrees = np.degrees(turned).tolist()
    turns = sort == "poses" or (sort == "outputs" and not made.task.slides)
    least = rates.least is not None and math.isfinite(rates.least_rates[k])
    return Sensitivity(
        dimension=made.names[k],
        tolerance=off,
        x=x.tolist() if made.task.guides else None,
        y=y.tolist() if made.task.guides else None,
        travel=x.tolist() if sort == "outputs" and made.task.slides else None,
        angle=degrees if turns else None,
        transmission=math.degrees(rates.least_rates[k]) if least else None,
        share=share,
    )


def _matter(listed: list[Sensitivity | None]) -> list[str]:
    """The dimensions, the first most, whose tolerances make up :data:`MATTER` of the errors."""
    named: list[str] = []
    left = MATTER
    for one in listed:
        if left <= 0.0 or one is None or one.share <= 0.0:
            break
        named.append(one.dimension)
        left -= one.share
    return named


def _worst(made: Product, off: Real) -> WorstCase:
    """The greatest errors over all corners of the tolerances, every one of them driven."""
    open_ones = np.flatnonzero(off > 0.0)
    corners = np.tile(made.nominal, (2 ** len(open_ones), 1))
    corners[:, open_ones] += np.array(list(combined((-1.0, 1.0), repeat=len(open_ones)))) * off[open_ones]
    driven = deviations(made.task, corners)
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
