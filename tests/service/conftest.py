import pytest

from service.jobs.store.database import connect, upgrade
from service.jobs.store.schema import metadata
from tests.cluster.backend import CHOSEN
from tests.support import cpu_time
from tests.support.service.analyses import analyse as analyse  # a fixture
from tests.support.service.running import LEAN, SCRIPTED, RunningServer


@pytest.fixture(scope="session")
def server(tmp_path_factory):
    """The real service, as an operator would run it, except that it loads kernels when a job needs them."""
    running = RunningServer(tmp_path_factory.mktemp("server"), LEAN, workers=1, reserve=0)
    cpu_time.share_server(running.process.pid)
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="session")
def scripted(tmp_path_factory):
    """The real service with one worker, whose solver does what a problem's seed says."""
    running = RunningServer(tmp_path_factory.mktemp("scripted"), SCRIPTED, workers=1)
    cpu_time.share_server(running.process.pid)
    yield running
    assert running.stop() == 0


@pytest.fixture
def client(server):
    return server.client


@pytest.fixture(scope="module")
def engine(tmp_path_factory):
    """A store of its own for a file of tests."""
    engine = connect(CHOSEN.store_url(tmp_path_factory.mktemp("store")), durable=True)
    upgrade(engine)
    yield engine
    engine.dispose()


@pytest.fixture
def emptied(engine):
    """The same without a row."""
    with engine.begin() as connection:
        for table in metadata.sorted_tables:
            connection.execute(table.delete())
    return engine
