"""What the checks of a cam have to say: each limit as it is stated, whether it is kept, and whether the cam is the
smallest that keeps all of them, where the answer says so."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, NamedTuple

from tests.support.independent.comparison import Beside

EXACT, CLEAR = 1e-6, 4e-3
"""Shares of a limit: a value that exceeds it by less than the first keeps it, by more than the second breaks it. What
lies between is for the slack of the check to say."""

SMALLER = (0.995, 0.98, 0.95, 0.9, 0.8, 0.65, 0.5, 0.3)
"""Shares of a proven radius at which no cam may be sound."""

LEAST_RATIO, EDGE, HUB = 1.02, 0.02, 1e-3
"""What every cam keeps: radius of the pitch curve over the roller's; over the travel, the radius of curvature under a
face, and the base circle's radius."""


class Limit(NamedTuple):
    """A limit by the name of its check; ``sense`` is 1 where the value may not be more, −1 where not less."""

    value: float
    sense: int

    def excess(self, found: float) -> float:
        """By what share of it a value exceeds the limit."""
        over = self.sense * (found - self.value)
        return over / abs(self.value) if self.value else math.copysign(math.inf, over) if over else 0.0


def limits_of(stated: dict[str, Any]) -> dict[str, Limit]:
    """The limits that a statement has, by the names of their checks."""
    limits, follower = stated.get("limits", {}), stated["follower"]
    found: dict[str, Limit] = {}
    if follower["type"].endswith("roller"):
        rise = limits.get("pressure_angle", 30.0)
        found["pressure_angle"] = Limit(rise, 1)
        found["pressure_angle_fall"] = Limit(limits.get("pressure_angle_fall", rise), 1)
        found["curvature_ratio"] = Limit(limits.get("curvature_ratio", 2.0), -1)
    else:
        found["min_radius"] = Limit(limits.get("min_radius", 0.0), -1)
        if "face_width" in limits:
            found["face_width"] = Limit(limits["face_width"], 1)
    if follower["type"].startswith("oscillating"):
        pivot = follower["pivot_distance"]
        if not isinstance(pivot, dict):
            found["clears_pivot"] = Limit(pivot, 1)
    if limits.get("hub_radius"):
        found["hub_radius"] = Limit(limits["hub_radius"], -1)
    if "size" in limits:
        found["size"] = Limit(limits["size"], 1)
    for name in ("velocity", "acceleration", "jerk"):
        if name in limits:
            found[f"peak_{name}"] = found[f"table_{name}"] = Limit(limits[name], 1)
    grooved = stated.get("closure", "force") != "force" or follower["type"] == "barrel_roller"
    if "dynamics" in stated and not grooved:
        found["contact_force"] = Limit(stated["dynamics"].get("least_force", 0.0), -1)
    if "dynamics" in stated and "min_frequency_ratio" in stated["dynamics"]:
        found["frequency_ratio"] = Limit(stated["dynamics"]["min_frequency_ratio"], -1)
    if "overturning_moment" in limits:
        found["overturning_moment"] = Limit(limits["overturning_moment"], 1)
    return found


def compare_verdicts(beside: Beside, stated: dict[str, Any], found: dict[str, float]) -> None:
    """Whether each check has the stated limit, and says rightly whether it is kept; ``found`` are measured values."""
    limits = limits_of(stated)
    checks = {check.name: check for check in beside.design.verification.checks}
    for name, limit in limits.items():
        check = checks.get(name)
        if check is None:
            # Rates have checks where a motion follows the criterion.
            if name in found and not name.startswith(("peak_", "table_")):
                beside.same("checks.passed", f"no check {name}", name)
            continue
        beside.add("checks.limit", check.limit, limit.value, abs(limit.value) or 1.0)
        if name not in found:
            continue
        excess = limit.excess(found[name])
        if excess <= EXACT:
            beside.same("checks.passed", (name, check.passed), (name, True))
        elif excess > CLEAR:
            beside.same("checks.passed", (name, check.passed), (name, False))
    beside.same("checks.passed", beside.design.verification.passed, all(check.passed for check in checks.values()))


Measure = Callable[[Any], dict[str, float]]
"""Of a mechanism the values by the names of their checks; empty where it makes no cam."""


def compare_smallest(beside: Beside, stated: dict[str, Any], travel: float, measured: Measure) -> None:
    """No smaller cam is sound, with any offset where that is free.

    ``travel`` is the follower's, radians of an arm.
    """
    mechanism, follower = beside.design.mechanism, stated["follower"]
    name = _radius_of(follower)
    if name in follower:
        return
    limits = _bounds(stated, travel)
    roller = _least_roller(follower)
    for share in SMALLER:
        radius = share * getattr(mechanism, name)
        offsets: list[float | None] = [None]
        if follower.get("offset") == "free":
            offsets += [radius * x / 20.0 for x in range(-19, 20)]
        sound = []
        for offset in offsets:
            update = {} if offset is None else {"offset": offset}
            update |= {"roller_radius": roller} if roller else {}
            smaller = mechanism.model_copy(
                update={name: radius, "follower": mechanism.follower.model_copy(update=update)}
            )
            if _sound(limits, measured(smaller)):
                sound.append(offset)
        beside.same("mechanism.smallest", (share, sound), (share, []))


def sound_radius(stated: dict[str, Any], travel: float, measured: Measure) -> float | None:
    """The stated radius, or one from thousandths to thousands of the follower's own length, with which a cam is sound.

    None where none is found, or another dimension is free.
    """
    follower, name = stated["follower"], _radius_of(stated["follower"])
    given = {key: value for key, value in follower.items() if key != "roller_radius"}
    given |= {"roller_radius": _least_roller(follower), "offset": follower.get("offset", 0.0), "sense": 1} | given
    if given["offset"] == "free" or isinstance(given.get("pivot_distance"), dict):
        return None
    size = follower.get("arm", follower.get("pivot_distance", travel))
    limits = _bounds(stated, travel)
    grid = [size * 10.0 ** (power / 40.0) for power in range(-120, 121)]
    for radius in [follower[name]] if name in follower else grid:
        kind = "barrel_cam" if name == "cylinder_radius" else "cam"
        radii = {"prime_radius": None, "base_radius": None, "cylinder_radius": None} | {name: radius}
        mechanism = SimpleNamespace(type=kind, follower=SimpleNamespace(**({"face_offset": 0.0} | given)), **radii)
        if _sound(limits, measured(mechanism)):
            return radius
    return None


def _radius_of(follower: dict[str, Any]) -> str:
    """What a cam's size is called."""
    if follower["type"] == "barrel_roller":
        return "cylinder_radius"
    return "prime_radius" if follower["type"].endswith("roller") else "base_radius"


def _least_roller(follower: dict[str, Any]) -> float | None:
    roller = follower.get("roller_radius")
    return roller["min"] if isinstance(roller, dict) else roller


def _bounds(stated: dict[str, Any], travel: float) -> dict[str, Limit]:
    """The limits that a cam's size follows from, and what is always kept: no undercut, no edge under a face."""
    limits = {name: limit for name, limit in limits_of(stated).items() if name != "size"}
    if "curvature_ratio" in limits:
        limits["curvature_ratio"] = Limit(max(limits["curvature_ratio"].value, LEAST_RATIO), -1)
    follower = stated["follower"]
    travel *= follower.get("arm", follower.get("pivot_distance", 1.0))
    if "min_radius" in limits:
        limits["min_radius"] = Limit(max(limits["min_radius"].value, EDGE * travel), -1)
    if follower["type"] != "barrel_roller":
        hub = limits["hub_radius"].value if "hub_radius" in limits else 0.0
        limits["hub_radius"] = Limit(max(hub, HUB * travel), -1)
    return limits


def _sound(limits: dict[str, Limit], values: dict[str, float]) -> bool:
    return bool(values) and all(limits[name].excess(value) <= EXACT for name, value in values.items() if name in limits)


def compare_roller(beside: Beside, stated: dict[str, Any], pitch_radius: float) -> None:
    """A roller that is free between two radii is as large as the pitch curve and the hub allow."""
    stated_radius = stated["follower"].get("roller_radius")
    if not isinstance(stated_radius, dict):
        return
    limits = stated.get("limits", {})
    mechanism = beside.design.mechanism
    ratio = max(limits.get("curvature_ratio", 2.0), LEAST_RATIO)
    lift = beside.design.metrics.lift
    travel = math.radians(lift) * stated["follower"]["arm"] if "arm" in stated["follower"] else lift
    hub = max(limits.get("hub_radius", 0.0), HUB * travel)
    fits = min(stated_radius["max"], pitch_radius / ratio, mechanism.prime_radius - hub)
    found = max(fits, stated_radius["min"])
    beside.add("mechanism.roller_radius", mechanism.follower.roller_radius, found, found)
