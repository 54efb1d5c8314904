"""What answers about gears are made of: exact ratios, pairs of gears, and the geometry of their meshes."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Self

from pydantic import Field

from kinematics.gear.teeth import Mesh, saving_shift
from kinematics.gear.train import OrdinaryTrain
from synthesis.model.answer import Answer
from synthesis.model.dimension import Length


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


class SuggestedShift(Answer):
    """Profile shift, in modules, that would make a mesh sound; nothing of it is in the mechanism."""

    driver: float
    driven: float
    centre_distance: Length
    contact_ratio: float


class MeshGeometry(Answer):
    """One mesh of full-depth teeth at the distance of the pitch circles."""

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


def mesh_geometries(train: OrdinaryTrain) -> list[MeshGeometry]:
    """Geometry of every mesh, with a shift that would save it where it is not sound."""
    return [
        MeshGeometry(
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
