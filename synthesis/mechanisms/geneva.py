"""Geneva drives given by their dimensions, in an answer or a request."""

from __future__ import annotations

import math
from typing import Any

from kinematics.indexing.drag_link import CrankCourse, DragLink
from kinematics.indexing.geneva import Geneva


def build_drive(mechanism: Any) -> CrankCourse:
    """Build a Geneva drive with its crank, and with the drag link that drives the crank, if there is one.

    Parameters
    ----------
    mechanism : object
        A model with ``type``, ``stations`` and the sizes of the type. Sizes that are None are those of shock-free
        entry.
    """
    drive = Geneva.shock_free(mechanism.type, mechanism.stations)
    ratio = drive.ratio
    if mechanism.type == "geneva_spherical":
        if mechanism.cone_angle is not None:
            ratio = math.tan(math.radians(mechanism.cone_angle))
    elif mechanism.crank_radius is not None and mechanism.center_distance is not None:
        ratio = mechanism.crank_radius / mechanism.center_distance
    # The radius of a crank may be rounded to slightly less than the minimum that reaches the slots: use the minimum.
    drive = Geneva(mechanism.type, mechanism.stations, max(ratio, drive.ratio))
    # Only plane drives have a drag link.
    if mechanism.type == "geneva_spherical" or mechanism.drag_link is None:
        return CrankCourse(drive)
    link = mechanism.drag_link
    # In the middle of the indexing motion, the crank points towards the axis of an external wheel, and away from that
    # of an internal wheel.
    towards = 0.0 if mechanism.type == "geneva_external" else math.pi
    lengths = DragLink(link.input / link.ground, link.coupler / link.ground, link.output / link.ground)
    return CrankCourse(drive, lengths, towards - math.radians(link.crank_offset))
