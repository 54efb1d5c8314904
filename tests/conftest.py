"""Settings that all tests share, the size of campaigns, and the database that the service runs on."""

from datetime import date

import pytest
from hypothesis import settings

# Assertions of shared code are explained as those of tests are.
pytest.register_assert_rewrite("tests.support")

from tests import campaign  # noqa: E402
from tests.cluster import backend  # noqa: E402
from tests.support import cpu_time  # noqa: E402

settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")


def pytest_addoption(parser):
    cpu_time.add_options(parser)
    parser.addoption(
        "--backend",
        choices=backend.NAMES,
        default=backend.NAMES[0],
        help="what the service runs on: SQLite and workers of its own, or PostgreSQL and worker hosts",
    )
    parser.addoption(
        "--campaign-minutes",
        type=float,
        default=campaign.DEFAULT_MINUTES,
        help="how long a campaign may take; inf for all cases",
    )
    parser.addoption(
        "--campaign-day",
        type=int,
        default=date.today().toordinal(),
        help="the day, as an ordinal number, whose draw of campaign tests is made; today by default",
    )


def pytest_report_header(config):
    minutes, day = config.getoption("--campaign-minutes"), config.getoption("--campaign-day")
    return f"campaign: {minutes:g} minutes, drawn by --campaign-day {day}"


def pytest_configure(config):
    backend.choose(config.getoption("--backend"))
    campaign.choose_budget(config.getoption("--campaign-minutes"))
    if cpu_time.is_requested(config):
        config.pluginmanager.register(cpu_time.CpuTimePlugin(config), "cpu-time")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    """Cases that a mark deselects are gone by now."""
    dropped = campaign.BUDGET.choose_cases(items, config.getoption("--campaign-day"))
    if dropped:
        config.hook.pytest_deselected(items=dropped)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    if item.get_closest_marker("campaign") is not None:
        campaign.BUDGET.begin(item)


def pytest_runtest_teardown(item):
    campaign.BUDGET.end(item)


@pytest.fixture(scope="session", autouse=True)
def postgres():
    """Ends PostgreSQL if the tests have started it."""
    yield
    backend.CHOSEN.remove()
