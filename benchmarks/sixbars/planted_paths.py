"""Planted curves: random sixbars, each with 24 points of its own coupler curve, and whether one is found that draws it.

A planted sixbar has a crank that turns fully, transmission angles of 15° at least, and P on a link that is not joined
to the ground. The task is the points, the type, the planted transmission angle and twice the link ratio. ``met`` are
the tasks whose points lie on the curve of a sixbar to a millionth of the box's diagonal, root mean square; ``near``
those to a ten-thousandth.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.sixbars.path import off, solved
from benchmarks.sixbars.planted_functions import ratio_of
from benchmarks.sixbars.spread import each
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from synthesis.proof.rebuilt import rebuilt

TASKS = 100

SAMPLES, DENSE, FINE = 24, 240, 28_800
LEAST, WIDEST = 15.0, 10.0
MET, NEAR = 1e-6, 1e-4
TYPES = ["watt_1", "stephenson_1", "stephenson_3"]

Complex = NDArray[np.complex128]


def planted(kind: str, rng: np.random.Generator) -> tuple[Complex, dict[str, float]]:
    """Points of a random sixbar's curve, and what it keeps."""
    names = sorted({joint for listed in catalogue.SIXBAR_LINKS[kind].values() for joint in listed})
    turn = np.linspace(0.0, 2.0 * math.pi, DENSE, endpoint=False)
    while True:
        places = rng.uniform(-1.0, 1.0, len(names)) + 1j * rng.uniform(-1.0, 1.0, len(names))
        joints = dict(zip(names, (complex(z) for z in places), strict=True))
        ratio = ratio_of(joints, kind)
        if ratio > WIDEST:
            continue
        mechanism = catalogue.sixbar(kind, joints)
        motion = drive(mechanism, float(mechanism.reference_input) + turn, order=0)
        if not motion.valid.all():
            continue
        least = math.degrees(math.asin(min(float(np.abs(sine).min()) for sine in motion.sines.values())))
        curve = motion.joints["P"][0]
        if least < LEAST or math.hypot(float(np.ptp(curve.real)), float(np.ptp(curve.imag))) < 0.2:
            continue
        points = curve[:: DENSE // SAMPLES]
        return points, {"min_transmission_angle": least - 0.5, "max_link_ratio": 2.0 * ratio}


def distance(design: Any, points: Complex) -> float:
    """The root mean square of the distances of points from the curve of a design, in diagonals of their box."""
    mechanism = rebuilt(design.mechanism)
    turn = np.linspace(0.0, 2.0 * math.pi, FINE, endpoint=False)
    curve = drive(mechanism, float(mechanism.reference_input) + turn, order=0).joints["P"][0]
    size = math.hypot(float(np.ptp(points.real)), float(np.ptp(points.imag)))
    return float(np.sqrt(np.mean(off(points, curve) ** 2))) / size


def tried(kind: str, points: Complex, constraints: dict[str, float]) -> tuple[float, float]:
    """The least distance of the designs of a task, infinite where there is none, and the processor time."""
    result, processor, _ = solved(points, mechanisms=[kind], constraints=constraints, max_designs=3)
    passed = [design for design in result.designs if design.verification.passed]
    return min((distance(design, points) for design in passed), default=math.inf), processor


def table(tasks: int, seed: int) -> None:
    print(f"{'planted':<14}{'tasks':>6}{'met %':>8}{'near %':>8}{'median':>11}{'worst':>11}{'CPU s':>7}{'most':>7}")
    for kind in TYPES:
        rng = np.random.default_rng([seed, TYPES.index(kind)])
        found, times = zip(*each(tried, [(kind, *planted(kind, rng)) for _ in range(tasks)]), strict=True)
        errors = np.array(found)
        print(
            f"{kind:<14}{tasks:>6}{100.0 * np.mean(errors <= MET):>8.1f}{100.0 * np.mean(errors <= NEAR):>8.1f}"
            f"{np.median(errors):>11.2e}{errors.max():>11.2e}{np.median(times):>7.2f}{max(times):>7.1f}",
            flush=True,
        )
