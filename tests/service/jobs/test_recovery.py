"""When the jobs of a host that seems to be gone are taken back."""

import time

import pytest
from sqlalchemy.exc import OperationalError

from service.jobs.cluster import recovery
from service.jobs.cluster.recovery import Recovery
from tests.support.service.running import SOON_S, until

LEASE_S, PERIOD_S = 0.6, 0.02


class Leases:
    """A store that is away until ``back_at``, and in which the lease of one job is over by then."""

    def __init__(self, back_at):
        self.back_at = back_at
        self.taken_at = None

    def find_expired(self):
        if time.monotonic() < self.back_at:
            raise OperationalError("SELECT", {}, Exception("connection refused"))
        return ["job"]

    def take_back(self, job_ids):
        assert job_ids == ["job"]
        self.taken_at = self.taken_at or time.monotonic()
        return []


@pytest.mark.parametrize("away_s", [0.5 * LEASE_S, 0.95 * LEASE_S, 1.5 * LEASE_S])
def test_hosts_may_renew_their_leases_first_when_the_store_comes_back(monkeypatch, away_s):
    """However long it was away, and whenever in that time it was found to be so."""
    monkeypatch.setattr(recovery, "LEASE_S", LEASE_S)
    monkeypatch.setattr(recovery, "PERIOD_S", PERIOD_S)
    leases = Leases(time.monotonic() + away_s)
    thread = Recovery(leases)
    thread.start()
    try:
        until(lambda: leases.taken_at, SOON_S, "the job taken back")
    finally:
        thread.stop()
        thread.join(SOON_S)
    # The last question that failed was asked a round, on a busy machine a few, before the store came back.
    assert leases.taken_at - leases.back_at > 0.7 * LEASE_S
