"""Code that several tests share: parts of cams."""

from __future__ import annotations

from typing import Any

CAM: dict[str, Any] = {
    "kind": "cam",
    "segments": [
        {"motion": "rise", "angle": 120.0, "lift": 20.0, "law": "modified_sine"},
        {"motion": "dwell", "angle": 60.0},
        {"motion": "return", "angle": 120.0, "law": "cycloidal"},
        {"motion": "dwell", "angle": 60.0},
    ],
    "follower": {"type": "translating_roller", "roller_radius": 10.0, "offset": 4.0},
    "profile_points": 360,
}
SWUNG = [{**CAM["segments"][0], "lift": 12.0}, *CAM["segments"][1:]]
ARM = {"type": "oscillating_roller", "roller_radius": 10.0, "arm": 90.0, "pivot_distance": 110.0}
FACED = {"type": "oscillating_flat", "pivot_distance": 200.0, "face_offset": 5.0}
DRIVE: dict[str, Any] = {
    "kind": "indexing", "drive": "geneva_external", "stations": 5, "rollers": 1, "center_distance": 80.0,
    "roller_diameter": 12.0, "speed_rpm": 60.0,
}  # fmt: skip
RATCHET = {
    "kind": "indexing", "drive": "ratchet", "stations": 24, "wall_thickness": 6.0, "wheel_shaft_diameter": 20.0,
    "load_torque": 40.0, "pawls": {"count": 2},
}  # fmt: skip
PROBLEMS: dict[str, dict[str, Any]] = {
    "roller": CAM,
    "arm": {**CAM, "segments": SWUNG, "follower": ARM, "rotation": "cw"},
    "flat": {**CAM, "follower": {"type": "translating_flat", "offset": 3.0}},
    "flat_arm": {**CAM, "segments": SWUNG, "follower": FACED},
    "groove": {**CAM, "closure": "form"},
    "conjugate": {**CAM, "closure": "conjugate"},
    "external": DRIVE,
    "internal": {**DRIVE, "drive": "geneva_internal", "stations": 4},
    "ratchet": RATCHET,
}
