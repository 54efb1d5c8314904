"""Pytest plugin: measure the CPU time of every case, and hold the mark ``slow`` against it.

The CPU time of a case is that of its body: of this process, and of the processes that it starts. Fixtures do not
count, nor does the time in which numba loads or compiles kernels, because that is paid by whichever case comes first.
A server that many cases share also works in the background; its CPU time is listed, never judged.

A case over ``SLOW_S`` belongs among the tests marked ``slow``, and a test whose cases all stay under ``QUICK_S`` does
not. With ``--check-marks`` the run fails where a mark is wrong by the factor ``MARGIN``; smaller errors are listed.
Two things keep noise out of the verdict. CPU time is scaled by the speed of the machine, which is measured again when
a case is over the limit. And the modules of the product are imported before the first case.
"""

from __future__ import annotations

import importlib
import json
import os
import pkgutil
import sys
from collections import defaultdict
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import pytest

from tests.support import session_folder

SLOW_S = 1.0
"""CPU time of a case, in seconds, above which it must be marked ``slow``."""

QUICK_S = 0.3
"""CPU time, in seconds, below which it must not be."""

MARGIN = 2.0
"""Factor by which a mark must be wrong before the run fails: repeated runs of one case differ by up to 40 %."""

REFERENCE_S = 0.0040
"""CPU time of `_work` on the machine that the limits were set on."""

PRODUCT = ("kinematics", "synthesis", "service", "mechsynth")
JUDGED_APART = {"campaign", "fuzz", "faults", "cluster", "browser", "site", "cad"}
"""Marks of tests that have a target of their own; `make quick` leaves them out whatever they cost."""

TICKS_PER_S = os.sysconf("SC_CLK_TCK")

shared_servers: set[int] = set()
"""Process ids of servers that many cases share."""

own_servers: set[int] = set()
"""Process ids of running servers that a case or a file has for itself. Each takes seconds to start, so that the cases
which need one may be marked ``slow`` whatever they cost."""


def share_server(pid: int) -> None:
    """Count a server among those that many cases share."""
    own_servers.discard(pid)
    shared_servers.add(pid)


_charged = 0.0


def charge(seconds: float) -> None:
    """Add the CPU time of an answer that another case has paid for."""
    global _charged
    _charged += seconds


def charge_server(pid: int, seconds: float) -> None:
    """Add, in a worker of a server, the CPU time of an answer that another case has paid for."""
    session_folder.append_line(f"charged-{pid}", repr(seconds))


def _read_server_charges(pid: int) -> float:
    return sum(map(float, session_folder.read_lines(f"charged-{pid}")))


class Cost(NamedTuple):
    """CPU seconds of a case: ``own``, and what shared servers used at the same time."""

    own: float
    servers: float


def _work() -> None:
    total = 0
    for number in range(100_000):
        total += number * number


def measure_slowness() -> float:
    """Return how many times slower this machine is than the reference now, at least 1."""
    times = []
    for _ in range(5):
        begun = process_time()
        _work()
        times.append(process_time() - begun)
    return max(1.0, min(times) / REFERENCE_S)


def _list_children(pid: int) -> list[int]:
    children: list[int] = []
    try:
        for thread in os.listdir(f"/proc/{pid}/task"):
            children += map(int, Path(f"/proc/{pid}/task/{thread}/children").read_text().split())
    except OSError:  # the process has ended, or the system has no such files
        pass
    return children


def _tree_seconds(pid: int) -> float:
    """Return the CPU time of a process, of its descendants, and of those that it has waited for."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    # Fields 14 to 17 of proc(5): user and system time, and those of children that have been waited for.
    own = sum(map(int, fields[11:15])) / TICKS_PER_S
    return own + sum(_tree_seconds(child) for child in _list_children(pid))


class _KernelClock:
    """CPU time that numba spends under its compiler lock: compiling kernels, or loading them from disk."""

    def __init__(self) -> None:
        self.seconds = 0.0
        self._depth = 0
        self._begun = 0.0
        self._installed = False

    def install(self) -> None:
        if self._installed or "numba" not in sys.modules:
            return
        event: Any = importlib.import_module("numba.core.event")
        clock = self

        class Listener(event.Listener):  # type: ignore[misc]
            def on_start(self, _event: Any) -> None:
                if clock._depth == 0:
                    clock._begun = process_time()
                clock._depth += 1

            def on_end(self, _event: Any) -> None:
                clock._depth -= 1
                if clock._depth == 0:
                    clock.seconds += process_time() - clock._begun

        event.register("numba:compiler_lock", Listener())
        self._installed = True


class CpuTimePlugin:
    """Measure cases in the processes that run them; judge and list them in the one that reports."""

    def __init__(self, config: pytest.Config) -> None:
        self.config = config
        self.kernels = _KernelClock()
        self.costs: dict[str, Cost] = {}
        self.marked: dict[str, bool] = {}
        self.wrong: list[str] = []
        self.listed: list[str] = []

    def _read(self) -> Cost:
        times = os.times()
        own = process_time() + times.children_user + times.children_system - self.kernels.seconds + _charged
        servers = 0.0
        for child in _list_children(os.getpid()):
            seconds = _tree_seconds(child) + _read_server_charges(child)
            if child in shared_servers:
                servers += seconds
            else:
                own += seconds
        return Cost(own, servers)

    @pytest.hookimpl
    def pytest_collection_finish(self, session: pytest.Session) -> None:
        if not self.config.getoption("--check-marks") or is_controller(self.config):
            return
        for package in PRODUCT:
            for module in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
                if "migrations" not in module.name:
                    try:
                        importlib.import_module(module.name)
                    except ImportError:  # modules of an extra that is not installed
                        continue

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Any:
        self.kernels.install()
        before = self._read()
        try:
            return (yield)
        finally:
            self.kernels.install()
            after = self._read()
            own, servers = after.own - before.own, after.servers - before.servers
            if own > SLOW_S:
                own /= measure_slowness()
            apart = any(mark.name in JUDGED_APART for mark in item.iter_markers())
            marked: bool | None = item.get_closest_marker("slow") is not None
            if apart or (marked and own_servers):
                marked = None
            item.user_properties.append(("cpu", (own, servers, marked)))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when != "call" or report.skipped:
            return
        for name, value in report.user_properties:
            if name == "cpu":
                own, servers, marked = value
                self.costs[report.nodeid] = Cost(own, servers)
                if marked is not None:
                    self.marked[report.nodeid] = marked

    def judge(self) -> None:
        """Compare marks with costs: cases over the limit, and marked tests of which no case is near it."""
        peaks: dict[str, float] = defaultdict(float)
        for case, marked in self.marked.items():
            cost = self.costs[case]
            if marked:
                test = case.partition("[")[0]
                peaks[test] = max(peaks[test], cost.own + cost.servers)
            elif cost.own > MARGIN * SLOW_S:
                self.wrong.append(f"{case} takes {cost.own:.1f} s and is not marked slow")
            elif cost.own + cost.servers > SLOW_S:
                self.listed.append(f"{case} takes {cost.own:.1f} s, shared servers {cost.servers:.1f} s")
        for test, peak in peaks.items():
            if peak < QUICK_S / MARGIN:
                self.wrong.append(f"{test} takes {peak:.2f} s at most and is marked slow")
            elif peak < QUICK_S:
                self.listed.append(f"{test} takes {peak:.2f} s at most and is marked slow")

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        if "PYTEST_XDIST_WORKER" in os.environ:
            return
        self.judge()
        if file := self.config.getoption("--cpu-times"):
            rows = {case: [round(cost.own, 3), round(cost.servers, 3)] for case, cost in self.costs.items()}
            Path(file).write_text(json.dumps(rows, indent=0), "utf-8")
        if self.wrong and self.config.getoption("--check-marks") and session.exitstatus == pytest.ExitCode.OK:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        if not self.costs:
            return
        total, servers = (sum(seconds) for seconds in zip(*self.costs.values(), strict=True))
        terminalreporter.write_line(
            f"CPU time of {len(self.costs)} cases: {total:.0f} s, of shared servers {servers:.0f} s"
        )
        if self.config.getoption("--check-marks"):
            for title, lines in (("wrong marks", self.wrong), ("marks to look at", self.listed)):
                if lines:
                    terminalreporter.section(title)
                    for line in sorted(lines):
                        terminalreporter.write_line(line)


def is_requested(config: pytest.Config) -> bool:
    """Return whether the CPU time of cases is asked for: reading it costs each case some milliseconds."""
    return bool(config.getoption("--check-marks") or config.getoption("--cpu-times"))


def is_controller(config: pytest.Config) -> bool:
    """Return whether this process hands cases to others instead of running them."""
    return "PYTEST_XDIST_WORKER" not in os.environ and bool(config.getoption("numprocesses", None))


def add_options(parser: pytest.Parser) -> None:
    """Add the options of the plugin."""
    parser.addoption("--cpu-times", metavar="FILE", help="write the CPU seconds of every case to this file, as JSON")
    parser.addoption("--check-marks", action="store_true", help="fail where the mark slow contradicts the CPU time")
