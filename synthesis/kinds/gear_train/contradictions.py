"""Contradictions in a requested gear train: errors that no single field shows."""

from __future__ import annotations

import math

from synthesis.kinds.gear_train.extent import beyond_search
from synthesis.kinds.gear_train.rings import no_ring_runs
from synthesis.kinds.gear_train.stated_stages import GEARS, StatedStage, sense_of
from synthesis.kinds.gear_train.stated_train import FINEST_PITCHES, ROUNDING, StatedTrain, TeethRange
from synthesis.model.gear_strength import CARRYING_TYPES
from synthesis.model.ratio_target import parse_target
from synthesis.model.statement import Contradiction

FITTED_TYPES = ("external", "helical")
"""Types of stages whose teeth can be fitted."""


def contradictions_of(stated: StatedTrain) -> list[Contradiction]:
    """Return all contradictions by field; the size of the search is only checked if the lists suit the stages."""
    unsuited = [*_wrong_lists(stated), *_wrong_fit(stated)]
    return [
        *_wrong_stages(stated),
        *_contradicting_fields(stated),
        *unsuited,
        *([] if unsuited else beyond_search(stated)),
        *_too_weak(stated),
    ]


def _wrong_stages(stated: StatedTrain) -> list[Contradiction]:
    """Check stages that are given one by one, and the constraints on all of them together."""
    if stated.stages is None:
        return []
    faults = [
        Contradiction(f"/stages/{number}{path}", detail)
        for number, stage in enumerate(stated.stages)
        for path, detail in stage.faults()
    ]
    if not faults:
        faults += _impossible_gears(stated, stated.stages)
    if stated.max_stages is not None:
        detail = f"{len(stated.stages)} stages are given one by one; omit max_stages"
        faults.append(Contradiction("/max_stages", detail))
    if stated.stock is not None:
        detail = "the gears of a stock have no type; give driver and driven of the stages instead"
        faults.append(Contradiction("/stock", detail))
    faults += _wrong_direction(stated, stated.stages)
    for number, stage in enumerate(stated.stages):
        path = f"/stages/{number}/type"
        if stated.reverted and not stage.is_parallel:
            faults.append(Contradiction(path, f"the shafts of a {stage.type} stage are not parallel; omit reverted"))
        if stated.is_fitted and stage.type not in FITTED_TYPES:
            detail = f"the teeth of {stage.type} stages cannot be fitted; omit {', '.join(stated.fitting_fields)}"
            faults.append(Contradiction(path, detail))
        if stated.strength is not None and stage.type not in CARRYING_TYPES:
            detail = f"the strength of {stage.type} stages is not estimated; omit strength"
            faults.append(Contradiction(path, detail))
    if stated.strength is not None and any(stage.type == "internal" for stage in stated.stages):
        wrong = stated.strength.faults_of_ring()
        faults += [Contradiction(f"/strength{path}", detail) for path, detail in wrong]
    return faults + _wrong_load(stated, stated.stages)


def _wrong_load(stated: StatedTrain, stages: list[StatedStage]) -> list[Contradiction]:
    """Check values of helical stages that are unknown, or that follow from the strength."""
    helical = [number for number, stage in enumerate(stages) if stage.type == "helical"]
    if stated.strength is None or not helical:
        return []
    faults = [Contradiction(f"/strength{path}", detail) for path, detail in stated.strength.faults_of_helix()]
    if stated.strength.allowable_contact is not None and stated.strength.factors.contact_geometry is None:
        # The contact stress formula holds from one axial pitch of overlap on: face ≥ π m / sin β.
        least = max(math.pi / math.sin(math.radians(abs(stages[number].helix_angle or 90.0))) for number in helical)
        if stated.strength.max_face_width < least:
            detail = f"the contact stress of these helical teeth is only known for faces from {least:.4g} modules"
            faults.append(Contradiction("/strength/max_face_width", f"{detail}, at which they overlap by one pitch"))
    detail = "the strength determines the face; omit the face width, or omit strength"
    return faults + [
        Contradiction(f"/stages/{number}/face_width", detail)
        for number in helical
        if stages[number].face_width is not None
    ]


def _impossible_gears(stated: StatedTrain, stages: list[StatedStage]) -> list[Contradiction]:
    """Find stages whose given gears cannot be made or cannot run."""
    faults = []
    for number, stage in enumerate(stages):
        path, pairs = f"/stages/{number}", stage.given_pairs()
        if stage.type == "bevel" and not any(stage.meeting_cones(*pair) for pair in pairs):
            faults.append(Contradiction(f"{path}/shaft_angle", "these bevel gears have no cones at this angle"))
        if stage.type == "internal" and no_ring_runs(stage, math.radians(stated.pressure_angle)):
            detail = "the pinion does not run in the ring: their tips or fillets interfere"
            faults.append(Contradiction(path, f"{detail}; give the ring more teeth, or the pinion fewer"))
    return faults


def _wrong_direction(stated: StatedTrain, stages: list[StatedStage]) -> list[Contradiction]:
    """Check that the stages have the requested direction."""
    wanted, sense = stated.demanded_sign, sense_of(stages)
    if not wanted or wanted == sense:
        return []
    # A negative ratio requests the direction if the direction field does not.
    field = "/ratio" if stated.direction == "any" else "/direction"
    if not sense:
        detail = "has no meaning for intersecting or crossed shafts: it depends on the side on which gears are placed"
        return [Contradiction(field, f"a direction {detail}; give only the size of the ratio")]
    turning = "in the same direction" if sense > 0 else "in opposite directions"
    detail = f"with these stages input and output turn {turning}; use one internal stage more, or one less"
    return [Contradiction(field, detail)]


def _contradicting_fields(stated: StatedTrain) -> list[Contradiction]:
    """Check for redundant or contradictory fields."""
    contradictions = []
    if stated.direction == "same" and parse_target(stated.ratio)[0] < 0:
        contradictions.append(
            Contradiction("/direction", "a negative ratio means opposite directions; omit the sign or the direction")
        )
    if stated.module is not None and stated.diametral_pitch is not None:
        contradictions.append(
            Contradiction("/diametral_pitch", "the module already determines the pitch; give only one of them")
        )
    if stated.stock is not None and stated.teeth is not None:
        contradictions.append(
            Contradiction("/stock", "the stock already determines the tooth numbers; omit teeth or stock")
        )
    if stated.reverted and stated.most_stages < 2:
        contradictions.append(Contradiction("/reverted", "a reverted train has at least two stages; raise max_stages"))
    return contradictions


def _wrong_lists(stated: StatedTrain) -> list[Contradiction]:
    """Check lists of ranges and of modules against the stages, and ranges for a sound tooth number."""
    contradictions = []
    if isinstance(stated.teeth, list) and len(stated.teeth) != 2 * stated.most_stages:
        contradictions.append(
            Contradiction(
                "/teeth",
                f"expected {2 * stated.most_stages} ranges, driver and driven gear of {stated.most_stages} stages, "
                f"got {len(stated.teeth)}",
            )
        )
    elif isinstance(stated.teeth, list) and stated.stages is not None:
        contradictions += _contradicting_places(stated, stated.teeth, stated.stages)
    for place, one in enumerate(stated.ranges):
        if one.min is None and _fewest_at(stated, place) > one.max:
            path = f"/teeth/{place}/max" if isinstance(stated.teeth, list) else "/teeth/max"
            detail = f"below {_fewest_at(stated, place)}, the fewest teeth without undercut; give min as well"
            contradictions.append(Contradiction(path, detail))
    if isinstance(stated.module, list):
        if len(set(stated.module)) < len(stated.module) and stated.reverted:
            contradictions.append(Contradiction("/module", "lists a module twice; each is a choice for every stage"))
        elif max(stated.pitches()) > FINEST_PITCHES:
            contradictions.append(Contradiction("/module", "the modules have no common measure; round them"))
        elif not stated.reverted and len(stated.module) != stated.most_stages:
            contradictions.append(
                Contradiction(
                    "/module", f"expected the modules of {stated.most_stages} stages, got {len(stated.module)}"
                )
            )
    return contradictions


def _contradicting_places(
    stated: StatedTrain, ranges: list[TeethRange], stages: list[StatedStage]
) -> list[Contradiction]:
    """Check the ranges of places for which a stage gives the gears."""
    faults = []
    for place, one in enumerate(ranges):
        stage, name = stages[place // 2], GEARS[place % 2]
        limits = stage.limits(name)
        if limits is None:
            continue
        if not ((one.min or 0) <= limits[0] and limits[1] <= one.max):
            detail = f"does not contain the {name} gear that stage {place // 2 + 1} gives; omit one of them"
            faults.append(Contradiction(f"/teeth/{place}", detail))
    return faults


def _fewest_at(stated: StatedTrain, place: int) -> int:
    """Return the fewest teeth that are not undercut, for a place in the list of ranges or for all."""
    if stated.stages is None:
        return stated.fewest_teeth
    rows = stated.stages[place // 2 : place // 2 + 1] if isinstance(stated.teeth, list) else stated.stages
    # A stage that gives both of its gears needs no range.
    free = [stage for stage in rows if stage.driver is None or stage.driven is None]
    return max((stage.fewest_teeth(stated.pressure_angle, ROUNDING) for stage in free), default=0)


def _wrong_fit(stated: StatedTrain) -> list[Contradiction]:
    """Check modules to choose from that are also given otherwise, and distances that do not suit the stages."""
    contradictions = []
    if stated.modules is not None:
        for name, pitch in (("module", stated.module), ("diametral_pitch", stated.diametral_pitch)):
            if pitch is not None:
                contradictions.append(Contradiction("/modules", f"omit {name}, or omit modules"))
        if len(set(stated.modules)) < len(stated.modules):
            contradictions.append(Contradiction("/modules", "lists a module twice; each is a choice"))
    if isinstance(stated.centre_distance, list):
        if stated.reverted:
            contradictions.append(
                Contradiction("/centre_distance", "a reverted train has one distance for all stages; give a number")
            )
        elif len(stated.centre_distance) != stated.most_stages:
            expected = f"expected the distances of {stated.most_stages} stages, got {len(stated.centre_distance)}"
            contradictions.append(Contradiction("/centre_distance", expected))
    return contradictions


def _too_weak(stated: StatedTrain) -> list[Contradiction]:
    """Check the required strength."""
    if stated.strength is None:
        return []
    return [Contradiction(f"/strength{path}", detail) for path, detail in stated.strength.faults()]
