"""Problems solved in this process, or by a service."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Any, Self

from mechsynth.answers import Result
from mechsynth.progress import Progress, ProgressCallback, open_progress
from mechsynth.statements import InvalidProblem, Problem, build_statement, check_problem
from service import client as service


class Cancelled(Exception):
    """The problem was given up before it was solved."""


def solve(
    problem: Problem, *, label: str | None = None, progress: Progress = False, cancel: threading.Event | None = None
) -> Result:
    """Solve a problem in this process.

    Parameters
    ----------
    problem : a problem of :mod:`mechsynth.kinds`, or a mapping
        What a client would post as ``problem``.
    label : str, optional
        The heading of drawings.
    progress : bool or callable
        True shows a bar; a callable is told the share that is done and what is being done.
    cancel : threading.Event, optional
        Set by another thread, it stops the solver at its next report of progress.

    Raises
    ------
    InvalidProblem
        For a problem that is ill-formed or contradicts itself, with the paths of its fields.
    Cancelled
        When ``cancel`` was set.
    """
    from synthesis.dispatch import solve as solved

    asked = check_problem(problem)
    with open_progress(progress) as told:
        return Result(solved(asked, _stop_on_cancel(cancel, told)), asked, label)


def _stop_on_cancel(cancel: threading.Event | None, report_progress: ProgressCallback) -> ProgressCallback:
    def report(fraction: float, message: str) -> None:
        if cancel is not None and cancel.is_set():
            raise Cancelled("the problem was given up")
        report_progress(fraction, message)

    return report


class Client:
    """A running service, which solves problems as :func:`solve` does.

    Parameters
    ----------
    url : str
        Where it is.
    key : str, optional
        Its API key, where it has keys.
    timeout_s : float
        How long one answer may take, seconds.

    Attributes
    ----------
    service : service.client.Client
        What speaks with it: jobs, lists, analyses.
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
        """Have a problem solved, and wait for the answer. An interrupt cancels the job, as ``cancel`` does.

        Raises
        ------
        InvalidProblem, Cancelled
            As :func:`solve`.
        ClientError
            ``Unreachable``, ``Refused``, or ``JobFailed`` where the job has ended without a result.
        """
        with open_progress(progress) as told:
            try:
                job = self.service.solve(
                    build_statement(problem), label=label, progress=_convert_progress(told), cancel=cancel
                )
            except service.ClientError as error:
                raise _classify_error(error, cancel) from error
        return _build_result(job)

    def result(self, job_id: str) -> Result:
        """The answer of a job that has ended; raises as :meth:`solve`."""
        return _build_result(self.service.job(job_id).with_result())


class AsyncClient:
    """The same on an event loop; who cancels a task that waits cancels its job.

    Parameters
    ----------
    url, key, timeout_s
        As of :class:`Client`.
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
        """Have a problem solved, and wait for the answer; raises as :meth:`Client.solve`."""
        with open_progress(progress) as told:
            try:
                job = await self.service.solve(build_statement(problem), label=label, progress=_convert_progress(told))
            except service.ClientError as error:
                raise _classify_error(error, None) from error
        return _build_result(job)

    async def result(self, job_id: str) -> Result:
        """The answer of a job that has ended; raises as :meth:`Client.solve`."""
        return _build_result((await self.service.job(job_id)).with_result())


def _convert_progress(report_progress: ProgressCallback) -> Any:
    return lambda progress: report_progress(progress.fraction, progress.message)


def _build_result(job: service.Job) -> Result:
    assert job.result is not None
    return Result.from_json(job.problem, job.result, job.label)


_PROBLEM_POINTER = "/problem"
"""Where the problem stands in the body of a request."""


def _classify_error(error: service.ClientError, cancel: threading.Event | None) -> Exception:
    """What a fault of a client is called here."""
    if isinstance(error, service.JobFailed) and error.job.status == "cancelled":
        return Cancelled(str(error))
    if isinstance(error, service.Refused):
        if cancel is not None and cancel.is_set() and error.status == 404:
            return Cancelled("the job had ended when it was given up, and was removed")
        if error.status == 422 and error.errors and all(_is_in_problem(path) for path in error.errors):
            return InvalidProblem({path.removeprefix(_PROBLEM_POINTER): told for path, told in error.errors.items()})
    return error


def _is_in_problem(path: str) -> bool:
    return path == _PROBLEM_POINTER or path.startswith(f"{_PROBLEM_POINTER}/")
