"""Kernels of sixbar function generators: against the core and differences; and descents along curved valleys."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from synthesis.kinds.function.fourbar.task import make_function_task
from synthesis.kinds.function.sixbar import kernels
from synthesis.kinds.function.sixbar import residuals as fit
from synthesis.kinds.function.sixbar.descents import TYPE_NUMBERS, SixbarCandidate
from synthesis.kinds.function.sixbar.followers import follow_sixbar
from synthesis.kinds.function.sixbar.link_lengths import MAX_LENGTHS, compute_log_lengths
from synthesis.kinds.function.sixbar.mechanism import build_function_sixbar
from synthesis.numerics.geodesic import follow_valley
from synthesis.numerics.levenberg import descend
from tests.support.synthesis.function_tasks import FunctionProblem

TASK = make_function_task(
    FunctionProblem(kind="function", function={"name": "sine", "x": [0.0, 90.0]}, input_range=60.0, output_range=60.0)
)
U = np.linspace(0.0, 1.0, 25)
V = TASK.problem.function.share_along(U)


def drawn(kind: int, seed: int) -> SixbarCandidate:
    """A random sixbar that goes through the whole range with transmission angles of 25°."""
    rng = np.random.default_rng(seed)
    own, logs = kernels.IS_USED[kind], kernels.IS_LOGARITHMIC[kind]
    name = next(name for name, number in TYPE_NUMBERS.items() if number == kind)
    while True:
        at = np.zeros(kernels.ROW_SIZE)
        at[own] = rng.uniform(-1.5, 1.5, int(own.sum()))
        at[logs] = np.exp(at[logs] / 2.0)
        at[[kernels.K, kernels.L]] = math.radians(60.0)
        at[-1] = rng.uniform(-math.pi, math.pi) if kind == kernels.STEPHENSON_2 else 0.0
        assembly = int(rng.integers(4))
        there = follow_sixbar(kind, assembly, at, U, V)
        if math.isfinite(there.tau) and np.abs(there.cosines).max() < math.cos(math.radians(25.0)):
            at[-1] = there.tau if kind == kernels.STEPHENSON_2 else 0.0
            return SixbarCandidate(name, assembly, at, 0.0)


def stepped(found: SixbarCandidate, n: int, step: float) -> np.ndarray:
    at = found.at.copy()
    at[n] = at[n] * math.exp(step) if kernels.IS_LOGARITHMIC[TYPE_NUMBERS[found.type], n] else at[n] + step
    return at


@pytest.mark.parametrize("kind", range(3))
@pytest.mark.parametrize("seed", range(3))
def test_errors_and_transmission_are_those_of_the_driven_linkage(kind, seed):
    found = drawn(kind, seed)
    mechanism, dials = build_function_sixbar(TASK, found)
    there = follow_sixbar(kind, found.assembly, found.at, U, V)
    joints = {name: complex(*place) for name, place in mechanism.skeleton.joints.items()}
    linkage = catalogue.make_sixbar(found.type, joints)
    inputs = np.radians(dials.input.place + dials.input.scale * (90.0 * U - dials.input.at))
    motion = drive(linkage, inputs - math.tau * round((inputs[0] - float(linkage.reference_input)) / math.tau), order=0)
    assert motion.valid.all()
    wanted = np.radians(dials.output.place + dials.output.scale * (np.sin(np.radians(90.0 * U)) - dials.output.at))
    off = np.angle(np.exp(1j * (motion.angles["output"][0] - wanted - there.errors)))
    assert np.abs(off).max() < 1e-9
    least = min(float(np.abs(sine).min()) for sine in motion.sines.values())
    assert math.sqrt(1.0 - np.abs(there.cosines).max() ** 2) == pytest.approx(least, abs=1e-9)


@pytest.mark.parametrize("kind", range(3))
def test_derivatives_are_those_of_differences(kind):
    found, step = drawn(kind, 7), 1e-6
    there = follow_sixbar(kind, found.assembly, found.at, U, V, 0.0)
    for n in np.flatnonzero(kernels.IS_USED[kind]):
        ends = [follow_sixbar(kind, found.assembly, stepped(found, n, side), U, V) for side in (step, -step)]
        assert there.slopes[:, n] == pytest.approx((ends[0].errors - ends[1].errors) / (2.0 * step), abs=1e-6)
        by = (ends[0].cosines - ends[1].cosines) / (2.0 * step)
        assert there.by_cosine[:, :, n] == pytest.approx(by, abs=2e-4)


def lengths(kind: int, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    logs, slopes = np.empty(MAX_LENGTHS), np.empty((MAX_LENGTHS, kernels.ROW_SIZE))
    count = compute_log_lengths(kind, at, logs, slopes)
    return logs[:count], slopes[:count]


@pytest.mark.parametrize("kind", range(3))
@pytest.mark.parametrize("seed", range(3))
def test_lengths_are_all_distances_between_pins_of_a_link(kind, seed):
    found = drawn(kind, seed)
    mechanism, _ = build_function_sixbar(TASK, found)
    logs, _ = lengths(kind, found.at)
    whole = mechanism.links
    if kind == kernels.WATT_2:
        # The ternary link in the middle holds both fourbars; how they stand to one another is chosen later.
        one, other = (
            [whole[name] for name in names]
            for names in (
                ("ground", "input", "coupler", "rocker"),
                ("ground_side", "rocker_arm", "link_5", "output"),
            )
        )
        for part, stands in ((one, logs[:4]), (other, logs[4:])):
            assert np.sort(np.log(part) - math.log(part[0])) == pytest.approx(np.sort(stands - stands[0]), abs=1e-9)
        return
    scale = math.log(whole["ground"])
    assert np.sort(np.log(list(whole.values())) - scale) == pytest.approx(np.sort(logs), abs=1e-9)


@pytest.mark.parametrize("kind", range(3))
def test_derivatives_of_lengths_are_those_of_differences(kind):
    found, step = drawn(kind, 7), 1e-6
    _, slopes = lengths(kind, found.at)
    for n in range(kernels.ROW_SIZE):
        ends = [lengths(kind, stepped(found, n, side))[0] for side in (step, -step)]
        assert slopes[:, n] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), abs=1e-8)


def test_a_curved_valley_is_followed_to_its_end():
    # The sixbar's own function, from a fifth of its lengths away: the least squares are nothing at the end of a valley.
    found = drawn(kernels.WATT_2, 2)
    kind = TYPE_NUMBERS[found.type]
    there = follow_sixbar(kind, found.assembly, found.at, U, V)
    points = np.stack([U, V + there.errors / found.at[kernels.L], np.full(len(U), 0.2), np.zeros(len(U))])
    start = found.at.copy()
    logs = kernels.IS_LOGARITHMIC[kind]
    start[logs] = np.log(start[logs])
    open_ = kernels.IS_USED[kind].copy()
    open_[[kernels.K, kernels.L]] = False
    start[open_] += np.random.default_rng(0).normal(0.0, 0.2, int(open_.sum()))
    setting = np.zeros(fit.SETTING.size)
    setting[[fit.KIND, fit.ASSEMBLY, fit.SIGN_K, fit.SIGN_L]] = kind, found.assembly, 1.0, 1.0
    setting[[fit.COSINE, fit.RATIO]], setting[fit.FREE] = (2.0, 99.0), open_
    ends = []
    for method, more in ((descend, (300, 1e-15)), (follow_valley, (300,))):
        x = start.copy()
        ended = method(
            fit.evaluate_rows, x, points, setting, np.zeros(1), np.zeros(1), fit.count_max_rows(len(U)), *more
        )
        ends.append(ended[0] if isinstance(ended, tuple) else ended)
    # Half a sum of squares: 1e-20 is a rms error of a ten-billionth of a radian.
    assert ends[1] < 1e-20
    assert ends[1] < 1e-3 * ends[0]
