"""A server that could not keep jobs says so, and takes none."""

import shutil
import sqlite3
from types import SimpleNamespace

import pytest
from sqlalchemy import text
from sqlalchemy.exc import OperationalError

from kinematics.message import compose
from service.jobs.job_store import JobStore
from service.jobs.store import probe
from service.jobs.store.database import connect, is_unreachable, upgrade
from service.jobs.store.probe import FileLost, StoreProbe, explain_error
from tests.support.service.running import SCRIPTED, RunningServer, until
from tests.support.service.scripted_server import INSTANT

pytestmark = pytest.mark.embedded


@pytest.fixture
def opened(tmp_path):
    engine = connect(f"sqlite:///{tmp_path}/jobs.sqlite3", durable=True)
    upgrade(engine)
    yield engine
    engine.dispose()


def test_a_store_that_takes_writes_has_no_fault(opened):
    assert JobStore(opened).find_fault() is None


def test_a_full_disk_is_a_fault(opened, monkeypatch):
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: SimpleNamespace(free=probe.MIN_FREE_BYTES - 1))
    assert StoreProbe(opened).find_fault() == "service-store-full"


def test_errors_of_the_databases_are_told_apart(opened):
    with opened.connect() as connection:
        connection.execute(text("CREATE TABLE large (content)"))
        connection.execute(text("PRAGMA max_page_count = 1"))
        with pytest.raises(OperationalError) as full:
            connection.execute(text("INSERT INTO large VALUES (zeroblob(100000))"))
        assert explain_error(full.value) == "service-store-full"
        connection.rollback()
        connection.execute(text("PRAGMA query_only = 1"))
        with pytest.raises(OperationalError) as reading:
            connection.execute(text("DELETE FROM jobs"))
        assert explain_error(reading.value) == "service-store-read-only"
    refused = OperationalError("", {}, type("DiskFull", (Exception,), {"sqlstate": "53100"})())
    assert explain_error(refused) == "service-store-full"
    assert explain_error(OperationalError("", {}, sqlite3.OperationalError("?"))) == "service-store-silent"


def test_an_outcome_is_kept_for_a_moment(opened, monkeypatch):
    kept = StoreProbe(opened)
    assert kept.find_fault() is None
    monkeypatch.setattr(kept, "_check", lambda: "service-store-full")
    assert kept.find_fault() is None
    monkeypatch.setattr(probe, "FRESH_S", 0.0)
    assert kept.find_fault() == "service-store-full"


def test_a_file_that_is_removed_or_replaced_is_used_no_more(opened, tmp_path):
    file, elsewhere = tmp_path / "jobs.sqlite3", tmp_path / "elsewhere"
    file.rename(elsewhere)
    for make_file in (lambda: None, file.touch):
        make_file()
        with pytest.raises(FileLost) as lost, opened.begin():
            pass
        assert is_unreachable(lost.value)
        assert StoreProbe(opened).find_fault() == "service-store-file-lost"
    elsewhere.rename(file)
    assert StoreProbe(opened).find_fault() is None


@pytest.mark.slow
def test_a_server_whose_file_is_gone_takes_no_jobs(tmp_path):
    server = RunningServer(tmp_path, SCRIPTED, workers=1)
    try:
        done = server.post(seed=INSTANT, wait=20)
        file, elsewhere = tmp_path / "data" / "mechsynth.sqlite3", tmp_path / "elsewhere"
        file.rename(elsewhere)
        refused = server.client.post("/v1/jobs", json={"problem": {"kind": "gear_train", "ratio": "pi"}})
        assert (refused.status_code, refused.json()["type"]) == (503, "/problems/store-unavailable")
        until(lambda: server.client.get("/readyz").status_code == 503, what="a server that is not ready")
        assert server.client.get("/readyz").json()["detail"] == compose("service-store-file-lost")
        elsewhere.rename(file)
        assert server.job(done["id"])["status"] == "succeeded"
        assert server.post(seed=INSTANT, wait=20)["status"] == "succeeded"
    finally:
        assert server.stop() == 0
