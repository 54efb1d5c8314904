"""FastAPI dependencies for the parts of the application that endpoints use."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Annotated, TypeVar

from fastapi import Depends, Request

from service.answers.desk import AnswerDesk
from service.api.http.documents import Documents
from service.imports.desk import ImportDesk
from service.jobs.batches.desk import BatchDesk
from service.jobs.batches.rows import BatchSummary
from service.jobs.desk import JobDesk
from service.jobs.events.poller import JobPoller
from service.jobs.store.schema import JobSummary
from service.parts.export.worker import Workshop

T = TypeVar("T")


def _build_dependency(name: str, of_type: type[T]) -> Callable[[Request], Awaitable[T]]:
    """Return a dependency that yields the application's state attribute ``name``."""

    async def get_part(request: Request) -> T:
        value = getattr(request.app.state, name)
        assert isinstance(value, of_type)
        return value

    return get_part


Desk = Annotated[JobDesk, Depends(_build_dependency("desk", JobDesk))]
Batches = Annotated[BatchDesk, Depends(_build_dependency("batches", BatchDesk))]
Poller = Annotated[JobPoller[JobSummary], Depends(_build_dependency("poller", JobPoller))]
BatchPoller = Annotated[JobPoller[BatchSummary], Depends(_build_dependency("batch_poller", JobPoller))]
Answers = Annotated[AnswerDesk, Depends(_build_dependency("answers", AnswerDesk))]
Readers = Annotated[ImportDesk, Depends(_build_dependency("readers", ImportDesk))]
Bench = Annotated[Workshop, Depends(_build_dependency("workshop", Workshop))]
ApiDocuments = Annotated[Documents, Depends(_build_dependency("documents", Documents))]
