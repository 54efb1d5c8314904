"""Motion of a mechanism with redundant constraints: nearby positions are corrected to satisfy all constraints.

At the change point of a parallelogram its dyad alone could continue either way; the third crank allows only one. So if
the dyads close in the reference's assembly but violate a constraint, the other assemblies are tried.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Mask, Real, Scalar
from kinematics.linkage.planar.constraints import MAX_MISFIT, MIN_SINGULAR_VALUE, Poses
from kinematics.linkage.planar.mechanism import Mechanism

NEAR_MISFIT = 1e-2
"""Misfit of the constraints, as a share of the size, up to which a position is a valid start: at a change point a dyad
of rounded dimensions has an error of the root of the rounding."""

EXACT_MISFIT = 1e-12
"""Misfit of dimensions that agree to rounding: such a position needs no comparison with others."""

DISTINCT_TOLERANCE = 1e-6
"""Difference of two poses, as a share of the size or in radians, above which they are distinct."""

CLEAR_RATIO = 1e-3
"""Ratio of misfits below which the better of two poses is accepted as the true one, if both satisfy the constraints of
rounded dimensions, as near a change point. Otherwise the position is undetermined."""

Start = tuple[dict[str, Complex], dict[str, Real]]
"""Joints and angles by name, each of shape (1,) + S + (N,)."""


class SettledMotion(NamedTuple):
    """Motion over designs × inputs as in :class:`~kinematics.linkage.planar.drive.MechanismMotion`."""

    valid: NDArray[np.bool_]
    smooth: NDArray[np.bool_]
    angles: dict[str, Real]
    joints: dict[str, Complex]
    slides: dict[str, Real]


def _mask_unsettled(poses: Poses, best: Real, rival: Real, least: Real) -> tuple[Mask, Mask]:
    """Clear positions and rates that are not unique; return where positions and where rates are known.

    Parameters
    ----------
    best, rival : float, shape (N,)
        Smallest misfit, and that of another pose.
    least : float, shape (N,)
        Smallest singular value of the constraints.
    """
    valid = (best <= MAX_MISFIT) & ((rival > MAX_MISFIT) | (best <= np.maximum(CLEAR_RATIO * rival, EXACT_MISFIT)))
    for jet in poses:
        jet[:, :, ~valid] = np.nan
    # Rates are undefined where the input does not determine them.
    smooth = valid & (least > MIN_SINGULAR_VALUE)
    for jet in poses:
        jet[1:, :, ~smooth] = np.nan
    return np.asarray(valid), np.asarray(smooth)


def settle(
    mechanism: Mechanism, own: NDArray[np.int64], inputs: Real, starts: Iterable[Start], reference: Real
) -> SettledMotion:
    """Solve for positions and rates that satisfy all constraints.

    Parameters
    ----------
    own : int, shape (D,)
        The design of each row of inputs.
    inputs : float, shape (n,) + S + (N,) with D rows of N
        Absolute inputs and their rates.
    starts : iterable of Start
        Nearby positions, those of the reference's assembly first; NaN without a position.
    reference : float, shape (M,)
        The designs' inputs in the reference.
    """
    length, *shape = inputs.shape
    each = np.repeat(own, shape[-1])

    def expand_designs(values: NDArray[Scalar]) -> NDArray[Scalar]:
        return np.asarray(np.broadcast_to(values, mechanism.shape).ravel()[each])

    origin, size = expand_designs(mechanism.frame[0]), expand_designs(mechanism.frame[1])
    constraints = mechanism.constraints(each)
    turned = {link: expand_designs(mechanism.link_angle(link)) for link in constraints.links}
    moved = inputs.reshape(length, -1).copy()
    moved[0] -= reference[each]
    if mechanism.has_slide_input:
        moved /= size
        moved[0] += constraints.get_input(constraints.reference)[0]
    poses = Poses.unknown(length, len(constraints.links), len(each))
    closed = None
    best, rival, least = np.full(len(each), np.inf), np.full(len(each), np.inf), np.full(len(each), np.nan)
    for joints, angles in starts:
        near = Poses(
            np.stack([(joints[base].ravel() - origin) / size for base in constraints.bases])[None],
            np.stack([angles[link].ravel() - turned[link] for link in constraints.links])[None],
        )
        misfit = constraints.misfit(near, moved[:1])
        # The reference's assembly decides whether a position exists at all.
        closed = np.isfinite(misfit) if closed is None else closed
        left = np.flatnonzero((best > EXACT_MISFIT) & closed & (misfit <= NEAR_MISFIT))
        if not len(left):
            continue
        found, misfit, smallest = mechanism.constraints(each[left]).settle(near.take(left), moved[:, left])
        met = misfit <= MAX_MISFIT
        at, found, misfit, smallest = left[met], found.take(met), misfit[met], smallest[met]
        nearer = misfit < best[at]
        # A distinct pose is a rival; the same pose again is not.
        other = poses.measure_distance(at, found) > DISTINCT_TOLERANCE
        rival[at[other]] = np.minimum(rival[at], np.maximum(misfit, best[at]))[other]
        poses.store(at[nearer], found.take(nearer))
        best[at], least[at[nearer]] = np.minimum(misfit, best[at]), smallest[nearer]
        if (best <= EXACT_MISFIT).all():
            break
    valid, smooth = _mask_unsettled(poses, best, rival, least)

    def reshape_jet(jet: NDArray[Scalar], unit: Real, zero: NDArray[Scalar]) -> NDArray[Scalar]:
        scaled: NDArray[Scalar] = np.multiply(jet, unit)
        scaled[0] += zero
        return scaled.reshape(length, *shape)

    one, none = np.ones(()), np.zeros(())
    return SettledMotion(
        valid.reshape(shape),
        smooth.reshape(shape),
        {link: reshape_jet(poses.rotations[:, n], one, turned[link]) for n, link in enumerate(constraints.links)},
        {name: reshape_jet(jet, size, origin) for name, jet in constraints.points(poses).items()},
        {
            name: reshape_jet(jet, size, none)
            for name, jet in zip(mechanism.slide_names, constraints.travels(poses), strict=True)
        },
    )
