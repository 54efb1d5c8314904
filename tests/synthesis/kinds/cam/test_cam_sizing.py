"""Sizing against brute force over radii and angles, against closed forms, and against the literature."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment
from synthesis.kinds.cam.sizing.critical_points import find_critical_motion
from synthesis.kinds.cam.sizing.sizing import (
    RollerLimits,
    search_offset,
    search_pivot,
    size_oscillating_flat,
    size_oscillating_roller,
    size_translating_flat,
    size_translating_roller,
)
from tests.campaign import sampled
from tests.support.synthesis.cam_sampling import dense_motion, first_sound, oscillating, random_program, translating

AGREES = 1e-6


def keeps(angle: np.ndarray, kappa: np.ndarray, v: np.ndarray, limits: RollerLimits) -> bool:
    steep = (angle[v >= 0.0] <= limits.rise).all() and (angle[v <= 0.0] <= limits.fall).all()
    return bool(steep and (np.abs(kappa) * limits.pitch_radius <= 1.0).all())


def random_limits(rng: np.random.Generator, radius: float) -> RollerLimits:
    rise, fall = np.radians(rng.uniform(20.0, 45.0, 2))
    return RollerLimits(float(rise), float(fall), radius * float(rng.uniform(0.0, 2.0)), 0.05)


def check_translating(seed: int) -> None:
    rng = np.random.default_rng(seed)
    program = random_program(rng, 1.0)
    offset = float(rng.choice([0.0, rng.uniform(-0.5, 0.5)]))
    limits = random_limits(rng, 1.0)
    size = size_translating_roller(program, offset, limits)
    start = max(limits.least, abs(offset)) + 1e-6
    stop = 1.5 * (size.radius if size else 30.0)
    brute = first_sound(program, lambda r, m: keeps(*translating(m, r, offset), m.v, limits), start, stop)
    if size is None:
        assert brute is None
        return
    assert brute is not None
    assert size.radius == pytest.approx(brute, abs=AGREES * size.radius)


def check_oscillating(seed: int) -> None:
    rng = np.random.default_rng(seed)
    program = random_program(rng, math.radians(rng.uniform(8.0, 25.0)))
    arm, sense = 1.0, int(rng.choice([-1, 1]))
    pivot = float(rng.uniform(0.8, 1.8))
    limits = random_limits(rng, 0.15)
    size = size_oscillating_roller(program, arm, pivot, sense, limits)
    start, stop = max(abs(arm - pivot), limits.least) + 1e-5, arm + pivot - 1e-5

    def sound(radius: float, motion: Motion) -> bool:
        psi = math.acos((pivot**2 + arm**2 - radius**2) / (2.0 * pivot * arm))
        return psi + motion.s.max() < math.pi and keeps(
            *oscillating(motion, radius, arm, pivot, sense), motion.v, limits
        )

    brute = first_sound(program, sound, start, stop if size is None else min(stop, 1.5 * size.radius))
    if size is None:
        assert brute is None
        return
    assert brute is not None
    assert size.radius == pytest.approx(brute, abs=max(AGREES * size.radius, 2e-5 * (size.radius <= start + 2e-5)))


def face_sweep(program: Program) -> float:
    """Length that the contact sweeps on a translating face: greatest less least v, whatever the base radius."""
    velocity = program.peaks[1]
    return velocity.greatest - velocity.least


def check_flat(seed: int) -> None:
    rng = np.random.default_rng(seed)
    motion = dense_motion(program := random_program(rng, 1.0))
    radius = float(rng.uniform(0.0, 1.0))
    brute = max(radius - float((motion.s + motion.a).min()), 0.01)
    assert size_translating_flat(program, radius, 0.01).radius == pytest.approx(brute, abs=AGREES * brute)
    assert face_sweep(program) == pytest.approx(float(np.ptp(motion.v)), abs=1e-6)
    swing = random_program(rng, math.radians(rng.uniform(5.0, 15.0)))
    sense, pivot, face = int(rng.choice([-1, 1])), 3.0, float(rng.uniform(-0.3, 0.3))
    size = size_oscillating_flat(swing, pivot, face, sense, 0.4, 0.05, None)

    def sound(base: float, motion: Motion) -> bool:
        psi = math.asin((base + face) / pivot) + motion.s
        if psi.max() >= 0.5 * math.pi or (pivot * np.sin(psi) < max(face, 0.0)).any():
            return False
        # The face's line in the cam's frame as an envelope: h(α) by finite differences of its support function.
        rate = 1.0 - sense * motion.v
        h1 = pivot * np.cos(psi) * motion.v / rate
        slope = pivot * (motion.a * np.cos(psi) - motion.v**2 * np.sin(psi)) / rate
        turned = pivot * np.cos(psi) * motion.v * (sense * motion.a) / rate**2
        assert h1.shape == slope.shape
        rho = pivot * np.sin(psi) - face + (slope + turned) / rate
        return bool((rho >= 0.4).all())

    stop = pivot - face - 1e-6 if size is None else min(1.2 * size.radius, pivot - face - 1e-6)
    claimed = None if size is None else size.radius * (1.0 + 1e-7)
    brute_base = first_sound(swing, sound, max(0.05, 1e-6 - face), stop, claimed)
    assert (size is None) == (brute_base is None)
    if size is not None and brute_base is not None:
        assert size.radius == pytest.approx(brute_base, abs=AGREES * max(size.radius, 1.0))


@pytest.mark.parametrize("seed", range(4))
def test_translating_roller_against_brute_force(seed):
    check_translating(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_oscillating_roller_against_brute_force(seed):
    check_oscillating(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_flat_faces_against_brute_force(seed):
    check_flat(seed)


@pytest.mark.campaign
@pytest.mark.parametrize("block", range(sampled(50)))
def test_two_hundred_random_programs_and_followers(block):
    for seed in range(1000 + 4 * block, 1004 + 4 * block):
        (check_translating, check_translating, check_oscillating, check_flat)[seed % 4](seed)


def one_rise(law: str, degrees: float, lift: float, fall_degrees: float = 150.0) -> Program:
    up, down = math.radians(degrees), math.radians(fall_degrees)
    rest = 0.5 * (2.0 * math.pi - up - down)
    return Program(
        [
            build_law_segment(LAWS[law], up, 0.0, lift),
            build_dwell(rest, lift),
            build_law_segment(LAWS[law], down, lift, 0.0),
            build_dwell(rest, 0.0),
        ]
    )


def test_literature_prime_radii():
    """Rao: the nomogram's cycloidal rise of 2 in 60° at 30°, and the eighth-power rise of SP 5.7 at 45°."""
    limits = RollerLimits(math.radians(30.0), math.radians(30.0), 0.0, 0.1)
    assert size_translating_roller(one_rise("cycloidal", 60.0, 2.0), 0.0, limits).radius == pytest.approx(
        5.67701748, rel=1e-8
    )
    wide = RollerLimits(math.radians(45.0), math.radians(45.0), 0.0, 0.1)
    assert size_translating_roller(one_rise("eighth_power", 30.0, 1.0), 0.0, wide).radius == pytest.approx(
        2.93307636, rel=1e-8
    )


def test_flat_example_of_rao():
    """§5.5: harmonic, 4 cm in 90° each way: base radius 4, width 8."""
    quarter = 0.5 * math.pi
    law = LAWS["simple_harmonic"]
    program = Program(
        [
            build_law_segment(law, quarter, 0.0, 4.0),
            build_dwell(quarter, 4.0),
            build_law_segment(law, quarter, 4.0, 0.0),
            build_dwell(quarter, 0.0),
        ]
    )
    assert size_translating_flat(program, 0.0, 0.1).radius == pytest.approx(4.0, rel=1e-8)
    assert face_sweep(program) == pytest.approx(8.0, rel=1e-12)


@pytest.mark.campaign
def test_the_best_offset_beats_its_neighbours():
    """Against a grid of offsets: by pressure angle alone proven, with curvature at least as good as the grid."""
    program = one_rise("modified_sine", 60.0, 1.0, 110.0)
    for radius, proven in ((0.0, True), (1.5, False)):
        limits = RollerLimits(math.radians(30.0), math.radians(40.0), radius, 0.1)
        size = search_offset(program, limits, (-1.5, 1.5))
        assert size.proven is proven
        around = [size_translating_roller(program, float(e), limits) for e in np.linspace(-1.5, 1.5, 21)]
        best = min(found.radius for found in around if found is not None)
        assert size.radius <= best * (1.0 + 1e-8)
        assert size.radius >= 0.97 * best
        assert size.free == pytest.approx(size.free)
        again = size_translating_roller(program, size.free, limits)
        assert again.radius == pytest.approx(size.radius, rel=1e-6)


@pytest.mark.campaign
def test_the_best_pivot_beats_its_neighbours():
    program = one_rise("cycloidal", 120.0, math.radians(20.0))
    limits = RollerLimits(math.radians(30.0), math.radians(30.0), 0.5, 0.1)
    size = search_pivot(program, 5.0, (3.0, 9.0), 1, limits)
    grid = [size_oscillating_roller(program, 5.0, float(c), 1, limits) for c in np.linspace(3.0, 9.0, 31)]
    assert size.radius <= min(found.radius for found in grid if found is not None) * (1.0 + 1e-9)
    assert not size.proven


def test_a_face_too_narrow_needs_another_start_angle():
    program = one_rise("cycloidal", 120.0, math.radians(15.0))
    free = size_oscillating_flat(program, 6.0, 0.2, 1, 0.5, 0.1, None)
    motion = find_critical_motion(program, lambda m: m.v)

    def sweep(base: float) -> float:
        psi = math.asin((base + 0.2) / 6.0) + dense_motion(program).s
        return float(np.ptp(6.0 * np.cos(psi) / (1.0 - dense_motion(program).v)))

    assert motion.s.max() > 0.0
    width = 0.98 * sweep(free.radius)
    narrow = size_oscillating_flat(program, 6.0, 0.2, 1, 0.5, 0.1, width)
    assert narrow.radius > free.radius
    assert sweep(narrow.radius) <= width * (1.0 + 1e-6)


def test_no_radius_is_sound():
    """A swing so fast that no start angle keeps the pressure angle."""
    program = one_rise("cycloidal", 25.0, math.radians(60.0))
    limits = RollerLimits(math.radians(20.0), math.radians(20.0), 0.0, 0.1)
    assert size_oscillating_roller(program, 5.0, 6.0, -1, limits) is None
