"""Stages that are stated one by one: what is refused of them, and that what is usual need not be written."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from synthesis.analyses import parse_request
from synthesis.kinds.gear_train.statement.ring_pairs import find_running_pairs
from synthesis.kinds.gear_train.verification import verify
from synthesis.model.gears.stages import compute_ring_addenda
from tests.support.independent import typed_trains
from tests.support.synthesis.typed_trains import BEVEL, HELICAL, INTERNAL, Statement, faults, solved, stated

SPUR: Statement = {"type": "external"}
GIVEN: Statement = {"type": "external", "driver": {"min": 20, "max": 30}, "driven": {"min": 20, "max": 30}}


@pytest.mark.parametrize(
    ("stages", "fields", "path"),
    [
        ([BEVEL, SPUR, SPUR, SPUR], {"teeth": {"min": 12, "max": 2000}}, "/teeth"),
        ([GIVEN, SPUR, SPUR, SPUR], {"teeth": {"min": 12, "max": 600}}, "/teeth"),
        ([SPUR, INTERNAL, HELICAL, HELICAL | {"helix_angle": 10.0}], {"teeth": {"min": 12, "max": 130}}, "/teeth"),
        ([GIVEN | {"driver": 20, "driven": {"min": 20, "max": 120}}] * 3 + [INTERNAL], {}, "/teeth"),
        ([GIVEN | {"driver": {"min": 20, "max": 120}}] * 3 + [GIVEN | {"driver": {"min": 20, "max": 121}}], {},
         "/stages"),
        ([SPUR, SPUR, SPUR | {"driver": 20}], {"reverted": True, "teeth": {"min": 12, "max": 2000}}, "/teeth"),
    ],
)  # fmt: skip
def test_a_search_too_large_is_refused(stages: list[Statement], fields: Statement, path: str) -> None:
    """More choices of drivers, or of driven gears, than are held: whichever stages they are of."""
    assert faults(*stages, ratio="100", **fields) == [path]


@pytest.mark.parametrize(
    ("stages", "fields"),
    [
        ([SPUR, GIVEN, GIVEN, GIVEN], {"teeth": {"min": 12, "max": 300}}),
        ([GIVEN, GIVEN, GIVEN, SPUR], {"teeth": {"min": 12, "max": 300}}),
        ([SPUR, SPUR, SPUR, SPUR], {"teeth": {"min": 12, "max": 100}}),
        ([SPUR, BEVEL, BEVEL, BEVEL], {"teeth": {"min": 12, "max": 2000}}),
        ([GIVEN | {"driver": 20}, SPUR, SPUR], {"reverted": True, "teeth": {"min": 12, "max": 300}}),
    ],
)
def test_a_search_that_is_small_is_not_refused(stages: list[Statement], fields: Statement) -> None:
    """A wide range of one stage beside the narrow ones of others; and choices of like stages in one order only."""
    assert faults(*stages, ratio="100", **fields) == []


@pytest.mark.slow
def test_a_wide_stage_beside_narrow_ones_is_solved() -> None:
    result = solved(SPUR, GIVEN, GIVEN, GIVEN, ratio="7/2", teeth={"min": 12, "max": 60})
    assert result.designs[0].metrics.relative_error == 0.0
    assert result.search.combinations == (49 * 11**3) ** 2


@pytest.mark.slow
@pytest.mark.parametrize(("angle", "least"), [(20.0, 4), (25.0, 0)])
def test_rings_that_run_are_those_of_a_sound_pair(angle: float, least: int) -> None:
    """Of every pinion and ring, against the pair's own geometry and against corners that are followed as points."""
    phi, trimmed = math.radians(angle), 0
    for pinion, ring in itertools.product((14, 18, 19, 24, 33), range(24, 62)):
        if ring <= pinion + 4:
            continue
        short = compute_ring_addenda(pinion, ring, phi)[1]
        if short < 0.3:
            continue
        pair: Statement = {"type": "gear_pair", "teeth": [pinion, ring], "internal": True, "pressure_angle": angle}
        told = parse_request({"mechanism": pair | {"addendum": [1.0, short]}}).build_answer()
        runs = bool(find_running_pairs(np.array([float(pinion)]), np.array([float(ring)]), phi)[0])
        thin_or_cut = any(
            gear["undercut"] or gear["tip_thickness"] is None or gear["tip_thickness"] <= 0.0 for gear in told["gears"]
        )
        if not thin_or_cut:
            assert runs == told["sound"], (pinion, ring)
        if told["ring_trimmed"]:
            assert not runs
            trimmed += not told["tips_foul"] and not any(gear["fillet_interference"] for gear in told["gears"])
        assert runs == typed_trains.runs_in_ring(pinion, ring, phi), (pinion, ring)
    assert trimmed >= least, "so many rings are refused for their cutter alone"


def test_a_ring_that_its_cutter_trims_does_not_pass() -> None:
    """18:35, whose tips the cutter of 17 teeth takes off, is neither found nor verified."""
    found = solved(INTERNAL, ratio="35/18", teeth={"min": 18, "max": 40}, tolerance=0.3, max_designs=50)
    meshes = [(d.mechanism.stages[0].driver, d.mechanism.stages[0].driven) for d in found.designs]
    assert (18, 35) not in meshes
    assert (18, 37) in meshes
    assert all(mesh.ring_trimmed is False for design in found.designs for mesh in design.metrics.meshes)
    made = found.designs[0].mechanism
    one, short = compute_ring_addenda(18, 35, math.radians(20.0))
    assert made.stages[0].addendum is not None
    addendum = made.stages[0].addendum.model_copy(update={"driver": one, "driven": short})
    stage = made.stages[0].model_copy(update={"driver": 18, "driven": 35, "addendum": addendum})
    ratio = made.ratio.from_fraction(Fraction(35, 18))
    design = verify(stated(INTERNAL, ratio="35/18", teeth={"min": 18, "max": 40}),
                    made.model_copy(update={"stages": [stage], "ratio": ratio}))  # fmt: skip
    assert design is not None
    assert [check.name for check in design.verification.checks if not check.passed] == ["rings"]


WORM_RANGE: Statement = {"type": "worm", "driver": {"min": 1, "max": 3}, "driven": {"min": 30, "max": 36}}


@pytest.mark.parametrize(
    ("stage", "usual", "fields"),
    [
        (WORM_RANGE, {"hand": "right"}, {"ratio": "300"}),
        (WORM_RANGE, {"friction": 0.05}, {"ratio": "300"}),
        (WORM_RANGE, {"diameter_quotient": 10.0}, {"ratio": "300"}),
        (INTERNAL, {"ring": "driven"}, {"ratio": "9", "teeth": {"min": 18, "max": 70}}),
        (BEVEL | {"driver": {"min": 20, "max": 24}}, {"shaft_angle": 90.0}, {"ratio": "15/8"}),
    ],
)
def test_what_is_usual_need_not_be_written(stage: Statement, usual: Statement, fields: Statement) -> None:
    """Stages are alike whether or not their statements say what they are anyway."""
    plain, told = solved(stage, stage, **fields), solved(stage, stage | usual, **fields)
    assert plain.search.ties == told.search.ties
    assert plain.summary == told.summary
    name = next(iter(usual))
    other = {"hand": "left", "friction": 0.06, "diameter_quotient": 9.0, "shaft_angle": 91.0, "ring": "driver"}[name]
    if name != "ring":
        unlike = solved(stage, stage | {name: other}, **fields)
        assert unlike.search.ties > plain.search.ties


@pytest.mark.parametrize(
    ("stages", "fields", "paths"),
    [
        ([SPUR | {"driver": 20}], {"teeth": [{"min": 30, "max": 31}, {"min": 30, "max": 50}]}, ["/teeth/0"]),
        ([SPUR | {"driven": 51}], {"teeth": [{"min": 10, "max": 31}, {"min": 30, "max": 50}]}, ["/teeth/1"]),
        ([SPUR, GIVEN], {"teeth": [{"max": 40}, {"max": 40}, {"min": 20, "max": 29}, {"min": 21, "max": 30}]},
         ["/teeth/2", "/teeth/3"]),
        ([SPUR | {"driver": 20}], {"teeth": [{"min": 20, "max": 31}, {"min": 30, "max": 50}]}, []),
        ([{"type": "worm", "driver": 2, "driven": 40}], {"teeth": [{}, {}]}, []),
        ([SPUR, SPUR], {"max_stages": 2}, ["/max_stages"]),
        ([SPUR, SPUR], {"max_stages": 3}, ["/max_stages"]),
        ([SPUR, SPUR], {"max_stages": None}, []),
    ],
)  # fmt: skip
def test_what_contradicts_the_stages_is_refused(stages: list[Statement], fields: Statement, paths: list[str]) -> None:
    assert faults(*stages, ratio="4", **fields) == paths


def test_the_proof_says_that_gears_of_a_stage_stand() -> None:
    """The range of `teeth` is for the gears that no stage states."""
    words = "the gears given by stages unchanged"
    both = solved(SPUR | {"driver": 20, "driven": 80}, SPUR, ratio="8", teeth={"min": 20, "max": 40})
    assert words in both.summary
    assert words not in solved(SPUR | {"driver": 20, "driven": 80}, ratio="4").summary
    assert words not in solved(SPUR, ratio="2", teeth={"min": 20, "max": 40}).summary


@pytest.mark.parametrize(
    ("stage", "path"),
    [
        (BEVEL | {"driven": 60, "shaft_angle": 120.0}, "/stages/0/shaft_angle"),
        (BEVEL | {"driven": {"min": 50, "max": 60}, "shaft_angle": 120.0}, "/stages/0/shaft_angle"),
        (INTERNAL | {"driver": 40, "driven": 42}, "/stages/0"),
        (INTERNAL | {"driver": 40, "driven": 20}, "/stages/0"),
        (INTERNAL | {"driver": 40, "driven": 40}, "/stages/0"),
        (INTERNAL | {"driver": 20, "driven": 40, "ring": "driver"}, "/stages/0"),
        (INTERNAL | {"driver": 42, "driven": 40, "ring": "driver"}, "/stages/0"),
        (INTERNAL | {"driver": {"min": 40, "max": 50}, "driven": {"min": 20, "max": 40}}, "/stages/0"),
        (INTERNAL | {"driver": 18, "driven": 35}, "/stages/0"),
    ],
)
def test_gears_that_cannot_be_are_refused(stage: Statement, path: str) -> None:
    assert faults(stage, ratio="3") == [path]


@pytest.mark.parametrize(
    "stage",
    [
        BEVEL | {"driven": 30, "shaft_angle": 120.0},
        BEVEL | {"driven": {"min": 30, "max": 60}, "shaft_angle": 120.0},
        INTERNAL | {"driver": 40, "driven": 20, "ring": "driver"},
        INTERNAL | {"driver": 18, "driven": {"min": 20, "max": 37}},
    ],
)
def test_gears_of_which_some_can_be_are_not_refused(stage: Statement) -> None:
    assert faults(stage, ratio="3") == []


def test_an_analysis_names_the_angle_at_which_there_are_no_cones() -> None:
    def told(**stage: Any) -> list[str]:
        stages = [{"driver": 20, "driven": 60, **stage}]
        return [
            path for path, _ in parse_request({"mechanism": {"type": "gear_train", "stages": stages}}).find_errors()
        ]

    assert told(type="bevel", shaft_angle=120.0) == ["/mechanism/stages/0/shaft_angle"]
    assert told(type="bevel", shaft_angle=100.0) == []


def test_the_largest_stage_ratio_is_of_all_stages() -> None:
    """A worm's is that of its gear's teeth to its threads; the limit is one of gears."""
    worm: Statement = {"type": "worm", "driver": 2, "driven": 40}
    design = solved(worm, SPUR, ratio="40", teeth={"min": 20, "max": 40}, max_stage_ratio=2.5).designs[0]
    assert design.metrics.largest_stage_ratio == 20.0
    limited = next(check for check in design.verification.checks if check.name == "stage_ratio")
    assert (limited.value, limited.limit, limited.passed) == (2.0, 2.5, True)
    assert solved(worm, ratio="20").designs[0].metrics.largest_stage_ratio == 20.0
