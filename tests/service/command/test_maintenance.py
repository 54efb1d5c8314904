"""``mechsynth backup`` and ``mechsynth upgrade``."""

import sqlite3
import subprocess
import sys

import pytest

from service.command.maintenance import MaintenanceFailure, back_up, run_upgrade
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect, list_missing_revisions, upgrade
from service.settings import Settings
from tests.support.service.running import REAL, environment

pytestmark = pytest.mark.embedded


@pytest.fixture
def settings(tmp_path):
    return Settings(data_dir=tmp_path / "data")


@pytest.fixture
def engine(settings):
    engine = connect(settings.store_url, durable=True)
    upgrade(engine)
    yield engine
    engine.dispose()


def create(engine, label):
    return JobStore(engine).create(tenant="", kind="motion", label=label, problem="{}")


def test_a_copy_has_every_job_although_the_store_is_in_use(settings, engine, tmp_path):
    jobs = [create(engine, f"job {n}") for n in range(20)]
    with engine.begin():  # a reader, as a server has some
        back_up(settings, tmp_path / "copy")
    create(engine, "later")
    copy = connect(f"sqlite:///{tmp_path / 'copy'}", durable=False)
    kept = JobStore(copy).list_page(tenant="", limit=100)
    assert {job.id for job in kept} == {job.id for job in jobs}
    assert list_missing_revisions(copy) == []
    copy.dispose()
    assert not (tmp_path / "copy.part").exists()


def test_a_backup_never_replaces_a_file(settings, engine, tmp_path):
    (tmp_path / "copy").write_text("an earlier one")
    with pytest.raises(MaintenanceFailure, match="exists"):
        back_up(settings, tmp_path / "copy")
    assert (tmp_path / "copy").read_text() == "an earlier one"


def test_a_damaged_database_gives_no_backup(settings, tmp_path):
    settings.data_dir.mkdir()
    (settings.data_dir / "mechsynth.sqlite3").write_bytes(b"no database" * 1000)
    with pytest.raises(MaintenanceFailure, match="cannot copy"):
        back_up(settings, tmp_path / "copy")
    assert [file.name for file in tmp_path.iterdir()] == ["data"]


def test_a_check_changes_nothing(settings, capsys):
    with pytest.raises(MaintenanceFailure, match="no database"):
        run_upgrade(settings, only_check=True)
    assert not settings.data_dir.exists()
    engine = connect(settings.store_url, durable=True)
    upgrade(engine, "0005")
    assert list_missing_revisions(engine)[0] == "0006"
    assert not run_upgrade(settings, only_check=True)
    assert list_missing_revisions(engine)[0] == "0006"
    assert run_upgrade(settings, only_check=False)
    assert list_missing_revisions(engine) == []
    assert run_upgrade(settings, only_check=True)
    assert "0006" in capsys.readouterr().out
    engine.dispose()


def test_tables_of_a_later_version_are_refused(settings, engine):
    raw = sqlite3.connect(settings.data_dir / "mechsynth.sqlite3")
    with raw:
        raw.execute("UPDATE alembic_version SET version_num = '9999'")
    raw.close()
    with pytest.raises(MaintenanceFailure, match="later version"):
        run_upgrade(settings, only_check=True)


@pytest.mark.slow
def test_the_commands_end_with_a_status(settings, engine, tmp_path):
    def run(*command):
        return subprocess.run(
            [sys.executable, *REAL, *command], env=environment(tmp_path), cwd=tmp_path, capture_output=True, text=True
        )

    assert run("upgrade", "--check").returncode == 0
    assert run("backup", "copy").returncode == 0
    again = run("backup", "copy")
    assert (again.returncode, again.stderr) == (1, "mechsynth backup: copy exists; give the name of a new file\n")
