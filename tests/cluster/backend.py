"""What the service under test runs on: SQLite and its own workers, or PostgreSQL, Celery and a broker.

The same tests run on each; ``pytest --backend`` chooses, and whoever starts a service asks :data:`CHOSEN` for the
settings. The engines are started when they are first asked for, and shared by all services of a run: each folder that
a service is started in has a database and a queue to itself.
"""

import hashlib
import threading

from tests.cluster.engines import Postgres, RabbitMQ, Redis

NAMES = ("sqlite+local", "postgres+rabbitmq", "postgres+redis")
BROKERS = {"rabbitmq": RabbitMQ, "redis": Redis}


class Backend:
    """Engines by their names, started at need."""

    def __init__(self, name):
        self.name = name
        self._engines = {}
        self._lock = threading.Lock()

    @property
    def distributed(self):
        return self.name != NAMES[0]

    @property
    def postgres(self):
        return self._started(Postgres)

    @property
    def broker(self):
        return self._started(BROKERS[self.name.partition("+")[2]])

    def _started(self, engine):
        with self._lock:
            if engine not in self._engines:
                self._engines[engine] = engine()
            return self._engines[engine]

    def mark(self, folder):
        """The name of the database and of the queue of a service in this folder."""
        return f"m{hashlib.sha256(str(folder).encode()).hexdigest()[:16]}"

    def store_url(self, folder):
        """The store of a service in this folder."""
        return (
            self.postgres.database(self.mark(folder))
            if self.distributed
            else f"sqlite:///{folder}/data/mechsynth.sqlite3"
        )

    def settings(self, folder):
        """What a service in this folder has to be told, besides its folder."""
        if not self.distributed:
            return {}
        return {
            "executor": "celery",
            "database_url": self.store_url(folder),
            "broker_url": self.broker.url(),
            "queue": self.mark(folder),
        }

    def remove(self):
        for engine in self._engines.values():
            engine.remove()
        self._engines.clear()


CHOSEN = Backend(NAMES[0])


def choose(name):
    CHOSEN.name = name
