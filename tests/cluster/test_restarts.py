"""PostgreSQL is restarted under load, also by a crash, and nothing that was acknowledged is lost.

``MECHSYNTH_RESTARTS`` says how often: twice, once by a crash, and ten times by ``make test-faults``.
"""

import os
import signal
import time

import pytest

from tests.cluster.backend import CHOSEN
from tests.cluster.deployment import Deployment
from tests.cluster.load import WELL, Load, verdict
from tests.support.service.running import until

RESTARTS = int(os.environ.get("MECHSYNTH_RESTARTS", "2"))

pytestmark = [pytest.mark.cluster, pytest.mark.timeout(900)]


def test_nothing_acknowledged_is_lost_when_postgresql_is_restarted(tmp_path):
    deployment = Deployment(tmp_path, servers=2, hosts=2, workers=1)
    try:
        began = time.monotonic()
        with Load([server.url for server in deployment.servers]) as load:
            for n in range(RESTARTS):
                before = len(load.accepted)
                # Each falls among jobs: there are new ones before the next.
                until(lambda before=before: len(load.accepted) >= before + 10 or load.failure, 120.0, "more jobs")
                assert load.failure is None, load.failure
                # Every other time it is broken off: PostgreSQL then recovers from its log.
                CHOSEN.postgres.restart(signal.SIGINT if n % 2 else signal.SIGQUIT)
        deployment.finish(180.0)
        became = verdict(load.accepted, deployment.jobs())
        print(
            f"\n{RESTARTS} restarts of PostgreSQL in {time.monotonic() - began:.0f} s, every other one a crash, while "
            f"4 clients had {len(load.accepted)} jobs accepted ({load.refused} answers 503): "
            + ", ".join(f"{len(found)} {what}" for what, found in became.items())
        )
        assert became == WELL
        assert deployment.stop() == [0, 0, 0, 0]
    finally:
        deployment.kill()
