"""What answers about gears are made of: exact ratios, pairs of gears, and the geometry of their meshes."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Self

from pydantic import Field

from kinematics.gear.flanks import Contact, ShapedRing, rack_cut_form, straight_depth
from kinematics.gear.profile import involute_start
from kinematics.gear.teeth import FULL_DEPTH_DEDENDUM, Gear, Mesh, saving_shift
from kinematics.gear.train import OrdinaryTrain
from synthesis.model.answer import Answer, optional
from synthesis.model.dimension import Angle, Length

ON_LIMIT = 1e-9
"""Share of the module or the centre distance within which a limit of teeth counts as kept: rounding, of teeth on it."""


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
    """One mesh of full-depth teeth at the distance of the pitch circles, or fitted by a profile shift."""

    stage: int
    driver: int = Field(description="Teeth; of an idler where one lies between.")
    driven: int
    centre_distance: Length
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


def tool_contact(mesh: Mesh, ring: ShapedRing | None = None, helix_angle: float = 0.0) -> Contact:
    """A mesh with the involutes that its tools leave: racks on external gears, undercut ones too, a cutter on a ring.

    ``helix_angle``: radians, of helical gears.
    """
    ends = involute_start(mesh.gear, helix_angle) if ring is None else ring.form
    return Contact(mesh, (involute_start(mesh.pinion, helix_angle), ends))


def rack_undercuts(mesh: Mesh) -> tuple[bool, bool]:
    """Whether the rack of full-depth teeth takes away from the flanks of the pinion, and of the gear."""
    depth = straight_depth(mesh.pinion.pressure_angle, FULL_DEPTH_DEDENDUM)
    one, two = (rack_cut_form(gear, depth) < -ON_LIMIT * mesh.centre_distance for gear in (mesh.pinion, mesh.gear))
    return one, two


def fitted_geometry(stage: int, driver: int, driven: int, mesh: Mesh) -> MeshGeometry:
    """Geometry of a mesh whose teeth are fitted; contact in a fillet is interference too."""
    contact, slack = tool_contact(mesh), ON_LIMIT * mesh.centre_distance
    one, two = (mesh.pinion, mesh.gear) if driver <= driven else (mesh.gear, mesh.pinion)
    sliding = contact.specific_sliding if driver <= driven else contact.specific_sliding[::-1]
    return MeshGeometry(
        stage=stage,
        driver=driver,
        driven=driven,
        centre_distance=mesh.centre_distance,
        contact_ratio=mesh.contact_ratio,
        interferes=min(*contact.margins, *contact.reaches) < -slack,
        undercut=any(rack_undercuts(mesh)),
        working_pressure_angle=math.degrees(mesh.pressure_angle),
        tip_diameter=LengthOfGears(driver=2.0 * one.tip_radius, driven=2.0 * two.tip_radius),
        tip_shortening=(1.0 - one.addendum) * one.module,
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
    return [
        fitted_geometry(number, driver, driven, mesh)
        if fitted or stage.shifts != (0.0, 0.0)
        else MeshGeometry(
            stage=number,
            driver=driver,
            driven=driven,
            centre_distance=mesh.centre_distance,
            contact_ratio=mesh.contact_ratio,
            interferes=mesh.interferes,
            undercut=mesh.pinion.is_undercut,
            suggested_shift=_suggested_shift(mesh, driver),
        )
        for number, (stage, meshes) in enumerate(zip(train.stages, train.meshes, strict=True), 1)
        for (driver, driven), mesh in zip(itertools.pairwise(stage.gears), meshes, strict=True)
    ]


def _suggested_shift(mesh: Mesh, driver: int) -> SuggestedShift | None:
    saved = saving_shift(mesh)
    if saved is None:
        return None
    shifts = saved.pinion.shift, saved.gear.shift
    first, second = shifts if driver == mesh.pinion.teeth else shifts[::-1]
    return SuggestedShift(
        driver=first, driven=second, centre_distance=saved.centre_distance, contact_ratio=saved.contact_ratio
    )
