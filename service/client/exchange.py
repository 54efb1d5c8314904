"""How a client speaks with the service, whoever does the reading and waiting: requests, attempts and events."""

from __future__ import annotations

import json
import uuid
from collections.abc import Mapping
from typing import Any, NamedTuple

import httpx

from service.client.values import Job, JobSummary, Json, Progress, Refused, Unreachable, build_job, build_summary

MAX_ATTEMPTS = 4
"""How often a request is sent in all before it is given up."""

MAX_RESUMPTIONS = 8
"""How often in a row a broken stream is resumed: for a minute, which a service may take to start again."""

MAX_PAUSE_S = 30.0

STREAM_TIMEOUT = httpx.Timeout(60.0)
"""The service breaks the silence of a stream every 15 seconds."""

_TEMPORARY_STATUSES = (429, 502, 503, 504)


class Request(NamedTuple):
    """What is sent: a method, a path and what httpx takes besides."""

    method: str
    path: str
    more: Mapping[str, Any] = {}


def build_pool_settings(url: str, key: str | None, timeout_s: float) -> dict[str, Any]:
    """What a pool of connections to one service is made with."""
    headers = {} if key is None else {"Authorization": f"Bearer {key}"}
    return {"base_url": url, "headers": headers, "timeout": timeout_s}


def build_submission(problem: Mapping[str, Any], label: str | None, wait_s: int) -> Request:
    """A problem to be solved; the answer may be waited for, for 30 seconds at most."""
    body = {"problem": dict(problem), **({} if label is None else {"label": label})}
    headers = {"Idempotency-Key": uuid.uuid4().hex, **({"Prefer": f"wait={wait_s}"} if wait_s > 0 else {})}
    return Request("POST", "/v1/jobs", {"json": body, "headers": headers})


def build_job_request(job_id: str) -> Request:
    """The job as it stands."""
    return Request("GET", f"/v1/jobs/{job_id}")


def build_removal(job_id: str) -> Request:
    """Cancels an unfinished job, removes a finished one."""
    return Request("DELETE", f"/v1/jobs/{job_id}")


def build_file_request(job_id: str, design: int, form: str) -> Request:
    """A file of a design."""
    return Request("GET", f"/v1/jobs/{job_id}/designs/{design}.{form}")


def parse_job(answer: httpx.Response) -> Job:
    """The job in an answer."""
    return build_job(answer.json())


class Attempts:
    """How often one request was sent, and when it is sent again."""

    def __init__(self, url: object) -> None:
        self._url, self._made = url, 0

    def handle_refusal(self, answer: httpx.Response) -> float:
        """Seconds to the next attempt after an answer that is none; raises where there is no next one."""
        self._made += 1
        if answer.status_code not in _TEMPORARY_STATUSES or self._made >= MAX_ATTEMPTS:
            raise build_refusal(answer)
        return _compute_pause_s(self._made, answer.headers.get("retry-after"))

    def handle_silence(self, error: httpx.TransportError) -> float:
        """The same where there was no answer."""
        self._made += 1
        if self._made >= MAX_ATTEMPTS:
            raise _build_unreachable(self._url, error) from None
        return _compute_pause_s(self._made, None)


class EventReader:
    """Where a reader of a job's events stands: what was heard last, and how often the stream has broken since."""

    def __init__(self, job_id: str, url: object) -> None:
        self.path = f"/v1/jobs/{job_id}/events"
        self.ended = False
        self._url = url
        self._last: str | None = None
        self._failures = 0
        self._name, self._data = "message", ""
        self._id: str | None = None

    def build_request(self) -> dict[str, Any]:
        """What the stream is asked for with: from where on."""
        self._name, self._data, self._id = "message", "", None
        return {"headers": {} if self._last is None else {"Last-Event-ID": self._last}, "timeout": STREAM_TIMEOUT}

    def check_opened(self, answer: httpx.Response) -> bool:
        """Whether there is a stream to be read; there is none after the last event."""
        self.ended = answer.status_code == 204
        return answer.status_code == 200

    def parse_line(self, line: str) -> JobSummary | Progress | None:
        """What a line of the stream completes; comments, and events of other names, are passed over."""
        field, _, value = line.partition(":")
        value = value.removeprefix(" ")
        match field:
            case "event":
                self._name = value
            case "data":
                self._data += value
            case "id":
                self._id = value
            case "" if not line and self._data:
                name, data, event_id = self._name, json.loads(self._data), self._id
                self._name, self._data, self._id = "message", "", None
                self._last, self._failures = event_id or self._last, 0
                return self._parse_event(name, data)
        return None

    def _parse_event(self, name: str, data: Json) -> JobSummary | Progress | None:
        if name == "removed":
            raise Refused(404, {"detail": "The job was removed."})
        if name == "progress":
            return Progress(**data)
        if name != "state":
            return None
        job = build_summary(data)
        self.ended = job.finished
        return job

    def handle_break(self, fault: Refused | httpx.TransportError | None) -> float:
        """Seconds until the stream is resumed, not to storm a service that has just come up; raises where it is not."""
        if isinstance(fault, Refused) and (
            fault.status not in _TEMPORARY_STATUSES or self._failures >= MAX_RESUMPTIONS
        ):
            raise fault
        if isinstance(fault, httpx.TransportError) and self._failures >= MAX_RESUMPTIONS:
            raise _build_unreachable(self._url, fault) from None
        self._failures += 1
        return _compute_pause_s(self._failures, None)


def extract_progress(news: JobSummary | Progress) -> Progress:
    """How far the job is, as something that was heard of it says."""
    return news.progress if isinstance(news, JobSummary) else news


def build_refusal(answer: httpx.Response) -> Refused:
    """The refusal that an answer is."""
    try:
        problem = answer.json()
    except ValueError:
        problem = None
    return Refused(answer.status_code, problem if isinstance(problem, dict) else {"detail": answer.reason_phrase})


def _build_unreachable(url: object, error: Exception) -> Unreachable:
    return Unreachable(f"no answer from {url} ({type(error).__name__}: {error})")


def _compute_pause_s(attempt: int, retry_after: str | None) -> float:
    """What the service asks for, or longer each time."""
    asked_for = float(retry_after) if retry_after is not None and retry_after.isdecimal() else 0.1 * 2**attempt
    return min(asked_for, MAX_PAUSE_S)
