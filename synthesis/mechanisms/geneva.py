"""A Geneva drive by its dimensions, from an answer or from a client's request."""

from __future__ import annotations

import math
from typing import Any

from kinematics.indexing.drag_link import CrankCourse, DragLink
from kinematics.indexing.geneva import Geneva


def build_drive(mechanism: Any) -> CrankCourse:
    """Build the drive with its crank, and with the drag link before it if there is one.

    Parameters
    ----------
    mechanism : object
        Has ``type``, ``stations`` and the sizes of the type; those of shock-free entry if they are None.
    """
    drive = Geneva.shock_free(mechanism.type, mechanism.stations)
    ratio = drive.ratio
    if mechanism.type == "geneva_spherical":
        if mechanism.cone_angle is not None:
            ratio = math.tan(math.radians(mechanism.cone_angle))
    elif mechanism.crank_radius is not None and mechanism.center_distance is not None:
        ratio = mechanism.crank_radius / mechanism.center_distance
    # A crank rounded to slightly less than the minimum still reaches the slots: use the minimum.
    drive = Geneva(mechanism.type, mechanism.stations, max(ratio, drive.ratio))
    # Only plane drives have a drag link.
    if mechanism.type == "geneva_spherical" or mechanism.drag_link is None:
        return CrankCourse(drive)
    link = mechanism.drag_link
    # Direction of the crank in the middle of the index: towards an external wheel's axis, away from the others'.
    towards = 0.0 if mechanism.type == "geneva_external" else math.pi
    lengths = DragLink(link.input / link.ground, link.coupler / link.ground, link.output / link.ground)
    return CrankCourse(drive, lengths, towards - math.radians(link.crank_offset))
