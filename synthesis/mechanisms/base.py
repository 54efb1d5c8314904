"""Common functions of given mechanisms: assembly, and refusal of contradictory dimensions."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable
from itertools import chain

from kinematics.errors import DimensionError
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose
from synthesis.model.linkage.given_linkage import AGREEMENT_TOLERANCE

FIRST_ANGLE_DEGREES = 30
"""First input angle, degrees, to try for a configuration; not 0, because many linkages have a change point there, with
all links along the ground line."""


class MechanismError(ValueError):
    """Raised for a given mechanism that cannot exist; carries the path of the field within the mechanism."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


def require_agreement(
    path: str, given: float | None, measured: float, message_id: str = "mechanisms-pivots-give-other-distance"
) -> None:
    """Raise MechanismError if a redundant dimension contradicts the others, which give the value ``measured``."""
    # The tolerance is relative to the larger value, so that the order of the two does not matter.
    if given is not None and abs(given - measured) > AGREEMENT_TOLERANCE * max(abs(measured), abs(given)):
        raise MechanismError(path, compose(message_id, length=f"{measured:.9g}"))


def assemble_at_reference(
    make: Callable[[float], Mechanism], degrees: float | None, between: Iterable[float]
) -> Mechanism:
    """Assemble a mechanism at its reference angle, or at the first input angle at which this is possible.

    Parameters
    ----------
    make : callable
        Builds the mechanism at an input angle in radians, or raises DimensionError.
    degrees : float or None
        Reference input angle. If it is None, whole degrees are tried from 30° on.
    between : iterable of float
        Further angles to try, radians, in the middle of the range in which the mechanism can be assembled. That range
        may be narrower than a degree. The angles are computed only if needed.

    Raises
    ------
    MechanismError
        If the mechanism cannot be assembled.
    """
    if degrees is not None:
        try:
            return make(math.radians(degrees))
        except DimensionError:
            raise MechanismError("/reference_input_angle", compose("mechanisms-not-assembled-at-angle")) from None
    # Try whole degrees first, because they give readable results; the computed angles are the fallback.
    for angle in chain((math.radians((FIRST_ANGLE_DEGREES + step) % 360) for step in range(360)), between):
        try:
            return make(angle)
        except DimensionError:
            continue
    raise MechanismError("/links", compose("mechanisms-not-assembled-at-any-angle"))


def find_reaching_angles(crank: float, o2: complex, o4: complex, least: float, most: float) -> list[float]:
    """Find crank angles, radians, at which the distance of the crank pin from O4 is in the middle of its range.

    The range is ``least`` to ``most``, limited to distances that the crank can reach. The angles follow from the law of
    cosines in the triangle O2, A, O4. The list is empty if the crank cannot reach the range.
    """
    ground = abs(o4 - o2)
    # Intersect the distances that the crank can reach with those that the other links permit.
    low, high = max(least, abs(crank - ground)), min(most, crank + ground)
    if low > high or ground == 0.0:
        return []
    reach = 0.5 * (low + high)
    # The difference of squares is factored; otherwise rounding would dominate for nearly equal lengths.
    cosine = ((crank - reach) * (crank + reach) + ground * ground) / (2.0 * crank * ground)
    # At an end of the range, rounding may give a cosine beyond ±1.
    turn = math.acos(max(-1.0, min(1.0, cosine)))
    return [cmath.phase(o4 - o2) + turn, cmath.phase(o4 - o2) - turn]


def find_middle_sine(
    centre: float, radius: float, bound: float, least: float = -1.0, most: float = 1.0
) -> float | None:
    """Return the sine for which centre + radius · sine is in the middle of its permitted range.

    The range is −``bound`` to +``bound``, limited to sines from ``least`` to ``most``. Return None if it is empty.
    """
    low, high = max(-bound, centre + radius * least), min(bound, centre + radius * most)
    return None if low > high else max(-1.0, min(1.0, (0.5 * (low + high) - centre) / radius))
