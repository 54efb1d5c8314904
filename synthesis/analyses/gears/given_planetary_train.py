"""Models of a given planetary train: a known arrangement with its teeth, or a list of meshes."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from kinematics.gear.arrangements import ARRANGEMENTS
from kinematics.gear.planetary import EXTERNAL, INTERNAL, Mesh, Train, compute_speed_ratio
from kinematics.message import compose
from synthesis.analyses.gears.given_train import GivenRatio
from synthesis.model.problem import Flag, PositiveNumber, Statement

MAX_MESHES = 8
"""Maximum number of meshes. The directions of power are tried in all combinations: at most 2⁸, in half a second."""

ToothCount = Annotated[int, Field(strict=True, ge=1, le=10_000)]
Body = Annotated[str, Field(min_length=1, max_length=40)]


class GivenMesh(Statement):
    """Two gears in mesh: their bodies, the carrier of their axes (``ground`` where it stands still), their teeth."""

    first: Body
    second: Body
    carrier: Body
    first_teeth: ToothCount
    second_teeth: ToothCount
    internal: Flag = Field(
        default=False,
        description="Whether one gear has internal teeth or is the far side gear of a bevel differential.",
    )


class GivenPlanetaryTrain(Statement):
    """An arrangement with teeth, or custom meshes. Other fields of a design are accepted, too."""

    type: Literal["planetary_train"]
    arrangement: str | None = None
    teeth: dict[str, ToothCount] | None = None
    meshes: list[GivenMesh] | None = Field(default=None, min_length=1, max_length=MAX_MESHES)
    planet_bodies: list[Body] = Field(
        default=[], max_length=24, description="Bodies that rotate freely; only with `meshes`."
    )
    input: Body | None = None
    output: Body | None = None
    fixed: Body | None = None
    planets: object = None
    places: object = None
    module: object = None
    pressure_angle: object = None
    addendum: object = None
    face_widths: list[PositiveNumber | None] | None = Field(
        default=None, max_length=8, description="Face width of each plane, as in a design, for `strength`."
    )
    ratio: GivenRatio | None = Field(
        default=None,
        description="Ratio, as in a design; compared with that of the teeth if all three members are given.",
    )

    def build_train(self) -> Train:
        """Build the speed equations of a valid mechanism."""
        if self.meshes is None:
            assert self.arrangement is not None
            assert self.teeth is not None
            return ARRANGEMENTS[self.arrangement].build_train(self.teeth)
        rows = [
            Mesh(
                row.first,
                row.second,
                row.carrier,
                row.first_teeth,
                row.second_teeth,
                INTERNAL if row.internal else EXTERNAL,
            )
            for row in self.meshes
        ]
        return Train(tuple(rows), frozenset(self.planet_bodies))

    def compute_ratio(self) -> Fraction | None:
        """Compute the ratio of input speed to output speed, with the fixed member at rest.

        Return None if one of the three members is not given, or if the ratio is undetermined.
        """
        if self.input is None or self.output is None or self.fixed is None:
            return None
        return compute_speed_ratio(self.build_train(), self.input, self.output, [self.fixed])

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        if self.meshes is not None:
            if self.arrangement is not None or self.teeth is not None:
                return [("/mechanism/meshes", compose("analyses-arrangement-and-meshes"))]
            return [
                (f"/mechanism/meshes/{k}", compose("analyses-mesh-of-equal-bodies"))
                for k, row in enumerate(self.meshes)
                if len({row.first, row.second, row.carrier}) < 3
            ]
        if self.arrangement not in ARRANGEMENTS:
            return [("/mechanism/arrangement", compose("analyses-arrangement-unknown", names=", ".join(ARRANGEMENTS)))]
        names = ARRANGEMENTS[self.arrangement].gear_names
        if set(self.teeth or {}) != set(names):
            return [("/mechanism/teeth", compose("analyses-teeth-of-other-gears", names=", ".join(names)))]
        return []
