import pytest

from tests.service.running import SCRIPTED, RunningServer


@pytest.fixture(scope="session")
def server(tmp_path_factory):
    """The real service, as an operator would run it."""
    running = RunningServer(tmp_path_factory.mktemp("server"), workers=2, reserve=0)
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="session")
def scripted(tmp_path_factory):
    """The real service with one worker, whose solver does what a problem's seed says."""
    running = RunningServer(tmp_path_factory.mktemp("scripted"), SCRIPTED, workers=1)
    yield running
    assert running.stop() == 0


@pytest.fixture
def client(server):
    return server.client
