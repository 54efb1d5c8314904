"""What answers about gears are made of: exact ratios, pairs of gears, and the geometry of their meshes."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any, NamedTuple, Self

from pydantic import Field

from kinematics.gear.flanks import Contact, ShapedRing, rack_cut_form, straight_depth
from kinematics.gear.helical import HelicalGear
from kinematics.gear.profile import involute_start
from kinematics.gear.teeth import FULL_DEPTH_DEDENDUM, Gear, Mesh, saving_shift
from kinematics.gear.train import OrdinaryTrain, StageKind, TrainStage
from synthesis.model.answer import Answer, optional
from synthesis.model.dimension import Angle, Length
from synthesis.model.mesh_limits import usual_cutter

ON_LIMIT = 1e-9
"""Share of the module or the centre distance within which a limit of teeth counts as kept: rounding, of teeth on it."""

SHOWN = 10
"""Decimals of an angle that was stated in degrees, after it has been radians."""


class Ratio(Answer):
    """Input speed over output speed as a reduced fraction; negative where they turn in opposite directions."""

    numerator: int
    denominator: int
    value: float

    @classmethod
    def of(cls, ratio: Fraction) -> Self:
        """The ratio of exact speeds."""
        return cls(numerator=ratio.numerator, denominator=ratio.denominator, value=float(ratio))

    @property
    def exact(self) -> Fraction:
        """The fraction that is stated."""
        return Fraction(self.numerator, self.denominator)


class GearPairTeeth(Answer):
    """Teeth of a pair of gears."""

    driver: int
    driven: int


class OfGears(Answer):
    """A pure number of both gears of a mesh."""

    driver: float
    driven: float


class AngleOfGears(Answer):
    """An angle of both gears of a mesh, degrees."""

    driver: Angle
    driven: Angle


class LengthOfGears(Answer):
    """A length of both gears of a mesh."""

    driver: Length
    driven: Length


class SuggestedShift(Answer):
    """Profile shift, in modules, that would make a mesh sound; nothing of it is in the mechanism."""

    driver: float
    driven: float
    centre_distance: Length
    contact_ratio: float


class MeshGeometry(Answer):
    """One mesh of full-depth teeth at the distance of the pitch circles, or fitted by a profile shift.

    Helical teeth are looked at in the plane of rotation, bevel teeth as the spur gears of their back cones, a worm gear
    in its middle plane, where the worm is a rack. A ring's teeth are shortened for its pinion.
    """

    stage: int
    driver: int = Field(description="Teeth; of an idler where one lies between.")
    driven: int
    centre_distance: Length = Field(description="Of the shafts; 0 where they meet.")
    contact_ratio: float
    interferes: bool = Field(description="Whether a tip digs into the flank of this very mate.")
    undercut: bool = Field(description="Whether a rack that cuts the smaller gear takes away from its flanks.")
    suggested_shift: SuggestedShift | None = Field(
        default=None, description="Where the mesh interferes or is undercut and a profile shift would save it."
    )
    working_pressure_angle: Angle | None = optional("Degrees; from here on where teeth are fitted.")
    tip_diameter: LengthOfGears | None = optional()
    tip_shortening: Length | None = optional("What the tips of shifted gears lose so that the clearance stays.")
    tip_thickness: LengthOfGears | None = optional()
    specific_sliding: OfGears | None = optional("Sliding over rolling where it is greatest on each flank; negative.")
    backlash: Length | None = optional("Play on the working pitch circles.")
    type: StageKind | None = optional("Of the stage, where it is not one of external spur gears; so is what follows.")
    pitch_diameter: LengthOfGears | None = optional("Of bevel gears at the large end.")
    addendum: OfGears | None = optional("Of an internal pair, modules: the ring's teeth are shortened for the pinion.")
    ring_trimmed: bool | None = optional("Of an internal pair: whether the usual cutter takes off tips of the ring.")
    helix_angle: AngleOfGears | None = optional("Of helical gears, positive for right-handed ones.")
    transverse_module: Length | None = optional("Of helical gears, in the plane of rotation.")
    virtual_teeth: OfGears | None = optional("Of spur gears with the same teeth: in the normal plane, on back cones.")
    overlap_ratio: float | None = optional("Face width over axial pitch of helical teeth, where a width is stated.")
    total_contact_ratio: float | None = optional("Contact ratio and overlap together.")
    cone_angle: AngleOfGears | None = optional("Between axis and pitch cone of bevel gears.")
    cone_distance: Length | None = optional("From the apex of bevel gears to the large end.")
    lead: Length | None = optional("Of a worm.")
    lead_angle: Angle | None = optional("Of a worm, degrees.")
    efficiency: float | None = optional("Share of the power that a worm passes on, with the stated friction.")
    self_locking: bool | None = optional("Whether the gear cannot drive the worm.")


def tool_contact(mesh: Mesh, ring: ShapedRing | None = None, helix_angle: float = 0.0) -> Contact:
    """A mesh with the involutes that its tools leave: racks on external gears, undercut ones too, a cutter on a ring.

    ``helix_angle``: radians, of helical gears.
    """
    ends = involute_start(mesh.gear, helix_angle) if ring is None else ring.form
    return Contact(mesh, (involute_start(mesh.pinion, helix_angle), ends))


class Helix(NamedTuple):
    """The pressure angle of the normal plane, and the helix angle; radians."""

    pressure_angle: float
    helix_angle: float


def rack_undercuts(mesh: Mesh, helix: Helix | None = None) -> tuple[bool, bool]:
    """Whether the rack of full-depth teeth takes away from the flanks of the pinion, and of the gear."""
    angle = mesh.pinion.pressure_angle if helix is None else helix.pressure_angle
    depth = rack_depth(angle, 0.0 if helix is None else helix.helix_angle)
    one, two = (rack_cut_form(gear, depth) < -ON_LIMIT * mesh.centre_distance for gear in (mesh.pinion, mesh.gear))
    return one, two


def reaches_fillet(mesh: Mesh) -> bool:
    """Whether contact goes below an involute: of gears as a rack cuts them, of a ring as the usual cutter shapes it."""
    ring = shaped_ring(mesh) if mesh.gear.internal else None
    return min(tool_contact(mesh, ring).margins) < -ON_LIMIT * mesh.centre_distance


def shaped_ring(mesh: Mesh) -> ShapedRing:
    """The ring of a mesh with the usual cutter."""
    return ShapedRing(mesh.gear, int(usual_cutter(mesh.gear.teeth)))


def rack_depth(pressure_angle: float, helix_angle: float = 0.0) -> float:
    """How far the straight flank of the rack of full-depth teeth reaches below its reference line, modules.

    Radians; of helical teeth ``pressure_angle`` is that of the normal plane, and so is the rack, and the modules are
    those of the plane of rotation.
    """
    return straight_depth(pressure_angle, FULL_DEPTH_DEDENDUM) * math.cos(helix_angle)


def fitted_geometry(stage: int, driver: int, driven: int, mesh: Mesh, helix: Helix | None = None) -> MeshGeometry:
    """Geometry of a mesh whose teeth are fitted; contact in a fillet is interference too."""
    contact = tool_contact(mesh, helix_angle=0.0 if helix is None else helix.helix_angle)
    slack = ON_LIMIT * mesh.centre_distance
    one, two = (mesh.pinion, mesh.gear) if driver <= driven else (mesh.gear, mesh.pinion)
    sliding = contact.specific_sliding if driver <= driven else contact.specific_sliding[::-1]
    full = 1.0 if helix is None else math.cos(helix.helix_angle)
    return MeshGeometry(
        stage=stage,
        driver=driver,
        driven=driven,
        centre_distance=mesh.centre_distance,
        contact_ratio=mesh.contact_ratio,
        interferes=min(*contact.margins, *contact.reaches) < -slack,
        undercut=any(rack_undercuts(mesh, helix)),
        working_pressure_angle=math.degrees(mesh.pressure_angle),
        tip_diameter=LengthOfGears(driver=2.0 * one.tip_radius, driven=2.0 * two.tip_radius),
        tip_shortening=(full - one.addendum) * one.module,
        tip_thickness=LengthOfGears(driver=_tip_thickness(one), driven=_tip_thickness(two)),
        specific_sliding=OfGears(driver=sliding[0], driven=sliding[1]),
        backlash=contact.backlash,
    )


def _tip_thickness(gear: Gear) -> float:
    return gear.thickness_at(gear.tip_radius)


def mesh_geometries(train: OrdinaryTrain, fitted: bool = False) -> list[MeshGeometry]:
    """Geometry of every mesh, with a shift that would save it where it is not sound.

    Of shifted stages, and of all where teeth are ``fitted``, more is told, and no shift is suggested.
    """
    found = []
    for number, (stage, meshes) in enumerate(zip(train.stages, train.meshes, strict=True), 1):
        if stage.kind == "worm":
            found.append(_worm_geometry(number, stage, train.pressure_angle))
            continue
        # Rings and bevel gears are never fitted: they stand as their pitch circles and cones do.
        shifted = stage.kind not in ("internal", "bevel") and (fitted or stage.shifts != (0.0, 0.0))
        for (driver, driven), mesh in zip(itertools.pairwise(stage.gears), meshes, strict=True):
            if shifted:
                helix = Helix(train.pressure_angle, stage.helix_angle) if stage.kind == "helical" else None
                geometry = fitted_geometry(number, driver, driven, mesh, helix)
            else:
                geometry = _standard_geometry(number, driver, driven, mesh, math.cos(stage.helix_angle))
            found.append(geometry.model_copy(update=_of_type(stage, mesh, train.pressure_angle)))
    return found


def _standard_geometry(stage: int, driver: int, driven: int, mesh: Mesh, shrunk: float) -> MeshGeometry:
    """A mesh without shift; ``shrunk`` are normal modules in modules of the plane of rotation."""
    return MeshGeometry(
        stage=stage,
        driver=driver,
        driven=driven,
        centre_distance=mesh.centre_distance,
        contact_ratio=mesh.contact_ratio,
        interferes=mesh.interferes,
        undercut=mesh.pinion.is_undercut,
        suggested_shift=_suggested_shift(mesh, driver <= driven, shrunk),
    )


def _of_type(stage: TrainStage, mesh: Mesh, pressure_angle: float) -> dict[str, Any]:
    """What is told of stages that are not of external spur gears, and where it is another than of those."""
    if stage.kind == "external":
        return {}
    told: dict[str, Any] = {"type": stage.kind}
    if stage.kind == "bevel":
        pair = stage.cones(pressure_angle)
        radii, cones, virtual = pair.pitch_radii, pair.cones, pair.virtual_teeth
        return told | {
            "centre_distance": 0.0,
            "suggested_shift": None,
            "pitch_diameter": LengthOfGears(driver=2.0 * radii[0], driven=2.0 * radii[1]),
            "cone_angle": AngleOfGears(driver=math.degrees(cones[0]), driven=math.degrees(cones[1])),
            "cone_distance": pair.cone_distance,
            "virtual_teeth": OfGears(driver=virtual[0], driven=virtual[1]),
        }
    one, two = stage.cut_gears(pressure_angle)
    told["pitch_diameter"] = LengthOfGears(driver=2.0 * one.pitch_radius, driven=2.0 * two.pitch_radius)
    if stage.kind == "internal":
        told["addendum"] = OfGears(driver=one.addendum, driven=two.addendum)
        told["interferes"] = mesh.interferes or reaches_fillet(mesh)
        told["ring_trimmed"] = shaped_ring(mesh).is_trimmed
        return told
    gear = HelicalGear(stage.driver, stage.module, stage.helix_angle, pressure_angle)
    angle, shrunk = round(math.degrees(stage.helix_angle), SHOWN), math.cos(stage.helix_angle) ** 3
    told |= {
        "helix_angle": AngleOfGears(driver=angle, driven=-angle),
        "transverse_module": gear.transverse_module,
        "virtual_teeth": OfGears(driver=stage.driver / shrunk, driven=stage.driven / shrunk),
    }
    if stage.face_width is not None:
        overlap = stage.face_width / gear.axial_pitch
        told |= {"overlap_ratio": overlap, "total_contact_ratio": mesh.contact_ratio + overlap}
    return told


def _worm_geometry(number: int, stage: TrainStage, pressure_angle: float) -> MeshGeometry:
    """A worm and its gear in the middle plane: a rack that cuts the gear is what meshes with it."""
    worm = stage.worm(pressure_angle)
    pair, undercut = worm.dimensions, worm.gear.is_undercut
    return MeshGeometry(
        stage=number,
        driver=stage.driver,
        driven=stage.driven,
        centre_distance=worm.centre_distance,
        contact_ratio=worm.contact_ratio,
        interferes=undercut,
        undercut=undercut,
        type="worm",
        pitch_diameter=LengthOfGears(driver=pair.worm_diameter, driven=pair.gear_diameter),
        lead=pair.lead,
        lead_angle=math.degrees(pair.lead_angle),
        efficiency=worm.efficiency(stage.friction),
        self_locking=worm.is_locking(stage.friction),
    )


def _suggested_shift(mesh: Mesh, pinion_drives: bool, shrunk: float) -> SuggestedShift | None:
    saved = saving_shift(mesh)
    if saved is None:
        return None
    shifts = saved.pinion.shift / shrunk, saved.gear.shift / shrunk
    first, second = shifts if pinion_drives else shifts[::-1]
    return SuggestedShift(
        driver=first, driven=second, centre_distance=saved.centre_distance, contact_ratio=saved.contact_ratio
    )
