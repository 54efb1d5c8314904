"""Motion of any point of any link of a mechanism.

A point p fixed in a link, in the link's frame with the origin at the joint z from which its angle θ is measured and the
real axis along it, moves as

    q = z + p e^{iθ},   q' = z' + iω p e^{iθ},   q'' = z'' + (iα − ω²) p e^{iθ},
    q''' = z''' + (iα' − 3ωα − iω³) p e^{iθ}                                  (Norton, Sec. 6.7, 7.3, 7.6).
"""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Complex
from kinematics.errors import DimensionError
from kinematics.linkage.planar.drive import MechanismMotion
from kinematics.linkage.planar.mechanism import GROUND, Mechanism


def link_point(mechanism: Mechanism, motion: MechanismMotion, link: str, place: complex) -> Complex:
    """Compute the position and the rates of a point of a link.

    Parameters
    ----------
    mechanism : Mechanism
        Designs of shape S.
    motion : MechanismMotion
        Its motion; jets of shape (n,) + S + (N,).
    link : str
        A link in motion.
    place : complex
        The point in the link's frame: origin at the link's first joint, real axis towards its second. For the input
        link the origin is its pivot, and the real axis points towards its other joint.

    Returns
    -------
    complex, shape (n,) + S + (N,)
        Position in the mechanism's coordinates, and rates per s^n.

    Raises
    ------
    DimensionError
        For an unknown link, or the ground.
    """
    if link == GROUND or link not in mechanism.links:
        raise DimensionError("link", "kinematics-moving-link", link)
    theta = motion.angles[link]
    unit = place * np.exp(1j * theta[0])
    turned = [unit]
    if len(theta) > 1:
        turned.append(1j * theta[1] * unit)
    if len(theta) > 2:
        turned.append((1j * theta[2] - theta[1] ** 2) * unit)
    if len(theta) > 3:
        turned.append((1j * theta[3] - 3.0 * theta[1] * theta[2] - 1j * theta[1] ** 3) * unit)
    return np.asarray(motion.joints[mechanism.link_line(link)[0]] + np.stack(turned))
