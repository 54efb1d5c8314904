"""Pivot regions as inequalities of a function generator and its placement, with derivatives by the steps.

A generator works alike in any position, direction and size, so regions involve four more parameters: with w the vector
of the ground line (for a slider-crank that of the slide, of given size) and o the position of O2, joint p is at
o + w p. Steps are those of the generator, followed by ln |w|, arg w, and o in units of the regions' extent.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.kinds.function.fourbar.structural_error import PARAMETER_COUNT, PLACED_PARAMETER_COUNT, Generators
from synthesis.kinds.function.fourbar.task import DEFAULT_GROUND_LENGTH, FunctionTask
from synthesis.results.placement import convert_regions, find_placement

DIRECTION_COUNT, SIZE_COUNT = 144, 5
"""Numbers of directions and sizes tried in the coarse placement, accurate to about 2 % of a linkage's size."""

MIN_SIZE_SHARE = 0.2
"""Minimum size tried, as a share of the maximum, if no length limit gives a minimum."""


class Regions:
    """Regions that must contain the pivots, for a task with free placement."""

    def __init__(self, task: FunctionTask) -> None:
        self.task, self.constraints = task, task.problem.constraints
        self.slides = task.problem.slides
        fixed = 1 if self.slides else 2
        regions = [self.constraints.fixed_pivot_region] * fixed + [self.constraints.moving_pivot_region] * 2
        self.boxes = convert_regions(regions)
        sides = np.concatenate([self.boxes.right - self.boxes.left, self.boxes.high - self.boxes.low])
        self.extent = float(sides[np.isfinite(sides)].max(initial=0.0)) or DEFAULT_GROUND_LENGTH
        limits = self.constraints.link_length
        self.shortest = 0.0 if limits is None else limits.min
        self.longest = math.inf if limits is None or limits.max is None else limits.max
        self.first = Generators(self.slides, task.inputs[:1], task.outputs[:1])

    @property
    def free(self) -> NDArray[np.bool_]:
        """Mask of the open parameters among the four of the placement."""
        return np.array([not self.slides, True, True, True])

    def joints(self, generators: Real) -> Complex:
        """Return pivots at the first target in the solver's frame, fixed ones first: (k, 7) gives shape (k, n)."""
        a, _, c, start, zero, k, scale = (generators[:, j] for j in range(PARAMETER_COUNT))
        errors = self.first.errors(generators, self.first.signs(generators))[:, 0]
        errors = np.where(np.isfinite(errors), errors, 0.0)
        pin = a * np.exp(1j * (start + k * self.first.inputs[0]))
        stands = zero + scale * self.first.outputs[0] + errors
        fixed = [np.zeros_like(pin)]
        if self.slides:
            joint = stands + 1j * c
        else:
            fixed.append(np.ones_like(pin))
            joint = 1.0 + c * np.exp(1j * stands)
        return np.stack([*fixed, pin, joint], axis=-1)

    def choose_placement(self, generator: Real) -> Real:
        """Append the best placement to a generator (7,): shape (11,)."""
        joints = self.joints(generator[None])[0]
        moving, fixed = list(joints[-2:]), list(joints[:-2])
        lengths = None if self.slides else [1.0, *(float(x) for x in generator[:3])]
        preferred = complex(self.task.unit if self.slides else DEFAULT_GROUND_LENGTH)
        found = find_placement(self.constraints, fixed, moving, lengths, preferred)
        at = found.origin / self.extent
        place = [math.log(abs(found.along)), float(np.angle(found.along)), at.real, at.imag]
        return np.concatenate([generator, place])

    def measure_outside(self, generators: Real) -> Real:
        """Estimate the minimum distance of many generators from the regions, in units of their extent: shape (k,)."""
        joints = self.joints(generators)
        if self.slides:
            sizes = np.full((len(joints), 1), self.task.unit)
        else:
            lengths = np.column_stack([np.ones(len(joints)), generators[:, :3]])
            most = np.minimum(self.longest / lengths.max(axis=1), 2.0 * self.extent)
            least = np.maximum(self.shortest / lengths.min(axis=1), 0.0)
            least = np.where(least > 0.0, np.minimum(least, most), MIN_SIZE_SHARE * most)
            sizes = least[:, None] * (most / least)[:, None] ** np.linspace(0.0, 1.0, SIZE_COUNT)
        best = np.full(len(joints), np.inf)
        for turn in np.exp(1j * math.tau * np.arange(DIRECTION_COUNT) / DIRECTION_COUNT):
            moved = (sizes * turn)[..., None] * joints[:, None, :]
            # The spread of the joints beyond what their boxes allow; centring them halves the distance.
            x = (self.boxes.left - moved.real).max(axis=-1) - (self.boxes.right - moved.real).min(axis=-1)
            y = (self.boxes.low - moved.imag).max(axis=-1) - (self.boxes.high - moved.imag).min(axis=-1)
            best = np.minimum(best, np.maximum(x, y).min(axis=1))
        return np.asarray(np.maximum(0.5 * best, 0.0) / self.extent)

    def values(self, at: Real) -> tuple[Real, Real]:
        """Return inequalities g ≤ 0 of a placed generator (11,), and their derivatives: shapes (m,) and (m, 11)."""
        generator, (log_size, turn, x, y) = at[:PARAMETER_COUNT], at[PARAMETER_COUNT:]
        along, origin = math.exp(log_size) * complex(math.cos(turn), math.sin(turn)), self.extent * complex(x, y)
        joints = self.joints(generator[None])[0]
        places = origin + along * joints
        slopes = np.zeros((len(joints), PLACED_PARAMETER_COUNT), np.complex128)
        slopes[-2:, :PARAMETER_COUNT] = along * self._differentiate_joints(generator)
        slopes[:, PARAMETER_COUNT], slopes[:, PARAMETER_COUNT + 1] = along * joints, 1j * along * joints
        slopes[:, PARAMETER_COUNT + 2], slopes[:, PARAMETER_COUNT + 3] = self.extent, 1j * self.extent
        left, right, low, high = self.boxes
        g = np.concatenate([left - places.real, places.real - right, low - places.imag, places.imag - high])
        rows = np.concatenate([-slopes.real, slopes.real, -slopes.imag, slopes.imag])
        stated = np.isfinite(g)
        g, rows = g[stated] / self.extent, rows[stated] / self.extent
        if self.slides:
            return g, rows
        logs = np.log(np.array([1.0, *generator[:3]])) + log_size
        of_logs = np.zeros((4, PLACED_PARAMETER_COUNT))
        of_logs[1:, :3] = np.eye(3)
        of_logs[:, PARAMETER_COUNT] = 1.0
        if self.shortest > 0.0:
            g, rows = np.concatenate([g, math.log(self.shortest) - logs]), np.concatenate([rows, -of_logs])
        if math.isfinite(self.longest):
            g, rows = np.concatenate([g, logs - math.log(self.longest)]), np.concatenate([rows, of_logs])
        return g, rows

    def _differentiate_joints(self, generator: Real) -> Complex:
        """Return derivatives of A and B at the first target, in the solver's frame, by the steps: shape (2, 7)."""
        a, _, c, start, zero, k, scale = (float(x) for x in generator)
        place, wanted = float(self.first.inputs[0]), float(self.first.outputs[0])
        errors = self.first.errors(generator[None], self.first.signs(generator[None]))[0]
        pin = a * np.exp(1j * (start + k * place))
        slopes = np.zeros((2, PARAMETER_COUNT), np.complex128)
        slopes[0, [0, 3, 5]] = pin, 1j * pin, 1j * pin * k * place
        stands = self.first.derivatives(generator, errors)[0] if np.isfinite(errors[0]) else np.zeros(PARAMETER_COUNT)
        stands = np.where(np.isfinite(stands), stands, 0.0)
        stands[[4, 6]] += 1.0, scale * wanted
        if self.slides:
            slopes[1] = stands
            slopes[1, 2] += 1j
            return slopes
        arm = c * np.exp(1j * (zero + scale * wanted + (errors[0] if np.isfinite(errors[0]) else 0.0)))
        slopes[1] = 1j * arm * stands
        slopes[1, 2] += arm
        return slopes
