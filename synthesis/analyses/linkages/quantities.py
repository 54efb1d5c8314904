"""Motion of a linkage over given inputs, and all quantities derived from it, as plain lists in degrees."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.linkage.fourbar import barker_type
from kinematics.linkage.fourbar.classification import BARKER
from kinematics.linkage.planar.branches import Branch
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import MechanismMotion, drive, has_given_up
from kinematics.linkage.planar.instant_centers import find_instant_centers
from kinematics.linkage.planar.limits import find_limit_positions, find_reference_branch, list_toggles
from kinematics.linkage.planar.link_points import link_point
from kinematics.linkage.planar.mechanism import GROUND, Mechanism, TopologyError
from kinematics.linkage.planar.program import build_program, compute_unit_frame
from kinematics.linkage.refined_extremes import GRID_SIZE, find_min_transmission_angles
from kinematics.message import compose
from synthesis.analyses.linkages.cycle import list_branches
from synthesis.analyses.linkages.fourbar import extract_fourbar
from synthesis.model.json_object import JsonObject

MAX_RATIO = 1e12
"""Ratio of speeds beyond which the output is at rest: its speed is that of rounding."""

BRANCH_SAMPLE_COUNT = 181
"""Number of samples on a branch at which its joints are listed: enough for a smooth curve on a screen."""


def analyze_motion(
    mechanism: Mechanism,
    at: Real,
    speed: Real,
    acceleration: float,
    *,
    tracked: bool = False,
    points: Mapping[str, tuple[str, complex]] = MappingProxyType({}),
) -> JsonObject:
    """Drive a mechanism to inputs and list its motion and all derived quantities.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism in its reference configuration.
    at, speed : float, shape (n,)
        Inputs (degrees, or lengths along the input slide) and their speeds (radians or lengths per second).
    acceleration : float
        Constant acceleration of the input.
    tracked : bool
        Whether to add the positions of the joints along each branch.
    points : mapping of str to (str, complex)
        Further points by name: the link, and the position on it.
    """
    slide = mechanism.has_slide_input
    inputs = at if slide else np.radians(at)
    motion = drive(mechanism, inputs, speed=speed, acceleration=acceleration)
    # Ratios and instant centres depend on the position alone, so they are also known at inputs with speed 0.
    paced = motion if np.all(speed) else drive(mechanism, inputs, order=1)
    sines = {link: np.abs(sine) for link, sine in motion.sines.items()}
    transmission = {link: _list_values(np.degrees(np.arcsin(np.minimum(sine, 1.0)))) for link, sine in sines.items()}
    with np.errstate(invalid="ignore"):
        least = np.degrees(np.arcsin(np.minimum(np.stack(list(sines.values())).min(axis=0), 1.0))) if sines else None
    ratios = {
        "torque_ratio": _compute_ratios(paced, paced.angles, _list_grounded_links(mechanism), _link_scale(mechanism)),
        "force_ratio": _compute_ratios(paced, paced.slides, _list_output_slides(mechanism), _slide_scale(mechanism)),
    }
    described = _describe_circuits(mechanism, tracked, _describe_undefined(mechanism, sines))
    notes = [*described["notes"], *_describe_dead_centres(paced, ratios)]
    if len(at) > 1:
        notes.append(compose("analyses-instant-centers-of-one-position"))
    classification = _classify_linkage(mechanism)
    if classification["grashof"] == "change_point":
        notes.append(compose("analyses-limits-at-change-point"))
    return {
        "input_angle": at.tolist(),
        "valid": motion.valid.tolist(),
        "links": {name: _list_series(jet) for name, jet in motion.angles.items()},
        "joints": {name: _describe_track(jet) for name, jet in motion.joints.items()},
        "points": {name: _describe_track(link_point(mechanism, motion, *of)) for name, of in points.items()},
        "slides": {name: _describe_travel(jet) for name, jet in motion.slides.items()},
        "transmission_angle": [math.nan] * len(at) if least is None else _list_values(least),
        "transmission_angles": transmission,
        "min_transmission_angle": _find_min_transmission_angle(mechanism, inputs, motion),
        **ratios,
        "instant_centers": _list_instant_centers(mechanism, paced) if len(at) == 1 else {},
        "classification": classification,
        **described,
        "notes": notes,
    }


def _find_min_transmission_angle(mechanism: Mechanism, inputs: Real, motion: MechanismMotion) -> float:
    """Find the minimum transmission angle between the first and the last input, degrees; NaN if there is none.

    It is the measure of the metrics and checks of designs: 0 if the motion reaches a toggle.
    """
    if not motion.sines:
        return math.nan
    if len(inputs) == 1:
        sine = np.abs(np.stack(list(motion.sines.values()))).min()
        return math.degrees(math.asin(min(float(sine), 1.0)))
    # A motion over time may turn back and repeat inputs.
    low, high = float(inputs.min()), float(inputs.max())
    grid = np.linspace(low, high, max(len(inputs), GRID_SIZE)) if low < high else np.array([low, low])
    angles = find_min_transmission_angles(lambda at: drive(mechanism, at, order=0), grid)
    return math.degrees(min(angles.values()))


def _list_values(values: Real) -> list[float]:
    listed: list[float] = values.tolist()
    return listed


def _list_series(jet: Real) -> dict[str, list[float]]:
    return {
        "angle": _list_values(np.degrees(_unwrap_angle(jet[0]))),
        "omega": _list_values(jet[1]),
        "alpha": _list_values(jet[2]),
        "jerk": _list_values(jet[3]),
    }


def _unwrap_angle(angle: Real) -> Real:
    """Unwrap angles so that they are continuous, with the first in (−π, π]; positions without a value are skipped."""
    known = np.isfinite(angle)
    out = angle.copy()
    if known.any():
        values = np.unwrap(angle[known])
        out[known] = values + (np.angle(np.exp(1j * values[0])) - values[0])
    return out


def _describe_track(jet: NDArray[np.complex128]) -> dict[str, list[float]]:
    names = (("x", "y"), ("vx", "vy"), ("ax", "ay"), ("jx", "jy"))
    return {
        name: _list_values(part)
        for pair, row in zip(names, jet, strict=True)
        for name, part in zip(pair, (row.real, row.imag), strict=True)
    }


def _describe_travel(jet: Real) -> dict[str, list[float]]:
    return dict(zip(("position", "velocity", "acceleration", "jerk"), map(_list_values, jet), strict=True))


def _compute_ratios(
    motion: MechanismMotion, moved: dict[str, Real], outputs: list[str], scale: float
) -> dict[str, list[float]]:
    """Compute the speed of the input over that of each output; NaN where the output is at rest, to rounding.

    By virtual work this is the ratio of the torque or force on the output to that of the input. ``scale`` is the unit
    of the ratio: 1 for two rotations or two translations, otherwise the size of the mechanism or its inverse.
    """
    ratios = {}
    for name in outputs:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            ratio = motion.input[1] / moved[name][1]
        ratios[name] = _list_values(np.where(np.abs(ratio) < MAX_RATIO * scale, ratio, np.nan))
    return ratios


def _link_scale(mechanism: Mechanism) -> float:
    return float(compute_unit_frame(mechanism).size) if mechanism.has_slide_input else 1.0


def _slide_scale(mechanism: Mechanism) -> float:
    return 1.0 if mechanism.has_slide_input else 1.0 / float(compute_unit_frame(mechanism).size)


def _describe_dead_centres(motion: MechanismMotion, ratios: Mapping[str, dict[str, list[float]]]) -> list[str]:
    """Describe the ratios that are missing at positions with a known speed of the output."""
    notes = []
    for field, listed in ratios.items():
        moved = motion.angles if field == "torque_ratio" else motion.slides
        # At a toggle the speed is unknown, and so is the ratio.
        resting = [name for name, values in listed.items() if (np.isnan(values) & np.isfinite(moved[name][1])).any()]
        if resting:
            notes.append(compose("analyses-output-at-rest", field=field, names=", ".join(resting)))
    return notes


def _list_instant_centers(mechanism: Mechanism, motion: MechanismMotion) -> dict[str, dict[str, list[float]]]:
    return {
        f"{one}-{other}": {"x": _list_values(center.point.real), "y": _list_values(center.point.imag)}
        for (one, other), center in find_instant_centers(mechanism, motion).items()
    }


def _list_grounded_links(mechanism: Mechanism) -> list[str]:
    """Return the links pinned to the ground, except the input."""
    ground = set(mechanism.links[GROUND])
    return [n for n, listed in mechanism.links.items() if n not in (GROUND, mechanism.input) and ground & set(listed)]


def _list_output_slides(mechanism: Mechanism) -> list[str]:
    """Return the names of the slides on the ground, except the input."""
    named = zip(mechanism.slide_names, mechanism.slides, strict=True)
    return [name for name, slide in named if slide.link == GROUND and slide.joint != mechanism.input]


def _classify_linkage(mechanism: Mechanism) -> JsonObject:
    kind = 0
    stated = extract_fourbar(mechanism)
    if stated is not None:
        kind = int(barker_type(stated.linkage))
    row = BARKER[kind - 1] if kind else None
    return {
        "grashof": None if row is None else row.motion,
        "barker": None if row is None else row.type,
        "barker_code": None if row is None else row.code,
        "mobility": mechanism.mobility,
    }


def _sample_branch(mechanism: Mechanism, branch: Branch) -> dict[str, dict[str, list[float]]] | None:
    """Sample the joints along a branch, densest at its ends; None if no assemblies distinguish the branches."""
    steps = build_program(mechanism).steps
    if not steps or len(branch.signs) != sum(step.has_two_solutions for step in steps):
        return None
    chosen = iter(branch.signs)
    signs = tuple(np.array(next(chosen) if step.has_two_solutions else 1) for step in steps)
    share = np.linspace(0.0, 1.0, BRANCH_SAMPLE_COUNT)
    if not branch.full:
        # Near a toggle, the joints move with the square root of the input's distance from it; equalize their steps.
        share = 0.5 - 0.5 * np.cos(np.pi * share)
    motion = drive(mechanism, branch.low + share * (branch.high - branch.low), signs=signs, order=0)
    return {
        name: {"x": _list_values(jet[0].real), "y": _list_values(jet[0].imag)} for name, jet in motion.joints.items()
    }


def _describe_undefined(mechanism: Mechanism, sines: dict[str, Real]) -> list[str]:
    """Describe results that are missing in the answer, with the reason."""
    notes = []
    if decompose(mechanism).left and not sines:
        notes.append(compose("analyses-no-pushing-leg"))
    elif mechanism.redundant:
        notes.append(compose("analyses-pushing-link-undetermined"))
    elif not sines:
        notes.append(compose("analyses-no-pushing-link"))
    if has_given_up(mechanism):
        notes.append(compose("analyses-motion-followed-in-part"))
    return notes


def _describe_circuits(mechanism: Mechanism, tracked: bool, notes: list[str]) -> JsonObject:
    """Describe toggles, circuits and limits; empty with a note if the circuits cannot be listed."""
    try:
        branches = list_branches(mechanism)
    except TopologyError as error:
        return {
            "toggles": [],
            "circuits": [],
            "limits": {},
            "notes": [*notes, compose("analyses-circuits-unknown", reason=str(error))],
        }
    scale = (lambda x: x) if mechanism.has_slide_input else math.degrees
    here = find_reference_branch(mechanism, branches)
    if here is None:
        notes = [*notes, compose("analyses-limits-unknown")]
    circuits: dict[int, list[JsonObject]] = {}
    for branch in branches:
        listed = circuits.setdefault(branch.circuit, [])
        one = {"from": scale(branch.low), "to": scale(branch.high), "full": branch.full, "reference": branch is here}
        listed.append({**one, "joints": _sample_branch(mechanism, branch)} if tracked else one)
    limits: dict[str, list[float] | None] = {}
    if here is not None:
        links = _list_grounded_links(mechanism)
        slides = _list_output_slides(mechanism)
        angles, travels = find_limit_positions(mechanism, here, links, slides)
        for name, span in zip(links, angles, strict=True):
            limits[name] = None if span is None else [math.degrees(x) for x in span]
        for name, span in zip(slides, travels, strict=True):
            limits[name] = None if span is None else list(span)
    return {
        "toggles": [scale(x) for x in list_toggles(mechanism, branches)],
        "circuits": [{"branches": listed} for listed in circuits.values()],
        "limits": limits,
        "notes": notes,
    }
