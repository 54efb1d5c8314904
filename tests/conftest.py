"""Settings that all tests share, the size of campaigns, and the engines that the service runs on while they run."""

import pytest
from hypothesis import settings

from tests import campaign
from tests.cluster import backend
from tests.support import cpu_time

settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")


def pytest_addoption(parser):
    cpu_time.add_options(parser)
    parser.addoption(
        "--backend",
        choices=backend.NAMES,
        default=backend.NAMES[0],
        help="what the service runs on: SQLite and workers of its own, or PostgreSQL, Celery and a broker",
    )
    parser.addoption(
        "--campaign-share",
        type=float,
        default=campaign.DEFAULT_SHARE,
        help="the share of the random cases of each campaign that are tried; 1 for all",
    )


def pytest_configure(config):
    backend.choose(config.getoption("--backend"))
    campaign.choose(config.getoption("--campaign-share"))
    config.pluginmanager.register(cpu_time.CpuTimePlugin(config), "cpu-time")


def pytest_collection_modifyitems(config, items):
    items[:], left_out = campaign.thinned(items)
    if left_out:
        config.hook.pytest_deselected(items=left_out)


@pytest.fixture(scope="session", autouse=True)
def engines():
    """Ends whatever engines the tests have started."""
    yield
    backend.CHOSEN.remove()
