"""The client for event loops: one thread can wait for many jobs at once."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import suppress
from types import TracebackType
from typing import Self

import httpx

from service.client import exchange
from service.client.exchange import Attempts, EventReader, Request
from service.client.values import ClientError, Job, JobSummary, Progress, Refused


class AsyncClient:
    """Talks to one service over one pool of connections, with the methods of :class:`Client`.

    Parameters
    ----------
    url, key, timeout_s
        As of :class:`Client`.
    """

    def __init__(self, url: str, key: str | None = None, *, timeout_s: float = 60.0) -> None:
        self._http = httpx.AsyncClient(**exchange.build_pool_settings(url, key, timeout_s))

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def submit(self, problem: Mapping[str, object], *, label: str | None = None, wait_s: int = 0) -> Job:
        """Submit a problem; wait at most ``wait_s`` seconds (up to 30) for the end of the job."""
        return exchange.parse_job(await self._send_request(exchange.build_submission(problem, label, wait_s)))

    async def job(self, job_id: str) -> Job:
        """Return the present state of the job."""
        return exchange.parse_job(await self._send_request(exchange.build_job_request(job_id)))

    async def delete(self, job_id: str) -> None:
        """Cancel an unfinished job, or remove a finished one."""
        await self._send_request(exchange.build_removal(job_id))

    async def follow(self, job_id: str) -> AsyncIterator[JobSummary | Progress]:
        """Yield the events of a job until its final state; see :meth:`Client.follow`."""
        following = EventReader(job_id, self._http.base_url)
        while not following.ended:
            fault: Refused | httpx.TransportError | None = None
            try:
                async with self._http.stream("GET", following.path, **following.build_request()) as answer:
                    if not following.check_opened(answer) and not following.ended:
                        # The body of a stream is not read by itself, and it has the reason.
                        await answer.aread()
                        raise exchange.build_refusal(answer)
                    async for line in answer.aiter_lines():
                        if (news := following.parse_line(line)) is not None:
                            yield news
                        if following.ended:
                            return
            except (Refused, httpx.TransportError) as error:
                fault = error
            # A stream may also end without an error, for example when the service stops.
            if not following.ended:
                await asyncio.sleep(following.handle_break(fault))

    async def wait(self, job_id: str, progress: Callable[[Progress], None] | None = None) -> Job:
        """Wait until the job has ended; report its progress to ``progress``."""
        async for news in self.follow(job_id):
            if progress is not None:
                progress(exchange.extract_progress(news))
        return await self.job(job_id)

    async def solve(
        self,
        problem: Mapping[str, object],
        *,
        label: str | None = None,
        progress: Callable[[Progress], None] | None = None,
    ) -> Job:
        """Solve a problem and wait for its result. Cancelling this task cancels the job.

        Raises
        ------
        JobFailed
            If the job ends without a result. An answer without designs is a result.
        """
        job = await self.submit(problem, label=label)
        try:
            job = await self.wait(job.id, progress)
        except ClientError:
            raise
        # A cancelled task, or an error of the progress callback: nothing waits for the job any more.
        except BaseException:
            with suppress(ClientError, RuntimeError):  # RuntimeError if the connections are already closed
                await self.delete(job.id)
            raise
        return job.with_result()

    async def file(self, job_id: str, design: int, form: str) -> bytes | None:
        """Return a file of a design (``svg``, ``dxf``, ``csv``, ...); None if its type of mechanism has none such."""
        try:
            return (await self._send_request(exchange.build_file_request(job_id, design, form))).content
        except Refused as refusal:
            # The caller knows the job, so that only its file can be missing.
            if refusal.status == 404:
                return None
            raise

    async def _send_request(self, request: Request) -> httpx.Response:
        attempts = Attempts(self._http.base_url)
        while True:
            try:
                answer = await self._http.request(request.method, request.path, **request.more)
            except httpx.TransportError as error:
                pause = attempts.handle_silence(error)
            else:
                if answer.is_success:
                    return answer
                pause = attempts.handle_refusal(answer)
            await asyncio.sleep(pause)
