"""Settings that all tests share, the size of campaigns, and the database that the service runs on."""

import gc
from collections import Counter
from datetime import date

import pytest
from hypothesis import settings

# Assertions of shared code are explained as those of tests are.
pytest.register_assert_rewrite("tests.support")

from tests import campaign  # noqa: E402
from tests.cluster import backend  # noqa: E402
from tests.support import cpu_time, session_folder  # noqa: E402

settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=25)
settings.register_profile("thorough", deadline=None, derandomize=True, max_examples=100)
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
        "--screens", action="store_true", help="write pictures of the studio's pages to var/screens, to look at"
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
    config.add_cleanup(session_folder.create())
    if cpu_time.is_requested(config):
        config.pluginmanager.register(cpu_time.CpuTimePlugin(config), "cpu-time")


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Collect without the garbage collector: what is imported and collected stays, and it takes a fifth of the time."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    """Cases that a mark deselects are gone by now."""
    dropped = campaign.BUDGET.choose_cases(items, config.getoption("--campaign-day"))
    if dropped:
        config.hook.pytest_deselected(items=dropped)
    sort_files(items)


SLOW_WEIGHT = 50
"""CPU time of a slow case in multiples of that of the others, roughly."""


def sort_files(items):
    """Move files that take long to the front, so that both processes of a run end at about the same time."""
    costs = Counter()
    for item in items:
        costs[item.path] += SLOW_WEIGHT if item.get_closest_marker("slow") else 1
    items.sort(key=lambda item: (-costs[item.path], item.path))


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
