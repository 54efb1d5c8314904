"""PostgreSQL as it comes from Debian, on a free port of this machine, in a folder of its own.

It is started in the foreground, as a child of the tests, and ended by its process id. It does not run as root; then it
runs as the user that its package has made.
"""

import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

import psycopg

START_S = 60.0
STOP_S = 30.0
USER = "postgres"


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def find_program(name):
    """The program of this name in PostgreSQL's folders, the newest first, or in the path."""
    folders = sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    for folder in folders:
        if os.access(folder / name, os.X_OK):
            return str(folder / name)
    found = shutil.which(name)
    if found is None:
        raise AssertionError(f"there is no {name}; Debian's postgresql has it, `make test-cluster` as root installs it")
    return found


def as_user(*command):
    if os.getuid() != 0:
        return list(command)
    # Replaces itself by the command, so that the process id is the server's own.
    return [find_program("setpriv"), f"--reuid={USER}", f"--regid={USER}", "--init-groups", *command]


class Postgres:
    """A server of PostgreSQL. It can be stopped, killed and started again, always on its port and its data."""

    def __init__(self, *options):
        self.folder = Path(tempfile.mkdtemp(prefix="mechsynth-postgres-"))
        self.port = free_port()
        self.process = None
        self.options = options
        if os.getuid() == 0:
            entry = pwd.getpwnam(USER)
            os.chown(self.folder, entry.pw_uid, entry.pw_gid)
        made = subprocess.run(
            as_user(
                find_program("initdb"), "-D", str(self.data), "-U", "mechsynth", "-A", "trust", "-E", "UTF8", "-N"
            ),
            capture_output=True, text=True, timeout=START_S, cwd=self.folder,
        )  # fmt: skip
        assert made.returncode == 0, made.stderr
        self.start()

    @property
    def data(self):
        return self.folder / "data"

    def start(self):
        command = as_user(
            find_program("postgres"), "-D", str(self.data), "-p", str(self.port),
            "-c", "listen_addresses=127.0.0.1", "-c", f"unix_socket_directories={self.folder}",
            "-c", "max_connections=300", *self.options,
        )  # fmt: skip
        with (self.folder / "log").open("ab") as log:
            self.process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd=self.folder, start_new_session=True
            )
        deadline = time.monotonic() + START_S
        while not self.answers():
            if self.process.poll() is not None or time.monotonic() > deadline:
                self.stop()
                raise AssertionError(f"PostgreSQL does not start: {(self.folder / 'log').read_text()[-3000:]}")
            time.sleep(0.1)  # a starting server has no event to wait for; START_S bounds the loop

    def stop(self, how=signal.SIGINT):
        """End it; by default it breaks off what is under way ("fast"), as an administrator would."""
        if self.process.poll() is None:
            self.process.send_signal(how)
            try:
                self.process.wait(STOP_S)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait(STOP_S)

    def restart(self, how=signal.SIGINT):
        self.stop(how)
        self.start()

    def remove(self):
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    def url(self, database="postgres"):
        return f"postgresql://mechsynth@127.0.0.1:{self.port}/{database}"

    def answers(self):
        try:
            psycopg.connect(self.url(), connect_timeout=3).close()
        except psycopg.OperationalError:
            return False
        return True

    def database(self, name):
        """The URL of a database of this name, made when missing."""
        with psycopg.connect(self.url(), autocommit=True) as connection:
            if connection.execute("SELECT 1 FROM pg_database WHERE datname = %s", (name,)).fetchone() is None:
                connection.execute(f'CREATE DATABASE "{name}"')
        return self.url(name)

    def query(self, database, statement, *values):
        with psycopg.connect(self.url(database), autocommit=True) as connection:
            return connection.execute(statement, values).fetchall()
