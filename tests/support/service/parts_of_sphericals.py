"""Code that several tests share: parts of sphericals."""

from __future__ import annotations

from typing import Any

SPHERICAL: dict[str, Any] = {
    "kind": "indexing",
    "drive": "geneva_spherical",
    "stations": 4,
    "sphere_radius": 50.0,
    "roller_diameter": 10.0,
    "speed_rpm": 100.0,
    "load_inertia": 0.01,
}
