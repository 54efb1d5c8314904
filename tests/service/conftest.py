import pytest

from tests.service.running import RunningServer


@pytest.fixture(scope="session")
def server(tmp_path_factory):
    """The real service, as an operator would run it."""
    running = RunningServer(tmp_path_factory.mktemp("server"))
    yield running
    assert running.stop() == 0


@pytest.fixture
def client(server):
    return server.client
