"""Arrangement of designs in planes, for the block ``layout`` of a statement: results and checks."""

from __future__ import annotations

import math
from typing import Any, TypeVar

from synthesis.model.answer import Check, Result, Verification
from synthesis.model.layout import StatedLayout
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.stated_linkage import StatedSkeleton
from synthesis.model.statement import StatedProblem

Design = TypeVar("Design", bound=Any)

PLANES = "planes"
"""Name of the check of the number of planes; it has no value for a design that cannot be built in any number."""


def held_to_planes(problem: StatedProblem, design: Design) -> Design:
    """Return a design with the check of its planes, if it passed all other checks and the problem limits the planes."""
    if not isinstance(problem, LinkageProblem) or problem.layout is None or problem.layout.max_planes is None:
        return design
    return laid_out(problem.layout, design) if design.verification.passed else design


def all_laid_out(stated: StatedLayout, result: Result[Any]) -> Result[Any]:
    """Return an answer with the layouts of all its designs and of the nearest miss."""
    miss = result.nearest_miss
    if miss is not None:
        miss = miss.model_copy(update={"design": laid_out(stated, miss.design)})
    designs = [laid_out(stated, design) for design in result.designs]
    return result.model_copy(update={"designs": designs, "nearest_miss": miss})


def laid_out(stated: StatedLayout, design: Design) -> Design:
    """Return a linkage design with its layout, and with the check of its planes if these are limited.

    Parameters
    ----------
    stated : StatedLayout
        The block of the statement.
    design : a design of linkages
        The verified design; it is returned unchanged if it already has a layout.
    """
    if design.layout is not None:
        return design
    # A local import: only problems with this block need the module.
    from synthesis.analyses.layout import layout_of
    from synthesis.mechanisms.skeleton import assembled_skeleton

    mechanism = assembled_skeleton(
        StatedSkeleton.model_validate(design.mechanism.skeleton.model_dump()),
        getattr(design.mechanism, "reference_input_angle", None),
    )
    metrics = design.metrics
    used = metrics.used_stroke
    if metrics.used_range is not None:
        used = math.radians(metrics.used_range[0]), math.radians(metrics.used_range[1])
    layout = layout_of(mechanism, stated, used)
    update: dict[str, Any] = {"layout": layout}
    if stated.max_planes is not None:
        check = Check(
            name=PLANES,
            passed=layout.buildable and layout.count <= stated.max_planes,
            value=float(layout.count) if layout.buildable else None,
            limit=float(stated.max_planes),
        )
        update["verification"] = Verification.of([*design.verification.checks, check])
    laid: Design = design.model_copy(update=update)
    return laid
