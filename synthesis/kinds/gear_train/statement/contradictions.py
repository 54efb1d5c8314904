"""Contradictions between several fields of a requested gear train."""

from __future__ import annotations

import math

from kinematics.message import compose
from synthesis.kinds.gear_train.statement.ring_pairs import has_no_running_ring
from synthesis.kinds.gear_train.statement.search_size import check_search_size
from synthesis.kinds.gear_train.statement.stages import GEARS, RequestedStage, compute_sense
from synthesis.kinds.gear_train.statement.train import MAX_PITCH_MULTIPLE, ROUNDING_MARGIN, GearTrainBase, TeethRange
from synthesis.model.gears.ratio_target import parse_target
from synthesis.model.gears.strength import RATED_STAGE_TYPES
from synthesis.model.problem import Contradiction

FITTED_TYPES = ("external", "helical")
"""Types of stages whose teeth can be fitted."""


def find_train_contradictions(train: GearTrainBase) -> list[Contradiction]:
    """Return all contradictions by field; the size of the search is only checked if the lists match the stages."""
    unsuited = [*_check_lists(train), *_check_fit(train)]
    return [
        *_check_stages(train),
        *_check_fields(train),
        *unsuited,
        *([] if unsuited else check_search_size(train)),
        *_check_strength(train),
    ]


def _check_stages(train: GearTrainBase) -> list[Contradiction]:
    """Check stages that are given one by one, and the constraints on all of them together."""
    if train.stages is None:
        return []
    faults = [
        Contradiction(f"/stages/{number}{path}", detail)
        for number, stage in enumerate(train.stages)
        for path, detail in stage.find_errors()
    ]
    if not faults:
        faults += _find_impossible_gears(train, train.stages)
    if train.max_stages is not None:
        detail = compose("gear_train-stages-and-max-stages", count=len(train.stages))
        faults.append(Contradiction("/max_stages", detail))
    if train.stock is not None:
        detail = compose("gear_train-stock-has-no-types")
        faults.append(Contradiction("/stock", detail))
    faults += _check_direction(train, train.stages)
    for number, stage in enumerate(train.stages):
        path = f"/stages/{number}/type"
        if train.reverted and not stage.is_parallel:
            faults.append(Contradiction(path, compose("gear_train-shafts-not-parallel", type=stage.type)))
        if train.is_fitted and stage.type not in FITTED_TYPES:
            detail = compose("gear_train-teeth-not-fittable", type=stage.type, fields=", ".join(train.fitting_fields))
            faults.append(Contradiction(path, detail))
        if train.strength is not None and stage.type not in RATED_STAGE_TYPES:
            detail = compose("gear_train-strength-not-estimated", type=stage.type)
            faults.append(Contradiction(path, detail))
    if train.strength is not None and any(stage.type == "internal" for stage in train.stages):
        wrong = train.strength.find_ring_errors()
        faults += [Contradiction(f"/strength{path}", detail) for path, detail in wrong]
    return faults + _check_load(train, train.stages)


def _check_load(train: GearTrainBase, stages: list[RequestedStage]) -> list[Contradiction]:
    """Check values of helical stages that are unknown, or that follow from the strength."""
    helical = [number for number, stage in enumerate(stages) if stage.type == "helical"]
    if train.strength is None or not helical:
        return []
    faults = [Contradiction(f"/strength{path}", detail) for path, detail in train.strength.find_helix_errors()]
    if train.strength.allowable_contact is not None and train.strength.factors.contact_geometry is None:
        # The contact stress formula holds from one axial pitch of overlap on: face ≥ π m / sin β.
        least = max(math.pi / math.sin(math.radians(abs(stages[number].helix_angle or 90.0))) for number in helical)
        if train.strength.max_face_width < least:
            detail = compose("gear_train-face-too-narrow-for-contact", least=f"{least:.4g}")
            faults.append(Contradiction("/strength/max_face_width", detail))
    detail = compose("gear_train-strength-determines-face")
    return faults + [
        Contradiction(f"/stages/{number}/face_width", detail)
        for number in helical
        if stages[number].face_width is not None
    ]


def _find_impossible_gears(train: GearTrainBase, stages: list[RequestedStage]) -> list[Contradiction]:
    """Find stages whose given gears cannot be made or cannot run."""
    faults = []
    for number, stage in enumerate(stages):
        path, pairs = f"/stages/{number}", stage.list_given_pairs()
        if stage.type == "bevel" and not any(stage.has_meeting_cones(*pair) for pair in pairs):
            faults.append(Contradiction(f"{path}/shaft_angle", compose("gear_train-bevel-without-cones")))
        if stage.type == "internal" and has_no_running_ring(stage, math.radians(train.pressure_angle)):
            faults.append(Contradiction(path, compose("gear_train-pinion-not-in-ring")))
    return faults


def _check_direction(train: GearTrainBase, stages: list[RequestedStage]) -> list[Contradiction]:
    """Check that the stages have the requested direction."""
    wanted, sense = train.required_sign, compute_sense(stages)
    if not wanted or wanted == sense:
        return []
    # A negative ratio requests the direction if the direction field does not.
    field = "/ratio" if train.direction == "any" else "/direction"
    if not sense:
        return [Contradiction(field, compose("gear_train-direction-without-meaning"))]
    turning = "gear_train-stages-turn-same" if sense > 0 else "gear_train-stages-turn-opposite"
    return [Contradiction(field, compose(turning))]


def _check_fields(train: GearTrainBase) -> list[Contradiction]:
    """Check for redundant or contradictory fields."""
    contradictions = []
    if train.direction == "same" and parse_target(train.ratio)[0] < 0:
        contradictions.append(Contradiction("/direction", compose("gear_train-negative-ratio-same-direction")))
    if train.module is not None and train.diametral_pitch is not None:
        contradictions.append(Contradiction("/diametral_pitch", compose("gear_train-module-and-pitch")))
    if train.stock is not None and train.teeth is not None:
        contradictions.append(Contradiction("/stock", compose("gear_train-stock-and-teeth")))
    if train.reverted and train.most_stages < 2:
        contradictions.append(Contradiction("/reverted", compose("gear_train-reverted-single-stage")))
    return contradictions


def _check_lists(train: GearTrainBase) -> list[Contradiction]:
    """Check lists of ranges and of modules against the stages, and ranges for a sound tooth number."""
    contradictions = []
    if isinstance(train.teeth, list) and len(train.teeth) != 2 * train.most_stages:
        contradictions.append(
            Contradiction(
                "/teeth",
                compose(
                    "gear_train-range-count-wrong",
                    ranges=2 * train.most_stages,
                    stages=train.most_stages,
                    given=len(train.teeth),
                ),
            )
        )
    elif isinstance(train.teeth, list) and train.stages is not None:
        contradictions += _check_places(train, train.teeth, train.stages)
    for place, one in enumerate(train.ranges):
        if one.min is None and _find_fewest_teeth(train, place) > one.max:
            path = f"/teeth/{place}/max" if isinstance(train.teeth, list) else "/teeth/max"
            detail = compose("gear_train-max-undercut", least=_find_fewest_teeth(train, place))
            contradictions.append(Contradiction(path, detail))
    if isinstance(train.module, list):
        if len(set(train.module)) < len(train.module) and train.reverted:
            contradictions.append(Contradiction("/module", compose("gear_train-stage-module-repeats")))
        elif max(train.pitches()) > MAX_PITCH_MULTIPLE:
            contradictions.append(Contradiction("/module", compose("gear_train-modules-incommensurable")))
        elif not train.reverted and len(train.module) != train.most_stages:
            detail = compose("gear_train-module-count-wrong", stages=train.most_stages, given=len(train.module))
            contradictions.append(Contradiction("/module", detail))
    return contradictions


def _check_places(train: GearTrainBase, ranges: list[TeethRange], stages: list[RequestedStage]) -> list[Contradiction]:
    """Check the ranges of places for which a stage gives the gears."""
    faults = []
    for place, one in enumerate(ranges):
        stage, name = stages[place // 2], GEARS[place % 2]
        limits = stage.limits(name)
        if limits is None:
            continue
        if not ((one.min or 0) <= limits[0] and limits[1] <= one.max):
            detail = compose("gear_train-range-excludes-gear", gear=name, stage=place // 2 + 1)
            faults.append(Contradiction(f"/teeth/{place}", detail))
    return faults


def _find_fewest_teeth(train: GearTrainBase, place: int) -> int:
    """Return the fewest teeth that are not undercut, for a place in the list of ranges or for all."""
    if train.stages is None:
        return train.fewest_teeth
    rows = train.stages[place // 2 : place // 2 + 1] if isinstance(train.teeth, list) else train.stages
    # A stage that gives both of its gears needs no range.
    free = [stage for stage in rows if stage.driver is None or stage.driven is None]
    return max((stage.fewest_teeth(train.pressure_angle, ROUNDING_MARGIN) for stage in free), default=0)


def _check_fit(train: GearTrainBase) -> list[Contradiction]:
    """Check modules to choose from that are also given otherwise, and distances that do not suit the stages."""
    contradictions = []
    if train.modules is not None:
        for name, pitch in (("module", train.module), ("diametral_pitch", train.diametral_pitch)):
            if pitch is not None:
                contradictions.append(Contradiction("/modules", compose("gear_train-modules-and-pitch", field=name)))
        if len(set(train.modules)) < len(train.modules):
            contradictions.append(Contradiction("/modules", compose("gear_train-modules-repeat")))
    if isinstance(train.centre_distance, list):
        if train.reverted:
            contradictions.append(Contradiction("/centre_distance", compose("gear_train-reverted-distance-list")))
        elif len(train.centre_distance) != train.most_stages:
            detail = compose(
                "gear_train-distance-count-wrong", stages=train.most_stages, given=len(train.centre_distance)
            )
            contradictions.append(Contradiction("/centre_distance", detail))
    return contradictions


def _check_strength(train: GearTrainBase) -> list[Contradiction]:
    """Check the required strength."""
    if train.strength is None:
        return []
    return [Contradiction(f"/strength{path}", detail) for path, detail in train.strength.find_errors()]
