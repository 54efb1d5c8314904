"""Dwell sixbars: promising starts, the output kept as still as can be, the way made exact, and verification."""

from __future__ import annotations

import cmath
import math
from functools import partial
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.fourbar import OPEN, coupler_points, positions
from synthesis.kinds.dwell.candidates import Start, starts
from synthesis.kinds.dwell.design import DwellDesign, DwellMechanism, DwellResult
from synthesis.kinds.dwell.outputs import RESTING, Kind, Task, extremes, fourbars, judged, output
from synthesis.kinds.dwell.problem import DEFAULT_CRANK, DwellProblem
from synthesis.kinds.dwell.verification import GRID, verify_dwell
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import CouplerPoint, Slide
from synthesis.model.linkages import skeleton, slide, to_point
from synthesis.numerics.narrowing import narrowest
from synthesis.outcome.placement import put
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import Sifting, reported
from synthesis.proof.measures import link_lengths

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

LINK_RATIO = 8.0
"""Longest link over shortest, at most, where the client says nothing; links of practice stay below about that."""

TRANSMISSION = 25.0
"""Least transmission angle over the turn, degrees, where the client says nothing."""

ARRIVED = 1e-2
"""Gain of a step, as a share, below which no more are made: the jitter is far below the tolerance, or stays above."""

MARGIN = 1.0
"""Degrees by which a demanded transmission angle is exceeded: between the angles that are looked at it is less."""

STARTS, ENOUGH = 8, 5
"""Starts that are refined for each type at most, and sound designs after which no more are."""

FARTHEST = 4.0
"""Coordinates of P, pivots and slides, in units of the greatest link ratio, at most."""

SLACK = 1e-4
"""Violation of a constraint with which a shape still counts as one; verification decides."""

WAY_STEPS = 30
"""Secant steps to the demanded way at most; five are usual."""

WAY_TOLERANCE, MAX_WAY_ERROR = 1e-11, 1e-8
"""Relative errors of the way at which the secant method has converged, and with which its last step is still used."""

KINDS: dict[tuple[str, str], Kind] = {
    ("pseudo_arc", "rocker"): "rocker",
    ("pseudo_arc", "slider"): "slider",
    ("straight_slot", "rocker"): "slot",
}
"""The output of each type."""


class _Sixbar(NamedTuple):
    """A shape in its own frame, with a crank of 1."""

    kind: Kind
    sign: int
    shape: Real


def solve_dwell(problem: DwellProblem, progress: Progress) -> DwellResult:
    """Solve a problem of dwells."""
    rng = np.random.default_rng(problem.seed)
    sifting = Sifting[DwellDesign](problem, undriven="crank_does_not_turn")
    types = problem.types
    for n, name in enumerate(types):
        kind = KINDS[name, problem.output.type]
        progress(n / len(types), f"driving outputs on coupler curves ({name.replace('_', ' ')})")
        way = math.nan if kind == "slider" else math.radians(problem.way)
        begun = starts(kind, problem.count, math.radians(problem.dwell_angle), way, _transmission(problem), rng, STARTS)
        span = (n + 1.0 / (len(begun) + 1)) / len(types), (n + 1.0) / len(types)
        sifting.sift(
            reported(begun, progress, span, "refining {next} of at most {all}"),
            partial(_driven, problem, kind),
            enough=len(sifting.passed) + ENOUGH,
        )
    progress(1.0, "verified")
    return DwellResult(
        designs=sifting.designs(partial(_ranked, problem)),
        search=sifting.search(
            "coupler curves drawn at random, outputs on their arcs and lines, sequential linear programming"
        ),
        summary=_summary(problem, sifting),
    )


def warm_up() -> None:
    """Load the kernels: those of arcs and pairs by a rocker with two dwells, those of lines by a slot with one."""
    rng = np.random.default_rng(0)
    starts("rocker", 2, 0.5, 0.7, 0.3, rng, 1)
    starts("slot", 1, 0.5, 0.7, 0.3, rng, 1)


def _transmission(problem: DwellProblem) -> float:
    stated = problem.constraints.min_transmission_angle
    return math.radians(TRANSMISSION if stated is None else min(stated + MARGIN, 89.0))


def _ranked(problem: DwellProblem, designs: list[DwellDesign]) -> list[DwellDesign]:
    return ranked(designs, problem.rank_by, {"accuracy": lambda design: design.metrics.jitter})


def _driven(problem: DwellProblem, kind: Kind, start: Start) -> DwellDesign | str | None:
    """The verified design that a start leads to."""
    sixbar = _refined(problem, kind, start)
    if sixbar is None:
        return "not_at_rest"
    mechanism = _mechanism(problem, sixbar)
    if problem.pivot is None:
        sized = not problem.slides and problem.crank is None
        mechanism = put(problem.constraints, mechanism, link_lengths(mechanism), sized=sized, turned=True)
    return verify_dwell(problem, mechanism)


def _refined(problem: DwellProblem, kind: Kind, start: Start) -> _Sixbar | None:
    """The shape near a start whose output moves least during the dwells, with exactly the demanded way."""
    constraints = problem.constraints
    ratio = LINK_RATIO if constraints.max_link_ratio is None else constraints.max_link_ratio
    way = math.nan if kind == "slider" else math.radians(problem.way)
    dwell = math.radians(problem.dwell_angle)
    task = Task(kind, start.sign, dwell, start.ends, way, math.sin(_transmission(problem)), ratio)
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(RESTING) / (RESTING - 1))
    high = np.full(len(start.shape), FARTHEST * ratio)
    low = -high
    low[:3], high[:3] = 1.0, ratio
    if kind != "slot":
        low[5], high[5] = 1.0, ratio
    if kind == "rocker":
        low[8], high[8] = 1.0, ratio
    best = narrowest(partial(judged, task, nodes), start.shape, low, high, arrived=ARRIVED)
    if best is None or best.violation > SLACK:
        return None
    found = _Sixbar(kind, start.sign, best.shape)
    return found if kind == "slider" else _with_way(found, way)


def _way(sixbar: _Sixbar) -> float:
    """Swing (radians) or stroke over the turn."""
    turn = np.linspace(0.0, 2.0 * np.pi, GRID, endpoint=False)
    p = coupler_points(fourbars(sixbar.shape[None]), turn[None], np.array([OPEN])).p
    low, high = extremes(output(sixbar.kind, sixbar.sign, sixbar.shape[None], p)[0])
    return float(high[0] - low[0])


def _with_way(sixbar: _Sixbar, way: float) -> _Sixbar | None:
    """The output's pivot moved along the line from the pin at rest (or along the slot) until the way is met."""
    before, factor = (0.0, 0.0), 1.0
    made = sixbar
    for _ in range(WAY_STEPS):
        off = _way(made) / way - 1.0
        if not math.isfinite(off):
            return None
        if abs(off) < WAY_TOLERANCE:
            return made
        slope = (off - before[1]) / (factor - before[0]) if before[0] else -1.0
        if slope == 0.0:
            return None
        before, factor = (factor, off), factor - off / slope
        made = _moved(sixbar, factor)
    return made if abs(off) < MAX_WAY_ERROR else None


def _moved(sixbar: _Sixbar, factor: float) -> _Sixbar:
    """The output's pivot ``factor`` times as far from where the pin, or P, stands when the first dwell begins."""
    shape = sixbar.shape.copy()
    at = slice(5, 7) if sixbar.kind == "slot" else slice(6, 8)
    pivot = complex(*shape[at])
    joints = _joints(sixbar)
    rest = joints["P"] if sixbar.kind == "slot" else joints["D"]
    moved = rest + factor * (pivot - rest)
    shape[at] = moved.real, moved.imag
    if sixbar.kind == "rocker":
        shape[8] *= factor
    return sixbar._replace(shape=shape)


def _joints(sixbar: _Sixbar) -> dict[str, complex]:
    """Joints where the first dwell begins, in the shape's own frame."""
    shape = sixbar.shape[None]
    begin = sixbar.shape[{"rocker": 9, "slider": 8, "slot": 7}[sixbar.kind]]
    at = positions(fourbars(shape), np.array([[begin]]), np.array([OPEN]))
    joints = {"O2": 0j, "O4": complex(sixbar.shape[2]), "A": at.a[0, 0], "B": at.b[0, 0], "P": at.p[0, 0]}
    p = joints["P"]
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
        turn = np.linspace(0.0, 2.0 * np.pi, GRID, endpoint=False)
        reach = np.abs(coupler_points(fourbars(shape), turn[None], np.array([OPEN])).p - joints["O6"]).max()
        joints["C"] = joints["O6"] + (p - joints["O6"]) / abs(p - joints["O6"]) * float(reach)
    return {name: complex(z) for name, z in joints.items()}


def _mechanism(problem: DwellProblem, sixbar: _Sixbar) -> DwellMechanism:
    """The sixbar in the client's units, with the crank's pivot where it is wanted."""
    if sixbar.kind == "slider":
        scale = problem.way / _way(sixbar)
    else:
        scale = DEFAULT_CRANK if problem.crank is None else problem.crank
    own = _joints(sixbar)
    pivot = complex(*(problem.pivot or (0.0, 0.0)))
    joints = {name: pivot + scale * z for name, z in own.items()}
    links = [("ground", ["O2", "O4"]), ("input", ["O2", "A"]), ("coupler", ["A", "B", "P"]), ("rocker", ["O4", "B"])]
    slides: list[Slide] = []
    kind: Literal["dwell_rocker", "dwell_slider", "dwell_slot"] = "dwell_rocker"
    if sixbar.kind == "slider":
        kind = "dwell_slider"
        links.append(("link_5", ["P", "D"]))
        slides.append(slide("D", "ground", joints["D"], float(sixbar.shape[7])))
    else:
        links[0][1].append("O6")
        if sixbar.kind == "rocker":
            links += [("link_5", ["P", "D"]), ("output", ["O6", "D"])]
        else:
            kind = "dwell_slot"
            links.append(("output", ["O6", "C"]))
            slides.append(slide("P", "output", joints["O6"], cmath.phase(joints["P"] - joints["O6"])))
    point = (own["P"] - own["A"]) / ((own["B"] - own["A"]) / abs(own["B"] - own["A"]))
    return DwellMechanism(
        type=kind,
        fixed_pivots={name: to_point(joints[name]) for name in links[0][1]},
        links={name: abs(joints[listed[1]] - joints[listed[0]]) for name, listed in links},
        coupler_point=CouplerPoint(distance=scale * abs(point), angle=math.degrees(cmath.phase(point))),
        reference_input_angle=math.degrees(cmath.phase(own["A"])),
        skeleton=skeleton(joints, dict(links), slides=slides),
    )


def _summary(problem: DwellProblem, sifting: Sifting[DwellDesign]) -> str:
    unit = problem.length_unit if problem.output.type == "slider" else "°"
    if not sifting.passed:
        reasons = sifting.listed() or "no curve rests it"
        return f"No dwell sixbar was found that meets every demand ({reasons}); that none exists is not proven."
    best, count = _ranked(problem, sifting.passed)[0], len(sifting.passed)
    widths = " and ".join(f"{rest.width:.1f}°" for rest in best.targets)
    many = f"{count} dwell sixbars" if count > 1 else "One dwell sixbar"
    return (
        f"{many}; in the first the output moves by {best.metrics.jitter:.2g} {unit} at most while it rests, and keeps "
        f"within {problem.allowed:.3g} {unit} over {widths} of the crank."
    )
