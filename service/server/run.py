"""Execution of the service: it binds the port, starts all parts, and stops them in order."""

from __future__ import annotations

import fcntl
import signal
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from ipaddress import ip_address
from types import FrameType
from typing import IO

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.access.keys import KeyStore
from service.jobs.executor import Executor
from service.jobs.store.database import connect, find_sqlite_file
from service.jobs.workers.local_executor import LocalExecutor
from service.observability import logs
from service.observability.metrics import Metrics
from service.server.precompile import Compilation, list_analysis_parts, list_parts
from service.settings import Settings

log = structlog.get_logger(__name__)


class ServeError(Exception):
    """The service cannot run here; the message is for the operator."""


def serve(settings: Settings) -> None:
    """Run the service until SIGINT or SIGTERM.

    Raises
    ------
    ServeError
        If the port or the data folder is not available, or the start fails.
    """
    signal.signal(signal.SIGTERM, _raise_stop)
    signal.signal(signal.SIGINT, _raise_stop)
    logs.configure(settings.log_level, settings.log_format)
    with _lock_data_folder(settings), _lock_store(settings), _open_listener(settings, _is_open(settings)) as listener:
        metrics = Metrics()
        executor = _create_executor(settings, metrics)
        compilation = _create_compilation(settings)
        try:
            # A worker takes as long to start as the web framework to import: in parallel, the service is ready in half
            # the time. The tables are created in between, long before any worker gets a job.
            executor.start()
            from service.server.web import WebServer

            compilation.start(after=lambda: executor.count_ready_workers() > 0)
            WebServer(settings, executor, metrics, compilation.state).run(sockets=[listener])
        except _StopSignal:
            pass
        except SystemExit:  # uvicorn's signal that the application did not start
            raise ServeError("the service could not start; the log above has the reason") from None
        finally:
            compilation.stop()
            executor.stop()


class _StopSignal(BaseException):
    """End of the program by SIGINT or SIGTERM; like KeyboardInterrupt, error handlers must not catch it."""


def _raise_stop(_signal: int, _frame: FrameType | None) -> None:
    # Before the server runs, this ends the start. The running server has its own handlers and raises the signal again
    # when it has stopped.
    raise _StopSignal


def _create_executor(settings: Settings, metrics: Metrics) -> Executor:
    try:
        if settings.executor == "cluster":
            # It imports the driver of PostgreSQL, which only the extra `cluster` installs.
            from service.jobs.cluster.executor import ClusterExecutor

            return ClusterExecutor(settings)
        return LocalExecutor(settings, metrics)
    except (SQLAlchemyError, ImportError, OSError) as error:
        raise _build_database_error(error) from None


def _create_compilation(settings: Settings) -> Compilation:
    """Create the compilation of the server: all kernels, or only its own if worker hosts run the jobs."""
    wanted = list_parts if settings.executor == "local" else list_analysis_parts
    return Compilation(wanted, settings.log_level, settings.log_format, ahead=settings.compile_ahead)


def _build_database_error(error: Exception) -> ServeError:
    # The message omits the URL, which may contain a password.
    return ServeError(f"cannot use the database ({type(error).__name__}); set MECHSYNTH_DATABASE_URL")


def _is_open(settings: Settings) -> bool:
    """Return whether the service is open for lack of keys; it then serves this machine only."""
    try:
        engine = connect(settings.store_url, durable=False)
        try:
            return not KeyStore(engine).has_keys()
        finally:
            engine.dispose()
    except (SQLAlchemyError, ImportError, OSError) as error:
        raise _build_database_error(error) from None


@contextmanager
def _open_listener(settings: Settings, only_here: bool) -> Iterator[socket.socket]:
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            settings.host, settings.port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
    except OSError:
        raise ServeError(f"the host {settings.host!r} has no address; set MECHSYNTH_HOST") from None
    if only_here:
        if "*" in settings.cors_origins:
            log.warning(
                "there are no API keys, and MECHSYNTH_CORS_ORIGINS admits every web page: any page shown by a browser "
                "on this machine can read and cancel all jobs; name the origins, or create a key",
            )
        if not ip_address(str(address[0]).partition("%")[0]).is_loopback:
            log.warning(
                "there are no API keys, so the service listens on 127.0.0.1 and not on the configured host; "
                "`mechsynth keys create NAME` creates a key",
                told=settings.host,
            )
            family, address = socket.AF_INET, ("127.0.0.1", settings.port)
        else:
            log.info("there are no API keys: the service is open to this machine only")
    with socket.socket(family, kind, protocol) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind(address)
        except OSError as error:
            raise ServeError(
                f"cannot listen on {settings.host} port {settings.port} ({error.strerror}); "
                "stop the program that uses the port, or set MECHSYNTH_PORT"
            ) from None
        yield listener


@contextmanager
def _lock_data_folder(settings: Settings) -> Iterator[None]:
    """Lock the data folder against other servers: each would requeue the jobs that the other one runs.

    The servers of a cluster do not use the folder.
    """
    if settings.executor == "cluster":
        yield
        return
    try:
        settings.data_dir.mkdir(parents=True, exist_ok=True)
        lock = open(settings.data_dir / "server.lock", "w")  # noqa: SIM115 (closed below)
    except OSError as error:
        raise ServeError(
            f"cannot write to the data folder {settings.data_dir} ({error.strerror}); set MECHSYNTH_DATA_DIR"
        ) from None
    with lock:
        _take_lock(lock, f"another server uses the data folder {settings.data_dir}; stop it, or set MECHSYNTH_DATA_DIR")
        yield


@contextmanager
def _lock_store(settings: Settings) -> Iterator[None]:
    """Lock the store against other servers, too, since it may lie outside the data folder."""
    try:
        file = find_sqlite_file(settings.store_url)
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
            lock = open(f"{file}.lock", "w")  # noqa: SIM115 (closed below)
    except (SQLAlchemyError, OSError) as error:
        raise _build_database_error(error) from None
    if file is None:
        yield
        return
    with lock:
        _take_lock(lock, "another server uses the same database; stop it, or set MECHSYNTH_DATABASE_URL")
        yield


def _take_lock(lock: IO[str], taken: str) -> None:
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise ServeError(taken) from None
