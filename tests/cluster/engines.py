"""PostgreSQL, RabbitMQ and Redis as they come from Debian, each on a free port of this machine, in a folder of its own.

They are started in the foreground, as children of the tests, and ended by their process ids. PostgreSQL and RabbitMQ
do not run as root; then they run as the users that their packages have made.
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

import amqp
import psycopg
import redis

START_S = 60.0
STOP_S = 30.0
PACKAGES = "postgresql, rabbitmq-server and redis-server (Debian); `make test-cluster` as root installs them"


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def program(name, *folders):
    """The program of this name, in one of the folders or in the path."""
    for folder in folders:
        if os.access(folder / name, os.X_OK):
            return str(folder / name)
    found = shutil.which(name)
    if found is None:
        raise AssertionError(f"there is no {name}; the tests need {PACKAGES}")
    return found


class Engine:
    """A server of somebody else's. It can be stopped, killed and started again, always on its port and its data."""

    user = None  # to run as, when we are root

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix=f"mechsynth-{type(self).__name__.lower()}-"))
        self.port = free_port()
        self.process = None
        if self.user is not None and os.getuid() == 0:
            entry = pwd.getpwnam(self.user)
            os.chown(self.folder, entry.pw_uid, entry.pw_gid)
        self.prepare()
        self.start()

    def prepare(self):
        """Make what the server needs before its first start."""

    def as_user(self, *command):
        if self.user is None or os.getuid() != 0:
            return list(command)
        # Replaces itself by the command, so that the process id is the server's own.
        return [program("setpriv"), f"--reuid={self.user}", f"--regid={self.user}", "--init-groups", *command]

    def run(self, *command):
        done = subprocess.run(self.as_user(*command), capture_output=True, text=True, timeout=START_S, cwd=self.folder)
        assert done.returncode == 0, done.stderr

    def launch(self, *command, **environment):
        with (self.folder / "log").open("ab") as log:
            return subprocess.Popen(
                self.as_user(*command), env={**os.environ, **environment}, stdin=subprocess.DEVNULL, stdout=log,
                stderr=log, cwd=self.folder, start_new_session=True,
            )  # fmt: skip

    def start(self):
        self.process = self.command()
        deadline = time.monotonic() + START_S
        while not self.answers():
            if self.process.poll() is not None or time.monotonic() > deadline:
                self.stop()
                raise AssertionError(
                    f"{type(self).__name__} does not start: {(self.folder / 'log').read_text()[-3000:]}"
                )
            time.sleep(0.1)  # an engine that starts tells nobody

    def stop(self, how=signal.SIGTERM):
        if self.process.poll() is None:
            self.process.send_signal(how)
            try:
                self.process.wait(STOP_S)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait(STOP_S)

    def restart(self, how=signal.SIGTERM):
        self.stop(how)
        self.start()

    def remove(self):
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)


class Postgres(Engine):
    user = "postgres"
    programs = property(lambda self: sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True))

    def prepare(self):
        self.data = self.folder / "data"
        self.run(
            program("initdb", *self.programs),
            "-D",
            str(self.data),
            "-U",
            "mechsynth",
            "-A",
            "trust",
            "-E",
            "UTF8",
            "-N",
        )

    def command(self):
        return self.launch(
            program("postgres", *self.programs), "-D", str(self.data), "-p", str(self.port),
            "-c", "listen_addresses=127.0.0.1", "-c", f"unix_socket_directories={self.folder}",
            "-c", "max_connections=200",
        )  # fmt: skip

    def stop(self, how=signal.SIGINT):  # "fast": breaks off what is under way, as an administrator would
        super().stop(signal.SIGINT if how == signal.SIGTERM else how)

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


class RabbitMQ(Engine):
    user = "rabbitmq"
    cookie = "mechsynthtests"

    def prepare(self):
        cookie = self.folder / ".erlang.cookie"
        cookie.write_text(self.cookie)
        cookie.chmod(0o400)
        if os.getuid() == 0:
            shutil.chown(cookie, self.user, self.user)
        self.names = free_port()
        # RabbitMQ would start the server of names by itself, and leave it behind.
        self.epmd = self.launch(program("epmd"), "-port", str(self.names), "-address", "127.0.0.1")

    def command(self):
        return self.launch(
            program("rabbitmq-server", Path("/usr/lib/rabbitmq/bin")),
            HOME=str(self.folder),
            ERL_EPMD_PORT=str(self.names),
            ERL_EPMD_ADDRESS="127.0.0.1",
            RABBITMQ_NODENAME=f"mechsynth{self.port}@localhost",
            RABBITMQ_NODE_IP_ADDRESS="127.0.0.1",
            RABBITMQ_NODE_PORT=str(self.port),
            RABBITMQ_DIST_PORT=str(free_port()),
            RABBITMQ_MNESIA_BASE=str(self.folder / "data"),
            RABBITMQ_LOG_BASE=str(self.folder),
            RABBITMQ_LOGS="-",
            RABBITMQ_CONF_ENV_FILE="/dev/null",
            RABBITMQ_CONFIG_FILE=str(self.folder / "rabbitmq.conf"),
            RABBITMQ_ENABLED_PLUGINS_FILE=str(self.folder / "enabled_plugins"),
            RABBITMQ_PID_FILE=str(self.folder / "pid"),
            RABBITMQ_SERVER_ADDITIONAL_ERL_ARGS="-kernel inet_dist_use_interface {127,0,0,1}",
            RUNNING_UNDER_SYSTEMD="true",  # the script replaces itself by the server
        )

    def url(self):
        return f"amqp://guest:guest@127.0.0.1:{self.port}//"

    def answers(self):
        try:
            with amqp.Connection(f"127.0.0.1:{self.port}", connect_timeout=3, read_timeout=5, write_timeout=5):
                return True
        except (OSError, amqp.AMQPError):
            return False

    def remove(self):
        self.stop()
        self.epmd.terminate()
        self.epmd.wait(STOP_S)
        super().remove()


class Redis(Engine):
    user = "redis"

    def command(self):
        return self.launch(
            program("redis-server"), "--port", str(self.port), "--bind", "127.0.0.1", "--dir", str(self.folder),
            "--appendonly", "yes", "--save", "",
        )  # fmt: skip

    def url(self):
        return f"redis://127.0.0.1:{self.port}/0"

    def answers(self):
        try:
            with redis.Redis(port=self.port, socket_timeout=3) as client:
                return bool(client.ping())
        except redis.ConnectionError:
            return False
