"""Arrangement of designs in planes, for the block ``layout`` of a statement: results and checks."""

from __future__ import annotations

import math
from typing import Any, TypeVar

from synthesis.model.answer import Check, Result, Verification
from synthesis.model.layout import LayoutSpec
from synthesis.model.linkage.given_linkage import SkeletonSpec
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import ProblemBase

Design = TypeVar("Design", bound=Any)

PLANES = "planes"
"""Name of the check of the number of planes; it has no value for a design that cannot be built in any number."""


def verify_planes(problem: ProblemBase, design: Design) -> Design:
    """Return a design with the check of its planes, if it passed all other checks and the problem limits the planes."""
    if not isinstance(problem, LinkageProblem) or problem.layout is None or problem.layout.max_planes is None:
        return design
    return lay_out_design(problem.layout, design) if design.verification.passed else design


def lay_out_designs(layout_spec: LayoutSpec, result: Result[Any]) -> Result[Any]:
    """Return an answer with the layouts of all its designs and of the nearest miss."""
    miss = result.nearest_miss
    if miss is not None:
        miss = miss.model_copy(update={"design": lay_out_design(layout_spec, miss.design)})
    designs = [lay_out_design(layout_spec, design) for design in result.designs]
    return result.model_copy(update={"designs": designs, "nearest_miss": miss})


def lay_out_design(layout_spec: LayoutSpec, design: Design) -> Design:
    """Return a linkage design with its layout, and with the check of its planes if these are limited.

    Parameters
    ----------
    layout_spec : LayoutSpec
        The block of the request.
    design : a design of linkages
        The verified design; it is returned unchanged if it already has a layout.
    """
    if design.layout is not None:
        return design
    # A local import: only problems with this block need the module.
    from synthesis.analyses.linkages.layout import lay_out_mechanism
    from synthesis.mechanisms.skeleton import assemble_skeleton

    mechanism = assemble_skeleton(
        SkeletonSpec.model_validate(design.mechanism.skeleton.model_dump()),
        getattr(design.mechanism, "reference_input_angle", None),
    )
    metrics = design.metrics
    used = metrics.used_stroke
    # Either a stroke or a range is known, depending on the input.
    if metrics.used_range is not None:
        used = math.radians(metrics.used_range[0]), math.radians(metrics.used_range[1])
    layout = lay_out_mechanism(mechanism, layout_spec, used)
    update: dict[str, Any] = {"layout": layout}
    if layout_spec.max_planes is not None:
        check = Check(
            name=PLANES,
            passed=layout.buildable and layout.count <= layout_spec.max_planes,
            # A design that cannot be built in any number of planes has no value.
            value=float(layout.count) if layout.buildable else None,
            limit=float(layout_spec.max_planes),
        )
        update["verification"] = Verification.from_checks([*design.verification.checks, check])
    laid: Design = design.model_copy(update=update)
    return laid
