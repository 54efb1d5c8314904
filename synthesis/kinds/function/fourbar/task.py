"""Numerical form of a function-generation problem, and conversion of a solver's linkage to a mechanism with dials.

Solvers work with ground 1 (slider-cranks: with the slider's range as unit) and radians. Inputs and outputs are φ and ψ
for scale 1: rotations of pairs, or shares of a function's range; the scales multiply them.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.fit.fourbar_forces import pack_forces
from synthesis.fit.placement_in_workspace import MovingFourbar, place_in_workspace
from synthesis.fit.placement_under_forces import place_under_forces
from synthesis.kinds.function.design import Dials, InputDial, OutputDial
from synthesis.kinds.function.fourbar.closure import Closure, select_closure
from synthesis.kinds.function.fourbar.structural_error import PARAMETER_COUNT, Generators
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.model.linkage.answer import FourbarMechanism, SliderCrankMechanism
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar, build_slider_crank, to_complex
from synthesis.results.placement import convert_regions, find_placement

ScaleRange = tuple[float, float]

DEFAULT_GROUND_LENGTH = 100.0
"""Default length of the ground link, length units."""

SAMPLE_COUNT = 121
"""Number of inputs at which an approximation is fitted, denser towards the ends of the range."""


class FunctionTask(NamedTuple):
    """Numerical form of a problem.

    Attributes
    ----------
    inputs, outputs : float, shape (n,)
        Pairs or precision points.
    sample_inputs, sample_outputs : float, shape (m,)
        Samples that an approximation follows: the whole range, or the pairs.
    zeros : pair of float or None
        Positions of the links at input 0 and output 0; None for an open zero.
    scales : pair of list of (low, high)
        Permitted intervals of each scale; both ends are equal for a given scale.
    unit : float
        Unit of the slider's positions, length units; 1 for a fourbar.
    """

    problem: FunctionProblem
    closure: Closure
    inputs: Real
    outputs: Real
    sample_inputs: Real
    sample_outputs: Real
    zeros: tuple[float | None, float | None]
    scales: tuple[list[ScaleRange], list[ScaleRange]]
    unit: float

    @property
    def free(self) -> NDArray[np.bool_]:
        """Mask of the open parameters among a generator's seven."""
        zeros = [zero is None for zero in self.zeros]
        scales = [any(low < high for low, high in choice) for choice in self.scales]
        return np.array([True, True, True, *zeros, *scales])

    def points(self) -> Generators:
        """Return the generators at the pairs or precision points."""
        return Generators(self.problem.slides, self.inputs, self.outputs)

    def samples(self) -> Generators:
        """Return the generators at the samples that an approximation follows."""
        return Generators(self.problem.slides, self.sample_inputs, self.sample_outputs)


def make_function_task(problem: FunctionProblem) -> FunctionTask:
    """Convert a problem to its numerical form."""
    zeros = problem.zero_choice
    radians = math.pi / 180.0
    if problem.pairs is not None:
        given = problem.values
        unit = float(np.ptp(given[:, 1])) if problem.slides else 1.0
        # With an open zero only differences matter; subtracting the first value keeps small numbers exact.
        given = given - np.where([zero is None for zero in zeros], given[0], 0.0)
        inputs, outputs = given[:, 0] * radians, given[:, 1] * (1.0 / unit if problem.slides else radians)
        choices = tuple(
            # An open scale has one interval, a given one an interval of no length.
            [problem.open_scale(side)] if scale is None else [(scale, scale)]
            for side, scale in enumerate(problem.scale_choice)
        )
        samples = inputs, outputs
        begins = 0.0, 0.0
    else:
        function = problem.function
        assert function is not None
        # Five points suffice as the targets of an approximation, which is judged by its samples.
        inputs = problem.precision_shares if problem.aim == "precision" else np.linspace(0.0, 1.0, 5)
        dense = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, SAMPLE_COUNT))
        outputs = function.share_along(inputs)
        samples = dense, function.share_along(dense)
        # A slider's positions are measured in its range, so that they are of the order of the ground of a fourbar.
        unit = abs(problem.span("output") or 1.0) if problem.slides else 1.0
        choices = (_list_ranges(problem, "input"), _list_ranges(problem, "output"))
        begins = problem.first_value("input"), problem.first_value("output")
    first = None if zeros[0] is None else (zeros[0] + begins[0]) * radians
    second = None if zeros[1] is None else (zeros[1] + begins[1]) * (1.0 / unit if problem.slides else radians)
    return FunctionTask(
        problem,
        select_closure(problem.slides),
        inputs,
        outputs,
        *samples,
        (first, second),
        (choices[0], choices[1]),
        unit,
    )


def _list_ranges(problem: FunctionProblem, side: str) -> list[ScaleRange]:
    """List the permitted ranges of a side, radians or slider units: given, both directions, or between limits."""
    span = problem.span("input" if side == "input" else "output")
    # Without a given output span both directions of the output are possible.
    both = side == "output" and (span is None or problem.either_direction)
    if span is None:
        low, high = (math.radians(limit) for limit in problem.range_limits)
        # The intervals must not contain zero, so one for each sign.
        return [(low, high), (-high, -low)] if both else [(low, high)]
    # Slider units are the range itself, so only its sign is left.
    given = math.copysign(1.0, span) if side == "output" and problem.slides else math.radians(span)
    return [(given, given), (-given, -given)] if both else [(given, given)]


def build_mechanism(
    task: FunctionTask, generator: Real, sign: float
) -> tuple[FourbarMechanism | SliderCrankMechanism, Dials]:
    """Build the mechanism of a solver's generator, at the first target, and its dials.

    Parameters
    ----------
    task : FunctionTask
        The task.
    generator : float, shape (7,) or (11,)
        With or without a placement, which is chosen anew. See :mod:`synthesis.kinds.function.fourbar.structural_error`.
    sign : float
        Its assembly.
    """
    problem = task.problem
    # The square roots are clipped at 0: at a dead centre rounding may make them slightly negative.
    a, b, c, start, _, k, _ = (float(x) for x in generator[:PARAMETER_COUNT])
    # The mechanism is drawn at its first target.
    place = float(task.inputs[0])
    theta = start + k * place
    pin = cmath.rect(a, theta)
    if problem.slides:
        joint = complex(a * math.cos(theta) + sign * math.sqrt(max(b * b - (c - pin.imag) ** 2, 0.0)), c)
    else:
        f = abs(1.0 - pin)
        x = (f * f + (b - c) * (b + c)) / (2.0 * f)
        joint = pin + (1.0 - pin) / f * complex(x, sign * math.sqrt(max(b * b - x * x, 0.0)))
    turns = start + k * np.array([task.sample_inputs.min(), task.sample_inputs.max()])
    origin, along = _place_linkage(task, MovingFourbar(np.array([1.0, a, b, c]), sign, turns, theta), pin, joint)
    pin, joint = origin + along * pin, origin + along * joint
    frame = math.degrees(cmath.phase(along))
    dials = make_dials(task, generator, frame, 0.0 if problem.slides else frame)
    if problem.slides:
        return build_slider_crank(origin, pin, joint, cmath.phase(along), pin), dials
    return build_fourbar(FourbarConfiguration(origin, pin, joint, origin + along, pin)), dials


def make_dials(task: FunctionTask, generator: Real, frame: float, turned: float) -> Dials:
    """Make the dials of a generator whose input and output are measured from lines at the given angles, degrees.

    ``generator`` starts with the seven parameters of a fourbar or a slider-crank.
    """
    problem = task.problem
    start, zero, k, scale = (float(x) for x in generator[3:PARAMETER_COUNT])
    to_input = 180.0 / math.pi
    # Sliders report positions in length units, cranks in degrees.
    to_output = task.unit if problem.slides else to_input
    if problem.pairs is not None:
        shift = [
            # With an open zero the dial starts at the first pair, because the task counts from it.
            value if zero is None else 0.0
            for value, zero in zip((problem.pairs[0].input, problem.pairs[0].output), task.zeros, strict=True)
        ]
        return Dials(
            input=InputDial(at=shift[0], place=frame + start * to_input, scale=k),
            output=OutputDial(at=shift[1], place=turned + zero * to_output, scale=scale),
        )
    function = problem.function
    assert function is not None
    low, high = function.interval
    least, greatest = function.find_extent()
    first = float(function.values(np.array([low]))[0])
    return Dials(
        input=InputDial(at=low, place=frame + start * to_input, scale=k * to_input / (high - low)),
        output=OutputDial(
            at=first,
            place=turned + zero * to_output,
            # A falling function turns the output's scale around.
            scale=scale * to_output * function.direction / (greatest - least),
        ),
    )


def _place_linkage(task: FunctionTask, linkage: MovingFourbar, pin: complex, joint: complex) -> tuple[complex, complex]:
    """Place a linkage: return O2, and the image of the solver's unit vector along the ground line or the slide.

    ``pin`` and ``joint`` are A and B in the solver's frame.
    """
    problem = task.problem
    if problem.fixed_pivots is not None:
        o2 = to_complex(problem.fixed_pivots.input)
        along = to_complex(problem.fixed_pivots.output) - o2
        return o2, along / abs(along) * task.unit if problem.slides else along
    constraints, lengths = problem.constraints, [float(length) for length in linkage.lengths]
    fixed, sized = ([0j], None) if problem.slides else ([0j, 1 + 0j], lengths)
    preferred = complex(task.unit if problem.slides else DEFAULT_GROUND_LENGTH)
    found = find_placement(constraints, fixed, [pin, joint], sized, preferred)
    limits = constraints.link_length
    least = 0.0 if limits is None else limits.min / min(lengths)
    most = math.inf if limits is None or limits.max is None else limits.max / max(lengths)
    if problem.space is not None and not problem.slides:
        regions = [constraints.fixed_pivot_region] * 2 + [constraints.moving_pivot_region] * 2
        found = place_in_workspace(problem.space, linkage, convert_regions(regions), (least, most), found) or found
    elif constraints.force_limits and not problem.slides:
        forces = pack_forces(problem.dynamics, constraints.force_limits, problem.length_unit, 0j, 1.0)
        bound = constraints.fixed_pivot_region is not None or constraints.moving_pivot_region is not None
        if len(forces) and not bound:
            found = place_under_forces(forces, linkage, (least, most), found)
    return found.origin, found.along
