"""Cognates of a fourbar: other linkages whose coupler point traces the same curve.

With the complex link vectors u = A − O2, v = B − A, w = B − O4, g = O4 − O2 the loop is u + v = g + w, and the coupler
point is P = A + ζ v with ζ = (P in the coupler's frame)/b. The theorem of Roberts and Chebyshev
(S. Roberts, Proc. London Math. Soc. 7 (1875) 14, doi:10.1112/plms/s1-7.1.14; Norton, Sec. 3.7) is the loop multiplied
by ζ and by 1 − ζ. The third fixed pivot, which completes a ground triangle similar to the coupler triangle, is

    OC = O2 + ζ g.

*Left* cognate, on O2 and OC. From O2 the vectors ζ v, then ζ u, end at OC + ζ w. Its coupler, ζ u, carries
O2 + ζ v + u = P: the coupler point is the coupler divided by ζ.

*Right* cognate, on OC and O4. From OC the vectors (1 − ζ) u, then −(1 − ζ) w, end at O4 − (1 − ζ) v. Its coupler
carries OC + (1 − ζ) u + ζ w = P.

Every link of a cognate therefore turns with one link of the source, at a constant angle from it. A proper triangle is
not required: with P on the line A B (Cayley's diagram flattened) ζ is real and the formulas still hold. With P at a
moving pivot the curve is a circle or an arc, ζ or 1 − ζ vanishes, and there is no cognate.

*Geared fivebar* (Norton, Fig. 3-28). The left cognate's link ζ v at O2 and the right one's −(1 − ζ) v at O4 both turn
with the source's coupler, and therefore with each other; u and w, from their ends, meet in P.

*Parallel motion* (Norton, Example 3-11). The right cognate moved by O2 − OC has its input (1 − ζ) u on O2, in one piece
with u, and its coupler point at Q = P + O2 − OC. A link P Q, which does not turn, takes the place of its output link.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Mask, Real
from kinematics.linkage.fourbar.closed_form import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    positions,
    require,
    with_angle_axis,
)

Link = Literal["input", "coupler", "output"]

PIVOT_TOLERANCE = 1e-9
"""Share of the coupler within which P counts as at A or B: the cognate would shrink to this share of the source while
its coupler point keeps its distance, and nine digits would be lost."""


class Configuration(NamedTuple):
    """Input angle (radians in (−π, π]) and assembly sign over designs × input angles of the source.

    Where ``valid`` is False the angle is NaN and the assembly +1.
    """

    valid: Mask
    input_angle: Real
    assembly: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Cognate:
    """A fourbar that traces the curve of another.

    Parameters
    ----------
    linkage : Fourbar
        The cognate, designs as in the source.
    source : Fourbar
        The original linkage.
    turns_with : tuple of str
        Links of the source with which the cognate's input, coupler and output turn.
    offset : float
        Angles of the cognate's input, coupler and output from those links of the source, radians in (−π, π],
        shape designs + (3,).
    """

    linkage: Fourbar
    source: Fourbar
    turns_with: tuple[Link, Link, Link]
    offset: Real

    def configuration(self, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> Configuration:
        """Return the cognate's configuration while the source is at ``input_angle`` in ``assembly``.

        The parameters and errors are those of :func:`kinematics.linkage.positions`, for the source. The cognate's
        assembly changes where its own input passes a toggle. Since the coupler of a parallelogram only translates, a
        cognate's link that turns with it does not move and cannot drive.
        """
        at = positions(self.source, input_angle, assembly)
        theta, axis = with_angle_axis(self.source, input_angle, np.shape(assembly))
        vector: dict[Link, Complex] = {
            "input": np.broadcast_to(self.source.input[axis] * np.exp(1j * theta), at.b.shape),
            "coupler": at.b - at.a,
            "output": at.b - self.source.output_pivot[axis],
        }
        own_input, own_coupler, own_output = (
            vector[link] * np.exp(1j * self.offset[..., k][axis]) for k, link in enumerate(self.turns_with)
        )
        # The side of the output relative to the coupler decides the assembly.
        side = own_coupler.real * own_output.imag - own_coupler.imag * own_output.real
        angle = np.where(at.valid, np.angle(own_input), np.nan)
        return Configuration(at.valid, angle, np.where(side < 0.0, CROSSED_ASSEMBLY, OPEN_ASSEMBLY))


class Cognates(NamedTuple):
    """Both cognates: ``left`` on O2 (its input) and OC, ``right`` on OC (its input) and O4.

    The right one's input turns with the source's input, and it is always in the other assembly; a crank stays a crank
    and the transmission angle is the same (Norton, Sec. 3.7). The left one's input turns with the source's coupler.
    """

    left: Cognate
    right: Cognate


@dataclass(frozen=True, eq=False)
class GearedFivebarCognate:
    """A geared fivebar that traces the curve of a fourbar; fields of shape designs, angles in radians.

    The input link and coupler 1 start from ``input_pivot``, the output link and coupler 2 from ``output_pivot``. The
    couplers are pinned together at the coupler point, which is ``coupler_point`` in the frame of coupler 1 (origin at
    the input link's pin, real axis along the coupler). The output turns ``gear_ratio`` times as far as the input, and
    ``phase`` is its angle from the ground line when the input lies along that line. The input's angle is that of the
    source's coupler plus ``input_offset``.
    """

    input_pivot: Complex
    output_pivot: Complex
    input: Real
    coupler_1: Real
    coupler_2: Real
    output: Real
    coupler_point: Complex
    gear_ratio: Real
    phase: Real
    input_offset: Real


@dataclass(frozen=True, eq=False)
class ParallelMotion:
    """A Watt I sixbar whose link P Q keeps its direction while both its ends trace the coupler curve.

    The fourbar ``linkage`` with a pin C added to its input link, a link C Q and the link P Q. ``crank_point`` is C in
    the input link's frame (origin at O2, real axis towards A), ``guide`` the length of C Q, and ``translation`` the
    vector from P to Q, which is constant. Shapes: designs.
    """

    linkage: Fourbar
    crank_point: Complex
    guide: Real
    translation: Complex


def build_cognates(linkage: Fourbar) -> Cognates:
    """Build both Roberts–Chebyshev cognates (Norton, Sec. 3.7, Figs. 3-24 to 3-26).

    Raises
    ------
    DimensionError
        For a coupler point at A or B, which has no cognates.

    Examples
    --------
    Those of Chebyshev's straight-line linkage are Hoeken's, 2 : 1 : 2.5 : 2.5 (Norton, Fig. 3-29):

    >>> pair = build_cognates(Fourbar.from_lengths(2.5, 1.0, 2.5, 2.0, 0.5))
    >>> pair.left.linkage.lengths
    array([1.  , 0.5 , 1.25, 1.25])
    """
    zeta, rest = _compute_ratios(linkage)
    pivot = linkage.input_pivot + zeta * (linkage.output_pivot - linkage.input_pivot)
    a, b, c = linkage.input, linkage.coupler, linkage.output
    # Lengths scale by the moduli, angles by the arguments.
    stretch, shrink = np.abs(zeta), np.abs(rest)
    left = Fourbar(linkage.input_pivot, pivot, stretch * b, stretch * a, stretch * c, a * stretch / zeta)
    right = Fourbar(pivot, linkage.output_pivot, shrink * a, shrink * c, shrink * b, -c * zeta * shrink / rest)
    turn, other = np.angle(zeta), np.angle(rest)
    return Cognates(
        Cognate(left, linkage, ("coupler", "input", "output"), _wrap_angle(np.stack((turn, turn, turn), axis=-1))),
        Cognate(
            right,
            linkage,
            ("input", "output", "coupler"),
            _wrap_angle(np.stack((other, other + np.pi, other + np.pi), axis=-1)),
        ),
    )


def build_geared_fivebar_cognate(linkage: Fourbar) -> GearedFivebarCognate:
    """Build the geared fivebar on O2 and O4 that traces the same curve (Norton, Sec. 3.7 and Fig. 3-28).

    Its links are AP, a, c and BP, its gear ratio is +1. The geared fivebars on the other two pairs of pivots are those
    of the cognates.

    Raises
    ------
    DimensionError
        For a coupler point at A or B.
    """
    zeta, rest = _compute_ratios(linkage)
    return GearedFivebarCognate(
        linkage.input_pivot,
        linkage.output_pivot,
        np.abs(zeta) * linkage.coupler,
        linkage.input,
        linkage.output,
        np.abs(rest) * linkage.coupler,
        linkage.input.astype(np.complex128),
        np.ones_like(linkage.input),
        _wrap_angle(np.angle(-rest / zeta)),
        _wrap_angle(np.angle(zeta)),
    )


def build_parallel_motion(linkage: Fourbar) -> ParallelMotion:
    """Build the Watt I sixbar that moves a link along the coupler curve without rotation (Norton, Example 3-11).

    Raises
    ------
    DimensionError
        For a coupler point at A or B.
    """
    zeta, rest = _compute_ratios(linkage)
    return ParallelMotion(
        linkage,
        rest * linkage.input,
        np.abs(zeta) * linkage.output,
        zeta * (linkage.input_pivot - linkage.output_pivot),
    )


def _compute_ratios(linkage: Fourbar) -> tuple[Complex, Complex]:
    """Compute ζ and 1 − ζ; neither may be zero."""
    zeta = linkage.coupler_point / linkage.coupler
    # Not 1 − ζ, which would cancel for P near B.
    rest = (linkage.coupler - linkage.coupler_point) / linkage.coupler
    apart = np.minimum(np.abs(zeta), np.abs(rest)) > PIVOT_TOLERANCE
    require("coupler_point", "kinematics-away-from-moving-pivots", linkage.coupler_point, apart)
    return zeta, rest


def _wrap_angle(angle: Real) -> Real:
    """Wrap an angle to (−π, π]."""
    return np.asarray(np.pi - np.mod(np.pi - angle, 2.0 * np.pi))
