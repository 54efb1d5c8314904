"""PostgreSQL and the broker are restarted under load, also by a crash, and nothing that was acknowledged is lost.

``MECHSYNTH_RESTARTS`` says how often: "10,5", PostgreSQL and the broker. ``make test-faults`` does it so often.
"""

import os
import random
import signal
import time

import pytest

from tests.cluster.backend import CHOSEN
from tests.cluster.deployment import Deployment
from tests.cluster.load import WELL, Load, verdict
from tests.support.service.running import until

STORE_RESTARTS, BROKER_RESTARTS = map(int, os.environ.get("MECHSYNTH_RESTARTS", "4,2").split(","))
SEED = 7

pytestmark = [pytest.mark.cluster, pytest.mark.timeout(900)]


def test_nothing_acknowledged_is_lost_when_the_engines_are_restarted(tmp_path):
    rng = random.Random(SEED)
    events = ["store"] * STORE_RESTARTS + ["broker"] * BROKER_RESTARTS
    rng.shuffle(events)
    deployment = Deployment(tmp_path, servers=2, hosts=2, workers=1)
    try:
        began = time.monotonic()
        with Load([server.url for server in deployment.servers]) as load:
            for n, which in enumerate(events):
                before = len(load.accepted)
                # Each falls among jobs: there are new ones before the next.
                until(lambda before=before: len(load.accepted) >= before + 10 or load.failure, 120.0, "more jobs")
                assert load.failure is None, load.failure
                engine = CHOSEN.postgres if which == "store" else CHOSEN.broker
                # Every other time it is broken off: PostgreSQL then recovers from its log.
                engine.restart(signal.SIGTERM if n % 2 else signal.SIGQUIT if which == "store" else signal.SIGKILL)
        deployment.finish(180.0)
        became = verdict(load.accepted, deployment.jobs())
        print(
            f"\n{CHOSEN.name}: {STORE_RESTARTS} restarts of PostgreSQL and {BROKER_RESTARTS} of the broker in "
            f"{time.monotonic() - began:.0f} s, every other one a crash, while 4 clients had {len(load.accepted)} jobs "
            f"accepted ({load.refused} answers 503): "
            + ", ".join(f"{len(found)} {what}" for what, found in became.items())
        )
        assert became == WELL
        assert deployment.stop() == [0, 0, 0, 0]
    finally:
        deployment.kill()
