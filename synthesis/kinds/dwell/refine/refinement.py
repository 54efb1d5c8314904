"""Conversion of a refined shape to a sixbar with the exact range, and to the mechanism of an answer.

Shapes are those of :mod:`synthesis.kinds.dwell.motion.outputs` or of
:mod:`synthesis.kinds.dwell.refine.stephenson_2`.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage.fourbar import OPEN_ASSEMBLY, positions
from kinematics.linkage.planar.catalogue import SIXBAR_LINKS
from kinematics.linkage.planar.mechanism import GROUND
from synthesis.kinds.dwell.design import DwellMechanism, MechanismType
from synthesis.kinds.dwell.motion.outputs import (
    Carrier,
    Kind,
    build_fourbars,
    compute_output,
    find_extremes,
    locate_points,
)
from synthesis.kinds.dwell.problem import DEFAULT_CRANK, DwellProblem
from synthesis.kinds.dwell.refine import stephenson_2
from synthesis.kinds.dwell.verification import GRID_STEP_COUNT
from synthesis.model.linkage.answer import CouplerPoint, Slide
from synthesis.model.linkage.conversion import build_skeleton, build_slide, to_point
from synthesis.model.linkage.sixbars import Links, list_lengths

MAX_RANGE_STEPS = 30
"""Maximum number of secant steps to the required range; five are usual."""

RANGE_TOLERANCE, MAX_RANGE_ERROR = 1e-11, 1e-8
"""Relative errors of the range: tolerance of the secant method, and maximum at which its last step is still used."""


STEPHENSON_2_LINKS: Links = {
    name: tuple(joint for joint in joints if joint != "P") for name, joints in SIXBAR_LINKS["stephenson_2"].items()
}
"""The joints on each link of a Stephenson II."""


class SixbarShape(NamedTuple):
    """A shape in its own frame, with a crank of 1, its number of dwells, and the link that carries P, if any."""

    kind: Kind
    sign: int
    shape: Real
    carrier: Carrier
    dwells: int


def measure_range(sixbar: SixbarShape) -> float:
    """Return the swing (radians) or the stroke of the output over a turn."""
    if sixbar.kind == "triad":
        return stephenson_2.measure_range(sixbar.shape, GRID_STEP_COUNT)
    turn = np.linspace(0.0, 2.0 * np.pi, GRID_STEP_COUNT, endpoint=False)
    p = locate_points(sixbar.shape[None], turn[None], sixbar.carrier)
    low, high = find_extremes(compute_output(sixbar.kind, sixbar.sign, sixbar.shape[None], p)[0])
    return float(high[0] - low[0])


def adjust_range(sixbar: SixbarShape, way: float) -> SixbarShape | None:
    """Adjust the range to ``way`` by moving the output's pivot along its line to the resting pin, or along the slot.

    Returns None if the secant method does not converge.
    """
    before, factor = (0.0, 0.0), 1.0
    made = sixbar
    for _ in range(MAX_RANGE_STEPS):
        off = measure_range(made) / way - 1.0
        if not math.isfinite(off):
            return None
        if abs(off) < RANGE_TOLERANCE:
            return made
        # The swing is roughly inverse to the distance of the pivot: slope −1 for the first step.
        slope = (off - before[1]) / (factor - before[0]) if before[0] else -1.0
        if slope == 0.0:
            return None
        before, factor = (factor, off), factor - off / slope
        made = _move_pivot(sixbar, factor)
    return made if abs(off) < MAX_RANGE_ERROR else None


def _move_pivot(sixbar: SixbarShape, factor: float) -> SixbarShape:
    """Move the output's pivot to ``factor`` times its distance from D (or P) at the beginning of the first dwell."""
    if sixbar.kind == "triad":
        return sixbar._replace(shape=stephenson_2.move_pivot(sixbar.shape, factor))
    shape = sixbar.shape.copy()
    at = slice(5, 7) if sixbar.kind == "slot" else slice(6, 8)
    pivot = complex(*shape[at])
    joints = _locate_joints(sixbar)
    # The output rests as long as this point rests, wherever the pivot is on the line.
    rest = joints["P"] if sixbar.kind == "slot" else joints["D"]
    moved = rest + factor * (pivot - rest)
    shape[at] = moved.real, moved.imag
    if sixbar.kind == "rocker":
        # The rocker's length changes with its pivot, so that D stays in place.
        shape[8] *= factor
    return sixbar._replace(shape=shape)


def _locate_joints(sixbar: SixbarShape) -> dict[str, complex]:
    """Return the joints at the beginning of the first dwell, in the shape's own frame."""
    if sixbar.kind == "triad":
        return stephenson_2.name_joints(sixbar.shape)
    shape = sixbar.shape[None]
    begin = np.array([[sixbar.shape[-sixbar.dwells]]])
    at = positions(build_fourbars(shape), begin, np.array([OPEN_ASSEMBLY]))
    p = at.p[0, 0] if sixbar.carrier == "coupler" else locate_points(shape, begin, sixbar.carrier)[0, 0]
    joints = {"O2": 0j, "O4": complex(sixbar.shape[2]), "A": at.a[0, 0], "B": at.b[0, 0], "P": p}
    if sixbar.kind == "slider":
        _, _, _, _, _, link, offset, angle = sixbar.shape[:8]
        along = cmath.exp(1j * angle)
        local = p * along.conjugate()
        place = local.real + sixbar.sign * math.sqrt(link**2 - (local.imag - offset) ** 2)
        joints["D"] = along * complex(place, offset)
    elif sixbar.kind == "rocker":
        link, rocker = sixbar.shape[5], sixbar.shape[8]
        joints["O6"] = complex(*sixbar.shape[6:8])
        arm = p - joints["O6"]
        cosine = (rocker**2 + abs(arm) ** 2 - link**2) / (2.0 * rocker * abs(arm))
        lean = complex(cosine, sixbar.sign * math.sqrt(max(1.0 - cosine**2, 0.0)))
        joints["D"] = joints["O6"] + rocker * arm / abs(arm) * lean
    else:
        joints["O6"] = complex(*sixbar.shape[5:7])
        turn = np.linspace(0.0, 2.0 * np.pi, GRID_STEP_COUNT, endpoint=False)
        # The slot must be long enough for P's greatest distance in the turn.
        reach = np.abs(locate_points(shape, turn[None], sixbar.carrier) - joints["O6"]).max()
        joints["C"] = joints["O6"] + (p - joints["O6"]) / abs(p - joints["O6"]) * float(reach)
    return {name: complex(z) for name, z in joints.items()}


def build_mechanism(problem: DwellProblem, sixbar: SixbarShape) -> DwellMechanism:
    """Build the sixbar in the client's units, with the crank's pivot at its required place."""
    if sixbar.kind == "slider":
        # Only a slider's linkage has a free size: the stroke determines it.
        scale = problem.way / measure_range(sixbar)
    else:
        scale = DEFAULT_CRANK if problem.crank is None else problem.crank
    own = _locate_joints(sixbar)
    pivot = complex(*(problem.pivot or (0.0, 0.0)))
    joints = {name: pivot + scale * z for name, z in own.items()}
    kind, links, slides = _list_links(sixbar, joints)
    point = None
    if "P" in links.get("coupler", ()):
        arm = (own["P"] - own["A"]) / ((own["B"] - own["A"]) / abs(own["B"] - own["A"]))
        point = CouplerPoint(distance=scale * abs(arm), angle=math.degrees(cmath.phase(arm)))
    return DwellMechanism(
        type=kind,
        fixed_pivots={name: to_point(joints[name]) for name in links[GROUND]},
        links=list_lengths(joints, links, point=None),
        coupler_point=point,
        reference_input_angle=math.degrees(cmath.phase(own["A"])),
        skeleton=build_skeleton(joints, links, slides=slides),
    )


def _list_links(sixbar: SixbarShape, joints: dict[str, complex]) -> tuple[MechanismType, Links, list[Slide]]:
    """Return the type of a sixbar, the joints on each of its links, and its slides."""
    if sixbar.kind == "triad":
        return "dwell_stephenson_2", STEPHENSON_2_LINKS, []
    on_rocker = sixbar.carrier == "rocker"
    links: dict[str, tuple[str, ...]] = {
        GROUND: ("O2", "O4"),
        "input": ("O2", "A"),
        "coupler": ("A", "B") if on_rocker else ("A", "B", "P"),
        "rocker": ("O4", "B", "P") if on_rocker else ("O4", "B"),
    }
    if sixbar.kind == "slider":
        there = build_slide("D", GROUND, joints["D"], float(sixbar.shape[7]))
        return "dwell_watt_slider" if on_rocker else "dwell_slider", links | {"link_5": ("P", "D")}, [there]
    links[GROUND] = "O2", "O4", "O6"
    if sixbar.kind == "rocker":
        links |= {"link_5": ("P", "D"), "output": ("O6", "D")}
        return "dwell_watt_rocker" if on_rocker else "dwell_rocker", links, []
    there = build_slide("P", "output", joints["O6"], cmath.phase(joints["P"] - joints["O6"]))
    return "dwell_slot", links | {"output": ("O6", "C")}, [there]
