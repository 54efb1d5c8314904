"""The process dies right before or right after each statement of the creation and of each upgrade of the tables."""

import time

import pytest

from tests.support.service.upgrades import dies_everywhere, is_whole, killed_at, older

REVISIONS = (None, "0001", "0002", "0003", "0004")
"""What there may be before: nothing at all, or the tables of an older version."""

MANY = 1_000_000
MANY_S = 60.0  # a few in good health; a machine may be ten times as busy

pytestmark = [pytest.mark.faults, pytest.mark.timeout(600)]


@pytest.mark.parametrize("moment", ["before", "after"])
@pytest.mark.parametrize("revision", REVISIONS)
def test_an_upgrade_that_is_killed_at_any_statement_is_done_again(tmp_path, revision, moment):
    died = dies_everywhere(tmp_path, revision, moment, range(1000))
    print(f"\nupgrade from {revision or 'nothing'} killed {moment} each of {died} statements: whole at the next start")
    assert died > 5


def test_an_upgrade_of_many_jobs_that_is_killed_is_done_again_in_bounded_time(tmp_path):
    older(tmp_path, "0001", MANY)
    assert killed_at(tmp_path, 18, "after")
    began = time.monotonic()
    assert is_whole(tmp_path, MANY)
    took = time.monotonic() - began
    print(f"\n{MANY} jobs: whole {took:.1f} s after a killed upgrade")
    assert took < MANY_S
