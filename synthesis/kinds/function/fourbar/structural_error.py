"""Structural error of many function generators at once, and its derivatives, for use in solvers.

Dimensions are those of :mod:`synthesis.kinds.function.fourbar.closure`, followed by the scales: (a, b, c, φ₀, ψ₀, k, l)
for a fourbar with ground 1, (a, b, e, θ₀, s₀, k, l) for a slider-crank. The input turns by k φ, and the output should
turn by l ψ. Steps change (ln a, ln b, ln c or e, zeros, ln k, ln l); a limit on a ratio is linear in these.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real

PARAMETER_COUNT = 7
"""Number of parameters of a linkage and its scales."""

PLACED_PARAMETER_COUNT = PARAMETER_COUNT + 4
"""Number of parameters including size, direction and position: see
:mod:`synthesis.kinds.function.fourbar.pivot_regions`."""

MAX_ERROR = 1.0
"""Maximum structural error of an approximation, radians (or slider ranges). Angular errors are wrapped to half a turn,
so larger ones are ambiguous."""


class Generators:
    """Fourbars or slider-cranks as function generators, evaluated at common inputs.

    Parameters
    ----------
    slides : bool
        Whether they are slider-cranks.
    inputs, outputs : float, shape (n,) or (k, n)
        φ and ψ, radians, from the first input; outputs of a slider in units of its range.
    """

    def __init__(self, slides: bool, inputs: Real, outputs: Real) -> None:
        self.slides, self.inputs, self.outputs = slides, inputs, outputs

    def some(self, rows: NDArray[np.int64]) -> Generators:
        """Return the generators at selected inputs."""
        return Generators(self.slides, self.inputs[rows], self.outputs[rows])

    def errors(self, dimensions: Real, signs: Real) -> Real:
        """Return errors of generators (k, 7) with assembly signs (k,) or (k, n): shape (k, n), NaN if not assembled."""
        # One sign for each generator holds for all inputs.
        signs = signs if signs.ndim == dimensions.ndim else signs[..., None]
        a, b, c, start, zero, k, scale = (dimensions[..., j, None] for j in range(PARAMETER_COUNT))
        theta = start + k * self.inputs
        with np.errstate(invalid="ignore", over="ignore"):
            if self.slides:
                # The offset e is to the left of the slide's direction.
                y = c - a * np.sin(theta)
                s = a * np.cos(theta) + signs * np.sqrt(b * b - y * y)
                return np.asarray(s - zero - scale * self.outputs)
            # B from the triangle A B O4 over the diagonal f, on the side given by the sign.
            pin = a * np.exp(1j * theta)
            f = np.abs(1.0 - pin)
            x = (f * f + (b - c) * (b + c)) / (2.0 * f)
            joint = pin + (1.0 - pin) / f * (x + 1j * signs * np.sqrt(b * b - x * x))
            # Taking the angle of the quotient wraps the error to half a turn.
            return np.asarray(np.angle((joint - 1.0) * np.exp(-1j * (zero + scale * self.outputs))))

    def signs(self, dimensions: Real) -> Real:
        """Return the assembly signs at inputs whose outputs are met exactly, shape (k, n)."""
        a, _, c, start, zero, k, scale = (dimensions[..., j, None] for j in range(PARAMETER_COUNT))
        pin = a * np.exp(1j * (start + k * self.inputs))
        if self.slides:
            # At inputs that are met, B is known, and its side of A (or of the diagonal) is the assembly.
            return np.asarray(np.sign(zero + scale * self.outputs - pin.real))
        joint = 1.0 + c * np.exp(1j * (zero + scale * self.outputs))
        return np.asarray(np.sign(((1.0 - pin).conj() * (joint - pin)).imag))

    def derivatives(self, dimensions: Real, errors: Real, _sign: float = 0.0) -> Real:
        """Return derivatives of one generator's errors by the steps, shape (n, 7); the errors imply the assembly."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self._differentiate(dimensions, errors)

    def _differentiate(self, dimensions: Real, errors: Real) -> Real:
        a, b, c, start, zero, k, scale = dimensions[:PARAMETER_COUNT]
        theta = start + k * self.inputs
        if self.slides:
            # The slider's true position is the required one plus the error, so no root and no sign are needed.
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
            # Differentiate the component of the loop a e^{iθ} + b e^{iγ} = 1 + c e^{iψ} along the coupler.
            divisor = (1j * c * np.exp(1j * output) * along.conj()).real
            columns = [
                (pin * along.conj()).real / divisor,
                b / divisor,
                -(c * np.exp(1j * output) * along.conj()).real / divisor,
                (1j * pin * along.conj()).real / divisor,
                # A zero shifts the required output, and so the error by the same amount with opposite sign.
                -np.ones_like(theta),
            ]
            turned = columns[3]
        # Derivatives by logarithms of scales: the chain rule multiplies by the scale.
        return np.stack([*columns, turned * k * self.inputs, -scale * self.outputs], axis=-1)

    def apply_step(self, dimensions: Real, step: Real) -> Real:
        """Apply a step to a generator: multiply lengths and scales by exponentials, add to the rest."""
        found = dimensions.copy()
        # The slide's offset may be negative or zero, so it has no logarithm.
        logs = [0, 1, 5, 6] if self.slides else [0, 1, 2, 5, 6]
        adds = [2, 3, 4] if self.slides else [3, 4]
        found[logs] *= np.exp(step[logs])
        found[adds] += step[adds]
        # Size, direction and position of a placed linkage are already logarithms, angles and shares.
        found[PARAMETER_COUNT:] += step[PARAMETER_COUNT:]
        return found
