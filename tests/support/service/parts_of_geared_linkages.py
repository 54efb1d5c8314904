"""Code that several tests share: parts of geared linkages."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinematics.linkage.planar.catalogue import make_geared_fivebar
from kinematics.linkage.planar.drive import drive
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.slider_cranks_and_fivebars import build_geared_fivebar
from synthesis.kinds.path.verification.linkage import verify_traced
from synthesis.registry import parse_problem


def planted(ratio: float) -> tuple[Any, Any]:
    """A problem, and a geared fivebar of the ratio as the answer to it."""
    angle = 0.3
    linkage = make_geared_fivebar(0.0, 60.0, 10.0, 70.0, 70.0, 12.0, ratio, 0.5, angle, 1, 30.0 + 20.0j)
    at = {name: complex(z) for name, z in linkage.joints.items()}
    o2, a, c, b, o5, p = (at[name] for name in ("O2", "A", "C", "B", "O5", "P"))
    mechanism = build_geared_fivebar(o2, a, c, b, o5, p, ratio, angle)
    assert mechanism is not None
    traced = drive(linkage, angle + np.array([0.0, 0.4, 0.9, 1.7, 2.5, 3.0]), order=0).joints["P"][0]
    points = [{"x": z.real, "y": z.imag} for z in traced.tolist()]
    problem = parse_problem({"kind": "path", "mechanism": "geared_fivebar", "gear_ratio": ratio, "points": points})
    assert isinstance(problem, PathProblem)
    return problem, verify_traced(problem, mechanism)
