"""Drag-link sixbars: a drag link turns a second crank unevenly, which drives a rocker or a slider with equal strokes.

The second crank O4–B turns by half a turn in each stroke, from ψ0 on, and the input by α = 2π/(T + 1) in the fast one
(Norton, Example 3-10). With the ground d = 1 as the shortest link a drag link's minimum transmission angle is

    cos μ = (|b² + c² − a² − 1| + 2a)/2bc,

which is smallest for given a and c at b² = a² + 1 − c². For c between 1 and √((a² + 1)/2) this value then falls as c
increases, while the time ratio of the best ψ0 rises. So c follows from T for each a, and a is found by a search in one
dimension. For time ratios below about 2.2 the transmission angle grows with a without end, so that a limit of the link
ratio determines a.

The dyad: a slider whose slide passes through O4 along ψ0, of stroke 2c; or the rocker of a central crank-rocker of
swing ψ, with c/sin(ψ/2) as its length and its transmission angle below π/2 − ψ/2.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from kinematics.compiling import njit
from kinematics.message import compose
from synthesis.kinds.quick_return.design import DragLinkMechanism, RatioRange
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.model.linkage.conversion import build_skeleton, build_slide, to_point

MAX_LINK_RATIOS = (10.0, 6.0, 4.0, 3.0, 2.0)
"""Maximum link ratios of the drag links that are searched."""

MIN_INPUT_LENGTH = 1.0 + 1e-4
"""Minimum length of the input that is searched, in grounds. With an input as long as the ground the linkage is always
close to a change point."""

DIRECTION_COUNT = 90
"""Number of directions ψ0 that are evaluated first."""

GOLDEN_RATIO, SECTION_COUNT = 0.6180339887498949, 40
"""Share of the interval that a golden section keeps, and number of sections, which reduce it to 4e-9 of its length."""

LENGTH_COUNT = 25
"""Number of lengths of the input that are evaluated first."""

LENGTH_SEPARATION = 1e-3
"""Drag links whose inputs differ by less than this, in grounds, are duplicates."""

LENGTH_TOLERANCE = 1e-9
"""Tolerance of the best length of the input, in grounds; the transmission angle is flat at its maximum."""

RATIO_MARGIN = 1e-8
"""Share by which the drag link's maximum time ratio exceeds the required one, so that some ψ0 gives that exactly."""

SLIDER_DYAD_ANGLE = math.radians(75.0)
"""Transmission angle of the slider's dyad, radians, unless a larger one is required."""

ROCKER_DYAD_RATIO = 3.0
"""Link 5 over the second crank of a rocker's dyad, unless a transmission angle requires a longer one."""


class DragLink(NamedTuple):
    """A drag link at the beginning of its slow stroke.

    Lengths are in units of the ground. ``start`` is the direction of the second crank, ``input_angle`` that of the
    input, both in radians from the line O2 → O4.
    """

    input: float
    coupler: float
    output: float
    start: float
    input_angle: float

    @property
    def transmission(self) -> float:
        """The minimum transmission angle, radians."""
        a, b, c = self.input, self.coupler, self.output
        return math.acos(min((abs(b * b + c * c - a * a - 1.0) + 2.0 * a) / (2.0 * b * c), 1.0))


def compute_slider_range(problem: QuickReturnProblem) -> RatioRange:
    """Return the time ratios of drag-link sixbars with a slider: all."""
    reason = compose("quick_return-drag-link-unlimited")
    return RatioRange(
        type="drag_link_slider", least=1.0, least_included=True, greatest=None, reaches=True, reason=reason
    )


def compute_rocker_range(problem: QuickReturnProblem) -> RatioRange:
    """Return the time ratios of drag-link sixbars with a rocker: all, for a swing below half a turn."""
    swings = problem.swing is not None and problem.swing < 180.0
    return RatioRange(
        type="drag_link_rocker",
        least=1.0,
        least_included=swings,
        greatest=None if swings else 1.0,
        reaches=swings,
        reason=compose("quick_return-drag-link-unlimited")
        if swings
        else compose("quick_return-drag-link-rocker-swing"),
    )


def build_drag_link_sliders(problem: QuickReturnProblem) -> list[DragLinkMechanism]:
    """Return drag-link sixbars with a slider, one for each limit of the drag link's lengths."""
    assert problem.stroke is not None
    demanded = math.radians(problem.constraints.min_transmission_angle or 0.0)
    mechanisms = []
    for drag in _find_drag_links(problem):
        scale = 0.5 * problem.stroke / drag.output
        link = drag.output / math.cos(max(SLIDER_DYAD_ANGLE, demanded)) * (1.0 + 1e-12)
        turn = cmath.exp(1j * (math.radians(problem.direction) - drag.start))
        end = cmath.exp(1j * drag.start) * (drag.output + link)
        mechanisms.append(_build_mechanism(problem, drag, scale, turn, link, 1.0 + end, None))
    return mechanisms


def build_drag_link_rockers(problem: QuickReturnProblem) -> list[DragLinkMechanism]:
    """Return drag-link sixbars with a rocker, one for each limit of the drag link's lengths."""
    assert problem.swing is not None
    demanded = math.radians(problem.constraints.min_transmission_angle or 0.0)
    half = math.radians(0.5 * problem.swing)
    sine, rho = math.sin(half), ROCKER_DYAD_RATIO
    # cos² μ = sin²(ψ/2) + cos²(ψ/2)/ρ²
    room = (math.cos(demanded) - sine) * (math.cos(demanded) + sine)
    if room > 0.0:
        rho = max(rho, math.cos(half) / math.sqrt(room) * (1.0 + 1e-9))
    mechanisms = []
    for drag in _find_drag_links(problem):
        c = drag.output
        along = cmath.exp(1j * drag.start)
        o6 = 1.0 + along * c * complex(rho, math.sqrt((1.0 / sine - 1.0) * (1.0 / sine + 1.0)))
        c_pin = 1.0 + along * c * (rho + 1.0)
        lengths = [1.0, drag.input, drag.coupler, c, rho * c, c / sine, abs(o6 - 1.0)]
        scale = problem.compute_scale(min(lengths), max(lengths), c / sine)
        turn = cmath.exp(1j * math.radians(problem.direction))
        mechanisms.append(_build_mechanism(problem, drag, scale, turn, rho * c, c_pin, o6))
    return mechanisms


def _find_drag_links(problem: QuickReturnProblem) -> list[DragLink]:
    limit = problem.constraints.max_link_ratio
    # The limit itself is tried as well: transmission usually improves with the ratio.
    ratios = [ratio for ratio in MAX_LINK_RATIOS if limit is None or ratio < limit] + ([] if limit is None else [limit])
    drag_links: list[DragLink] = []
    for ratio in sorted(ratios, reverse=True):
        best = find_drag_link(problem.time_ratio, ratio)
        if best is not None and all(abs(best.input - kept.input) > LENGTH_SEPARATION for kept in drag_links):
            drag_links.append(best)
    return drag_links


def find_drag_link(time_ratio: float, link_ratio: float) -> DragLink | None:
    """Find the drag link of the best transmission angle whose second crank turns half a turn with a time ratio.

    Parameters
    ----------
    time_ratio : float
        At least 1.
    link_ratio : float
        Maximum of the longest link over the ground, above 1.

    Returns
    -------
    DragLink or None
        None if no drag link within the limit of the link ratio has the time ratio.
    """
    if link_ratio <= MIN_INPUT_LENGTH:
        return None
    lengths = np.exp(np.linspace(math.log(MIN_INPUT_LENGTH), math.log(link_ratio), LENGTH_COUNT))
    # The grid brackets the minimum, which a bounded search then refines.
    cosines = [_compute_cosine(a, time_ratio) for a in lengths]
    k = int(np.argmin(cosines))
    # No length has the time ratio.
    if cosines[k] > 1.0:
        return None
    a = float(lengths[k])
    low, high = float(lengths[max(k - 1, 0)]), float(lengths[min(k + 1, LENGTH_COUNT - 1)])
    closer = minimize_scalar(
        _compute_cosine, bounds=(low, high), args=(time_ratio,), method="bounded", options={"xatol": LENGTH_TOLERANCE}
    )
    if closer.fun < cosines[k]:
        a = float(closer.x)
    c = _find_output(a, time_ratio)
    assert c is not None
    start = _find_start(a, c, time_ratio)
    if start is None:
        return None
    return DragLink(a, math.sqrt((a - c) * (a + c) + 1.0), c, start, _compute_input_angle(a, c, start))


def _compute_cosine(a: float, time_ratio: float) -> float:
    """Return cos μ of the best drag link with an input of length a; 2 if none has the time ratio."""
    c = _find_output(a, time_ratio)
    return 2.0 if c is None else a / (c * math.sqrt((a - c) * (a + c) + 1.0))


def _find_output(a: float, time_ratio: float) -> float | None:
    """Return the longest second crank with which an input of length a has the time ratio."""
    wanted = time_ratio * (1.0 + RATIO_MARGIN)
    high = math.sqrt(0.5 * (a * a + 1.0))
    # At c = 1 exactly the drag link has a change point.
    low = 1.0 + (high - 1.0) * 1e-6
    if _compute_max_ratio(a, high) >= wanted:
        return high
    if not _compute_max_ratio(a, low) > wanted:
        return None
    return float(brentq(lambda c: _compute_max_ratio(a, c) - wanted, low, high, xtol=1e-13, rtol=1e-13))


@njit(cache=True, nogil=True)
def _compute_input_angle(a: float, c: float, direction: float) -> float:
    """Return the input angle at a direction of the second crank, from the line O2 → O4."""
    x, y = 1.0 + c * math.cos(direction), c * math.sin(direction)
    f = math.hypot(x, y)
    along = (f * f + a * a - (a - c) * (a + c) - 1.0) / (2.0 * f)
    # At a change point rounding may put the cosine beyond 1.
    return math.atan2(y, x) + math.acos(min(max(along / a, -1.0), 1.0))


@njit(cache=True, nogil=True)
def _compute_slow_rotation(a: float, c: float, start: float) -> float:
    """Return the input rotation, radians, while the second crank makes half a turn from the direction ``start``."""
    # Both angles are known modulo a full turn; the difference of a drag link is positive.
    return (_compute_input_angle(a, c, start + math.pi) - _compute_input_angle(a, c, start)) % (2.0 * math.pi)


@njit(cache=True, nogil=True)
def _find_slowest_direction(a: float, c: float) -> float:
    """Find the direction of the second crank from which its next half turn takes the longest, by golden section."""
    step = 2.0 * math.pi / DIRECTION_COUNT
    best, most = 0.0, -1.0
    for k in range(DIRECTION_COUNT):
        rotation = _compute_slow_rotation(a, c, k * step)
        if rotation > most:
            best, most = k * step, rotation
    low, high = best - step, best + step
    left, right = high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low)
    at_left, at_right = _compute_slow_rotation(a, c, left), _compute_slow_rotation(a, c, right)
    for _ in range(SECTION_COUNT):
        if at_left > at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN_RATIO * (high - low)
            at_left = _compute_slow_rotation(a, c, left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN_RATIO * (high - low)
            at_right = _compute_slow_rotation(a, c, right)
    return 0.5 * (low + high)


@njit(cache=True, nogil=True)
def _compute_max_ratio(a: float, c: float) -> float:
    slow = _compute_slow_rotation(a, c, _find_slowest_direction(a, c))
    return slow / (2.0 * math.pi - slow)


def _find_start(a: float, c: float, time_ratio: float) -> float | None:
    """Find the direction of the second crank at the beginning of a slow stroke with the time ratio."""
    wanted = 2.0 * math.pi * time_ratio / (time_ratio + 1.0)

    def compute_error(at: float) -> float:
        return _compute_slow_rotation(a, c, at) - wanted

    best = _find_slowest_direction(a, c)
    if compute_error(best) < 0.0:
        return None
    # Half a turn later the slow and the fast stroke are exchanged, so the root is bracketed.
    return float(brentq(compute_error, best, best + math.pi, xtol=1e-15, rtol=1e-15))


def _build_mechanism(
    problem: QuickReturnProblem,
    drag: DragLink,
    scale: float,
    turn: complex,
    link: float,
    c_pin: complex,
    o6: complex | None,
) -> DragLinkMechanism:
    """Build the sixbar at the beginning of its slow stroke.

    ``c_pin`` and ``o6`` are in units of the ground, from O2 with the ground along +x; ``scale`` and ``turn`` (a unit
    vector) convert them to the problem's plane.
    """
    o2 = problem.o2
    local = {
        "O2": 0j,
        "O4": 1.0 + 0j,
        "A": drag.input * cmath.exp(1j * drag.input_angle),
        "B": 1.0 + drag.output * cmath.exp(1j * drag.start),
        "C": c_pin,
    }
    links = [("input", ["O2", "A"]), ("coupler", ["A", "B"]), ("driven_crank", ["O4", "B"]), ("link_5", ["B", "C"])]
    lengths = {"ground": 1.0, "input": drag.input, "coupler": drag.coupler, "driven_crank": drag.output, "link_5": link}
    fixed = ["O2", "O4"]
    if o6 is not None:
        local["O6"] = o6
        links.append(("output", ["O6", "C"]))
        lengths |= {"output": abs(c_pin - o6), "output_ground": abs(o6 - 1.0)}
        fixed.append("O6")
    joints = {name: o2 + scale * turn * z for name, z in local.items()}
    return DragLinkMechanism(
        type="drag_link_slider" if o6 is None else "drag_link_rocker",
        fixed_pivots={name: to_point(joints[name]) for name in fixed},
        links={name: scale * length for name, length in lengths.items()},
        skeleton=build_skeleton(
            joints,
            {"ground": fixed, **dict(links)},
            slides=[build_slide("C", "ground", joints["O4"], cmath.phase(turn) + drag.start)] if o6 is None else [],
        ),
    )
