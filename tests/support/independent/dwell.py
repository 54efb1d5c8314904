"""Answers whose output rests (docs/tasks/dwell.md): where it moves least, and how long it stays within tolerance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import greatest, least
from tests.support.independent.linkage import Used, compare_linkage
from tests.support.independent.output import Output

SAMPLES = 11_520
"""Places of a turn at which the output is known; between them lies the polynomial through the eight nearest."""

WINDOW = 601
"""Places of a rest at which its greatest and least output are looked for."""

STARTS = 1440
"""Places of a turn where a rest may begin, before the best of them are looked at more closely."""

CLOSER, ROUNDS = 21, 6
"""Places of a closer look, and how many follow each other."""

HALVINGS = 23
"""Of eight steps between which the width lies."""


class Turn:
    """The output over a turn of the crank, as often as it is asked for."""

    def __init__(self, output: Output) -> None:
        self.step = math.tau / SAMPLES
        self.values = output.at(self.step * np.arange(SAMPLES))
        nodes = np.arange(-3, 5)
        self.nodes = nodes
        self.weights = np.array([1.0 / np.prod([j - i for i in nodes if i != j]) for j in nodes])

    def at(self, turns: Real) -> Real:
        """The output at turns, by Lagrange's polynomial."""
        where = turns / self.step
        k = np.floor(where).astype(np.int64)
        u = (where - k)[..., None]
        gaps = u - self.nodes
        hit = np.abs(gaps) < 1e-12
        shares = self.weights / np.where(hit, 1.0, gaps)
        values = self.values[(k[..., None] + self.nodes) % SAMPLES]
        between = (shares * values).sum(axis=-1) / shares.sum(axis=-1)
        return np.asarray(np.where(hit.any(axis=-1), (values * hit).sum(axis=-1), between))

    def spread(self, begin: Real, wide: float) -> Real:
        """Greatest less least output from each place on, while the crank turns on."""
        values = self.at(begin[:, None] + wide * np.linspace(0.0, 1.0, WINDOW))
        return np.asarray(_peak(values) + _peak(-values))

    def coarse(self, wide: float) -> Real:
        """Nearly the same from each of :data:`STARTS` places of the turn on."""
        values = self.values[:: SAMPLES // STARTS]
        count = min(math.ceil(wide / math.tau * STARTS), STARTS) + 1
        windows = np.lib.stride_tricks.sliding_window_view(np.concatenate([values, values, values[:1]]), count)[:STARTS]
        return np.asarray(windows.max(axis=1) - windows.min(axis=1))

    def mean(self, begin: float, wide: float) -> float:
        """The mean output from a place on."""
        nodes, weights = np.polynomial.legendre.leggauss(60)
        return float(self.at(begin + 0.5 * wide * (nodes + 1.0)) @ weights) / 2.0


def _peak(values: Real) -> Real:
    """The greatest of rows, by the parabola through the neighbours of each."""
    rows, k = np.arange(len(values)), np.clip(values.argmax(axis=1), 1, values.shape[1] - 2)
    before, at, after = values[rows, k - 1], values[rows, k], values[rows, k + 1]
    bend = before - 2.0 * at + after
    with np.errstate(divide="ignore", invalid="ignore"):
        top = at - 0.125 * np.where(bend < 0.0, (after - before) ** 2 / bend, 0.0)
    inside = (at >= before) & (at >= after)
    return np.asarray(np.where(inside, top, values.max(axis=1)))


def _least_spread(turn: Turn, allowed: NDArray[np.bool_], wide: float) -> float:
    """The least that the output moves of all rests that begin at some of the places or next to them."""
    step = math.tau / STARTS
    chosen: list[int] = []
    for k in np.argsort(np.where(allowed, turn.coarse(wide), np.inf)).tolist():
        if all(2 < (k - other) % STARTS < STARTS - 2 for other in chosen):
            chosen.append(k)
        if len(chosen) == 3:
            break
    return min(_closer(turn, step * k, 2.0 * step, wide) for k in chosen)


def _closer(turn: Turn, at: float, reach: float, wide: float, ends: tuple[float, float] = (-9.9, 99.9)) -> float:
    """The least that the output moves of rests that begin about a place, between two ends."""
    best = math.inf
    for _ in range(ROUNDS):
        closer = np.clip(at + reach * np.linspace(-1.0, 1.0, CLOSER), *ends)
        there = turn.spread(closer, wide)
        at, best = float(closer[there.argmin()]), min(best, float(there.min()))
        reach *= 2.0 / (CLOSER - 1)
    return best


def compare_dwell(beside: Beside, stated: dict[str, Any]) -> None:
    """How the output rests, and how it goes."""
    design = beside.design
    drive = Drive(design.mechanism.skeleton)
    if not drive.follow(-0.1, math.tau + 0.1):
        beside.unmeasured("could not be driven")
        return
    output = Output(drive, design.mechanism.type)
    unit = 180.0 / math.pi if output.turns else 1.0
    top, foot = greatest(output.at, 0.0, math.tau).value, least(output.at, 0.0, math.tau).value
    way = (top - foot) * unit
    wanted = stated["output"].get("swing", stated["output"].get("stroke"))
    beside.metric("way", way, way)
    beside.check("way", abs(way / wanted - 1.0))
    jitters = _compare_rests(beside, stated, drive, Turn(output), (foot, top), unit)
    beside.metric("jitter", max(jitters), way)
    for name, function in (("peak_velocity", output.rate), ("peak_acceleration", output.acceleration)):
        over, under = greatest(function, 0.0, math.tau).value, least(function, 0.0, math.tau).value
        peak = max(over, -under)
        beside.metric(name, peak, peak)
    places = drive.at(np.linspace(0.0, math.tau, 2881)).ravel()
    task = wanted if not output.turns else 2.0 * abs(drive.home[drive.names.index("A")] - drive.home[0])
    compare_linkage(beside, stated, drive, Used((0.0, math.tau), task, places))


def _compare_rests(
    beside: Beside, stated: dict[str, Any], drive: Drive, turn: Turn, ends: tuple[float, float], unit: float
) -> list[float]:
    """Each rest: how much the output moves, where, and for how long; the jitters."""
    foot, top = ends
    way = (top - foot) * unit
    wanted = stated.get("dwells") or stated.get("count", 1) * [{"angle": stated["dwell_angle"]}]
    allowed = stated.get("tolerance") or 0.01 * stated["output"].get("swing", stated["output"].get("stroke"))
    jitters, timed = [], []
    for k, (rest, dwell) in enumerate(zip(beside.design.targets, wanted, strict=True)):
        wide = math.radians(dwell["angle"])
        begin = math.radians(rest.input_angle) - drive.reference
        timed.append((begin, wide))
        own = float(turn.spread(np.array([begin]), wide)[0]) * unit
        jitters.append(own)
        beside.add("targets.jitter", rest.jitter, own, way)
        # Where it begins is as sharp as the least movement is: it is compared by how much the output moves from there.
        beside.add("targets.input_angle", own, _smallest(turn, dwell, begin, ends, len(wanted)) * unit, way)
        values = turn.at(begin + wide * np.linspace(0.0, 1.0, 4 * WINDOW))[None]
        level = 0.5 * float((_peak(values) - _peak(-values))[0]) * unit
        level += 360.0 * round((rest.level - level) / 360.0) if unit != 1.0 else 0.0
        beside.add("targets.level", rest.level, level, way)
        off = turn.mean(begin, wide)
        beside.add("targets.off_end", rest.off_end, min(top - off, off - foot) / (top - foot), 1.0)
        beside.add("targets.width", rest.width, math.degrees(_width(turn, begin + 0.5 * wide, allowed / unit)), 360.0)
        beside.check(f"dwell_{k + 1}", own, way)
        share = (off - foot) / (top - foot)
        if "at" not in dwell:
            beside.check(f"dwell_{k + 1}_at_end", min(share, 1.0 - share))
            continue
        beside.check(f"dwell_{k + 1}_at_place", abs(share - _place(dwell)))
        placed = beside.design.dwells[k]
        beside.add("dwells.angle", placed.angle, dwell["angle"], 360.0)
        beside.add("dwells.at", placed.at, share, 1.0)
        beside.add("dwells.error", placed.error, own, way)
    if len(timed) > 1:
        clear = [
            (other - begin) % math.tau >= wide * (1.0 - 1e-6)
            for begin, wide in timed
            for other, _ in timed
            if other != begin
        ]
        beside.check("dwells_apart", all(clear))
    return jitters


def _place(dwell: dict[str, Any]) -> float:
    return float({"low": 0.0, "high": 1.0}.get(dwell["at"], dwell["at"]))


def _smallest(turn: Turn, dwell: dict[str, Any], begin: float, ends: tuple[float, float], count: int) -> float:
    """The least that the output moves of all rests that might be this one: of two in its half of the way."""
    foot, top = ends
    wide = math.radians(dwell["angle"])
    means = np.array([turn.mean(math.tau * k / STARTS, wide) for k in range(STARTS)])
    if "at" in dwell:
        off = np.abs((means - foot) / (top - foot) - _place(dwell))
        return _least_spread(turn, off <= max(0.05, float(off.min())), wide)
    halves = [means > 0.5 * (foot + top), means <= 0.5 * (foot + top)]
    bests = [_least_spread(turn, half, wide) for half in halves if half.any()]
    if count == 1:
        return min(bests)
    return bests[0 if turn.mean(begin, wide) > 0.5 * (foot + top) else -1]


def _width(turn: Turn, middle: float, allowed: float) -> float:
    """The longest rotation with the middle in it over which the output keeps within what is allowed, by halving."""
    step = math.tau / STARTS
    at = round(middle / step)

    def nearest(steps: int) -> tuple[float, int]:
        """The least movement in so many steps with the middle in them, and where they begin."""
        begins = np.arange(at - steps, at + 1)
        spreads = turn.coarse(steps * step)[begins % STARTS]
        return float(spreads.min()), int(begins[spreads.argmin()])

    few, many = 0, STARTS
    while many - few > 1:
        tried = (few + many) // 2
        few, many = (tried, many) if nearest(tried)[0] <= allowed else (few, tried)
    begin = step * nearest(few)[1]
    low, high = max(few - 4, 0) * step, min(few + 4, STARTS) * step
    for _ in range(HALVINGS):
        wide = 0.5 * (low + high)
        least = _closer(turn, begin, 10.0 * step, wide, (middle - wide, middle))
        low, high = (wide, high) if least <= allowed else (low, wide)
    return low
