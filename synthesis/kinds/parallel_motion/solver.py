"""Build and verify sixbars for parallel motion from a fourbar, its cognates, or the fourbars of a path problem."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from functools import partial
from typing import Literal, NamedTuple

from kinematics.linkage.fourbar import Fourbar, build_cognates, build_parallel_motion, positions
from kinematics.message import compose, join_messages
from synthesis.kinds.parallel_motion.design import ParallelMotionDesign, ParallelMotionMechanism, ParallelMotionResult
from synthesis.kinds.parallel_motion.problem import ParallelMotionProblem, SourceLinkage
from synthesis.kinds.parallel_motion.verification import verify_parallel_motion
from synthesis.kinds.path.solver import solve_path
from synthesis.mechanisms import GivenFourbar, MechanismError
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import (
    FourbarConfiguration,
    build_coupler_point,
    build_driven_fourbar,
    build_skeleton,
    to_point,
)
from synthesis.model.problem import Contradiction, ContradictionError
from synthesis.results.candidate_log import DEFECT_REASONS, CandidateLog, report_candidates
from synthesis.results.ranking import rank_designs

Base = Literal["source", "left_cognate", "right_cognate", "path"]
InputSide = Literal["input", "output"]

PATH_PROGRESS_SHARE = 0.9
"""Share of the progress assigned to a path problem."""

REJECTION_REASONS = DEFECT_REASONS | {"translates": "rotation", "on_curve": "deviation"}
"""Rejection reason by failed check; other checks use their own name."""


class _SourceFourbar(NamedTuple):
    """A fourbar that traces the curve, in its first position."""

    base: Base
    input_side: InputSide
    joints: FourbarConfiguration


def solve_parallel_motion(problem: ParallelMotionProblem, progress: Progress) -> ParallelMotionResult:
    """Solve a problem of parallel motion."""
    if problem.path is not None:
        found = solve_path(problem.path, scale_progress(progress, 0.0, PATH_PROGRESS_SHARE))
        mechanisms = [design.mechanism for design in found.designs]
        # Sixbars and slider-cranks have no cognates of this kind.
        fourbars = list(_list_from_path([one for one in mechanisms if isinstance(one, FourbarMechanism)]))
    else:
        assert problem.linkage is not None
        fourbars = list(_list_from_linkage(problem.linkage, cognates_too=problem.include_cognates))
    sifting = CandidateLog[ParallelMotionDesign](problem, REJECTION_REASONS)
    sifting.verify_candidates(
        report_candidates(fourbars, progress, (PATH_PROGRESS_SHARE, 1.0), "parallel_motion-progress-driving-sixbars"),
        lambda fourbar: verify_parallel_motion(
            problem, _build_sixbar(fourbar.joints), fourbar.base, fourbar.input_side
        ),
    )
    progress(1.0, compose("parallel_motion-verified"))
    designs = sifting.select_designs(partial(_rank_designs, problem.rank_by))
    return ParallelMotionResult(
        designs=designs,
        search=sifting.build_search(compose("parallel_motion-method")),
        summary=_describe_result(designs, sifting),
    )


def warm_up() -> None:
    """Compile or load the kernels by solving the example."""
    extra = ParallelMotionProblem.model_config["json_schema_extra"]
    assert isinstance(extra, dict)
    examples = extra["examples"]
    assert isinstance(examples, list)
    solve_parallel_motion(ParallelMotionProblem.model_validate(examples[0]), lambda fraction, message: None)


def _rank_designs(rank_by: str, designs: list[ParallelMotionDesign]) -> list[ParallelMotionDesign]:
    """Rank designs. Equally good ones keep their order: first the given fourbar, then its cognates."""
    return rank_designs(
        designs, rank_by, {"accuracy": lambda design: design.metrics.rms_residual}, ties=lambda design: 0.0
    )


def _list_from_linkage(given: SourceLinkage, *, cognates_too: bool) -> Iterator[_SourceFourbar]:
    """Yield the given fourbar and both cognates, each with either fixed pivot as the input's."""
    stated = given.model_dump(exclude={"skeleton", "reference_body_angle"}, exclude_none=True)
    try:
        mechanism = GivenFourbar.model_validate({**stated, "reference_input_angle": given.reference}).build_mechanism()
    except MechanismError as error:
        raise ContradictionError(Contradiction(f"/linkage{error.path}", error.detail)) from None
    joints = FourbarConfiguration(*(complex(mechanism.joints[name]) for name in ("O2", "A", "B", "O4", "P")))
    yield _SourceFourbar("source", "input", joints)
    if not cognates_too:
        return
    # Either fixed pivot can carry the input; the sixbars differ, the curve does not.
    yield _SourceFourbar("source", "output", _reverse_input(joints))
    linkage, angle, side = _convert_to_linkage(joints)
    pair = build_cognates(linkage)
    names: tuple[Base, Base] = ("left_cognate", "right_cognate")
    for name, cognate in zip(names, pair, strict=True):
        # All cognates are shown in the position in which P is at the same place.
        stands = cognate.configuration(angle, side)
        at = positions(cognate.linkage, float(stands.input_angle), int(stands.assembly))
        own = FourbarConfiguration(
            complex(cognate.linkage.input_pivot),
            complex(at.a),
            complex(at.b),
            complex(cognate.linkage.output_pivot),
            complex(at.p),
        )
        yield _SourceFourbar(name, "input", own)
        yield _SourceFourbar(name, "output", _reverse_input(own))


def _list_from_path(mechanisms: list[FourbarMechanism]) -> Iterator[_SourceFourbar]:
    for mechanism in mechanisms:
        linkage, side, reference = build_driven_fourbar(mechanism)
        at = positions(linkage, reference, side)
        pivots = complex(linkage.input_pivot), complex(linkage.output_pivot)
        yield _SourceFourbar(
            "path", "input", FourbarConfiguration(pivots[0], complex(at.a), complex(at.b), pivots[1], complex(at.p))
        )


def _reverse_input(joints: FourbarConfiguration) -> FourbarConfiguration:
    """Return the fourbar with the output link as the input."""
    return FourbarConfiguration(joints.o4, joints.b, joints.a, joints.o2, joints.p)


def _convert_to_linkage(joints: FourbarConfiguration) -> tuple[Fourbar, float, int]:
    """Convert joints to a fourbar of the analysis core; return it with its input angle, radians, and its assembly."""
    o2, a, b, o4, p = joints
    coupler = b - a
    linkage = Fourbar(o2, o4, abs(a - o2), abs(coupler), abs(b - o4), (p - a) / coupler * abs(coupler))
    side = 1 if ((o4 - a).conjugate() * coupler).imag >= 0.0 else -1
    return linkage, cmath.phase(a - o2), side


def _build_sixbar(joints: FourbarConfiguration) -> ParallelMotionMechanism:
    """Build the sixbar: the fourbar with pin C on its input, the guide C–Q and the body P–Q."""
    o2, a, b, o4, p = joints
    linkage, angle, _ = _convert_to_linkage(joints)
    made = build_parallel_motion(linkage)
    places = {
        "O2": o2,
        "O4": o4,
        "A": a,
        "B": b,
        "C": o2 + complex(made.crank_point) * cmath.exp(1j * angle),
        "P": p,
        "Q": p + complex(made.translation),
    }
    links = {
        "ground": ["O2", "O4"],
        "input": ["O2", "A", "C"],
        "coupler": ["A", "B", "P"],
        "output": ["O4", "B"],
        "guide": ["C", "Q"],
        "body": ["P", "Q"],
    }
    return ParallelMotionMechanism(
        fixed_pivots={name: to_point(places[name]) for name in links["ground"]},
        links={
            **{name: abs(places[listed[1]] - places[listed[0]]) for name, listed in links.items()},
            "input_arm": abs(places["C"] - o2),
        },
        coupler_point=build_coupler_point(a, b, p),
        reference_input_angle=math.degrees(angle),
        skeleton=build_skeleton(places, links),
    )


def _describe_result(designs: list[ParallelMotionDesign], sifting: CandidateLog[ParallelMotionDesign]) -> str:
    if not sifting.passed:
        reasons = sifting.format_reasons() or compose("parallel_motion-no-fourbar")
        return compose("parallel_motion-none-carries", candidates=sifting.candidates, reasons=reasons)
    best = designs[0].metrics
    carrying = compose("parallel_motion-sixbars-carry", passed=len(sifting.passed), candidates=sifting.candidates)
    shown = compose(
        "parallel_motion-best-design" if best.full_rotation else "parallel_motion-best-design-swings",
        angle=f"{best.min_transmission_angle:.1f}",
        x=f"{best.translation[0]:.6g}",
        y=f"{best.translation[1]:.6g}",
    )
    return join_messages([carrying, shown])
