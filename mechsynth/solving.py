"""Solve problems in this process or by a running service."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType
from typing import Self

from mechsynth.answers import Result
from mechsynth.progress import Progress, ProgressCallback, open_progress
from mechsynth.statements import InvalidProblem, Problem, build_statement, check_problem
from service import client as service


class Cancelled(Exception):
    """The solution was cancelled."""


def solve(
    problem: Problem, *, label: str | None = None, progress: Progress = False, cancel: threading.Event | None = None
) -> Result:
    """Solve a problem in this process.

    Parameters
    ----------
    problem : a problem of :mod:`mechsynth.kinds`, or a mapping
        The problem as a client would post it.
    label : str, optional
        Heading of the drawings.
    progress : bool or callable
        True shows a bar; a callable receives the completed share and the present step.
    cancel : threading.Event, optional
        Event that another thread sets to stop the solver at its next progress report.

    Raises
    ------
    InvalidProblem
        If the problem is invalid or contradictory, with the paths of its fields.
    Cancelled
        If ``cancel`` was set.
    """
    # Imported on demand, because the solvers take seconds to load.
    from synthesis.dispatch import solve as solved

    checked = check_problem(problem)
    with open_progress(progress) as report_progress:
        return Result(solved(checked, _stop_on_cancel(cancel, report_progress)), checked, label)


def _stop_on_cancel(cancel: threading.Event | None, report_progress: ProgressCallback) -> ProgressCallback:
    def report(fraction: float, message: str) -> None:
        # A report of progress is the only place at which a solver can be stopped.
        if cancel is not None and cancel.is_set():
            raise Cancelled("the solution was cancelled")
        report_progress(fraction, message)

    return report


class Client:
    """A running service that solves problems like :func:`solve`.

    Parameters
    ----------
    url : str
        URL of the service.
    key : str, optional
        API key, if the service has keys.
    timeout_s : float
        Time limit for one answer, seconds.

    Attributes
    ----------
    service : service.client.Client
        The underlying client for jobs, lists and analyses.
    """

    def __init__(self, url: str, key: str | None = None, *, timeout_s: float = 60.0) -> None:
        self.service = service.Client(url, key, timeout_s=timeout_s)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self.service.close()

    def solve(
        self,
        problem: Problem,
        *,
        label: str | None = None,
        progress: Progress = False,
        cancel: threading.Event | None = None,
    ) -> Result:
        """Solve a problem and wait for the answer.

        Parameters are those of the function :func:`solve`. An interrupt cancels the job, as ``cancel`` does.

        Raises
        ------
        InvalidProblem, Cancelled
            As :func:`solve`.
        ClientError
            ``Unreachable``, ``Refused``, or ``JobFailed`` if the job ended without a result.
        """
        with open_progress(progress) as report_progress:
            try:
                job = self.service.solve(
                    build_statement(problem), label=label, progress=_convert_progress(report_progress), cancel=cancel
                )
            except service.ClientError as error:
                raise _classify_error(error, cancel) from error
        return _build_result(job)

    def result(self, job_id: str) -> Result:
        """Return the answer of a finished job; raises as :meth:`solve`."""
        return _build_result(self.service.job(job_id).with_result())


class AsyncClient:
    """The client for event loops. Cancelling a waiting task cancels its job.

    Parameters
    ----------
    url, key, timeout_s
        As for :class:`Client`.
    """

    def __init__(self, url: str, key: str | None = None, *, timeout_s: float = 60.0) -> None:
        self.service = service.AsyncClient(url, key, timeout_s=timeout_s)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the connections."""
        await self.service.close()

    async def solve(self, problem: Problem, *, label: str | None = None, progress: Progress = False) -> Result:
        """Solve a problem and wait for the answer; raises as :meth:`Client.solve`."""
        with open_progress(progress) as report_progress:
            try:
                job = await self.service.solve(
                    build_statement(problem), label=label, progress=_convert_progress(report_progress)
                )
            except service.ClientError as error:
                raise _classify_error(error, None) from error
        return _build_result(job)

    async def result(self, job_id: str) -> Result:
        """Return the answer of a finished job; raises as :meth:`Client.solve`."""
        return _build_result((await self.service.job(job_id)).with_result())


def _convert_progress(report_progress: ProgressCallback) -> Callable[[service.Progress], None]:
    return lambda progress: report_progress(progress.fraction, progress.message)


def _build_result(job: service.Job) -> Result:
    assert job.result is not None
    return Result.from_json(job.problem, job.result, job.label)


_PROBLEM_POINTER = "/problem"
"""JSON pointer to the problem in a request body."""


def _classify_error(error: service.ClientError, cancel: threading.Event | None) -> Exception:
    """Convert an error of the client to the exceptions of this package."""
    if isinstance(error, service.JobFailed) and error.job.status == "cancelled":
        return Cancelled(str(error))
    if isinstance(error, service.Refused):
        # Deleting a job that has just ended removes it; the client then finds no job.
        if cancel is not None and cancel.is_set() and error.status == 404:
            return Cancelled("the job had already ended when it was cancelled, and was removed")
        # Faults elsewhere, such as in the label, are no faults of the problem.
        if error.status == 422 and error.errors and all(_is_in_problem(path) for path in error.errors):
            return InvalidProblem(
                {path.removeprefix(_PROBLEM_POINTER): detail for path, detail in error.errors.items()}
            )
    return error


def _is_in_problem(path: str) -> bool:
    return path == _PROBLEM_POINTER or path.startswith(f"{_PROBLEM_POINTER}/")
