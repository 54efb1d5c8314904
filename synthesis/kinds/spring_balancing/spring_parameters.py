"""Springs that were found: ends, rate, free length and preload from the parameters of a program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.spring_balancing.effects import Setting, compute_effects, compute_free_limits
from synthesis.kinds.spring_balancing.program import compute_norm
from synthesis.kinds.spring_balancing.requested_springs import SoughtSpring
from synthesis.model.json_object import JsonObject

NEGLIGIBLE_EFFECT = 1e-7
"""Effect of a spring on the drive, as a share of the unbalanced drive, below which it may be omitted."""


class Spring(NamedTuple):
    """A spring in units of forces, its ends in the reference; for a torsion spring the free angle, radians.

    ``ends`` is empty for a torsion spring.
    """

    number: int
    ends: tuple[complex, ...]
    rate: float
    free: float
    preload: float


def compute_centres(corners: Sequence[Complex], rates: Real) -> tuple[complex, ...]:
    """Return the centres of the rates at pairs of corners, for both ends."""
    whole = float(rates.sum())
    if not whole > 0.0:
        return tuple(complex(end.mean()) for end in corners)
    # Share of the whole rate at each pair of corners.
    table = rates.reshape(len(corners[0]), len(corners[1])) / whole
    return complex(table.sum(axis=1) @ corners[0]), complex(table.sum(axis=0) @ corners[1])


def build_springs(setting: Setting, places: Sequence[Sequence[Complex]], parameters: Sequence[Real]) -> list[Spring]:
    """Build the springs of parameters; each spring may have several corners at one end at most."""
    found = []
    for n, (spring, ends, own) in enumerate(zip(setting.problem.springs, places, parameters, strict=True)):
        if spring.links is not None:
            rate, by = max(float(own[0]), 0.0), float(own[1])
            free = by / rate if rate > 0.0 else 0.0
            low, high = np.radians(spring.free_angles)
            found.append(Spring(n, (), rate, min(max(free, float(low)), float(high)), 0.0))
        elif spring.is_superposable:
            own = np.maximum(own, 0.0)
            found.append(Spring(n, compute_centres(ends, own), float(own.sum()), 0.0, 0.0))
        else:
            at = complex(ends[0][0]), complex(ends[1][0])
            rate, by, preload = max(float(own[0]), 0.0), float(own[1]), float(own[2])
            low, high = compute_free_limits(spring, setting.task.machine.scale, setting.compute_lengths(spring, at))
            free = min(max(by / rate if rate > 0.0 else low, low), high)
            # A negligible preload above the minimum is the program's tolerance.
            if preload - spring.preloads[0] <= NEGLIGIBLE_EFFECT * rate * setting.size:
                preload = spring.preloads[0]
            found.append(Spring(n, at, rate, free, float(np.clip(preload, *spring.preloads))))
    return _select_needed(setting, [_limit_rate(setting.problem.springs[spring.number], spring) for spring in found])


def _limit_rate(requested: SoughtSpring, spring: Spring) -> Spring:
    low, high = requested.rates
    return spring._replace(rate=min(max(spring.rate, low), np.inf if high is None else high))


def read_parameters(setting: Setting, spring: Spring) -> tuple[list[Complex], Real]:
    """Return the ends of a found spring, and its parameters in the program of given ends."""
    stated = setting.problem.springs[spring.number]
    ends = [np.array([end]) for end in spring.ends]
    if stated.links is not None:
        return ends, np.array([spring.rate, spring.rate * spring.free])
    if stated.is_superposable:
        return ends, np.array([spring.rate])
    return ends, np.array([spring.rate, spring.rate * spring.free, spring.preload])


def compute_spring_drive(setting: Setting, spring: Spring) -> Real:
    """Compute a found spring's share of the drive, (N,)."""
    ends, own = read_parameters(setting, spring)
    return np.asarray(own @ compute_effects(setting, setting.problem.springs[spring.number], ends).drive)


def evaluate_springs(setting: Setting, springs: Sequence[Spring]) -> float:
    """Return the remaining share of the drive with springs."""
    left = setting.fixed + sum(
        (compute_spring_drive(setting, spring) for spring in springs), np.zeros(len(setting.fixed))
    )
    return compute_norm(left, setting.problem.norm) / compute_norm(setting.fixed, setting.problem.norm)


def _select_needed(setting: Setting, springs: list[Spring]) -> list[Spring]:
    """Select the springs that have an effect, or may not be omitted."""
    kept = []
    for spring in springs:
        stated = setting.problem.springs[spring.number]
        effect = float(np.abs(compute_spring_drive(setting, spring)).max())
        if stated.is_required or effect > NEGLIGIBLE_EFFECT * setting.peak:
            kept.append(spring)
    return kept


def list_blocks(setting: Setting, springs: Sequence[Spring]) -> list[JsonObject]:
    """List the springs in the form of the block ``dynamics``."""
    scale, stated = setting.task.machine.scale, setting.problem.springs
    written: list[JsonObject] = []
    for spring in springs:
        request = stated[spring.number]
        if request.ends is None:
            free = float(np.degrees(spring.free))
            written.append({"torsion": spring.rate, "links": list(request.links or ()), "free_angle": free})
            continue
        ends = [
            {"link": end.link, "point": [(at / scale).real, (at / scale).imag]}
            for end, at in zip(request.ends, spring.ends, strict=True)
        ]
        one: JsonObject = {"ends": ends, "rate": spring.rate, "free_length": spring.free / scale}
        if spring.preload:
            one["preload"] = spring.preload
        if request.form is not None and not request.without_length:
            one["one_sided"] = "pull" if request.form == "extension" else "push"
        written.append(one)
    return written
