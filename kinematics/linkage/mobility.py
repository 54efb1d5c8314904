"""Degrees of freedom of planar linkages by counting (Norton, Sec. 2.5).

The count uses only the numbers of links and joints. Special dimensions can give a linkage more freedom than its count
(parallel cranks, the E-quintet); Norton calls these paradoxes.
"""

from __future__ import annotations

from kinematics.errors import DimensionError


def compute_mobility(links: int, full_joints: int, half_joints: int = 0, grounded: int = 1) -> int:
    """Compute the mobility by Gruebler's equation in Kutzbach's form, M = 3 (L − G) − 2 J1 − J2 (Norton 2.1).

    Parameters
    ----------
    links : int
        Number of links L, ground included.
    full_joints, half_joints : int
        Joints with one freedom J1 (a multiple pin of n links counts n − 1 times) and with two freedoms J2.
    grounded : int
        Grounded links G: 1 for a mechanism, 0 for links that float.

    Raises
    ------
    DimensionError
        For a negative count.

    Examples
    --------
    >>> compute_mobility(links=4, full_joints=4)
    1
    """
    counts = {"links": links, "full_joints": full_joints, "half_joints": half_joints, "grounded": grounded}
    for name, count in counts.items():
        if count < 0:
            raise DimensionError(name, "kinematics-count-at-least", count, least=0)
    return 3 * (links - grounded) - 2 * full_joints - half_joints
