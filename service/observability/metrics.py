"""Metrics of the service in the format of Prometheus.

Labels contain no text chosen by clients: operations, methods, kinds, outcomes and reasons come from fixed lists, so
that clients can neither fill the memory with new values nor put secrets into them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from importlib.metadata import version
from typing import Final

import structlog
from prometheus_client import (
    CollectorRegistry,
    Counter,
    Gauge,
    GCCollector,
    Histogram,
    PlatformCollector,
    ProcessCollector,
)
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector

from service.observability.store_figures import StoreFigures

METHODS: Final = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})

_REQUEST_SECONDS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0)
_JOB_SECONDS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)

log = structlog.get_logger(__name__)


class WorkerMetrics:
    """Metrics of workers and of the process that runs them, in a separate registry."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        for collector in (ProcessCollector, PlatformCollector, GCCollector):
            collector(registry=self.registry)
        self._attempts = self._create_counter("job_attempts", "Attempts at jobs that have ended, by how.", "outcome")
        self._job_seconds = self._create_histogram(
            "job_seconds",
            "Computation of an attempt at a job that its worker has brought to an end.",
            "kind",
            _JOB_SECONDS,
        )
        self._worker_restarts = self._create_counter(
            "worker_restarts", "Worker processes that were replaced, by why.", "reason"
        )
        self._workers = self._create_gauge("workers_ready", "Worker processes that have finished starting.")
        self._queue_seconds = self._create_histogram(
            "queue_seconds", "From the acceptance of a job to its first attempt.", "cost", _JOB_SECONDS
        )
        build = Gauge("mechsynth_build_info", "Version of the program.", ("version",), registry=self.registry)
        build.labels(version("mechsynth")).set(1)

    def _create_counter(self, name: str, text: str, *labels: str) -> Counter:
        return Counter(f"mechsynth_{name}", text, labels, registry=self.registry)

    def _create_gauge(self, name: str, text: str, *labels: str) -> Gauge:
        return Gauge(f"mechsynth_{name}", text, labels, registry=self.registry)

    def _create_histogram(self, name: str, text: str, label: str, buckets: tuple[float, ...]) -> Histogram:
        return Histogram(f"mechsynth_{name}", text, (label,), buckets=buckets, registry=self.registry)

    def count_attempt(self, outcome: str, kind: str | None = None, seconds: float = 0.0) -> None:
        """Count an ended attempt at a job; kind and time are known if the worker itself ended it."""
        self._attempts.labels(outcome.replace(" ", "_")).inc()
        if kind is not None:
            self._job_seconds.labels(kind).observe(seconds)

    def observe_wait(self, cost: str, seconds: float) -> None:
        """Record the time that a job has waited for its first attempt."""
        self._queue_seconds.labels(cost).observe(seconds)

    def count_worker_restart(self, reason: str) -> None:
        """Count a replaced worker process."""
        self._worker_restarts.labels(reason).inc()


class HostMetrics(WorkerMetrics):
    """All metrics of one worker host."""

    def __init__(self) -> None:
        super().__init__()
        self._jobs = self._create_gauge(
            "host_jobs",
            "Jobs that this host has taken: a worker computes them.",
            "status",
        )

    def watch(self, workers: Callable[[], int], running: Callable[[], int]) -> None:
        """Set the callbacks that give the ready workers and the running jobs of the host at each read."""
        self._workers.set_function(workers)
        self._jobs.labels("running").set_function(running)


class Metrics(WorkerMetrics):
    """All metrics of one server."""

    def __init__(self) -> None:
        super().__init__()
        self._requests = self._create_counter(
            "http_requests", "Requests that were answered.", "operation", "method", "status"
        )
        self._request_seconds = self._create_histogram(
            "http_request_seconds",
            "From the head of a request to the end of its answer, waits and streams included.",
            "operation",
            _REQUEST_SECONDS,
        )
        self._rejections = self._create_counter(
            "http_rejections", "Requests that were answered with an error, by the type of the problem.", "reason"
        )
        self._jobs_accepted = self._create_counter("jobs_accepted", "Jobs that were accepted.", "kind")
        self._batches_accepted = self._create_counter("batches_accepted", "Batches that were accepted.", "kind")
        self._given_up = self._create_counter(
            "calls_given_up",
            "Analyses, drawings, parts and files that were given up, by why: time, memory, busy, gone, lost.",
            "pool",
            "reason",
        )
        self._defects = self._create_counter(
            "defects", "Requests refused after a numerical error that no field had kept out.", "operation"
        )
        self._listeners = self._create_gauge("event_listeners", "Clients that listen to the events of a job.")

    def count_request(self, operation: str, method: str, status: int, seconds: float) -> None:
        """Count an answered request."""
        self._requests.labels(operation, method if method in METHODS else "other", str(status)).inc()
        self._request_seconds.labels(operation).observe(seconds)

    def count_unread_refusal(self, status: int, type_: str) -> None:
        """Count an incomplete request that was answered with a problem of this type, before any operation saw it."""
        self._requests.labels("none", "other", str(status)).inc()
        self.count_rejection(type_)

    def count_rejection(self, type_: str) -> None:
        """Count a request that was answered with a problem of this type (``/problems/...``)."""
        self._rejections.labels(type_.removeprefix("/problems/")).inc()

    def count_job(self, kind: str) -> None:
        """Count an accepted job."""
        self._jobs_accepted.labels(kind).inc()

    def count_batch(self, kind: str) -> None:
        """Count an accepted batch."""
        self._batches_accepted.labels(kind).inc()

    def count_given_up(self, pool: str, reason: str) -> None:
        """Count an analysis, a drawing, parts or a file given up."""
        self._given_up.labels(pool, reason).inc()

    def count_defect(self, operation: str) -> None:
        """Count a request refused because of a defect of the service."""
        self._defects.labels(operation).inc()

    def watch_calls(self, counts: Callable[[], Mapping[str, Mapping[str, int]]]) -> None:
        """Set the callback that gives the calls by pool and state at each read."""
        self.registry.register(_Calls(counts))

    def watch(
        self, listeners: Callable[[], int], workers: Callable[[], int], store: Callable[[], StoreFigures]
    ) -> None:
        """Set the callbacks that give the listeners, the ready workers and the figures of the store at each read."""
        self._listeners.set_function(listeners)
        self._workers.set_function(workers)
        self.registry.register(_Store(store))


class _Calls(Collector):
    """Running and waiting calls in the pools of processes that answer requests."""

    def __init__(self, counts: Callable[[], Mapping[str, Mapping[str, int]]]) -> None:
        self._counts = counts

    def describe(self) -> Iterator[GaugeMetricFamily]:
        yield _create_calls_family()

    def collect(self) -> Iterator[GaugeMetricFamily]:
        family = _create_calls_family()
        for pool, counts in self._counts().items():
            for state, calls in counts.items():
                family.add_metric([pool, state], calls)
        yield family


def _create_calls_family() -> GaugeMetricFamily:
    return GaugeMetricFamily(
        "mechsynth_calls", "Analyses, drawings, parts and files that run or wait.", labels=["pool", "state"]
    )


class _Store(Collector):
    """Unfinished jobs and sizes, read from the store, which several servers may share."""

    def __init__(self, measure: Callable[[], StoreFigures]) -> None:
        self._measure = measure

    def describe(self) -> Iterator[GaugeMetricFamily]:
        yield from _create_store_families()

    def collect(self) -> Iterator[GaugeMetricFamily]:
        try:
            figures = self._measure()
        except Exception:  # any error of the database driver: the other metrics matter even more then
            log.exception("the store could not be measured")
            return
        unfinished, oldest, size, free = _create_store_families()
        for status, jobs in figures.unfinished.items():
            unfinished.add_metric([status], jobs)
        oldest.add_metric([], figures.oldest_queued_s)
        size.add_metric([], figures.size_bytes)
        if figures.free_bytes is not None:
            free.add_metric([], figures.free_bytes)
        yield from (unfinished, oldest, size, free)


def _create_store_families() -> tuple[GaugeMetricFamily, ...]:
    return (
        GaugeMetricFamily("mechsynth_jobs_unfinished", "Unfinished jobs in the store.", labels=["status"]),
        GaugeMetricFamily("mechsynth_oldest_job_seconds", "Age of the oldest queued job; 0 without one.", labels=[]),
        GaugeMetricFamily("mechsynth_store_bytes", "Size of the database.", labels=[]),
        GaugeMetricFamily("mechsynth_store_free_bytes", "Free space on the disk of a SQLite database.", labels=[]),
    )
