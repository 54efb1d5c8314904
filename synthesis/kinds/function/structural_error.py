"""The structural error of many function generators at once, and its derivatives, for the solver's own use.

Dimensions are those of :mod:`synthesis.kinds.function.closure`, followed by the scales: (a, b, c, φ₀, ψ₀, k, l) of a
fourbar with ground 1, (a, b, e, θ₀, s₀, k, l) of a slider-crank, where the input turns by k φ and the output should by
l ψ. They are changed by steps of (ln a, ln b, ln c or e, zeros, ln k, ln l), in which a limit on a ratio is linear.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

STEPS = 7
"""Numbers that a linkage and its scales have."""

PLACED = STEPS + 4
"""The same with size, direction and place: see :mod:`synthesis.kinds.function.regions`."""

ERROR = 1.0
"""Structural errors are wrapped into half a turn; beyond this many radians (or ranges of a slider) an approximation is
none."""


class Generators:
    """Fourbars or slider-cranks as function generators at common places of the input.

    Parameters
    ----------
    slides : bool
        Slider-cranks.
    inputs, outputs : float, shape (n,) or (k, n)
        φ and ψ, radians, from the first place; of a slider outputs in units of its range.
    """

    def __init__(self, slides: bool, inputs: Real, outputs: Real) -> None:
        self.slides, self.inputs, self.outputs = slides, inputs, outputs

    def some(self, rows: NDArray[np.int64]) -> Generators:
        """The same at some of the places."""
        return Generators(self.slides, self.inputs[rows], self.outputs[rows])

    def errors(self, dimensions: Real, signs: Real) -> Real:
        """Errors of generators of shape (k, 7) with assembly signs (k,) or (k, n): shape (k, n), NaN where none is."""
        signs = signs if signs.ndim == dimensions.ndim else signs[..., None]
        a, b, c, start, zero, k, scale = (dimensions[..., j, None] for j in range(STEPS))
        theta = start + k * self.inputs
        with np.errstate(invalid="ignore", over="ignore"):
            if self.slides:
                y = c - a * np.sin(theta)
                s = a * np.cos(theta) + signs * np.sqrt(b * b - y * y)
                return np.asarray(s - zero - scale * self.outputs)
            pin = a * np.exp(1j * theta)
            f = np.abs(1.0 - pin)
            x = (f * f + (b - c) * (b + c)) / (2.0 * f)
            joint = pin + (1.0 - pin) / f * (x + 1j * signs * np.sqrt(b * b - x * x))
            return np.asarray(np.angle((joint - 1.0) * np.exp(-1j * (zero + scale * self.outputs))))

    def signs(self, dimensions: Real) -> Real:
        """Assembly signs at places that are met exactly, shape (k, n)."""
        a, _, c, start, zero, k, scale = (dimensions[..., j, None] for j in range(STEPS))
        pin = a * np.exp(1j * (start + k * self.inputs))
        if self.slides:
            return np.asarray(np.sign(zero + scale * self.outputs - pin.real))
        joint = 1.0 + c * np.exp(1j * (zero + scale * self.outputs))
        return np.asarray(np.sign(((1.0 - pin).conj() * (joint - pin)).imag))

    def derivatives(self, dimensions: Real, errors: Real, _sign: float = 0.0) -> Real:
        """Of the errors of one generator by the steps, which tell its assembly: shape (n, 7)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self._derivatives(dimensions, errors)

    def _derivatives(self, dimensions: Real, errors: Real) -> Real:
        a, b, c, start, zero, k, scale = dimensions[:STEPS]
        theta = start + k * self.inputs
        if self.slides:
            x = zero + scale * self.outputs + errors - a * np.cos(theta)
            y = c - a * np.sin(theta)
            turned = -(x * a * np.sin(theta) - y * a * np.cos(theta)) / x
            columns = [
                (x * np.cos(theta) + y * np.sin(theta)) * a / x,
                np.full_like(x, b) * b / x,
                -y / x,
                turned,
                -np.ones_like(x),
            ]
        else:
            output = zero + scale * self.outputs + errors
            pin = a * np.exp(1j * theta)
            coupler = 1.0 + c * np.exp(1j * output) - pin
            along = coupler / np.abs(coupler)
            # Of the loop a e^{iθ} + b e^{iγ} = 1 + c e^{iψ} the part along the coupler.
            divisor = (1j * c * np.exp(1j * output) * along.conj()).real
            columns = [
                (pin * along.conj()).real / divisor,
                b / divisor,
                -(c * np.exp(1j * output) * along.conj()).real / divisor,
                (1j * pin * along.conj()).real / divisor,
                -np.ones_like(theta),
            ]
            turned = columns[3]
        return np.stack([*columns, turned * k * self.inputs, -scale * self.outputs], axis=-1)

    def stepped(self, dimensions: Real, step: Real) -> Real:
        """A generator after a step."""
        found = dimensions.copy()
        logs = [0, 1, 5, 6] if self.slides else [0, 1, 2, 5, 6]
        adds = [2, 3, 4] if self.slides else [3, 4]
        found[logs] *= np.exp(step[logs])
        found[adds] += step[adds]
        found[STEPS:] += step[STEPS:]
        return found
