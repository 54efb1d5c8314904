"""What the service under test runs on: SQLite and its own workers, or PostgreSQL and worker hosts.

The same tests run on both; ``pytest --backend`` chooses, and whoever starts a service asks :data:`CHOSEN` for the
settings. PostgreSQL is started when it is first asked for, and shared by all services of a run: each folder that a
service is started in has a database to itself.
"""

import hashlib
import threading

from tests.cluster.postgres import Postgres

NAMES = ("sqlite", "postgresql")


class Backend:
    """The chosen database, started at need."""

    def __init__(self, name):
        self.name = name
        self._postgres = None
        self._lock = threading.Lock()

    @property
    def distributed(self):
        return self.name == "postgresql"

    @property
    def postgres(self):
        with self._lock:
            if self._postgres is None:
                self._postgres = Postgres()
            return self._postgres

    def mark(self, folder):
        """The name of the database of a service in this folder."""
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
        return {"executor": "cluster", "database_url": self.store_url(folder)} if self.distributed else {}

    def remove(self):
        if self._postgres is not None:
            self._postgres.remove()
            self._postgres = None


CHOSEN = Backend(NAMES[0])


def choose(name):
    CHOSEN.name = name
