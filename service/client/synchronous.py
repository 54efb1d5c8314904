"""The synchronous client."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from types import TracebackType
from typing import Self

import httpx

from service.client import exchange
from service.client.exchange import Attempts, EventReader, Request
from service.client.values import ClientError, Job, JobSummary, Json, Progress, Refused, Status, build_summary

_CANCEL_CHECK_PERIOD_S = 0.05
"""Period of the check for a cancellation, seconds."""


class Client:
    """Talks to one service over one pool of connections.

    Parameters
    ----------
    url
        URL of the service, such as ``http://127.0.0.1:8000``.
    key
        API key, if the service has keys.
    timeout_s
        Time limit for one answer, seconds.
    """

    def __init__(self, url: str, key: str | None = None, *, timeout_s: float = 60.0) -> None:
        self._http = httpx.Client(**exchange.build_pool_settings(url, key, timeout_s))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def submit(self, problem: Mapping[str, object], *, label: str | None = None, wait_s: int = 0) -> Job:
        """Submit a problem; wait at most ``wait_s`` seconds (up to 30) for the end of the job."""
        return exchange.parse_job(self._send_request(exchange.build_submission(problem, label, wait_s)))

    def job(self, job_id: str) -> Job:
        """Return the present state of the job."""
        return exchange.parse_job(self._send_request(exchange.build_job_request(job_id)))

    def jobs(self, *, status: Status | None = None, kind: str | None = None) -> Iterator[JobSummary]:
        """Yield the jobs, newest first; pages are requested as needed."""
        query: dict[str, str] = {name: value for name, value in (("status", status), ("kind", kind)) if value}
        while True:
            page = self._send_request(Request("GET", "/v1/jobs", {"params": query})).json()
            yield from (build_summary(listed) for listed in page["jobs"])
            if page["next_cursor"] is None:
                return
            query["cursor"] = page["next_cursor"]

    def delete(self, job_id: str) -> None:
        """Cancel an unfinished job, or remove a finished one."""
        self._send_request(exchange.build_removal(job_id))

    def follow(self, job_id: str) -> Iterator[JobSummary | Progress]:
        """Yield the events of a job: the job at each change of its state, its progress in between.

        The last event is the job in its final state. A broken stream is resumed where it broke.
        """
        following = EventReader(job_id, self._http.base_url)
        while not following.ended:
            fault: Refused | httpx.TransportError | None = None
            try:
                with self._http.stream("GET", following.path, **following.build_request()) as answer:
                    if not following.check_opened(answer) and not following.ended:
                        # The body of a stream is not read by itself, and it has the reason.
                        answer.read()
                        raise exchange.build_refusal(answer)
                    for line in answer.iter_lines():
                        news = following.parse_line(line)
                        if news is not None:
                            yield news
                        if following.ended:
                            return
            except (Refused, httpx.TransportError) as error:
                fault = error
            # A stream may also end without an error, for example when the service stops.
            if not following.ended:
                time.sleep(following.handle_break(fault))

    def wait(self, job_id: str, progress: Callable[[Progress], None] | None = None) -> Job:
        """Wait until the job has ended; report its progress to ``progress``."""
        for news in self.follow(job_id):
            if progress is not None:
                progress(exchange.extract_progress(news))
        return self.job(job_id)

    def solve(
        self,
        problem: Mapping[str, object],
        *,
        label: str | None = None,
        progress: Callable[[Progress], None] | None = None,
        cancel: threading.Event | None = None,
    ) -> Job:
        """Solve a problem and wait for its result.

        The job is cancelled if another thread sets ``cancel``, or if the wait is interrupted.

        Raises
        ------
        JobFailed
            If the job ends without a result. An answer without designs is a result.
        """
        # Brief problems end within this second, so that one request answers them.
        job = self.submit(problem, label=label, wait_s=1)
        if not job.finished:
            with self._cancel_with(job.id, cancel):
                job = self.wait(job.id, progress)
        return job.with_result()

    @contextmanager
    def _cancel_with(self, job_id: str, cancel: threading.Event | None) -> Iterator[None]:
        over = threading.Event()
        watching = threading.Thread(target=self._cancel_when, args=(job_id, cancel, over), daemon=True)
        if cancel is not None:
            watching.start()
        try:
            yield
        except BaseException as error:
            if not isinstance(error, ClientError):  # an interrupt, or an error of the progress callback
                with suppress(ClientError):
                    self.delete(job_id)
            raise
        finally:
            # The thread must not cancel a job that has ended meanwhile: deleting it would remove its answer.
            over.set()
            if cancel is not None:
                watching.join()

    def _cancel_when(self, job_id: str, cancel: threading.Event, over: threading.Event) -> None:
        while not over.is_set():
            # Polls, because a thread cannot wait for two events at once.
            if cancel.wait(_CANCEL_CHECK_PERIOD_S):
                with suppress(ClientError):
                    self.delete(job_id)
                return

    def file(self, job_id: str, design: int, form: str) -> bytes | None:
        """Return a file of a design (``svg``, ``dxf``, ``csv``, ...); None if its type of mechanism has none such."""
        try:
            return self._send_request(exchange.build_file_request(job_id, design, form)).content
        except Refused as refusal:
            # The caller knows the job, so that only its file can be missing.
            if refusal.status == 404:
                return None
            raise

    def motion(self, job_id: str, design: int, *, steps: int = 360) -> Json:
        """Return the motion of a design over its cycle, joint by joint."""
        request = Request("GET", f"/v1/jobs/{job_id}/designs/{design}/motion", {"params": {"steps": steps}})
        return _parse_object(self._send_request(request))

    def analyse(self, mechanism: Mapping[str, object], motion: Mapping[str, object]) -> Json:
        """Analyse a given mechanism."""
        return self.analysis({"mechanism": dict(mechanism), "motion": dict(motion)})

    def analysis(self, request: Mapping[str, object]) -> Json:
        """Send a complete analysis request, which may have further blocks, and return its answer."""
        return _parse_object(self._send_request(Request("POST", "/v1/analyses", {"json": dict(request)})))

    def problems(self) -> dict[str, Json]:
        """Return the kinds of problems by name, each with title, description, schema and an example."""
        return {
            listed["kind"]: listed for listed in self._send_request(Request("GET", "/v1/problems")).json()["problems"]
        }

    def _send_request(self, request: Request) -> httpx.Response:
        """Send a request, repeating it if necessary, and return the answer."""
        attempts = Attempts(self._http.base_url)
        while True:
            try:
                answer = self._http.request(request.method, request.path, **request.more)
            except httpx.TransportError as error:
                pause = attempts.handle_silence(error)
            else:
                if answer.is_success:
                    return answer
                pause = attempts.handle_refusal(answer)
            time.sleep(pause)


def _parse_object(answer: httpx.Response) -> Json:
    parsed = answer.json()
    assert isinstance(parsed, dict)
    return parsed
