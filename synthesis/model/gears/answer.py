"""Parts of answers about gears: exact ratios, pairs of gears, and the geometry of their meshes."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Self

from pydantic import Field

from kinematics.gear.flanks import Contact, ShapedRing
from kinematics.gear.helical import HelicalGear
from kinematics.gear.profile import find_involute_start
from kinematics.gear.teeth import Gear, Mesh, find_saving_shift
from kinematics.gear.train import OrdinaryTrain, StageKind, TrainStage
from synthesis.model.answer import Answer, optional_field
from synthesis.model.dimension import Angle, Length
from synthesis.model.gears.mesh_limits import choose_cutter_teeth
from synthesis.model.json_object import JsonObject

LIMIT_TOLERANCE = 1e-9
"""Tolerance of a geometric limit of teeth, as a share of the module or centre distance, for teeth exactly at it."""

SHOWN_DECIMALS = 10
"""Decimals to which an angle is rounded that was given in degrees and converted to radians and back."""


class Ratio(Answer):
    """Input speed over output speed as a reduced fraction; negative if they turn in opposite directions."""

    numerator: int
    denominator: int
    value: float

    @classmethod
    def from_fraction(cls, ratio: Fraction) -> Self:
        """Return the ratio equal to an exact fraction."""
        return cls(numerator=ratio.numerator, denominator=ratio.denominator, value=float(ratio))

    @property
    def exact(self) -> Fraction:
        """The ratio as an exact fraction."""
        return Fraction(self.numerator, self.denominator)


class GearPairTeeth(Answer):
    """Teeth of a pair of gears."""

    driver: int
    driven: int


class GearNumbers(Answer):
    """A pure number of both gears of a mesh."""

    driver: float
    driven: float


class GearAngles(Answer):
    """An angle of both gears of a mesh, degrees."""

    driver: Angle
    driven: Angle


class GearLengths(Answer):
    """A length of both gears of a mesh."""

    driver: Length
    driven: Length


class SuggestedShift(Answer):
    """Profile shift, in modules, that would remove interference and undercut; the mechanism does not contain it."""

    driver: float
    driven: float
    centre_distance: Length
    contact_ratio: float


class MeshGeometry(Answer):
    """One mesh of full-depth teeth at the distance of the pitch circles, or fitted by a profile shift.

    Helical teeth are evaluated in the plane of rotation, bevel teeth as the spur gears of their back cones, a worm gear
    in its middle plane, where the worm is a rack. The teeth of a ring are shortened for its pinion.
    """

    stage: int
    driver: int = Field(description="Teeth of the driving gear, which may be an idler.")
    driven: int
    centre_distance: Length = Field(description="Distance of the shafts; 0 if they intersect.")
    contact_ratio: float
    interferes: bool = Field(description="Whether a tip digs into the flank of its mate.")
    undercut: bool = Field(description="Whether the rack that cuts the smaller gear removes part of its flanks.")
    suggested_shift: SuggestedShift | None = Field(
        default=None, description="Profile shift that would remove interference and undercut, if there is one."
    )
    working_pressure_angle: Angle | None = optional_field(
        "Working pressure angle, degrees. This field and those down to `backlash` are given for fitted teeth."
    )
    tip_diameter: GearLengths | None = optional_field()
    tip_shortening: Length | None = optional_field("Shortening of the tips of shifted gears that keeps the clearance.")
    tip_thickness: GearLengths | None = optional_field()
    specific_sliding: GearNumbers | None = optional_field(
        "Maximum ratio of sliding to rolling on each flank; negative."
    )
    backlash: Length | None = optional_field("Play on the working pitch circles.")
    type: StageKind | None = optional_field(
        "Type of the stage; this field and those that follow are left out for external spur gears."
    )
    pitch_diameter: GearLengths | None = optional_field("Pitch diameters; those of bevel gears at the large end.")
    addendum: GearNumbers | None = optional_field(
        "Addenda of an internal pair, modules; the ring's teeth are shortened for the pinion."
    )
    ring_trimmed: bool | None = optional_field(
        "Whether the default cutter trims the tips of the ring of an internal pair."
    )
    helix_angle: GearAngles | None = optional_field("Helix angles of helical gears, positive for right-handed ones.")
    transverse_module: Length | None = optional_field("Module of helical gears in the plane of rotation.")
    virtual_teeth: GearNumbers | None = optional_field(
        "Teeth of the equivalent spur gears: in the normal plane of helical gears, on the back cones of bevel gears."
    )
    overlap_ratio: float | None = optional_field(
        "Face width over axial pitch of helical teeth, if a face width is given."
    )
    total_contact_ratio: float | None = optional_field("Sum of contact ratio and overlap ratio.")
    cone_angle: GearAngles | None = optional_field("Angle between axis and pitch cone of bevel gears.")
    cone_distance: Length | None = optional_field("Distance from the apex of bevel gears to the large end.")
    lead: Length | None = optional_field("Lead of a worm.")
    lead_angle: Angle | None = optional_field("Lead angle of a worm, degrees.")
    efficiency: float | None = optional_field("Share of the power that a worm transmits, with the given friction.")
    self_locking: bool | None = optional_field("Whether the gear cannot drive the worm.")


def apply_tool_contact(mesh: Mesh, ring: ShapedRing | None = None, helix_angle: float = 0.0) -> Contact:
    """Return the contact of a mesh on the involutes that its cutting tools leave.

    An external gear, which may be undercut, is cut by a rack. A ring is shaped by a cutter, as described by ``ring``.
    ``helix_angle`` is that of helical gears, radians.
    """
    ends = find_involute_start(mesh.gear, helix_angle) if ring is None else ring.form
    return Contact(mesh, (find_involute_start(mesh.pinion, helix_angle), ends))


def is_fillet_reached(mesh: Mesh) -> bool:
    """Return whether contact extends below an involute, as cut by a rack or, for a ring, by the default cutter."""
    ring = shape_ring(mesh) if mesh.gear.internal else None
    return min(apply_tool_contact(mesh, ring).margins) < -LIMIT_TOLERANCE * mesh.centre_distance


def shape_ring(mesh: Mesh) -> ShapedRing:
    """Return the ring of a mesh as shaped by the default cutter."""
    return ShapedRing(mesh.gear, int(choose_cutter_teeth(mesh.gear.teeth)))


def describe_fitted_mesh(stage: int, driver: int, driven: int, mesh: Mesh) -> MeshGeometry:
    """Describe a mesh with fitted teeth; contact in a fillet also counts as interference."""
    contact = apply_tool_contact(mesh, helix_angle=mesh.pinion.helix_angle)
    slack = LIMIT_TOLERANCE * mesh.centre_distance
    one, two = (mesh.pinion, mesh.gear) if driver <= driven else (mesh.gear, mesh.pinion)
    sliding = contact.specific_sliding if driver <= driven else contact.specific_sliding[::-1]
    full = math.cos(mesh.pinion.helix_angle)
    return MeshGeometry(
        stage=stage,
        driver=driver,
        driven=driven,
        centre_distance=mesh.centre_distance,
        contact_ratio=mesh.contact_ratio,
        interferes=min(*contact.margins, *contact.reaches) < -slack,
        undercut=mesh.pinion.is_undercut or mesh.gear.is_undercut,
        working_pressure_angle=math.degrees(mesh.pressure_angle),
        tip_diameter=GearLengths(driver=2.0 * one.tip_radius, driven=2.0 * two.tip_radius),
        tip_shortening=(full - one.addendum) * one.module,
        tip_thickness=GearLengths(driver=_compute_tip_thickness(one), driven=_compute_tip_thickness(two)),
        specific_sliding=GearNumbers(driver=sliding[0], driven=sliding[1]),
        backlash=contact.backlash,
    )


def _compute_tip_thickness(gear: Gear) -> float:
    return gear.thickness_at(gear.tip_radius)


def describe_meshes(train: OrdinaryTrain, fitted: bool = False) -> list[MeshGeometry]:
    """Describe every mesh of a train, with a suggested shift for meshes that interfere or are undercut.

    Shifted stages, and all stages if the teeth are ``fitted``, are described in more detail and without a suggestion.
    """
    found = []
    for number, (stage, meshes) in enumerate(zip(train.stages, train.meshes, strict=True), 1):
        if stage.kind == "worm":
            found.append(_describe_worm_mesh(number, stage, train.pressure_angle))
            continue
        # Rings and bevel gears are never fitted, because their pitch circles or cones determine their positions.
        shifted = stage.kind not in ("internal", "bevel") and (fitted or stage.shifts != (0.0, 0.0))
        for (driver, driven), mesh in zip(itertools.pairwise(stage.gears), meshes, strict=True):
            if shifted:
                geometry = describe_fitted_mesh(number, driver, driven, mesh)
            else:
                geometry = _describe_standard_mesh(number, driver, driven, mesh, math.cos(stage.helix_angle))
            found.append(geometry.model_copy(update=_describe_stage_type(stage, mesh, train.pressure_angle)))
    return found


def _describe_standard_mesh(stage: int, driver: int, driven: int, mesh: Mesh, shrunk: float) -> MeshGeometry:
    """Describe a mesh without profile shift; ``shrunk`` is the normal module over that of the plane of rotation."""
    return MeshGeometry(
        stage=stage,
        driver=driver,
        driven=driven,
        centre_distance=mesh.centre_distance,
        contact_ratio=mesh.contact_ratio,
        interferes=mesh.interferes,
        undercut=mesh.pinion.is_undercut,
        suggested_shift=_suggest_shift(mesh, driver <= driven, shrunk),
    )


def _describe_stage_type(stage: TrainStage, mesh: Mesh, pressure_angle: float) -> JsonObject:
    """Return the fields of a mesh that differ from those of external spur gears, or that external spur gears lack."""
    if stage.kind == "external":
        return {}
    block: JsonObject = {"type": stage.kind}
    if stage.kind == "bevel":
        pair = stage.cones(pressure_angle)
        radii, cones, virtual = pair.pitch_radii, pair.cones, pair.virtual_teeth
        return block | {
            "centre_distance": 0.0,
            "suggested_shift": None,
            "pitch_diameter": GearLengths(driver=2.0 * radii[0], driven=2.0 * radii[1]),
            "cone_angle": GearAngles(driver=math.degrees(cones[0]), driven=math.degrees(cones[1])),
            "cone_distance": pair.cone_distance,
            "virtual_teeth": GearNumbers(driver=virtual[0], driven=virtual[1]),
        }
    one, two = stage.cut_gears(pressure_angle)
    block["pitch_diameter"] = GearLengths(driver=2.0 * one.pitch_radius, driven=2.0 * two.pitch_radius)
    if stage.kind == "internal":
        block["addendum"] = GearNumbers(driver=one.addendum, driven=two.addendum)
        block["interferes"] = mesh.interferes or is_fillet_reached(mesh)
        block["ring_trimmed"] = shape_ring(mesh).is_trimmed
        return block
    gear = HelicalGear(stage.driver, stage.module, stage.helix_angle, pressure_angle)
    angle, shrunk = round(math.degrees(stage.helix_angle), SHOWN_DECIMALS), math.cos(stage.helix_angle) ** 3
    block |= {
        "helix_angle": GearAngles(driver=angle, driven=-angle),
        "transverse_module": gear.transverse_module,
        "virtual_teeth": GearNumbers(driver=stage.driver / shrunk, driven=stage.driven / shrunk),
    }
    if stage.face_width is not None:
        overlap = stage.face_width / gear.axial_pitch
        block |= {"overlap_ratio": overlap, "total_contact_ratio": mesh.contact_ratio + overlap}
    return block


def _describe_worm_mesh(number: int, stage: TrainStage, pressure_angle: float) -> MeshGeometry:
    """Describe a worm and its gear in the middle plane, where the worm is identical to the rack that cuts the gear."""
    worm = stage.worm(pressure_angle)
    pair = worm.dimensions
    return MeshGeometry(
        stage=number,
        driver=stage.driver,
        driven=stage.driven,
        centre_distance=worm.centre_distance,
        contact_ratio=worm.contact_ratio,
        interferes=not worm.is_free_of_interference,
        undercut=worm.gear.is_undercut,
        type="worm",
        pitch_diameter=GearLengths(driver=pair.worm_diameter, driven=pair.gear_diameter),
        lead=pair.lead,
        lead_angle=math.degrees(pair.lead_angle),
        efficiency=worm.efficiency(stage.friction),
        self_locking=worm.is_locking(stage.friction),
    )


def _suggest_shift(mesh: Mesh, pinion_drives: bool, shrunk: float) -> SuggestedShift | None:
    saved = find_saving_shift(mesh)
    if saved is None:
        return None
    shifts = saved.pinion.shift / shrunk, saved.gear.shift / shrunk
    first, second = shifts if pinion_drives else shifts[::-1]
    return SuggestedShift(
        driver=first, driven=second, centre_distance=saved.centre_distance, contact_ratio=saved.contact_ratio
    )
