"""Documents of the API, which are constants of this version: built once, kept in the user's cache folder, and served.

Building them takes seconds of processor time and a hundred megabytes, so a process of their own does it, in the
background when the service is ready. Requests that come earlier wait for it, and other requests do not notice.
"""

from __future__ import annotations

import asyncio
import fcntl
import os
import shutil
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import IO

import structlog

from kinematics.message import compose
from service.api.http.cached_representation import Representation
from service.api.http.problem_details import Refusal
from service.jobs.processes.parent_death import bind_to_parent, export_parent_pid
from service.observability import logs
from service.parts.export.cad_available import is_installed

Build = Callable[[], Iterator[Mapping[str, bytes]]]
"""A function that yields documents by name, as JSON packed with gzip; first those that clients need first."""

MAX_WAIT_S = 45.0
"""Time that a request waits for the documents to be built, seconds; it takes six seconds on an idle machine."""

OUTDATED_S = 30 * 86_400.0
"""Age after which the documents of another version are removed from the cache folder, seconds."""

_SUFFIX = ".json.gz"
_PERIOD_S = 0.05
"""Period of the checks whether to build, whether to stop, and whether the documents are there, seconds."""

_ROOT = Path(__file__).resolve().parents[3]
_PACKAGES = ("kinematics", "synthesis", "service")

log = structlog.get_logger(__name__)


class Documents:
    """Serves the documents, from the cache folder or as soon as they are built. For use on one event loop only.

    Without ``ahead`` they are built when a request needs them.
    """

    def __init__(self, build: Build, log_level: str, log_format: logs.Format, *, ahead: bool) -> None:
        self._build, self._log_as, self._ahead = build, (log_level, log_format), ahead
        self._asked, self._stopping = threading.Event(), threading.Event()
        self._served: dict[str, Representation] = {}
        self._thread: threading.Thread | None = None

    def start(self, after: Callable[[], bool]) -> None:
        """Read the documents in the background, or build them once ``after`` returns true or a request waits."""
        self._thread = threading.Thread(target=self._prepare, args=(after,), name="documents", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End the process that builds the documents."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    async def find(self, name: str) -> Representation:
        """Return a document.

        Raises
        ------
        Refusal
            503 if the document is not ready in time.
        """
        self._asked.set()
        latest = time.monotonic() + MAX_WAIT_S
        while name not in self._served and time.monotonic() < latest and not self._stopping.is_set():
            # The thread that receives the documents belongs to no event loop, so its progress is polled.
            await asyncio.sleep(_PERIOD_S)
        if name not in self._served:
            raise Refusal(
                503, "busy", "service-title-busy", compose("service-documents-not-ready"), headers={"Retry-After": "5"}
            )
        return self._served[name]

    def _prepare(self, after: Callable[[], bool]) -> None:
        try:
            self._serve(read_documents() or {})
            while not self._served:
                while not self._asked.is_set() and not (self._ahead and after()):
                    if self._stopping.wait(_PERIOD_S):
                        return
                self._asked.clear()
                if self._build_in_process() or self._stopping.is_set():
                    return
                log.error("the process that builds the documents of the API has died")
                # From now on nothing but a request makes it try again.
                after = self._asked.is_set
        except Exception:
            # An error that ends this thread would otherwise leave no trace. Requests for documents are answered 503.
            log.exception("the documents of the API could not be prepared")

    def _serve(self, documents: Mapping[str, bytes]) -> None:
        self._served |= {
            name: Representation.from_packed(packed, "application/json") for name, packed in documents.items()
        }

    def _build_in_process(self) -> bool:
        """Build the documents in a process and serve them; return whether it has sent all of them."""
        export_parent_pid()
        context = get_context("spawn")
        ours, theirs = context.Pipe(duplex=False)
        arguments = theirs, self._build, os.getpid(), *self._log_as
        process = context.Process(target=_send_documents, args=arguments, name="documents", daemon=True)
        process.start()
        theirs.close()
        try:
            while not self._stopping.is_set():
                if ours.poll(_PERIOD_S):
                    documents = ours.recv()
                    if documents is None:
                        return True
                    self._serve(documents)
        except EOFError:
            self._served = {}
        finally:
            ours.close()
            process.kill()
            process.join()
        return False


def read_documents() -> dict[str, bytes] | None:
    """Return the documents of this version from the cache folder; None if they are not there."""
    folder = find_folder()
    try:
        return {file.name.removesuffix(_SUFFIX): file.read_bytes() for file in folder.iterdir()} if folder else None
    except OSError:
        return None


def write_documents(build: Build) -> Iterator[Mapping[str, bytes]]:
    """Yield all documents, and write them to the cache folder unless they are there.

    Of several processes that do so at once, one builds and the others read. A folder that cannot be written is no
    error: then each server builds the documents after its start.
    """
    folder = find_folder()
    with ExitStack() as opened:
        lock: IO[str] | None = None
        if folder is not None:
            with suppress(OSError):
                folder.parent.mkdir(parents=True, exist_ok=True)
                lock = opened.enter_context(folder.with_suffix(".lock").open("w"))
        if folder is None or lock is None:
            yield from build()
            return
        fcntl.flock(lock, fcntl.LOCK_EX)
        if (known := read_documents()) is not None:
            yield known
            return
        documents: dict[str, bytes] = {}
        for part in build():
            documents |= part
            yield part
        _write_folder(folder, documents)


def find_folder() -> Path | None:
    """Return the folder for the documents of this version, in the user's cache folder; None if the user has none."""
    given = os.environ.get("XDG_CACHE_HOME")
    try:
        caches = Path(given) if given else Path.home() / ".cache"
    except RuntimeError:  # a user without a home folder, as in some containers
        return None
    return caches / "mechsynth" / f"documents-{_compute_digest()}"


@cache
def _compute_digest() -> str:
    """Return a digest of everything that the documents depend on."""
    folders = [_ROOT / package for package in _PACKAGES]
    files = sorted(file for folder in folders for form in ("*.py", "*.ftl") for file in folder.rglob(form))
    parts = [sys.version, version("pydantic"), version("fastapi"), version("mechsynth"), str(is_installed())]
    parts += [f"{file.relative_to(_ROOT)} {sha256(file.read_bytes()).hexdigest()}" for file in files]
    return sha256("\n".join(parts).encode()).hexdigest()[:16]


def _write_folder(folder: Path, documents: Mapping[str, bytes]) -> None:
    with suppress(OSError):
        written = Path(tempfile.mkdtemp(dir=folder.parent, prefix="writing-"))
        try:
            for name, content in documents.items():
                (written / f"{name}{_SUFFIX}").write_bytes(content)
            # Other servers find either no folder or a complete one.
            written.rename(folder)
        finally:
            shutil.rmtree(written, ignore_errors=True)
        for other in folder.parent.glob("documents-*"):
            if time.time() - other.stat().st_mtime > OUTDATED_S:
                shutil.rmtree(other) if other.is_dir() else other.unlink()


def _send_documents(pipe: Connection, build: Build, parent: int, level: str, form: logs.Format) -> None:
    """Build the documents and send them; the main function of a process."""
    bind_to_parent(parent)
    logs.configure(level, form)
    for documents in write_documents(build):
        pipe.send(documents)
    pipe.send(None)  # the end
