"""The command line, as processes."""

import socket
import subprocess
import sys

import pytest

from tests.campaign import further
from tests.support.service.running import REAL, environment


def mechsynth(folder, *arguments, program=REAL, **settings):
    return subprocess.run(
        [sys.executable, *program, *arguments],
        env=environment(folder, **settings),
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
    )


def test_help_lists_the_commands(tmp_path):
    done = mechsynth(tmp_path, "--help")
    assert done.returncode == 0
    assert all(command in done.stdout for command in ("serve", "demo", "warm", "solve", "keys"))


def test_the_command_line_is_read_without_heavy_imports():
    heavy = "{'numpy', 'numba', 'scipy', 'cvxpy', 'fastapi', 'pydantic', 'sqlalchemy'}"
    program = (
        f"import sys, service.command.cli; service.command.cli._build_parser(); sys.exit(', '.join({heavy} & "
        "set(sys.modules)) or None)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value"),
    [("port", "none"), ("port", "70000"), ("workers", "0"), ("log_level", "loud"), ("job_timeout_s", "-1"),
     ("job_memory_mb", "lots"), ("max_wait_s", "nan"), ("max_wait_s", "31")],
)  # fmt: skip
def test_a_setting_that_cannot_be_used(tmp_path, name, value):
    done = mechsynth(tmp_path, "serve", **{name: value})
    assert done.returncode == 2
    assert f"MECHSYNTH_{name.upper()}" in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value", "instead"),
    [("executor", "celery", "cluster"), ("executor", "cluster", "MECHSYNTH_DATABASE_URL"),
     ("broker_url", "amqp://mq.example//", "PostgreSQL"), ("queue", "mechsynth", "PostgreSQL")],
)  # fmt: skip
def test_a_setting_of_a_cluster_that_cannot_be_used_says_what_replaces_it(tmp_path, name, value, instead):
    for command in ("serve", "worker"):
        done = mechsynth(tmp_path, command, **{name: value})
        assert done.returncode == 2
        assert f"MECHSYNTH_{name.upper()}" in done.stderr
        assert instead in done.stderr
        assert len(done.stderr.splitlines()) == 1


@pytest.mark.slow
def test_a_worker_host_needs_a_shared_database(tmp_path):
    done = mechsynth(tmp_path, "worker")
    assert done.returncode == 2
    assert "MECHSYNTH_EXECUTOR=cluster" in done.stderr


@pytest.mark.slow
def test_a_port_in_use(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as other:
        done = mechsynth(tmp_path, "serve", port=other.getsockname()[1])
    assert done.returncode == 1
    assert "MECHSYNTH_PORT" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_a_host_that_is_nowhere(tmp_path):
    done = mechsynth(tmp_path, "serve", host="300.1.2.3")
    assert done.returncode == 1
    assert "MECHSYNTH_HOST" in done.stderr


@pytest.mark.slow
def test_a_data_folder_in_use(server, tmp_path):
    done = mechsynth(tmp_path, "serve", data_dir=server.folder / "data")
    assert done.returncode == 1
    assert "another server" in done.stderr


@pytest.mark.slow
def test_a_database_in_use(server, tmp_path):
    (tmp_path / "link").symlink_to(server.folder / "data" / "mechsynth.sqlite3")
    for path in (server.folder / "data" / "mechsynth.sqlite3", tmp_path / "link"):
        done = mechsynth(tmp_path, "serve", database_url=f"sqlite:///{path}")
        assert done.returncode == 1
        assert "another server uses the same database" in done.stderr


@pytest.mark.slow
def test_a_data_folder_that_cannot_be(tmp_path):
    (tmp_path / "file").touch()
    done = mechsynth(tmp_path, "serve", data_dir=tmp_path / "file")
    assert done.returncode == 1
    assert "MECHSYNTH_DATA_DIR" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    "url",
    further(
        ["nonsense", "martian://x", "sqlite:////proc/nowhere/x", "sqlite:////etc", "sqlite://", "sqlite:///:memory:",
         "sqlite:///file:x?mode=memory&uri=true"],
        ["nonsense", "sqlite:////etc", "sqlite://"],
    ),
)  # fmt: skip
def test_a_database_that_cannot_be(tmp_path, url):
    done = mechsynth(tmp_path, "serve", database_url=url)
    assert done.returncode == 1
    assert "MECHSYNTH_DATABASE_URL" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.campaign
def test_the_demo_prints_and_draws(tmp_path):
    done = mechsynth(tmp_path, "demo", "--output", "out/demo.svg")
    assert done.returncode == 0, done.stderr
    assert "coupler link" in done.stdout
    assert "°" in done.stdout
    assert "passed  reaches_targets" in done.stdout
    assert "FAILED" not in done.stdout
    assert "<svg" in (tmp_path / "out" / "demo.svg").read_text()
    assert not list((tmp_path / "var").iterdir()), "nothing stays behind"


@pytest.mark.slow
def test_the_demo_fails_when_the_service_does(tmp_path):
    done = mechsynth(tmp_path, "demo", max_queued="none")
    assert done.returncode == 1
    assert "demo" in done.stderr
