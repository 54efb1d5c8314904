"""The analysis core: positions, velocities and accelerations a second on one core, and what others do in the same run.

    python -m benchmarks.analysis [--designs 2000] [--angles 360]

Every row does the same work in the same run: designs × input angles of crank-rockers (or slider-cranks whose crank
turns through), the input angles common to all designs. Compiled sweeps stand beside the same formulas in NumPy, over
all designs at once and in chunks that stay in the cache, and beside the compiled stepper of pylinkage where that is
installed. ``Δ`` is the greatest difference from the compiled row above, in units of the linkage's size. The last table
has the processor times of whole analyses, type by type, as the service answers them.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from kinematics.arrays import Real
from kinematics.linkage import slider_crank
from kinematics.linkage.batch import build_sweep
from kinematics.linkage.fourbar import closed_form as fourbar
from kinematics.linkage.fourbar import kernels as fourbar_sweeps
from kinematics.linkage.fourbar.closed_form import Fourbar
from kinematics.linkage.slider_crank import kernels as slider_sweeps
from kinematics.linkage.slider_crank.closed_form import SliderCrank
from synthesis.analyses import parse_request
from tests.kinematics import twins
from tests.support.problems.given_mechanisms import STATED

REPEATS = 9

CHUNK = 32
"""Designs that the NumPy formulas take at a time: their intermediate arrays then stay in the cache."""


def seconds(work: Callable[[], Any]) -> float:
    """Least time of several runs, after one that does not count."""
    work()
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def row(name: str, positions: int, work: Callable[[], Any], difference: float | None = None) -> None:
    rate = positions / seconds(work) / 1e6
    print(f"  {name:<66}{rate:>10.1f}{'' if difference is None else f'{difference:>12.1e}'}")


def crank_rockers(rng: np.random.Generator, n: int) -> Fourbar:
    """Links around Norton's 2, 7, 9, 6, anywhere in the plane."""
    a, b, c, d = (rng.uniform(0.95, 1.05, n) * length for length in (2.0, 7.0, 9.0, 6.0))
    pivot, point = (rng.normal(size=n) + 1j * rng.normal(size=n) for _ in range(2))
    return Fourbar(pivot, pivot + d * np.exp(1j * rng.uniform(-np.pi, np.pi, n)), a, b, c, point)


def slider_cranks(rng: np.random.Generator, n: int) -> SliderCrank:
    pivot, point = (rng.normal(size=n) + 1j * rng.normal(size=n) for _ in range(2))
    angle = rng.uniform(-np.pi, np.pi, n)
    on_slide = pivot + np.exp(1j * angle) * (rng.normal(size=n) + 1j * rng.uniform(-0.5, 0.5, n))
    return SliderCrank(pivot, on_slide, angle, rng.uniform(0.5, 1.0, n), rng.uniform(2.0, 4.0, n), point)


def chunk(linkage: Any, start: int) -> Any:
    fields = linkage.__dataclass_fields__
    return type(linkage)(*(getattr(linkage, name)[start : start + CHUNK] for name in fields))


def fourbar_points_in_numpy(linkage: Fourbar, theta: Real, designs: int) -> NDArray[np.complex128]:
    """Coupler points in real arithmetic with buffers that are used again, ``designs`` at a time."""
    n, m = linkage.input.size, theta.size
    out = np.empty((n, m), np.complex128)
    cosine, sine = np.cos(theta), np.sin(theta)
    kx, ky, dx, dy, square, f, product, term = np.empty((8, designs, m))
    columns = {name: getattr(linkage, name)[:, None] for name in linkage.__dataclass_fields__}
    ground = columns["output_pivot"] - columns["input_pivot"]
    with np.errstate(divide="ignore", invalid="ignore"):
        for start in range(0, n, designs):
            at = slice(start, start + designs)
            a, b, c = (columns[name][at] for name in ("input", "coupler", "output"))
            origin, arm, base = columns["input_pivot"][at], columns["coupler_point"][at] / b, ground[at]
            np.multiply(a, cosine, out=kx)
            np.multiply(a, sine, out=ky)
            np.subtract(base.real, kx, out=dx)
            np.subtract(base.imag, ky, out=dy)
            np.multiply(dx, dx, out=square)
            np.multiply(dy, dy, out=term)
            square += term
            np.sqrt(square, out=f)
            np.add(b + c, f, out=product)
            np.subtract(b + c, f, out=term)
            product *= term
            np.add(f, b - c, out=term)
            product *= term
            np.subtract(f, b - c, out=term)
            product *= term
            np.sqrt(product, out=product)
            np.divide(0.5, square, out=f)
            product *= f
            square += (b - c) * (b + c)
            square *= f
            # P = A + arm (along + i height) (dx + i dy), the factor of the diagonal being x + i y
            x, y = f, term
            np.multiply(square, arm.real, out=x)
            np.multiply(product, arm.imag, out=y)
            x -= y
            square *= arm.imag
            product *= arm.real
            y[...] = square
            y += product
            np.multiply(dx, x, out=square)
            np.multiply(dy, y, out=product)
            square -= product
            square += kx
            square += origin.real
            out.real[at] = square
            np.multiply(dx, y, out=square)
            np.multiply(dy, x, out=product)
            square += product
            square += ky
            square += origin.imag
            out.imag[at] = square
    return out


def stepper() -> Any:
    """The compiled stepper of pylinkage, or None."""
    try:
        from pylinkage.solver import simulation
    except ImportError:
        return None
    return simulation.simulate


def steps_of(linkage: Fourbar, k: int, theta: Real) -> tuple[Any, ...]:
    """Joints O2, O4, A, B, P of one design as the stepper takes them, one step before the first angle."""
    step = float(theta[1] - theta[0])
    first = fourbar.positions(chunk_of_one(linkage, k), theta[0] - step)
    o2, o4, point = linkage.input_pivot[k], linkage.output_pivot[k], linkage.coupler_point[k]
    joints = np.array([o2, o4, complex(first.a), complex(first.b), complex(first.p)])
    lengths = linkage.input[k], step, linkage.coupler[k], linkage.output[k], abs(point), np.angle(point)
    parents = np.array([[-1, -1, -1], [-1, -1, -1], [0, -1, -1], [2, 1, -1], [2, 3, -1]], np.int32)
    kinds, offsets = np.array([0, 0, 1, 2, 3], np.int32), np.array([0, 0, 0, 2, 4], np.int32)
    order = np.array([2, 3, 4], np.int32)
    return joints.view(np.float64).reshape(5, 2), np.array(lengths), kinds, parents, offsets, order, theta.size, 1.0


def chunk_of_one(linkage: Fourbar, k: int) -> Fourbar:
    return Fourbar(*(getattr(linkage, name)[k] for name in linkage.__dataclass_fields__))


def fourbars(linkage: Fourbar, theta: Real) -> None:
    designs, n = linkage.input.size, theta.size
    count, size = designs * n, 10.0
    at = build_sweep(linkage.blocks, theta, 1)
    point, valid = np.empty((designs, n), np.complex128), np.empty((designs, n), np.bool_)

    print("fourbar, coupler point")
    row(
        "compiled, into arrays that are used again", count, lambda: fourbar_sweeps.coupler_points(*at[:4], point, valid)
    )
    row("compiled, coupler_points()", count, lambda: fourbar.coupler_points(linkage, theta))
    for name, together in (("NumPy, all designs at once", designs), ("NumPy, in chunks", CHUNK)):
        gap = np.abs(fourbar_points_in_numpy(linkage, theta, together) - point).max() / size
        row(name, count, lambda together=together: fourbar_points_in_numpy(linkage, theta, together), gap)
    simulate = stepper()
    if simulate is None:
        print("  (no pylinkage beside it: pip install 'pylinkage[numba]')")
    else:
        some = [steps_of(linkage, k, theta) for k in range(min(designs, 100))]
        # The stepper writes into its first argument, where it ends as it began after a full turn.
        paths = np.array([simulate(one[0].copy(), *one[1:])[:, 4] for one in some])
        gap = np.abs(paths.view(np.complex128)[..., 0] - point[: len(some)]).max() / size
        row(
            "pylinkage, compiled stepper, a design at a time",
            len(some) * n,
            lambda: [simulate(*one) for one in some],
            gap,
        )

    print("fourbar, all joints and link angles")
    row("compiled, positions()", count, lambda: fourbar.positions(linkage, theta))
    row(
        "NumPy, all designs at once, with three derivatives",
        count,
        lambda: twins.fourbar(linkage, theta, 1, 1.0, 0.0, 0.0),
    )

    print("fourbar, coupler point: position, velocity, acceleration")
    rates = np.zeros((3, 1, n))
    rates[0] = 1.0
    points, masks = np.empty((3, designs, n), np.complex128), np.empty((2, designs, n), np.bool_)
    row(
        "compiled, into arrays that are used again",
        count,
        lambda: fourbar_sweeps.coupler_motion(*at[:4], rates, points, masks),
    )
    row("compiled, coupler_motion()", count, lambda: fourbar.coupler_motion(linkage, theta))

    print("fourbar, all joints and links: position, velocity, acceleration, jerk")
    whole, angles = np.empty((4, 3, designs, n), np.complex128), np.empty((4, 2, designs, n))
    row(
        "compiled, into arrays that are used again",
        count,
        lambda: fourbar_sweeps.whole_motion(*at[:4], rates, whole, angles, masks),
    )
    row("compiled, motion()", count, lambda: fourbar.motion(linkage, theta))
    plain_beside(linkage, theta, twins.fourbar, whole, size)


def sliders(linkage: SliderCrank, theta: Real) -> None:
    designs, n = linkage.crank.size, theta.size
    count = designs * n
    at = build_sweep(linkage.blocks, theta, 1)
    point, valid = np.empty((designs, n), np.complex128), np.empty((designs, n), np.bool_)
    print("slider-crank, coupler point")
    row("compiled, into arrays that are used again", count, lambda: slider_sweeps.coupler_points(*at[:4], point, valid))
    row("compiled, coupler_points()", count, lambda: slider_crank.coupler_points(linkage, theta))
    print("slider-crank, all joints, coupler angle and travel")
    row("compiled, positions()", count, lambda: slider_crank.positions(linkage, theta))
    print("slider-crank, all joints and links: position, velocity, acceleration, jerk")
    rates = np.zeros((3, 1, n))
    rates[0] = 1.0
    whole, angles = np.empty((4, 3, designs, n), np.complex128), np.empty((4, 2, designs, n))
    masks = np.empty((2, designs, n), np.bool_)
    row(
        "compiled, into arrays that are used again",
        count,
        lambda: slider_sweeps.whole_motion(*at[:4], rates, whole, angles, masks),
    )
    row("compiled, motion()", count, lambda: slider_crank.motion(linkage, theta))
    plain_beside(linkage, theta, twins.slider_crank, whole, 4.0)


def plain_beside(linkage: Any, theta: Real, twin: Callable[..., Any], whole: Any, size: float) -> None:
    """The same motion by the plain twin, at once and in chunks."""
    designs, n = whole.shape[2:]
    plain = twin(linkage, theta, 1, 1.0, 0.0, 0.0)
    gap = max(np.abs(order[x] - whole[k, j]).max() for k, order in enumerate(plain) for j, x in enumerate("abp")) / size
    row("NumPy, all designs at once", designs * n, lambda: twin(linkage, theta, 1, 1.0, 0.0, 0.0), gap)
    parts = [chunk(linkage, start) for start in range(0, designs, CHUNK)]
    row("NumPy, in chunks", designs * n, lambda: [twin(part, theta, 1, 1.0, 0.0, 0.0) for part in parts], gap)


def calls() -> None:
    """Times of calls on a single design at three angles."""
    print(f"\n{'one design at three angles':<68}{'µs':>10}")
    linkage, theta = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, 1j), np.array([0.1, 0.2, 0.3])
    for name, call in (
        ("Fourbar(...)", lambda: Fourbar(0.0, 6.0, 2.0, 7.0, 9.0, 1j)),
        ("positions()", lambda: fourbar.positions(linkage, theta)),
        ("motion()", lambda: fourbar.motion(linkage, theta)),
    ):
        print(f"  {name:<66}{seconds(lambda call=call: [call() for _ in range(200)]) / 200 * 1e6:>10.1f}")


def answers() -> None:
    """Processor times of whole analyses as the service gives them: 361 positions, all quantities, into JSON."""
    print(f"\n{'an analysis with 360 steps, request to JSON':<68}{'ms':>10}{'kB':>12}")
    for name, mechanism in STATED.items():
        content, times = b"", []
        for _ in range(REPEATS):
            start = time.process_time()
            content = to_json(parse_request({"mechanism": mechanism}).build_answer(), inf_nan_mode="null")
            times.append(time.process_time() - start)
        print(f"  {name:<66}{min(times) * 1e3:>10.1f}{len(content) / 1e3:>12.0f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--designs", type=int, default=2000)
    parser.add_argument("--angles", type=int, default=360)
    given = parser.parse_args()
    designs = CHUNK * math.ceil(given.designs / CHUNK)
    rng = np.random.default_rng(0)
    theta = np.linspace(0.0, 2.0 * np.pi, given.angles, endpoint=False)
    print(f"{f'{designs} designs × {given.angles} input angles, one core':<68}{'million/s':>10}{'Δ':>12}")
    fourbars(crank_rockers(rng, designs), theta)
    sliders(slider_cranks(rng, designs), theta)
    calls()
    answers()


if __name__ == "__main__":
    main()
