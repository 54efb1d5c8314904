"""Constraints on a function generator as inequalities, with derivatives by its steps.

In logarithms of the lengths a limit on a link ratio is linear. The transmission angle and Grashof's condition are not;
they are linearised at the current generator.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.pivot_regions import Regions
from synthesis.kinds.function.fourbar.structural_error import PARAMETER_COUNT
from synthesis.kinds.function.fourbar.task import FunctionTask

DEFAULT_MAX_RATIO = 1e5
"""Maximum link ratio, or length of a slider-crank's link in slider ranges, if no limit is given; beyond it errors
change only in digits that cannot be manufactured."""

INPUT_SAMPLE_COUNT = 25
"""Number of inputs over the range at which the transmission angle is constrained."""

LIMIT_MARGIN = 1e-7
"""Relative margin from every limit, so that rounding does not violate it."""

MAX_PLACEMENTS = 1000
"""Maximum number of generators whose placement is estimated: those with the smallest other violations."""

GRASHOF_MARGIN = 1e-4
"""Margin in Grashof's condition, in lengths of the shortest link; without it the linkage could have a change point."""


class GeneratorLimits:
    """Inequalities g(generator) ≤ 0 of a task.

    Parameters
    ----------
    task : FunctionTask
        The task with its constraints.
    least : float, optional
        Minimum transmission angle, degrees, if the client gives none.
    """

    def __init__(self, task: FunctionTask, least: float | None = None) -> None:
        problem, demanded = task.problem, task.problem.constraints
        self.slides = problem.slides
        ratio = (
            # A given limit is tightened to the default one: more extreme linkages are of no practical use.
            DEFAULT_MAX_RATIO if demanded.max_link_ratio is None else min(demanded.max_link_ratio, DEFAULT_MAX_RATIO)
        )
        lengths = demanded.link_length
        low, high = (0.0, math.inf) if lengths is None else (lengths.min, lengths.max or math.inf)
        self.shortest, self.longest = 0.0, math.inf
        if self.slides:
            self.shortest, self.longest = low / task.unit, min(high / task.unit, DEFAULT_MAX_RATIO)
        elif problem.fixed_pivots is not None:
            ground = abs(complex(*problem.fixed_pivots.output) - complex(*problem.fixed_pivots.input))
            # Lengths are relative to the ground, whose length the given pivots determine.
            self.shortest, self.longest = low / ground, high / ground
        elif low > 0.0 and math.isfinite(high):
            # Without a given ground the size is free, so length limits only restrict the ratio.
            ratio = min(ratio, high / low)
        # A margin keeps results within the limits in spite of the solver's tolerance.
        self.ratio = ratio / (1.0 + LIMIT_MARGIN)
        least = demanded.min_transmission_angle if demanded.min_transmission_angle is not None else least
        self.cosine = None if least is None else math.cos(math.radians(least)) - LIMIT_MARGIN
        inputs = task.sample_inputs
        self.places = np.linspace(float(inputs.min()), float(inputs.max()), INPUT_SAMPLE_COUNT)
        self.shortest_link = {"crank_rocker": 1, "double_crank": 0, "double_rocker": 2}.get(demanded.grashof)
        if self.slides:
            # A slider-crank has no Grashof class.
            self.shortest_link = None
        self.turns_through = demanded.full_rotation
        self.never_turns = demanded.grashof == "non_grashof"
        zones = (demanded.fixed_pivot_region, demanded.moving_pivot_region)
        # With given pivots nothing is left to place.
        self.regions = Regions(task) if problem.fixed_pivots is None and zones != (None, None) else None

    def clip_lengths(self, generators: Real) -> Real:
        """Clip the lengths of generators (k, 7) to the limits of ratio and size."""
        found = generators.copy()
        columns = [0, 1] if self.slides else [0, 1, 2]
        logs = np.log(found[:, columns])
        if not self.slides:
            logs = np.concatenate([np.zeros((len(logs), 1)), logs], axis=1)
        # Clip symmetrically about the middle of the logarithms, which changes the linkage least.
        middle = 0.5 * (logs.max(axis=1, keepdims=True) + logs.min(axis=1, keepdims=True))
        half = 0.5 * math.log(self.ratio)
        logs = np.clip(logs, middle - half, middle + half)
        # Return to ground 1.
        if not self.slides:
            logs = logs[:, 1:] - logs[:, :1]
        found[:, columns] = np.clip(
            np.exp(logs), self.shortest * (1.0 + LIMIT_MARGIN), self.longest / (1.0 + LIMIT_MARGIN)
        )
        if self.slides:
            found[:, 2] = np.clip(found[:, 2], -self.longest, self.longest)
        return found

    def check_rotation(self, generators: Real) -> NDArray[np.bool_]:
        """Return a mask of the generators whose required link rotates fully, with a margin; shape (k,)."""
        a, b, c = generators[:, :3].T
        if self.slides:
            # Crank plus offset must not exceed the coupler.
            return np.asarray(a + np.abs(c) < b)
        lengths = np.stack([np.ones_like(a), a, b, c])
        shortest, total = lengths.argmin(axis=0), lengths.sum(axis=0)
        excess = lengths.min(axis=0) + lengths.max(axis=0) - 0.5 * total
        wanted = [0, 1] if self.shortest_link is None else [self.shortest_link]
        return np.asarray((excess < -GRASHOF_MARGIN * lengths.min(axis=0)) & np.isin(shortest, wanted))

    def values(self, generator: Real, *, derivatives: bool = False) -> tuple[Real, Real]:
        """Return g and, on request, its derivatives by the steps: shapes (m,) and (m, n).

        n is 7, or 11 for a placed generator, for which the pivot regions are included.
        """
        # The placement does not affect the linkage's own limits.
        g, slopes = self._evaluate_linkage(generator[:PARAMETER_COUNT], derivatives=derivatives)
        if len(generator) == PARAMETER_COUNT or self.regions is None:
            return g, slopes
        placed, rows = self.regions.values(generator)
        slopes = np.pad(slopes, ((0, 0), (0, len(generator) - PARAMETER_COUNT)))
        return np.concatenate([g, placed + LIMIT_MARGIN]), np.concatenate([slopes, rows])

    def choose_placement(self, generator: Real) -> Real:
        """Append the best placement to a generator if there are pivot regions; otherwise return it unchanged."""
        return (
            generator
            if self.regions is None or len(generator) > PARAMETER_COUNT
            else self.regions.choose_placement(generator)
        )

    def measure_violations(self, generators: Real) -> Real:
        """Estimate the maximum constraint violation of many generators: shape (k,).

        It is infinite if a linkage cannot be assembled, or if its regions are not evaluated because too many others
        have smaller violations.
        """
        # The offset of a slider-crank is not the length of a link.
        lengths = generators[:, :2] if self.slides else np.column_stack([np.ones(len(generators)), generators[:, :3]])
        least, most = lengths.min(axis=1), lengths.max(axis=1)
        rows = [np.log(most / least / self.ratio), self._measure_class_violation(lengths)]
        sized = lengths if self.slides else lengths[:, 1:]
        if self.shortest > 0.0:
            rows.append(np.log(self.shortest / sized.min(axis=1)))
        if math.isfinite(self.longest):
            rows.append(np.log(sized.max(axis=1) / self.longest))
        if self.cosine is not None:
            rows.append(np.sqrt(1.0 - self.transmission(generators) ** 2) - self.cosine)
        worst = np.maximum(np.max(rows, axis=0), 0.0)
        if self.regions is None:
            return np.asarray(worst)
        # Placements are expensive, so only the nearest generators have theirs examined.
        nearest = np.argsort(worst)[:MAX_PLACEMENTS]
        placed = np.full(len(worst), np.inf)
        placed[nearest] = np.maximum(worst[nearest], self.regions.measure_outside(generators[nearest]))
        return placed

    def _measure_class_violation(self, lengths: Real) -> Real:
        """Measure the violation of the required Grashof class from lengths (k, 2 or 4): shape (k,)."""
        if self.slides or (self.shortest_link is None and not self.turns_through and not self.never_turns):
            return np.zeros(len(lengths))
        least = lengths.min(axis=1)
        excess = (2.0 * (least + lengths.max(axis=1)) - lengths.sum(axis=1)) / least
        if self.never_turns:
            return np.asarray(GRASHOF_MARGIN - excess)
        wanted = [0, 1] if self.shortest_link is None else [self.shortest_link]
        return np.asarray(np.maximum(excess + GRASHOF_MARGIN, np.log(lengths[:, wanted].min(axis=1) / least)))

    def _evaluate_linkage(self, generator: Real, *, derivatives: bool = False) -> tuple[Real, Real]:
        """Evaluate the inequalities that do not depend on the placement."""
        rows = [*self._evaluate_ratios(generator), *self._evaluate_grashof(generator)]
        g = np.array([value for value, _ in rows])
        slopes = np.array([slope for _, slope in rows]).reshape(-1, PARAMETER_COUNT)
        if self.cosine is None:
            return g, slopes
        cosines, turned = self._evaluate_transmission(generator, derivatives)
        # The cosine is limited from both sides, as angles near 180° transmit as badly as those near 0°.
        g = np.concatenate([g, cosines - self.cosine, -cosines - self.cosine])
        return g, np.concatenate([slopes, turned, -turned])

    def transmission(self, generators: Real) -> Real:
        """Return the minimum |sine| of the transmission angle over the range, shape (k,)."""
        cosines = self._compute_cosines(*(generators[:, j, None] for j in range(6)))
        return np.asarray(np.sqrt(np.maximum(1.0 - np.abs(cosines).max(axis=1) ** 2, 0.0)))

    def _sample_inputs(self, start: Real, k: Real) -> Real:
        """Return input angles for the transmission angle: samples of the range, and its interior extremes."""
        theta = np.asarray(start + k * self.places)
        first, last = theta[..., :1], theta[..., -1:]
        turned = 0.5 * math.pi if self.slides else 0.0
        inner = turned + math.pi * np.ceil((np.minimum(first, last) - turned) / math.pi)
        # Extremes outside the range are replaced by its end, which does no harm.
        extremes = np.minimum(np.concatenate([inner, inner + math.pi], axis=-1), np.maximum(first, last))
        return np.concatenate([theta, extremes], axis=-1)

    def _compute_cosines(self, a: Real, b: Real, c: Real, start: Real, _zero: Real, k: Real) -> Real:
        theta = self._sample_inputs(start, k)
        if self.slides:
            return np.asarray((c - a * np.sin(theta)) / b)
        f2 = 1.0 + a * a - 2.0 * a * np.cos(theta)
        return np.asarray((b * b + c * c - f2) / (2.0 * b * c))

    def _evaluate_transmission(self, generator: Real, derivatives: bool) -> tuple[Real, Real]:
        a, b, c, start, zero, k = (np.asarray(generator[j]) for j in range(6))
        cosines = self._compute_cosines(a, b, c, start, zero, k)
        slopes = np.zeros((len(cosines), PARAMETER_COUNT))
        if derivatives:
            theta = self._sample_inputs(start, k)
            if self.slides:
                slopes[:, 0], slopes[:, 1], slopes[:, 2] = -a * np.sin(theta) / b, -cosines, 1.0 / b
                slopes[:, 3] = -a * np.cos(theta) / b
            else:
                slopes[:, 0] = -(2.0 * a * a - 2.0 * a * np.cos(theta)) / (2.0 * b * c)
                slopes[:, 1], slopes[:, 2] = b / c - cosines, c / b - cosines
                slopes[:, 3] = -2.0 * a * np.sin(theta) / (2.0 * b * c)
            # Only inputs relative to the zero scale.
            slopes[:, 5] = slopes[:, 3] * (theta - start)
        return cosines, slopes

    def _evaluate_ratios(self, generator: Real) -> list[tuple[float, Real]]:
        """Return rows (value, slopes) of link ratios and lengths."""
        names = [0, 1] if self.slides else [0, 1, 2]
        logs = [(math.log(generator[j]), _make_unit_row(j)) for j in names]
        rows = []
        for log, slope in logs:
            if self.shortest > 0.0:
                rows.append((math.log(self.shortest * (1.0 + LIMIT_MARGIN)) - log, -slope))
            if math.isfinite(self.longest):
                rows.append((log - math.log(self.longest / (1.0 + LIMIT_MARGIN)), slope))
        if self.slides:
            rows += [
                (sign * generator[2] / self.longest - 1.0, sign * _make_unit_row(2) / self.longest)
                for sign in (1.0, -1.0)
            ]
        else:
            logs.append((0.0, np.zeros(PARAMETER_COUNT)))
        most = math.log(self.ratio)
        rows += [(one - other - most, s - t) for one, s in logs for other, t in logs if s is not t]
        return rows

    def _evaluate_grashof(self, generator: Real) -> list[tuple[float, Real]]:
        """Return rows of Grashof's condition: the shortest link plus any other is shorter than the other two."""
        if self.slides:
            if not self.turns_through:
                return []
            a, b, e = (float(x) for x in generator[:3])
            slope = a * _make_unit_row(0) - b * _make_unit_row(1)
            return [
                ((a + sign * e - b) / b + GRASHOF_MARGIN, (slope + sign * _make_unit_row(2)) / b)
                for sign in (1.0, -1.0)
            ]
        lengths = [1.0, *(float(x) for x in generator[:3])]
        short = self.shortest_link
        if self.never_turns:
            return [self._evaluate_change_point(lengths)]
        if short is None:
            if not self.turns_through:
                return []
            short = 1 if lengths[1] < 1.0 else 0
        slopes = [np.zeros(PARAMETER_COUNT), *(lengths[j + 1] * _make_unit_row(j) for j in range(3))]
        total, total_slope = sum(lengths), np.sum(slopes, axis=0)
        # Measure in units of the shortest link, so that the margin is significant even if that link is very short.
        unit = lengths[short]
        rows = []
        for j in range(4):
            if j != short:
                pair, slope = lengths[short] + lengths[j], slopes[short] + slopes[j]
                excess = (2.0 * pair - total) / unit
                rows.append((excess + GRASHOF_MARGIN, (2.0 * slope - total_slope - excess * slopes[short]) / unit))
        return rows

    def _evaluate_change_point(self, lengths: list[float]) -> tuple[float, Real]:
        """Return the row of a non-Grashof linkage: shortest and longest are together longer than the other two."""
        excess, slope, unit = 0.0, np.zeros(PARAMETER_COUNT), min(lengths)
        for j, length in enumerate(lengths):
            side = -1.0 if length in (unit, max(lengths)) else 1.0
            excess += side * length / unit
            if j:
                slope += side * length / unit * _make_unit_row(j - 1)
        shortest = lengths.index(unit)
        if shortest:
            slope -= excess * _make_unit_row(shortest - 1)
        return excess + GRASHOF_MARGIN, slope


def _make_unit_row(j: int) -> Real:
    row = np.zeros(PARAMETER_COUNT)
    row[j] = 1.0
    return row
