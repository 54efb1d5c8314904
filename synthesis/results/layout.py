"""Arrangement of designs in planes and its check, for the block ``layout`` of a statement."""

from __future__ import annotations

from typing import TypeVar

from synthesis.model.answer import Check, Verification
from synthesis.model.linkage.given_linkage import SkeletonSpec
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.protocols import DrivenDesign, HasReferenceAngle

Design = TypeVar("Design", bound=DrivenDesign)

PLANES = "planes"
"""Name of the check of the number of planes; it has no value for a design that cannot be built in any number."""


def add_layout(problem: LinkageProblem, design: Design) -> Design:
    """Return a design with its layout, and with the check of its planes if their number is limited.

    A design that already has a layout is returned unchanged.
    """
    layout_spec = problem.layout
    if layout_spec is None or design.layout is not None:
        return design
    # A local import: only problems with this block need the module.
    from synthesis.analyses.linkages.cycle import get_used_range
    from synthesis.analyses.linkages.layout import lay_out_mechanism
    from synthesis.mechanisms.skeleton import assemble_skeleton

    stated, metrics = design.mechanism, design.metrics
    reference = stated.reference_input_angle if isinstance(stated, HasReferenceAngle) else None
    mechanism = assemble_skeleton(SkeletonSpec.model_validate(stated.skeleton.model_dump()), reference)
    layout = lay_out_mechanism(mechanism, layout_spec, get_used_range(metrics))
    update: dict[str, object] = {"layout": layout}
    if layout_spec.max_planes is not None:
        check = Check(
            name=PLANES,
            passed=layout.buildable and layout.count <= layout_spec.max_planes,
            # A design that cannot be built in any number of planes has no value.
            value=float(layout.count) if layout.buildable else None,
            limit=float(layout_spec.max_planes),
        )
        update["verification"] = Verification.from_checks([*design.verification.checks, check])
    return design.model_copy(update=update)
