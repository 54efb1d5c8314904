"""The settings of the service, read from the environment (``MECHSYNTH_...``)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, SecretStr, ValidationError, field_validator, model_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

ENV_PREFIX = "MECHSYNTH_"

BROKER_SCHEMES = ("amqp://", "amqps://", "redis://", "rediss://")


class SettingsError(ValueError):
    """A setting has a value that cannot be used; the message is one line that names the variable."""


def _split_list(text: object) -> object:
    return tuple(part for given in text.split(",") if (part := given.strip())) if isinstance(text, str) else text


class Settings(BaseSettings):
    """What an operator can change. Every field is an environment variable with the prefix ``MECHSYNTH_``."""

    model_config = SettingsConfigDict(env_prefix=ENV_PREFIX, frozen=True, env_ignore_empty=True)

    host: str = Field(default="127.0.0.1", min_length=1, description="Address to listen on.")
    port: Annotated[int, Field(ge=0, le=65535, description="Port to listen on; 0 takes any free one.")] = 8000
    data_dir: Path = Field(default=Path("var"), description="Folder of the database; made when missing.")
    database_url: str | None = Field(
        default=None, description="SQLAlchemy URL of the job store; a SQLite file in data_dir when left out."
    )
    executor: Literal["local", "celery"] = Field(
        default="local", description="Who runs the jobs: workers of the server, or worker hosts behind a broker."
    )
    broker_url: SecretStr | None = Field(
        default=None, description="The broker between servers and worker hosts: amqp://... (RabbitMQ) or redis://..."
    )
    queue: Annotated[str, Field(pattern="^[A-Za-z0-9._-]{1,100}$", description="Name of the queue in the broker.")] = (
        "mechsynth"
    )
    workers: Annotated[int, Field(ge=1, le=256, description="Worker processes.")] = min(2, os.cpu_count() or 1)
    reserve: Annotated[int, Field(ge=0, le=256, description="Worker processes beside these, kept for short jobs.")] = 1
    worker_metrics_host: str = Field(
        default="127.0.0.1", min_length=1, description="Address at which a worker host shows its metrics."
    )
    worker_metrics_port: (
        Annotated[int, Field(ge=1, le=65535, description="Port of the metrics of a worker host; none when left out.")]
        | None
    ) = None
    compile_ahead: bool = Field(
        default=True, description="Compile kernels that are missing beside the jobs, not when a job first needs them."
    )
    max_body_bytes: Annotated[int, Field(ge=1024, le=1 << 30, description="Largest request body, bytes.")] = 1 << 20
    job_timeout_s: Annotated[float, Field(gt=0, le=86_400, description="Longest computation of a job, seconds.")] = (
        600.0
    )
    job_memory_mb: Annotated[
        int, Field(ge=64, le=1 << 20, description="Memory that a job may take beyond its idle worker's, MiB.")
    ] = 4096
    max_queued: Annotated[int, Field(ge=1, le=1_000_000, description="Queued jobs of a tenant; more are refused.")] = (
        1000
    )
    retention_days: (
        Annotated[float, Field(gt=0, le=36_500, description="How long finished jobs are kept; for ever when left out.")]
        | None
    ) = None
    max_wait_s: Annotated[
        int, Field(ge=0, le=30, description="Longest wait that Prefer: wait is granted, seconds.")
    ] = 30
    rate_limit: Annotated[
        str,
        Field(
            pattern=r"^(off|[1-9][0-9]{0,8}/(second|minute|hour|day))$",
            description="How often a key may ask: 600/minute, 20/second, ... or off.",
        ),
    ] = "1200/minute"
    cors_origins: Annotated[
        tuple[str, ...],
        NoDecode,
        BeforeValidator(_split_list),
        Field(description="Web origins that browsers may use the service from, separated by commas; * for any."),
    ] = ()
    log_level: Literal["debug", "info", "warning", "error"] = "info"
    log_format: Literal["text", "json"] = "text"

    @field_validator("broker_url")
    @classmethod
    def _check_broker(cls, url: SecretStr | None) -> SecretStr | None:
        if url is not None and not url.get_secret_value().startswith(BROKER_SCHEMES):
            raise ValueError(f"a broker's URL begins with {', '.join(BROKER_SCHEMES)}")
        return url

    @model_validator(mode="after")
    def _check_distributed(self) -> Self:
        if self.executor == "celery":
            if self.broker_url is None:
                raise ValueError(f"{ENV_PREFIX}EXECUTOR=celery needs a broker; set {ENV_PREFIX}BROKER_URL")
            if not self.store_url.startswith("postgres"):
                raise ValueError(f"{ENV_PREFIX}EXECUTOR=celery needs PostgreSQL; set {ENV_PREFIX}DATABASE_URL")
        return self

    @property
    def rate_limit_rule(self) -> str | None:
        """The rate limit in force."""
        return None if self.rate_limit == "off" else self.rate_limit

    @property
    def store_url(self) -> str:
        """The database URL in force."""
        return self.database_url or f"sqlite:///{(self.data_dir / 'mechsynth.sqlite3').absolute()}"


def read_settings() -> Settings:
    """The settings of this process.

    Raises
    ------
    SettingsError
        When a variable has a value that cannot be used.
    """
    try:
        return Settings()
    except ValidationError as error:
        faults = (
            (f"{ENV_PREFIX}{str(e['loc'][0]).upper()}: " if e["loc"] else "") + e["msg"].removeprefix("Value error, ")
            for e in error.errors()
        )
        raise SettingsError("; ".join(faults)) from None
