"""The settings of the service, read from the environment (``MECHSYNTH_...``)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, ValidationError, field_validator, model_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

ENV_PREFIX = "MECHSYNTH_"

REMOVED_SETTINGS = ("BROKER_URL", "QUEUE")
"""Settings of the broker that earlier versions had between servers and worker hosts."""


class SettingsError(ValueError):
    """A setting has an invalid value; the message is one line that names the variable."""


def _split_list(text: object) -> object:
    return tuple(part for given in text.split(",") if (part := given.strip())) if isinstance(text, str) else text


class Settings(BaseSettings):
    """Settings for the operator. Every field is an environment variable with the prefix ``MECHSYNTH_``."""

    model_config = SettingsConfigDict(env_prefix=ENV_PREFIX, frozen=True, env_ignore_empty=True)

    host: str = Field(default="127.0.0.1", min_length=1, description="Address to listen on.")
    port: Annotated[int, Field(ge=0, le=65535, description="Port to listen on; 0 takes any free one.")] = 8000
    data_dir: Path = Field(default=Path("var"), description="Folder of the database; created if missing.")
    database_url: str | None = Field(
        default=None, description="SQLAlchemy URL of the job store; by default a SQLite file in data_dir."
    )
    executor: Literal["local", "cluster"] = Field(
        default="local", description="Executor of jobs: workers of the server, or worker hosts that share its database."
    )
    workers: Annotated[int, Field(ge=1, le=256, description="Worker processes.")] = min(2, os.cpu_count() or 1)
    reserve: Annotated[int, Field(ge=0, le=256, description="Number of further workers, reserved for short jobs.")] = 1
    worker_metrics_host: str = Field(
        default="127.0.0.1", min_length=1, description="Address at which a worker host serves its metrics."
    )
    worker_metrics_port: (
        Annotated[int, Field(ge=1, le=65535, description="Port for the metrics of a worker host; by default none.")]
        | None
    ) = None
    compile_ahead: bool = Field(
        default=True, description="Compile missing kernels in parallel with the jobs, not when a job first needs them."
    )
    max_body_bytes: Annotated[int, Field(ge=1024, le=1 << 30, description="Largest request body, bytes.")] = 1 << 20
    job_timeout_s: Annotated[float, Field(gt=0, le=86_400, description="Time limit of a job, seconds.")] = 600.0
    job_memory_mb: Annotated[
        int, Field(ge=64, le=1 << 20, description="Memory limit of a job beyond its idle worker's memory, MiB.")
    ] = 4096
    max_queued: Annotated[int, Field(ge=1, le=1_000_000, description="Maximum number of a tenant's queued jobs.")] = (
        1000
    )
    retention_days: (
        Annotated[float, Field(gt=0, le=36_500, description="Days to keep finished jobs; by default forever.")] | None
    ) = None
    max_wait_s: Annotated[int, Field(ge=0, le=30, description="Longest wait granted to Prefer: wait, seconds.")] = 30
    rate_limit: Annotated[
        str,
        Field(
            pattern=r"^(off|[1-9][0-9]{0,8}/(second|minute|hour|day))$",
            description="Rate limit of a key: 600/minute, 20/second, ... or off.",
        ),
    ] = "1200/minute"
    cors_origins: Annotated[
        tuple[str, ...],
        NoDecode,
        BeforeValidator(_split_list),
        Field(description="Web origins from which browsers may use the service, separated by commas; * for any."),
    ] = ()
    log_level: Literal["debug", "info", "warning", "error"] = "info"
    log_format: Literal["text", "json"] = "text"

    @field_validator("executor", mode="before")
    @classmethod
    def _check_executor(cls, executor: object) -> object:
        if executor == "celery":
            raise ValueError("celery was replaced by cluster: servers and worker hosts share PostgreSQL only")
        return executor

    @model_validator(mode="after")
    def _check_cluster(self) -> Self:
        if self.executor == "cluster" and not self.store_url.startswith("postgres"):
            raise ValueError(f"{ENV_PREFIX}EXECUTOR=cluster needs PostgreSQL; set {ENV_PREFIX}DATABASE_URL")
        return self

    @property
    def rate_limit_rule(self) -> str | None:
        """The effective rate limit; None if it is off."""
        return None if self.rate_limit == "off" else self.rate_limit

    @property
    def store_url(self) -> str:
        """The effective database URL."""
        return self.database_url or f"sqlite:///{(self.data_dir / 'mechsynth.sqlite3').absolute()}"


def read_settings() -> Settings:
    """Read the settings of this process.

    Raises
    ------
    SettingsError
        If a variable has an invalid value, or belongs to a setting that was removed.
    """
    for name in REMOVED_SETTINGS:
        if os.environ.get(ENV_PREFIX + name):
            raise SettingsError(
                f"{ENV_PREFIX}{name}: there is no broker any more, worker hosts take the jobs from PostgreSQL; unset it"
            )
    try:
        return Settings()
    except ValidationError as error:
        faults = (
            (f"{ENV_PREFIX}{str(e['loc'][0]).upper()}: " if e["loc"] else "") + e["msg"].removeprefix("Value error, ")
            for e in error.errors()
        )
        raise SettingsError("; ".join(faults)) from None
