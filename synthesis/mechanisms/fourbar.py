"""Pin-jointed fourbars given by their dimensions."""

from __future__ import annotations

from typing import Literal

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar.closed_form import Fourbar
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.catalogue import ASSEMBLY_SIGNS
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.mechanisms.base import MechanismError, assemble_at_reference, find_reaching_angles, require_agreement
from synthesis.mechanisms.skeleton import GivenByDimensions
from synthesis.model.linkage.given_linkage import Assembly, CouplerPointSpec, FixedPivotsSpec, FourbarLengths


class GivenFourbar(GivenByDimensions):
    """A pin-jointed fourbar."""

    type: Literal["fourbar"]
    fixed_pivots: FixedPivotsSpec
    links: FourbarLengths
    coupler_point: CouplerPointSpec = CouplerPointSpec(distance=0.0)
    assembly: Assembly = "open"

    def assemble(self) -> Mechanism:
        """Assemble the mechanism at its reference input angle, or at one at which this is possible."""
        o2, o4 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        require_agreement("/links/ground", self.links.ground, abs(o4 - o2))
        try:
            linkage = Fourbar(
                o2, o4, self.links.input, self.links.coupler, self.links.output, self.coupler_point.vector
            )
        except DimensionError as error:
            raise MechanismError("/fixed_pivots", str(error)) from None
        return assemble_at_reference(
            lambda angle: catalogue.make_fourbar(linkage, angle, ASSEMBLY_SIGNS[self.assembly]),
            self.reference_input_angle,
            # Coupler and output must be able to bridge the distance of the crank pin from O4.
            find_reaching_angles(
                self.links.input,
                o2,
                o4,
                abs(self.links.coupler - self.links.output),
                self.links.coupler + self.links.output,
            ),
        )
