"""The ASGI application: assembly of all parts, start and stop."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from importlib.metadata import version
from typing import Any

from fastapi import FastAPI
from starlette.concurrency import run_in_threadpool
from starlette.types import Lifespan

from service.access.gate import Gate
from service.access.keys import KeyStore
from service.answers.desk import AnswerDesk
from service.api.http import problem_details
from service.api.http.documents import Documents
from service.api.pages import problem_types, studio_page
from service.api.routes import (
    analyses,
    batches,
    designs,
    docs,
    events,
    forces,
    health,
    imports,
    jobs,
    me,
    metrics,
    outlines,
    parts,
    problems,
    reports,
    results,
    simulations,
)
from service.imports.desk import ImportDesk
from service.jobs.batches.desk import BatchDesk
from service.jobs.batches.store import BatchStore
from service.jobs.desk import JobDesk
from service.jobs.events.notifier import ChangeNotifier
from service.jobs.events.poller import JobPoller
from service.jobs.executor import Executor
from service.jobs.job_store import JobStore
from service.jobs.retention import keep_tidy
from service.jobs.store.database import connect, find_sqlite_file, upgrade
from service.jobs.store.finished_cache import CAPACITY_BYTES, FinishedJobs
from service.kernels import ANALYSIS_PART, KernelsState
from service.observability.metrics import Metrics
from service.parts.export.worker import Workshop
from service.settings import Settings

_DESCRIPTION = """Designs mechanisms and verifies every answer by driving it.

Submit a problem as a job (`POST /v1/jobs`), wait for it or poll it, and read the designs from its result. Submit many
problems as a batch (`POST /v1/batches`). `GET /v1/problems` lists the kinds of problems, each with an example that can
be posted as it is. `POST /v1/analyses` analyses a given mechanism at once. `POST /v1/outlines` reads the outlines in a
drawing, and `POST /v1/imports` reads the curves in a drawing, a table or a picture.

Angles are degrees, counter-clockwise from +x; lengths are plain numbers in the problem's `length_unit`. Unknown fields
are refused. Errors are `application/problem+json` (RFC 9457); validation errors name each field by its JSON pointer."""


def create_app(settings: Settings, executor: Executor, measured: Metrics, kernels: KernelsState) -> FastAPI:
    """Create the service as an ASGI application. Its start upgrades the store and resumes unfinished jobs."""

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        engine = connect(settings.store_url, durable=True)
        store = JobStore(engine)
        notifier = ChangeNotifier(asyncio.get_running_loop())
        log_as = settings.log_level, settings.log_format
        app.state.answers = answers = AnswerDesk(*log_as, metrics=measured)
        answers.start(after=lambda: kernels.has(ANALYSIS_PART) or (kernels.is_ended and answers.is_awaited))
        app.state.documents = documents = Documents(build_documents, *log_as, ahead=settings.compile_ahead)
        documents.start(after=lambda: executor.count_ready_workers() > 0)
        app.state.readers = readers = ImportDesk(*log_as, metrics=measured, forks=lambda: answers.is_loaded)
        app.state.workshop = workshop = Workshop(
            settings.job_memory_mb, settings.job_timeout_s, *log_as, metrics=measured
        )
        try:
            executor.subscribe(notifier.publish)
            executor.start()
            await run_in_threadpool(upgrade, engine)
            await run_in_threadpool(executor.resume)
            # A SQLite store has one server; in any other store, another server may remove a job behind the cache.
            finished = FinishedJobs(CAPACITY_BYTES if find_sqlite_file(settings.store_url) else 0)
            app.state.desk = JobDesk(store, executor, notifier, measured, settings.max_queued, finished)
            app.state.gate = Gate(KeyStore(engine), settings.rate_limit_rule)
            batch_store = BatchStore(engine)
            app.state.batches = BatchDesk(batch_store, executor, notifier, measured, settings.max_queued, finished)
            pollers: list[JobPoller[Any]] = [JobPoller(store, notifier), JobPoller(batch_store, notifier)]
            app.state.poller, app.state.batch_poller = pollers
            measured.watch_calls(
                lambda: {
                    **answers.count_calls(),
                    **{pool.name: pool.count_calls() for pool in (readers.pool, workshop.pool)},
                }
            )
            measured.watch(lambda: sum(each.listeners for each in pollers), executor.count_ready_workers, store.measure)
            polling = [asyncio.create_task(poller.run()) for poller in pollers]
            tidying = asyncio.create_task(keep_tidy(store, batch_store, finished, settings.retention_days))
            yield
            tidying.cancel()
            notifier.close()
            await asyncio.gather(*polling)
        finally:
            notifier.close()
            await run_in_threadpool(answers.stop)
            await run_in_threadpool(documents.stop)
            readers.stop()
            await run_in_threadpool(workshop.stop)
            await run_in_threadpool(executor.stop)
            engine.dispose()

    app = build_application(lifespan)
    app.state.settings = settings
    app.state.metrics = measured
    app.state.kernels = kernels
    return app


def build_api_document() -> str:
    """Return the OpenAPI document for readers; no running service is needed."""
    return json.dumps(build_application(_run_nothing).openapi(), indent=1, ensure_ascii=False) + "\n"


def build_documents() -> Iterator[dict[str, bytes]]:
    """Yield all documents that the service sends, packed, by name (:mod:`service.api.http.documents`)."""
    # These take a tenth of the time, and clients need them first.
    yield problems.pack_documents()
    yield docs.pack_documents(build_application(_run_nothing))


@asynccontextmanager
async def _run_nothing(_app: FastAPI) -> AsyncIterator[None]:
    yield


def build_application(lifespan: Lifespan[FastAPI]) -> FastAPI:
    """Create an application with all routes and error handlers of the service."""
    app = FastAPI(
        title="mechsynth",
        summary="A REST service that designs mechanisms.",
        description=_DESCRIPTION,
        version=version("mechsynth"),
        license_info={"name": "MIT", "identifier": "MIT"},
        lifespan=lifespan,
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        # Problems and designs have one schema each for input and output.
        separate_input_output_schemas=False,
        openapi_tags=[jobs.TAG, batches.TAG, analyses.TAG, outlines.TAG, imports.TAG, problems.TAG, me.TAG, health.TAG],
    )
    problem_details.install(app)
    docs.install(app)
    routers = (
        jobs.router,
        designs.router,
        reports.router,
        results.router,
        forces.reading,
        forces.stating,
        parts.router,
        simulations.router,
        events.router,
        batches.router,
        batches.following,
        analyses.router,
        outlines.router,
        imports.router,
        problems.router,
        me.router,
        problem_types.router,
        health.router,
        metrics.router,
        studio_page.router,
    )
    for router in routers:
        app.include_router(router)
    app.state.routes = [*app.routes, *(route for router in routers for route in router.routes)]
    return app
