"""Driving any finished design by its skeleton's constraints alone, through the targets that it claims."""

from __future__ import annotations

import cmath
import math

import numpy as np

from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.linkage.answer import LinkageDesign
from tests.oracles.constraints import Constraints, Line


def constraints_of(design: LinkageDesign) -> Constraints:
    """The rigid links and slides of a design's skeleton."""
    bar = design.mechanism.skeleton
    return Constraints(
        {name: [complex(*z)] for name, z in bar.joints.items()},
        {link.name: link.joints for link in bar.links},
        [Line(s.joint, s.link, complex(*s.point), math.radians(s.angle)) for s in bar.slides],
        [],
        bar.input_link,
    )


def assert_drives_through(design: LinkageDesign, problem: MotionProblem, within: float = 1e-7) -> None:
    """The input, turning one way without coming to a toggle, takes the body through all positions in their order."""
    constraints = constraints_of(design)
    pushed = constraints.pushed
    unit = float(constraints.size[0]) if pushed else 1.0
    angles = np.array([target.position for target in design.targets])
    ways = (angles - angles[0]) / unit if pushed else np.radians(angles - angles[0])
    assert np.all(np.diff(ways) > 0.0) or np.all(np.diff(ways) < 0.0), "not in order"
    side = 1.0 if ways[-1] > 0.0 else -1.0
    trace = constraints.follow(constraints.start(), side, limit=abs(ways[-1]), to_toggle=True)[0]
    assert trace.ended == "limit", "a toggle on the way"
    first = {name: complex(z[0]) for name, z in constraints.joints(constraints.start()).items()}
    arm = "B" if "B" in first else "P"
    for way, position in zip(ways, problem.positions, strict=True):
        ((_, met),) = trace.at(float(way), 1e9) if way != 0.0 else [(0, trace.points[0])]
        joints = {name: complex(z[0]) for name, z in constraints.joints(met[None]).items()}
        assert abs(joints["P"] - position.point) <= within * problem.task_size
        turned = cmath.phase((joints[arm] - joints["A"]) / (first[arm] - first["A"]))
        demanded = math.radians(position.angle - problem.positions[0].angle)
        assert abs(math.remainder(turned - demanded, math.tau)) <= within


def turns_through(design: LinkageDesign) -> bool:
    """Whether the input link turns through on the design's own circuit."""
    trace = constraints_of(design).follow(constraints_of(design).start(), 1.0, limit=2.0 * math.pi, to_toggle=True)[0]
    return trace.ended in ("limit", "closed")
