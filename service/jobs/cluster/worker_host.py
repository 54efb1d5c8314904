"""A worker host: takes jobs from the store and runs them in its own workers (``mechsynth worker``).

The lanes and workers are those of the local executor (:mod:`service.jobs.workers.lane`), which handle turns,
cancellation, timeouts, memory limits and dead workers. A host with a free lane asks the store for the job whose turn it
is, when PostgreSQL notifies it of a queued job and once a second. While a job runs the host renews its lease; the store
answers with the claims that are no longer valid, and the host drops their jobs.
"""

from __future__ import annotations

import signal
import threading
import time
from types import FrameType

import structlog
from prometheus_client import start_http_server
from sqlalchemy.exc import SQLAlchemyError
from ulid import ULID

from service.jobs.cluster.leases import LeaseStore
from service.jobs.cluster.listener import StoreListener
from service.jobs.cluster.notifier import WORK_CHANNEL, StoreNotifier, read_count
from service.jobs.cluster.recovery import Recovery
from service.jobs.store.database import LaterTables, connect, is_unreachable, upgrade
from service.jobs.workers.local_executor import LocalExecutor
from service.kernels import Compiling
from service.observability import logs
from service.observability.metrics import HostMetrics
from service.settings import Settings

BEAT_PERIOD_S = 0.5
"""Period at which a host renews its leases and checks for cancelled jobs, seconds; these must stop within 2 s."""

STOP_TIMEOUT_S = 2.0
"""Time limit for the last notifications of a host that stops, seconds."""

log = structlog.get_logger(__name__)


class HostError(Exception):
    """The worker host cannot run here; the message is a sentence for the operator."""


class Host:
    """The lanes of a host, and the threads that wake them and renew their leases."""

    def __init__(self, settings: Settings, metrics: HostMetrics, compilation: Compiling) -> None:
        self.id = str(ULID())
        self.lanes = LocalExecutor(settings, metrics)
        self._compilation = compilation
        self._engine = connect(settings.store_url, durable=False)
        self._leases = LeaseStore(self._engine)
        self._recovery = Recovery(self._leases)
        self._beating = threading.Thread(target=self._run_heartbeat, name="beat", daemon=True)
        self._notifier = StoreNotifier(settings.store_url)
        self._listener = StoreListener(
            settings.store_url, WORK_CHANNEL, lambda payload: self.lanes.wake(read_count(payload))
        )
        self._stopping = threading.Event()
        metrics.watch(self.lanes.count_ready_workers, lambda: len(self.lanes.list_claims()))

    def start(self) -> None:
        """Create missing tables and start the lanes."""
        upgrade(self._engine)
        self.lanes.subscribe(self._notifier.announce_change)
        self.lanes.start()
        self.lanes.open()
        self._compilation.start(after=lambda: self.lanes.count_ready_workers() > 0)
        self._beating.start()
        self._recovery.start()
        self._notifier.start()
        self._listener.start()

    def stop(self) -> None:
        """Requeue the running jobs and end the workers."""
        self._stopping.set()
        self._compilation.stop()
        self._recovery.stop()
        self._listener.stop()
        running = len(self.lanes.list_claims())
        self.lanes.stop()
        for _ in range(running):  # they are queued again
            self._notifier.announce_work()
        self._notifier.stop()
        try:
            self._leases.remove_host(self.id)
        except SQLAlchemyError as error:  # the host's last sign of life then expires by itself
            log.warning("the store does not answer", error=type(error).__name__)
        if self._notifier.is_alive():
            self._notifier.join(STOP_TIMEOUT_S)

    def _run_heartbeat(self) -> None:
        while not self._stopping.wait(BEAT_PERIOD_S):
            try:
                for claim in self._leases.renew(self.lanes.list_claims()):
                    self.lanes.drop(claim)
                self._leases.record_host(self.id, self.lanes.count_ready_workers())
            except SQLAlchemyError as error:
                if not is_unreachable(error):
                    log.exception("the leases could not be renewed")
            except Exception:  # the next heartbeat must come after any error
                log.exception("the leases could not be renewed")


def run_host(settings: Settings, compilation: Compiling) -> None:
    """Run a worker host until SIGINT or SIGTERM.

    Raises
    ------
    HostError
        If the port for its metrics is not available, or the store belongs to a later version.
    SQLAlchemyError, OSError
        If the store cannot be reached.
    """
    logs.configure(settings.log_level, settings.log_format)
    metrics = HostMetrics()
    host = Host(settings, metrics, compilation)
    serve_metrics(metrics, settings)
    signal.signal(signal.SIGTERM, _raise_stop)
    signal.signal(signal.SIGINT, _raise_stop)
    try:
        _start(host)
        _report_ready(host)
        while True:
            signal.pause()
    except _StopSignal:
        pass
    finally:
        # A second signal must not interrupt the requeueing of jobs.
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        host.stop()


def _start(host: Host) -> None:
    try:
        host.start()
    except LaterTables as error:
        raise HostError(str(error)) from None


def serve_metrics(metrics: HostMetrics, settings: Settings) -> None:
    """Serve the metrics to Prometheus if the settings name a port, in a thread that ends with the process.

    Raises
    ------
    HostError
        If the port is not available.
    """
    address, port = settings.worker_metrics_host, settings.worker_metrics_port
    if port is None:
        return
    try:
        start_http_server(port, address, metrics.registry)
    except OSError as error:
        raise HostError(
            f"cannot serve metrics on {address} port {port} ({error.strerror}); set MECHSYNTH_WORKER_METRICS_PORT"
        ) from None
    log.info("metrics", host=address, port=port)


class _StopSignal(BaseException):
    """End of the program by SIGINT or SIGTERM; like KeyboardInterrupt, error handlers must not catch it."""


def _raise_stop(_signal: int, _frame: FrameType | None) -> None:
    raise _StopSignal


def _report_ready(host: Host) -> None:
    while host.lanes.count_ready_workers() == 0:
        time.sleep(BEAT_PERIOD_S / 10)  # lanes send no event when they are ready; this polls only at the start
    print(f"mechsynth worker {host.id} is ready", flush=True)
