"""The broker: Celery over RabbitMQ or Redis wakes a worker host when a server has stored a job.

A message holds the id of a job and decides nothing, so a lost, repeated or late message does no harm. A host that is
woken asks the store for the job whose turn it is (:mod:`service.jobs.workers.scheduler`), which may be another job.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import structlog
from celery import Celery
from kombu import Exchange, Queue
from kombu.exceptions import KombuError, OperationalError

from service.settings import Settings

TASK_NAME = "mechsynth.run"

CONNECT_TIMEOUT_S = 4.0
CONFIRM_TIMEOUT_S = 5.0
"""Time limit for RabbitMQ's confirmation of a message, seconds."""

RETRY_PAUSE_S = 1.0
"""Pause before an unreachable broker is tried again, seconds; callers fail at once meanwhile."""

BROKER_HEARTBEAT_S = 10.0
"""Heartbeat period of a connection, seconds. After two missed beats the messages of a lost host go to other hosts."""

log = structlog.get_logger(__name__)


class BrokerUnreachable(Exception):
    """The broker did not confirm the message, which may still have arrived."""


def create_celery_app(settings: Settings, *, publisher: bool) -> Celery:
    """Create the Celery application of servers and worker hosts: one queue, no results, no control messages."""
    url = settings.broker_url.get_secret_value() if settings.broker_url else ""
    amqp = url.startswith("amqp")
    options: dict[str, Any]
    if amqp:
        options = {"confirm_publish": True}
        if publisher:
            options |= {"read_timeout": CONFIRM_TIMEOUT_S, "write_timeout": CONFIRM_TIMEOUT_S}
    else:
        options = {
            "socket_connect_timeout": CONNECT_TIMEOUT_S,
            "socket_keepalive": True,
            "health_check_interval": BROKER_HEARTBEAT_S,
            **({"socket_timeout": CONFIRM_TIMEOUT_S} if publisher else {}),
        }
    queue = Queue(
        settings.queue,
        Exchange(settings.queue, type="direct"),
        routing_key=settings.queue,
        # Quorum queues survive the loss of a RabbitMQ node and write each message to disk.
        queue_arguments={"x-queue-type": "quorum"} if amqp else None,
    )
    app = Celery("mechsynth", broker=url, set_as_current=not publisher)
    app.conf.update(
        broker_transport_options=options,
        broker_connection_timeout=CONNECT_TIMEOUT_S,
        broker_connection_retry_on_startup=True,
        broker_connection_max_retries=None,
        # The publisher monitors its connection itself.
        broker_heartbeat=0 if publisher else BROKER_HEARTBEAT_S,
        task_queues=[queue],
        task_default_queue=settings.queue,
        task_ignore_result=True,
        task_acks_late=True,
        task_reject_on_worker_lost=True,
        task_serializer="json",
        accept_content=["json"],
        worker_prefetch_multiplier=1,
        # Quorum queues do not support a prefetch count for the whole channel.
        worker_detect_quorum_queues=True,
        worker_enable_remote_control=False,
        worker_hijack_root_logger=False,
        worker_cancel_long_running_tasks_on_connection_loss=False,
    )
    return app


class Publisher:
    """Sends the ids of jobs, one at a time over one connection. Safe to use from many threads."""

    def __init__(self, settings: Settings) -> None:
        self._app = create_celery_app(settings, publisher=True)
        self._lock = threading.Lock()
        self._connection: Any = None
        self._producer: Any = None
        self._not_before = float("-inf")
        self.reachable = True
        """Whether the broker answered the last request."""

    def send(self, job_id: str) -> None:
        """Send a message that wakes a worker host; on return the broker has the message.

        Raises
        ------
        BrokerUnreachable
            If the broker may not have the message.
        """
        self._run_connected(lambda: self._publish(job_id))

    def probe(self) -> None:
        """Check whether the broker answers and set ``reachable``; create the queue if it is missing."""
        with suppress(BrokerUnreachable):
            self._run_connected(self._declare)

    def close(self) -> None:
        """Close the connection."""
        with self._lock:
            self._disconnect()

    def _run_connected(self, act: Callable[[], None]) -> None:
        with self._lock:
            if time.monotonic() < self._not_before:
                raise BrokerUnreachable("the broker was out of reach a moment ago")
            try:
                self._connect()
                act()
            except Exception as error:  # every transport has its own errors, and some raise others
                if not isinstance(error, (OSError, KombuError, OperationalError, *self._list_connection_errors())):
                    log.exception("the broker could not be asked")
                self._disconnect()
                self._not_before = time.monotonic() + RETRY_PAUSE_S
                if self.reachable:
                    log.warning("the broker is out of reach", error=type(error).__name__)
                self.reachable = False
                raise BrokerUnreachable(type(error).__name__) from None
            if not self.reachable:
                log.info("the broker is there again")
            self.reachable = True

    def _list_connection_errors(self) -> tuple[type[BaseException], ...]:
        return () if self._connection is None else self._connection.connection_errors + self._connection.channel_errors

    def _connect(self) -> None:
        if self._connection is None:
            self._connection = self._app.connection_for_write()
            self._connection.ensure_connection(max_retries=1, timeout=CONNECT_TIMEOUT_S)
            self._producer = self._app.amqp.Producer(self._connection, auto_declare=False)
            self._declare()

    def _declare(self) -> None:
        for queue in self._app.amqp.queues.values():
            queue(self._producer.channel).declare()

    def _publish(self, job_id: str) -> None:
        self._app.send_task(
            TASK_NAME,
            args=(job_id,),
            producer=self._producer,
            retry=False,
            confirm_timeout=CONFIRM_TIMEOUT_S,
            declare=[],
        )

    def _disconnect(self) -> None:
        connection, self._connection, self._producer = self._connection, None, None
        if connection is not None:
            try:
                connection.collect(socket_timeout=0.5)
            except Exception:  # it is broken, which is why it is given up
                log.debug("a connection to the broker could not be closed", exc_info=True)
