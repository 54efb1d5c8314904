"""Variants of a linkage by another route: loops closed by root finding, nearest places by search of one input."""

from __future__ import annotations

import cmath
import math

import numpy as np
from scipy.optimize import minimize_scalar, root

from kinematics.linkage import Fourbar, SliderCrank, fourbar, slider_crank
from kinematics.linkage.variation import Task

WAY = 400
"""Inputs at which a motion is looked at for a toggle."""


def crank_rocker(sort: str, *, adjusted: bool = True, units: tuple[float, float] = (0.05, 0.01)) -> tuple:
    """A fourbar that meets four targets all but exactly: its dimensions and its task."""
    linkage = Fourbar(1.0 + 2.0j, 9.5 + 3.0j, 4.0, 8.0, 7.0, 5.0 + 3.0j)
    inputs = np.array([0.6, 1.2, 1.7, 2.5])
    at = fourbar.positions(linkage, inputs, -1)
    nominal = np.array([1.0, 2.0, 9.5, 3.0, 4.0, 8.0, 7.0, 5.0, 3.0])
    off = np.array([0.01, -0.004, 0.0, 0.006])
    task = Task(
        sort,
        np.full(4, -1),
        inputs,
        points=None if sort == "outputs" else at.p + off * (1.0 - 2.0j),
        angles={"poses": at.coupler_angle - 0.2 * off, "points": None, "outputs": at.output_angle + 0.2 * off}[sort],
        used=(0.6, 2.5),
        adjusted=adjusted,
        units=units,
    )
    return nominal[: task.dimensions], task


def slider(sort: str, *, adjusted: bool = True, units: tuple[float, float] = (0.05, 0.01)) -> tuple:
    """The same of a slider-crank."""
    angle = 0.4
    linkage = SliderCrank(1.0 - 1.0j, 3.0 + 1.0j, angle, 2.0, 6.0, 4.0 - 1.5j)
    inputs = np.array([-0.4, 0.5, 1.1])
    at = slider_crank.positions(linkage, inputs, 1)
    offset = ((1.0 - 1.0j - 3.0 - 1.0j) * cmath.exp(-1j * angle)).imag
    off = np.array([0.004, 0.01, -0.005])
    task = Task(
        sort,
        np.full(3, 1),
        inputs,
        slide_angle=angle,
        points=None if sort == "outputs" else at.p + off * (1.0 - 2.0j),
        angles=at.coupler_angle - 0.2 * off if sort == "poses" else None,
        travels=at.travel + off if sort == "outputs" else None,
        origin=3.0 + 1.0j,
        used=(-0.6, 1.1),
        adjusted=adjusted,
        units=units,
    )
    return np.array([1.0, -1.0, offset, 2.0, 6.0, 4.0, -1.5])[: task.dimensions], task


class Twin:
    """One variant, with the pin B of its coupler found by roots from a nominal place."""

    def __init__(self, task: Task, nominal: np.ndarray, row: np.ndarray) -> None:
        self.task, self.nominal, self.row = task, nominal, row

    def _loop(self, row: np.ndarray, theta: float):
        """The pin A, and what B is to fulfil."""
        if self.task.slides:
            a, b = row[3], row[4]
            along = cmath.exp(1j * self.task.slide_angle)
            pin = complex(row[0], row[1]) + a * cmath.exp(1j * theta)

            def guided(pin_b: complex) -> float:
                return ((complex(row[0], row[1]) - pin_b) / along).imag - row[2]

        else:
            a, b = row[4], row[5]
            pin = complex(row[0], row[1]) + a * cmath.exp(1j * theta)

            def guided(pin_b: complex) -> float:
                return abs(pin_b - complex(row[2], row[3])) - row[6]

        return pin, lambda z: [abs(complex(*z) - pin) - b, guided(complex(*z))]

    def _first(self, k: int, theta: float) -> complex:
        """Where the nominal linkage has B, by the analysis core."""
        n, sign = self.nominal, self.task.assemblies[k]
        if self.task.slides:
            along = cmath.exp(1j * self.task.slide_angle)
            pivot = complex(n[0], n[1])
            made = SliderCrank(pivot, pivot - 1j * along * n[2], self.task.slide_angle, n[3], n[4])
            return complex(slider_crank.positions(made, theta, sign).b)
        made = Fourbar(complex(n[0], n[1]), complex(n[2], n[3]), n[4], n[5], n[6])
        return complex(fourbar.positions(made, theta, sign).b)

    def offset(self, k: int, theta: float) -> tuple[complex, float]:
        """Deviations in the plane, or along the slide, and of the angle, from target ``k``; NaN where there is none."""
        row, task = self.row, self.task
        pin, loop = self._loop(row, theta)
        first = self._first(k, theta)
        if not cmath.isfinite(first):  # near a toggle of the nominal linkage: from that at the target
            first = self._first(k, float(task.inputs[k]))
        found = root(loop, [first.real, first.imag], tol=1e-13)
        if max(map(abs, loop(found.x))) > 1e-9:
            return complex(math.nan, math.nan), math.nan
        b = complex(*found.x)
        if task.sort == "outputs":
            if task.slides:
                along = cmath.exp(1j * task.slide_angle)
                return complex(((b - task.origin) / along).real - task.travels[k]), 0.0
            return 0j, math.remainder(cmath.phase(b - complex(row[2], row[3])) - task.angles[k], math.tau)
        p = pin + complex(row[-2], row[-1]) * (b - pin) / abs(b - pin)
        off = 0.0
        if task.sort == "poses":
            off = math.remainder(cmath.phase(b - pin) - task.angles[k], math.tau)
        return p - task.points[k], off

    def share(self, k: int, theta: float) -> float:
        """The greater of distance and angle in the task's units, or the root of the sum of their squares."""
        gap, off = self.offset(k, theta)
        taken = abs(gap) / self.task.units[0], abs(off) / self.task.units[1]
        share = max(taken) if self.task.greatest else math.hypot(*taken)
        return share if math.isfinite(share) else 1e9

    def nearest(self, k: int, reach: float = 0.1) -> float:
        """The input at which target ``k`` is nearest."""
        nominal = float(self.task.inputs[k])
        if not self.task.adjusted or self.task.sort == "outputs":
            return nominal
        grid = nominal + np.linspace(-reach, reach, 21)
        best = float(grid[np.argmin([self.share(k, at) for at in grid])])
        near = best - reach / 10.0, best + reach / 10.0
        return float(minimize_scalar(lambda at: self.share(k, at), bounds=near, options={"xatol": 1e-12}).x)
