"""Linkages as they are made, by another formulation than the product's: Freudenstein's half-angle equation in plain
numpy, the nearest input by golden section, and the branch by the discriminant along the way.

A sample is one linkage; its dimensions are a row: O2 (x, y), O4 (x, y), input, coupler, output, P (along, across), or
of a slider-crank O2 (x, y), offset, crank, coupler, P (along, across).

Source: Norton, Design of Machinery, Eq. 4.8 to 4.13 (fourbar) and 4.16 to 4.17 (slider-crank).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
STEPS = 26
WAY = 33
"""Inputs of the used range at which a sample is looked at."""


@dataclass
class Stated:
    """A design and what it is held to, read off a job's JSON: demanded P, body angles or outputs, and inputs."""

    row: np.ndarray
    slide: float | None
    foot: complex
    inputs: np.ndarray
    points: np.ndarray | None
    turns: np.ndarray | None
    outputs: np.ndarray | None
    used: tuple[float, float] | None
    free: bool

    @property
    def slides(self) -> bool:
        return self.slide is not None


def stated(problem: dict[str, Any], design: dict[str, Any]) -> Stated:
    """A design of a motion, path or function problem, as the service answers."""
    m = design["mechanism"]
    p = m["coupler_point"]
    local = p["distance"] * np.exp(1j * math.radians(p["angle"]))
    if m["type"] == "fourbar":
        slide, foot = None, 0j
        row = [*m["fixed_pivots"]["input"], *m["fixed_pivots"]["output"]]
        row += [m["links"]["input"], m["links"]["coupler"], m["links"]["output"]]
    else:
        slide, pivot = math.radians(m["slide"]["angle"]), complex(*m["fixed_pivot"])
        line = complex(*m["slide"]["point"])
        foot = line + np.exp(1j * slide) * ((pivot - line) * np.exp(-1j * slide)).real
        row = [pivot.real, pivot.imag, m["offset"], m["links"]["crank"], m["links"]["coupler"]]
    row = np.array([*row, local.real, local.imag])
    targets = design["targets"]
    inputs = np.radians([target["input_angle"] for target in targets])
    points = turns = outputs = None
    kind = problem["kind"]
    if kind == "function":
        places = np.array([target["output_place"] - target["error"] for target in targets])
        outputs = places if slide is not None else np.radians(places)
    else:
        listed = problem["positions"] if kind == "motion" else problem["points"]
        points = np.array([complex(one["x"], one["y"]) for one in listed])
    if kind == "motion":
        first = problem["positions"][0]["angle"]
        joints = {name: complex(*place) for name, place in m["skeleton"]["joints"].items()}
        body = math.radians(m.get("reference_body_angle") or first)
        turns = np.radians([one["angle"] for one in listed]) - body + np.angle(joints["B"] - joints["A"])
    used = design["metrics"].get("used_range")
    free = kind != "function" and problem.get("timing") != "prescribed"
    used = None if used is None else tuple(sorted(np.radians(used)))
    return Stated(row, slide, foot, inputs, points, turns, outputs, used, free)


def posed(of: Stated, rows: np.ndarray, theta: np.ndarray, sign: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """P, the angle of A → B, and the output (angle of O4 → B, or the slider's place); NaN where it does not close."""
    if of.slides:
        o2, offset, a, b = rows[:, 0] + 1j * rows[:, 1], rows[:, 2], rows[:, 3], rows[:, 4]
        along = np.exp(1j * of.slide)
        crank = a * np.exp(1j * theta)
        rise = -(offset + (crank / along).imag) / b
        turned = np.arcsin(np.where(np.abs(rise) <= 1.0, rise, np.nan))
        phi = of.slide + (turned if sign > 0 else math.pi - turned)
        pin = o2 + crank
        place = pin + b * np.exp(1j * phi)
        output = ((place - of.foot) / along).real
    else:
        o2, o4 = rows[:, 0] + 1j * rows[:, 1], rows[:, 2] + 1j * rows[:, 3]
        a, b, c = rows[:, 4], rows[:, 5], rows[:, 6]
        ground = o4 - o2
        d = np.abs(ground)
        zero = np.angle(ground)
        turned = theta - zero
        k1, k2, k3 = d / a, d / c, (a * a - b * b + c * c + d * d) / (2.0 * a * c)
        cosine = np.cos(turned)
        first = cosine - k1 - k2 * cosine + k3
        second = -2.0 * np.sin(turned)
        third = k1 - (k2 + 1.0) * cosine + k3
        root = second * second - 4.0 * first * third
        root = np.sqrt(np.where(root >= 0.0, root, np.nan))
        output = 2.0 * np.arctan2(-second - sign * root, 2.0 * first) + zero
        pin = o2 + a * np.exp(1j * theta)
        phi = np.angle(o4 + c * np.exp(1j * output) - pin)
    return pin + (rows[:, -2] + 1j * rows[:, -1]) * np.exp(1j * phi), phi, output


def missed(of: Stated, rows: np.ndarray, theta: np.ndarray, sign: int, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Distance and angle (radians) from target k."""
    p, phi, output = posed(of, rows, theta, sign)
    zero = np.zeros(len(rows))
    if of.outputs is not None:
        off = output - of.outputs[k]
        if of.slides:
            return np.abs(off), zero
        return zero, np.abs(np.mod(off + math.pi, math.tau) - math.pi)
    distance = np.abs(p - of.points[k])
    if of.turns is None:
        return distance, zero
    return distance, np.abs(np.mod(phi - of.turns[k] + math.pi, math.tau) - math.pi)


def branch(of: Stated) -> int:
    """The sign of the root that the design as drawn has at its targets."""
    row = of.row[None]
    misses = []
    for sign in (1, -1):
        off = [missed(of, row, of.inputs[k : k + 1], sign, k) for k in range(len(of.inputs))]
        misses.append(np.nansum([d[0] / np.abs(of.row).max() + t[0] if np.isfinite(d[0]) else 9.0 for d, t in off]))
    return 1 if misses[0] <= misses[1] else -1


def good(
    of: Stated, rows: np.ndarray, error: float | None, angle: float | None, *, fixed: bool = False, reach: float = 0.2
) -> np.ndarray:
    """Which samples keep the quality (length units, degrees) at every target and stay on their branch."""
    distance_unit = math.inf if error is None else error
    angle_unit = math.inf if angle is None else math.radians(angle)
    sign = branch(of)
    kept = np.ones(len(rows), bool)
    least, most = np.full(len(rows), np.inf), np.full(len(rows), -np.inf)
    for k, nominal in enumerate(of.inputs):
        here = np.flatnonzero(kept)

        def share(theta: np.ndarray, which: np.ndarray, k: int = k) -> np.ndarray:
            off = missed(of, rows[which], theta, sign, k)
            taken = np.maximum(off[0] / distance_unit, off[1] / angle_unit)
            return np.where(np.isfinite(taken), taken, np.inf)

        at = np.full(len(here), nominal)
        best = share(at, here)
        if not fixed and of.free:
            at, best = _nearest(share, here, float(nominal), reach, 1.0)
        kept[here] = best <= 1.0
        least[here], most[here] = np.minimum(least[here], at), np.maximum(most[here], at)
    if of.used is not None:
        before, after = of.inputs.min() - of.used[0], of.used[1] - of.inputs.max()
        for part in np.linspace(0.0, 1.0, WAY):
            here = np.flatnonzero(kept)
            low, high = least[here] - before, most[here] + after
            kept[here] = np.isfinite(posed(of, rows[here], low + part * (high - low), sign)[0])
    return kept


def squares(of: Stated, rows: np.ndarray, size: float, most: float = math.inf, reach: float = 0.2) -> np.ndarray:
    """The sum over the targets of the squares of distance (in sizes) and angle, at the nearest inputs; inf above most.

    Places of a slider are counted from the foot of its pivot. Branches are not looked at.
    """
    sign, total = branch(of), np.zeros(len(rows))
    shift = np.zeros(len(rows))
    if of.slides and of.outputs is not None:
        shift = (((rows[:, 0] - of.row[0]) + 1j * (rows[:, 1] - of.row[1])) * np.exp(-1j * of.slide)).real
    for k, nominal in enumerate(of.inputs):
        here = np.flatnonzero(total <= most)

        def miss(theta: np.ndarray, which: np.ndarray, k: int = k) -> np.ndarray:
            if of.outputs is not None and of.slides:
                off = (posed(of, rows[which], theta, sign)[2] - shift[which] - of.outputs[k]) / size
                taken = off * off
            else:
                distance, angle = missed(of, rows[which], theta, sign, k)
                taken = (distance / size) ** 2 + angle**2
            return np.where(np.isfinite(taken), taken, np.inf)

        at = np.full(len(here), nominal)
        total[here] += _nearest(miss, here, float(nominal), reach)[1] if of.free else miss(at, here)
    return np.where(total <= most, total, np.inf)


def neighbours(of: Stated, steps: np.ndarray, reach: int = 2) -> np.ndarray:
    """All rows on a grid within so many steps of a design, in every dimension of a step above 0."""
    values = []
    for at, step in zip(of.row, steps, strict=True):
        counts = np.arange(math.ceil(at / step - reach), math.floor(at / step + reach) + 1) if step else []
        values.append(np.array(counts) * step if step else np.array([at]))
    return np.stack(np.meshgrid(*values, indexing="ij"), axis=-1).reshape(-1, len(of.row))


def _nearest(
    share: Any, here: np.ndarray, nominal: float, reach: float, enough: float = -math.inf
) -> tuple[np.ndarray, np.ndarray]:
    """The inputs with the least share and that share, by golden section, or the first with no more than enough."""
    low, high = np.full(len(here), nominal - reach), np.full(len(here), nominal + reach)
    one, two = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    f, g = share(one, here), share(two, here)
    for _ in range(STEPS):
        on = np.flatnonzero(np.minimum(f, g) > enough)
        left = f[on] <= g[on]
        high[on], low[on] = np.where(left, two[on], high[on]), np.where(left, low[on], one[on])
        width = GOLDEN * (high[on] - low[on])
        fresh = np.where(left, high[on] - width, low[on] + width)
        value = share(fresh, here[on])
        one[on], two[on] = np.where(left, fresh, two[on]), np.where(left, one[on], fresh)
        f[on], g[on] = np.where(left, value, g[on]), np.where(left, f[on], value)
    return np.where(f <= g, one, two), np.minimum(f, g)


def with_clearances(of: Stated, links: np.ndarray, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """P, the angle of A → B and the output at target k with clearance links at O2, A, B and O4, shape (4, n).

    The vectors go from the centre of the hole in the link before to that of the pin in the link after it. The loop is
    closed by Newton's method in the angles of coupler and output, from the linkage without clearances.
    """
    row, theta = of.row, float(of.inputs[k])
    sign = branch(of)
    _, phi, output = (part[0] for part in posed(of, row[None], np.array([theta]), sign))
    count = links.shape[1]
    angle, second = np.full(count, phi), np.full(count, output)
    o2 = complex(row[0], row[1])
    crank, b = (row[3], row[4]) if of.slides else (row[4], row[5])
    pin = o2 + links[0] + crank * np.exp(1j * theta) + links[1]
    for _ in range(12):
        end = pin + b * np.exp(1j * angle) + links[2]
        if of.slides:
            # The pin lies on the slide, whose place along its line is the second unknown.
            there, slope = of.foot + second * np.exp(1j * of.slide), np.full(count, np.exp(1j * of.slide))
        else:
            o4 = complex(row[2], row[3])
            there = o4 + links[3] + row[6] * np.exp(1j * second)
            slope = 1j * row[6] * np.exp(1j * second)
        gap, turn = end - there, 1j * b * np.exp(1j * angle)
        determinant = -(np.conj(turn) * slope).imag
        angle = angle - (-(np.conj(gap) * slope).imag) / determinant
        second = second + (np.conj(turn) * gap).imag / (np.conj(turn) * slope).imag
    assert np.abs(gap).max() < 1e-9
    return pin + (row[-2] + 1j * row[-1]) * np.exp(1j * angle), angle, second


def dimensions_off(of: Stated, tolerances: dict[str, float]) -> np.ndarray:
    """The tolerance of each dimension of a row."""
    length, pivot = tolerances.get("length", 0.0), tolerances.get("pivot", 0.0)
    off = [pivot] * (3 if of.slides else 4) + [length] * ((2 if of.slides else 3) + 2)
    return np.array(off)


def samples(of: Stated, tolerances: dict[str, float], distribution: str, count: int, seed: int) -> np.ndarray:
    """Rows of dimensions that are off by chance."""
    off, rng = dimensions_off(of, tolerances), np.random.default_rng([seed, 77])
    shape = count, len(off)
    share = rng.random(shape) * 2.0 - 1.0 if distribution == "uniform" else rng.normal(0.0, 1.0 / 3.0, shape)
    return of.row + off * share
