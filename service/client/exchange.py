"""The protocol shared by both clients, without any input or output: requests, attempts and events."""

from __future__ import annotations

import json
import uuid
from collections.abc import Mapping
from typing import Any, NamedTuple

import httpx

from service.client.values import Job, JobSummary, Json, Progress, Refused, Unreachable, build_job, build_summary

MAX_ATTEMPTS = 4
"""Maximum number of attempts of a request."""

MAX_RESUMPTIONS = 8
"""Maximum number of consecutive resumptions of a broken stream: about a minute, enough for a restart of the service."""

MAX_PAUSE_S = 30.0

STREAM_TIMEOUT = httpx.Timeout(60.0)
"""Timeout of a stream, on which the service sends at least a comment every 15 seconds."""

# 429 is the rate limit, 503 a full queue or a busy service; a proxy answers 502 or 504 while the service restarts.
_TEMPORARY_STATUSES = (429, 502, 503, 504)


class Request(NamedTuple):
    """A request: method, path and further arguments for httpx."""

    method: str
    path: str
    more: Mapping[str, Any] = {}


def build_pool_settings(url: str, key: str | None, timeout_s: float) -> Json:
    """Return the arguments of httpx for a pool of connections to one service."""
    headers = {} if key is None else {"Authorization": f"Bearer {key}"}
    return {"base_url": url, "headers": headers, "timeout": timeout_s}


def build_submission(problem: Mapping[str, object], label: str | None, wait_s: int) -> Request:
    """Build the request that submits a problem and waits at most ``wait_s`` (up to 30) seconds for its end."""
    # The key makes the request repeatable: a second attempt gets the job that the first has created.
    body = {"problem": dict(problem), **({} if label is None else {"label": label})}
    headers = {"Idempotency-Key": uuid.uuid4().hex, **({"Prefer": f"wait={wait_s}"} if wait_s > 0 else {})}
    return Request("POST", "/v1/jobs", {"json": body, "headers": headers})


def build_job_request(job_id: str) -> Request:
    """Build the request for the present state of a job."""
    return Request("GET", f"/v1/jobs/{job_id}")


def build_removal(job_id: str) -> Request:
    """Build the request that cancels an unfinished job or removes a finished one."""
    return Request("DELETE", f"/v1/jobs/{job_id}")


def build_file_request(job_id: str, design: int, form: str) -> Request:
    """Build the request for a file of a design."""
    return Request("GET", f"/v1/jobs/{job_id}/designs/{design}.{form}")


def parse_job(answer: httpx.Response) -> Job:
    """Parse the job in an answer."""
    return build_job(answer.json())


class Attempts:
    """The attempts of one request, and the pauses between them."""

    def __init__(self, url: object) -> None:
        self._url, self._made = url, 0

    def handle_refusal(self, answer: httpx.Response) -> float:
        """Return the seconds until the next attempt after an error answer; raise if there is no next attempt."""
        self._made += 1
        if answer.status_code not in _TEMPORARY_STATUSES or self._made >= MAX_ATTEMPTS:
            raise build_refusal(answer)
        return _compute_pause_s(self._made, answer.headers.get("retry-after"))

    def handle_silence(self, error: httpx.TransportError) -> float:
        """Return the seconds until the next attempt after a missing answer; raise if there is no next attempt."""
        self._made += 1
        if self._made >= MAX_ATTEMPTS:
            raise _build_unreachable(self._url, error) from None
        return _compute_pause_s(self._made, None)


class EventReader:
    """State of a reader of a job's events: the last event received, and the failures of the stream since."""

    def __init__(self, job_id: str, url: object) -> None:
        self.path = f"/v1/jobs/{job_id}/events"
        self.ended = False
        self._url = url
        self._last: str | None = None
        self._failures = 0
        self._name, self._data = "message", ""
        self._id: str | None = None

    def build_request(self) -> Json:
        """Return the arguments of the request for the stream, with the event after which it resumes."""
        # Drop a partly received event: the service sends it again.
        self._name, self._data, self._id = "message", "", None
        return {"headers": {} if self._last is None else {"Last-Event-ID": self._last}, "timeout": STREAM_TIMEOUT}

    def check_opened(self, answer: httpx.Response) -> bool:
        """Return whether the answer is a stream; after the last event there is none (204)."""
        # By the standard of server-sent events, 204 asks the client not to reconnect.
        self.ended = answer.status_code == 204
        return answer.status_code == 200

    def parse_line(self, line: str) -> JobSummary | Progress | None:
        """Process a line of the stream and return the event that it completes; ignore comments and unknown events."""
        field, _, value = line.partition(":")
        # One blank after the colon belongs to the format, further ones to the value.
        value = value.removeprefix(" ")
        match field:
            case "event":
                self._name = value
            case "data":
                self._data += value
            case "id":
                self._id = value
            # A blank line ends an event. An event without data is ignored, as the standard requires.
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
        # A later version of the service may have further events.
        if name != "state":
            return None
        job = build_summary(data)
        self.ended = job.finished
        return job

    def handle_break(self, fault: Refused | httpx.TransportError | None) -> float:
        """Return the seconds until the stream is resumed, sparing a restarting service; raise after the last try."""
        if isinstance(fault, Refused) and (
            fault.status not in _TEMPORARY_STATUSES or self._failures >= MAX_RESUMPTIONS
        ):
            raise fault
        if isinstance(fault, httpx.TransportError) and self._failures >= MAX_RESUMPTIONS:
            raise _build_unreachable(self._url, fault) from None
        # Any event received resets the count, so it bounds only consecutive failures.
        self._failures += 1
        return _compute_pause_s(self._failures, None)


def extract_progress(news: JobSummary | Progress) -> Progress:
    """Return the progress in an event of a job."""
    return news.progress if isinstance(news, JobSummary) else news


def build_refusal(answer: httpx.Response) -> Refused:
    """Build the exception for an error answer."""
    try:
        problem = answer.json()
    except ValueError:
        # A proxy answers with a page, not with problem details.
        problem = None
    return Refused(answer.status_code, problem if isinstance(problem, dict) else {"detail": answer.reason_phrase})


def _build_unreachable(url: object, error: Exception) -> Unreachable:
    return Unreachable(f"no answer from {url} ({type(error).__name__}: {error})")


def _compute_pause_s(attempt: int, retry_after: str | None) -> float:
    """Return the pause before the next attempt, seconds: as the service requests, or doubling with each attempt."""
    # The service sends seconds; a date, the other form of the header, can only come from a proxy.
    asked_for = float(retry_after) if retry_after is not None and retry_after.isdecimal() else 0.1 * 2**attempt
    return min(asked_for, MAX_PAUSE_S)
