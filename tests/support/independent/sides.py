"""What a client fixes of the two sides of a linkage that carries a body, read off its joints (docs/tasks/motion.md)."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive


def compare_sides(beside: Beside, stated: dict[str, Any], drive: Drive, task: float) -> None:
    """The greatest deviation of each side from what is stated: shares of the task's size, and radians."""
    kind = beside.design.mechanism.type
    at = dict(zip(drive.names, drive.home, strict=True))
    link = ("O2", "A")
    if kind == "slider_crank":
        sides = {"input_side": (None, "B"), "output_side": link}
        sides = sides if drive.slides_in else {"input_side": link, "output_side": (None, "B")}
    elif kind == "inverted_slider_crank":
        sides = {"input_side": link, "output_side": ("O4", None)}
    else:
        sides = {"input_side": link, "output_side": ("O4", "B")}
    for name, (pivot, pin) in sides.items():
        gaps = _gaps(stated.get(name, {}), beside, drive, task, pivot, pin)
        if gaps:
            beside.check(name, max(gaps))
    line = stated.get("ground_line")
    if line is not None:
        along = cmath.rect(1.0, math.radians(line["angle"]))
        pivots = [at[pivot] for pivot, _ in sides.values() if pivot is not None]
        gap = max(abs(((place - complex(*line["point"])) * along.conjugate()).imag) for place in pivots)
        beside.check("ground_line", gap / task)


def _gaps(
    choice: dict[str, Any], beside: Beside, drive: Drive, task: float, pivot: str | None, pin: str | None
) -> list[float]:
    """Deviations of one side; empty where nothing of it is stated."""
    at = dict(zip(drive.names, (complex(z) for z in drive.home), strict=True))
    gaps = []
    for joint, wanted in ((pivot, choice.get("fixed_pivot")), (pin, choice.get("moving_pivot"))):
        for part, value in enumerate(wanted or ()):
            if value is not None and joint is not None:
                gaps.append(abs((at[joint].real, at[joint].imag)[part] - value) / task)
    if choice.get("slide_angle") is not None:
        along = next(u for joint, _, _, u in drive.slides if drive.names[joint] in (pivot, pin))
        gaps.append(abs(math.remainder(cmath.phase(along) - math.radians(choice["slide_angle"]), math.pi)))
    if pivot is not None and pin is not None:
        if choice.get("link_angle") is not None:
            gaps.append(_turn(at[pin] - at[pivot], choice["link_angle"]))
        for target, rotation in zip(beside.design.targets[1:], choice.get("rotations") or [], strict=False):
            if rotation is not None:
                # The input's own turn, or the joints of the driven linkage.
                gaps.append(_turned(drive, beside, target, pivot, pin, rotation))
    vector = choice.get("coupler_vector") or {}
    if pin is not None and vector.get("length") is not None:
        gaps.append(abs(abs(at["P"] - at[pin]) - vector["length"]) / task)
    if pin is not None and vector.get("angle") is not None:
        gaps.append(_turn(at["P"] - at[pin], vector["angle"]))
    return gaps


def _turned(drive: Drive, beside: Beside, target: Any, pivot: str, pin: str, rotation: float) -> float:
    """By how much a link's rotation from the first target to another differs from a stated one."""
    first = beside.design.targets[0].position
    begun = (math.radians(first) - drive.reference + math.pi) % math.tau - math.pi
    turn = begun + math.radians(target.position - first)
    z = drive.at(np.array([turn]))[0]
    now = complex(z[drive.names.index(pin)] - z[drive.names.index(pivot)])
    home = complex(drive.home[drive.names.index(pin)] - drive.home[drive.names.index(pivot)])
    return _turn(now / home, rotation)


def _turn(vector: complex, degrees: float) -> float:
    """Angle between a vector and a direction, radians, 0 to π."""
    return abs(cmath.phase(vector * cmath.rect(1.0, -math.radians(degrees))))
