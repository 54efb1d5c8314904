"""A client of the service for Python programs.

>>> with Client("http://127.0.0.1:8000") as client:  # doctest: +SKIP
...     job = client.solve({"kind": "motion", "positions": [...]})
...     drawing = client.file(job.id, 0, "svg")

It needs httpx and nothing of the service. Problems and results are plain JSON objects, as the reference describes them;
jobs and events are values. What can be sent again safely is sent again when the connection or the service fails for a
moment: a problem goes with an ``Idempotency-Key``, so that it makes one job however often it is sent.

    ClientError
    +-- Unreachable     no answer, after several attempts
    +-- Refused         the service has said no: a problem with type, status and details
    +-- JobFailed       the job has ended without a result
"""

from __future__ import annotations

import json
import time
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from types import TracebackType
from typing import Any, Literal, Self

import httpx

Json = dict[str, Any]
Status = Literal["queued", "running", "succeeded", "failed", "cancelled"]

ATTEMPTS = 4
"""How often a request is sent in all before it is given up."""

RESUMPTIONS = 8
"""How often in a row a broken stream is resumed: for a minute, which a service may take to start again."""

LONGEST_PAUSE_S = 30.0
_SILENCE_S = 60.0  # the service breaks the silence of a stream every 15 seconds
_TEMPORARY = (429, 502, 503, 504)


class ClientError(Exception):
    """Something did not work out; see the tree above."""


class Unreachable(ClientError):
    """The service does not answer at this URL."""


class Refused(ClientError):
    """The service has answered with a problem (RFC 9457)."""

    def __init__(self, status: int, problem: Mapping[str, Any]) -> None:
        self.status = status
        self.type = str(problem.get("type", "about:blank"))
        self.detail = str(problem.get("detail", ""))
        self.errors = {str(fault["path"]): str(fault["detail"]) for fault in problem.get("errors") or ()}
        lines = [f"{status}: {self.detail}", *(f"  {path or '/'}: {detail}" for path, detail in self.errors.items())]
        super().__init__("\n".join(lines))


class JobFailed(ClientError):
    """The job has ended without a result."""

    def __init__(self, job: Job) -> None:
        self.job = job
        super().__init__(f"the job is {job.status}: {(job.error or {}).get('detail', 'it was cancelled')}")


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a job is: the share that is done, and what is being done."""

    fraction: float
    message: str


@dataclass(frozen=True, slots=True)
class JobSummary:
    """A job as it is listed."""

    id: str
    kind: str
    label: str | None
    status: Status
    created_at: str
    started_at: str | None
    finished_at: str | None
    progress: Progress

    @property
    def finished(self) -> bool:
        """Whether the job will not change any more."""
        return self.status not in ("queued", "running")


@dataclass(frozen=True, slots=True)
class Job(JobSummary):
    """A job with its problem and, once it has one, its answer."""

    problem: Json
    result: Json | None
    error: Json | None


class Client:
    """Talks to one service, over one pool of connections.

    Parameters
    ----------
    url
        Where the service is, ``http://127.0.0.1:8000``.
    key
        The API key, where the service has keys.
    timeout_s
        How long one answer may take.
    """

    def __init__(self, url: str, key: str | None = None, *, timeout_s: float = 60.0) -> None:
        headers = {} if key is None else {"Authorization": f"Bearer {key}"}
        self._http = httpx.Client(base_url=url, headers=headers, timeout=timeout_s)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def submit(self, problem: Mapping[str, Any], *, label: str | None = None, wait_s: int = 0) -> Job:
        """Have a problem solved; waits ``wait_s`` seconds (30 at most) for the end of the job."""
        body = {"problem": dict(problem), **({} if label is None else {"label": label})}
        headers = {"Idempotency-Key": uuid.uuid4().hex, **({"Prefer": f"wait={wait_s}"} if wait_s > 0 else {})}
        return _job(self._asked("POST", "/v1/jobs", json=body, headers=headers).json())

    def job(self, job_id: str) -> Job:
        """The job as it stands."""
        return _job(self._asked("GET", f"/v1/jobs/{job_id}").json())

    def jobs(self, *, status: Status | None = None, kind: str | None = None) -> Iterator[JobSummary]:
        """The jobs, newest first, page by page as they are asked for."""
        query: dict[str, str] = {name: value for name, value in (("status", status), ("kind", kind)) if value}
        while True:
            page = self._asked("GET", "/v1/jobs", params=query).json()
            yield from (_summary(listed) for listed in page["jobs"])
            if page["next_cursor"] is None:
                return
            query["cursor"] = page["next_cursor"]

    def delete(self, job_id: str) -> None:
        """Cancel an unfinished job, or remove a finished one."""
        self._asked("DELETE", f"/v1/jobs/{job_id}")

    def follow(self, job_id: str) -> Iterator[JobSummary | Progress]:
        """What happens to a job, as it happens: the job at each change of its state, its progress in between.

        Ends with the job in its final state. A broken stream is resumed where it broke.
        """
        last: str | None = None
        failures = 0
        while True:
            headers = {} if last is None else {"Last-Event-ID": last}
            timeout = httpx.Timeout(_SILENCE_S)
            try:
                with self._http.stream("GET", f"/v1/jobs/{job_id}/events", headers=headers, timeout=timeout) as answer:
                    if answer.status_code == 204:
                        return
                    if answer.status_code != 200:
                        answer.read()
                        raise _refused(answer)
                    for name, data, event_id in _events(answer.iter_lines()):
                        last, failures = event_id or last, 0
                        if name == "progress":
                            yield Progress(**data)
                        elif name == "state":
                            job = _summary(data)
                            yield job
                            if job.finished:
                                return
                        elif name == "removed":
                            raise Refused(404, {"detail": "The job was removed."})
            except Refused as refusal:
                if refusal.status not in _TEMPORARY or failures >= RESUMPTIONS:
                    raise
            except httpx.TransportError as error:
                if failures >= RESUMPTIONS:
                    raise self._unreachable(error) from None
            failures += 1
            time.sleep(_pause_s(failures, None))  # not to storm a service that has just come up again

    def wait(self, job_id: str, progress: Callable[[Progress], None] | None = None) -> Job:
        """Wait until the job has ended; tells how far it is by ``progress``."""
        for news in self.follow(job_id):
            if progress is not None:
                progress(news.progress if isinstance(news, JobSummary) else news)
        return self.job(job_id)

    def solve(
        self,
        problem: Mapping[str, Any],
        *,
        label: str | None = None,
        progress: Callable[[Progress], None] | None = None,
    ) -> Job:
        """Have a problem solved, and wait for its result.

        Raises
        ------
        JobFailed
            When the job ends without a result. That no design exists is a result.
        """
        job = self.submit(problem, label=label, wait_s=1)
        if not job.finished:
            job = self.wait(job.id, progress)
        if job.result is None:
            raise JobFailed(job)
        return job

    def file(self, job_id: str, design: int, form: str) -> bytes | None:
        """A drawing or table of a design (``svg``, ``dxf``, ``csv``, ...); None where its mechanism has none such."""
        try:
            return self._asked("GET", f"/v1/jobs/{job_id}/designs/{design}.{form}").content
        except Refused as refusal:
            if refusal.status == 404:
                return None
            raise

    def motion(self, job_id: str, design: int, *, steps: int = 360) -> Json:
        """A design over its cycle, joint by joint."""
        return _object(self._asked("GET", f"/v1/jobs/{job_id}/designs/{design}/motion", params={"steps": steps}))

    def analyse(self, mechanism: Mapping[str, Any], motion: Mapping[str, Any]) -> Json:
        """What the analysis core knows of a given mechanism."""
        return _object(self._asked("POST", "/v1/analyses", json={"mechanism": dict(mechanism), "motion": dict(motion)}))

    def problems(self) -> dict[str, Json]:
        """The kinds of problems, each with title, description, schema and an example that runs."""
        return {listed["kind"]: listed for listed in self._asked("GET", "/v1/problems").json()["problems"]}

    def _asked(self, method: str, path: str, **request: Any) -> httpx.Response:
        """The answer to a request that may be sent again."""
        attempt = 0
        while True:
            attempt += 1
            retry_after = None
            try:
                answer = self._http.request(method, path, **request)
            except httpx.TransportError as error:
                if attempt >= ATTEMPTS:
                    raise self._unreachable(error) from None
            else:
                if answer.is_success:
                    return answer
                if answer.status_code not in _TEMPORARY or attempt >= ATTEMPTS:
                    raise _refused(answer)
                retry_after = answer.headers.get("retry-after")
            time.sleep(_pause_s(attempt, retry_after))  # what the service asks for, or longer each time

    def _unreachable(self, error: Exception) -> Unreachable:
        return Unreachable(f"no answer from {self._http.base_url} ({type(error).__name__}: {error})")


def _pause_s(attempt: int, retry_after: str | None) -> float:
    asked_for = float(retry_after) if retry_after is not None and retry_after.isdecimal() else 0.1 * 2**attempt
    return min(asked_for, LONGEST_PAUSE_S)


def _refused(answer: httpx.Response) -> Refused:
    try:
        problem = answer.json()
    except ValueError:
        problem = None
    return Refused(answer.status_code, problem if isinstance(problem, dict) else {"detail": answer.reason_phrase})


def _events(lines: Iterator[str]) -> Iterator[tuple[str, Json, str | None]]:
    """Name, data and id of each server-sent event; comments are passed over."""
    name, data, event_id = "message", "", None
    for line in lines:
        field, _, value = line.partition(":")
        value = value.removeprefix(" ")
        match field:
            case "event":
                name = value
            case "data":
                data += value
            case "id":
                event_id = value
            case "" if not line and data:
                yield name, json.loads(data), event_id
                name, data, event_id = "message", "", None


def _job(shown: Mapping[str, Any]) -> Job:
    return Job(**_values(shown, _JOB))


def _summary(listed: Mapping[str, Any]) -> JobSummary:
    return JobSummary(**_values(listed, _SUMMARY))


_JOB = [field.name for field in fields(Job)]
_SUMMARY = [field.name for field in fields(JobSummary)]


def _values(listed: Mapping[str, Any], names: Sequence[str]) -> Json:
    # Fields that a newer service has besides are passed over.
    return {**{name: listed[name] for name in names}, "progress": Progress(**listed["progress"])}


def _object(answer: httpx.Response) -> Json:
    parsed = answer.json()
    assert isinstance(parsed, dict)
    return parsed
