"""A worker host: takes jobs from the broker and runs them in workers of its own (``mechsynth worker``).

The lanes and workers are those of the local executor (:mod:`service.jobs.lane`), which handle cancelling, timeouts,
memory and death; Celery only delivers the ids of the jobs. Its task waits until a lane is done with the job, so that a
host holds no more messages than it has workers. While a job runs the host renews its lease in the store, which tells
it in return which claims no longer count: their jobs are dropped.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from types import FrameType

import structlog
from celery.concurrency.thread import TaskPool
from celery.exceptions import WorkerShutdown
from prometheus_client import start_http_server
from sqlalchemy.exc import SQLAlchemyError
from ulid import ULID

from service import logs
from service.jobs.broker import TASK, Publisher, celery_app
from service.jobs.database import LaterTables, connect, unreachable, upgrade
from service.jobs.leases import LeaseStore
from service.jobs.local import LocalExecutor
from service.jobs.recovery import Recovery
from service.metrics import HostMetrics
from service.settings import Settings

BEAT_PERIOD_S = 0.5
"""Period at which a host renews its leases and looks for cancelled jobs, which must stop within two seconds."""

STARVED_S = 5.0
"""A host that has had nothing to do for so long, while jobs wait for as long, takes them from the store itself: after
the broker was restarted its consumer may be connected and yet be given no messages any more."""

MAX_TAKEN = 50
"""Jobs that it then takes at once."""

log = structlog.get_logger(__name__)


class HostError(Exception):
    """The worker host cannot run here; the message is a sentence for the operator."""


class Host:
    """The lanes of a host, and the tasks that wait for their jobs."""

    def __init__(self, settings: Settings, metrics: HostMetrics) -> None:
        self.id = str(ULID())
        self.lanes = LocalExecutor(settings, metrics)
        self._engine = connect(settings.store_url, durable=False)
        self._leases = LeaseStore(self._engine)
        self._publisher = Publisher(settings)
        self._recovery = Recovery(self._leases, self._publisher, lambda: None)
        self._beating = threading.Thread(target=self._beat, name="beat", daemon=True)
        self._stopping = threading.Event()
        self._lock = threading.Lock()
        self._waiting: dict[str, list[threading.Event]] = {}
        metrics.watch(self.lanes.ready, lambda: len(self.lanes.claims()), self.waiting)

    def start(self) -> None:
        """Make the tables where they are missing, and start the lanes."""
        upgrade(self._engine)
        self.lanes.subscribe(self._done_with)
        self.lanes.start()
        self._beating.start()
        self._recovery.start()

    def work(self, job_id: str) -> None:
        """Have a lane run the job, and wait until it is done with it."""
        done = threading.Event()
        with self._lock:
            self._waiting.setdefault(job_id, []).append(done)
        self.lanes.submit(job_id)
        while not done.wait(BEAT_PERIOD_S):
            if self._stopping.is_set():
                return

    def waiting(self) -> int:
        """Number of jobs of the host that no lane has started."""
        with self._lock:
            taken = set(self._waiting)
        return len(taken.difference(self.lanes.claims().values()))

    def stop(self) -> None:
        """Put the running jobs back into the queue and end the workers. May be called again."""
        if self._stopping.is_set():
            return
        self._stopping.set()
        self._recovery.stop()
        self.lanes.stop()
        try:
            self._leases.host_is_gone(self.id)
        except SQLAlchemyError as error:  # then its last sign of life expires
            log.warning("the store does not answer", error=type(error).__name__)
        self._publisher.close()

    def _done_with(self, job_id: str | None) -> None:
        with self._lock:
            waiting = self._waiting.pop(job_id or "", [])
        for done in waiting:
            done.set()

    def _take_overdue(self) -> None:
        overdue = self._leases.overdue(STARVED_S, MAX_TAKEN)
        for job_id in overdue:
            self.lanes.submit(job_id)
        if overdue:
            log.warning("the broker brings no jobs; taken from the store", jobs=len(overdue))

    def _beat(self) -> None:
        busy_at = time.monotonic()
        while not self._stopping.wait(BEAT_PERIOD_S):
            try:
                claims = self.lanes.claims()
                for claim in self._leases.renew(claims):
                    self.lanes.drop(claim)
                self._leases.host_is_there(self.id, self.lanes.ready())
                if claims or self.waiting() or not self.lanes.ready():
                    busy_at = time.monotonic()
                elif time.monotonic() > busy_at + STARVED_S:
                    self._take_overdue()
                    busy_at = time.monotonic()
            except SQLAlchemyError as error:
                if not unreachable(error):
                    log.exception("the leases could not be renewed")
            except Exception:  # whatever it is, the next beat must come
                log.exception("the leases could not be renewed")


def run_host(settings: Settings) -> None:
    """Run a worker host until SIGINT or SIGTERM.

    Raises
    ------
    HostError
        When the port of its metrics cannot be had, or the store is of a later version.
    SQLAlchemyError, OSError
        When the store cannot be reached.
    """
    logs.configure(settings.log_level, settings.log_format)
    metrics = HostMetrics()
    host = Host(settings, metrics)
    show(metrics, settings)
    signal.signal(signal.SIGTERM, _end)
    signal.signal(signal.SIGINT, _end)
    try:
        _start(host)
        app = celery_app(settings, publisher=False)
        app.task(host.work, name=TASK)
        announcement = threading.Thread(target=_announce, args=(host,), name="announcement", daemon=True)
        announcement.start()
        app.WorkController(
            hostname=f"{host.id}@{os.uname().nodename}",
            pool_cls=_pool_of(host),
            concurrency=settings.workers,
            without_mingle=True,
            without_gossip=True,
            without_heartbeat=True,
        ).start()
    except WorkerShutdown:
        pass
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        host.stop()


def _start(host: Host) -> None:
    try:
        host.start()
    except LaterTables as error:
        raise HostError(str(error)) from None


def show(metrics: HostMetrics, settings: Settings) -> None:
    """Serve the metrics to Prometheus where the settings say so, in a thread that ends with the process.

    Raises
    ------
    HostError
        When the port cannot be had.
    """
    address, port = settings.worker_metrics_host, settings.worker_metrics_port
    if port is None:
        return
    try:
        start_http_server(port, address, metrics.registry)
    except OSError as error:
        raise HostError(
            f"cannot show metrics on {address} port {port} ({error.strerror}); set MECHSYNTH_WORKER_METRICS_PORT"
        ) from None
    log.info("metrics", host=address, port=port)


def _end(_signal: int, _frame: FrameType | None) -> None:
    raise WorkerShutdown(0)


def _announce(host: Host) -> None:
    while host.lanes.ready() == 0:
        time.sleep(BEAT_PERIOD_S / 10)  # lanes announce nothing when they are ready; this polls at the start only
    print(f"mechsynth worker {host.id} is ready", flush=True)


def _pool_of(host: Host) -> type[TaskPool]:
    """A pool of Celery whose tasks wait in threads for the lanes of a host and report to Celery's event loop."""

    class LanePool(TaskPool):
        """Ends the lanes first when it is stopped, so that the tasks end."""

        def on_stop(self) -> None:
            host.stop()
            super().on_stop()

    return LanePool
