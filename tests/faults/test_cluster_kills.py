"""Jobs while workers, worker hosts and servers of a deployment are killed at random: each ends, once, rightly.

``MECHSYNTH_FAULT_KILLS`` and ``MECHSYNTH_FAULT_JOBS`` say how many (100 and 300).
"""

import os
import random
import time

import pytest

from tests.cluster.deployment import Deployment, alive_now, signal_quietly
from tests.cluster.load import WELL, Load, verdict
from tests.support.service.running import START_S, until

KILLS = int(os.environ.get("MECHSYNTH_FAULT_KILLS", "100"))
JOBS = int(os.environ.get("MECHSYNTH_FAULT_JOBS", "300"))
ORPHAN_S = 5.0
SHARES = {"worker": 0.7, "host": 0.15, "server": 0.15}

pytestmark = [pytest.mark.faults, pytest.mark.cluster, pytest.mark.timeout(1800)]


def test_no_job_is_lost_or_doubled_or_wrong(tmp_path):
    rng = random.Random(3)
    killed = dict.fromkeys(SHARES, 0)
    longest_orphan_s = 0.0
    deployment = Deployment(tmp_path, servers=2, hosts=2, workers=2)
    try:
        began = time.monotonic()
        with Load([server.url for server in deployment.servers], at_least=JOBS) as load:
            while sum(killed.values()) < KILLS:
                assert load.failure is None, load.failure
                time.sleep(rng.uniform(0.0, 0.4))  # the moment is what is varied
                (what,) = rng.choices(list(SHARES), SHARES.values())
                if what == "worker":
                    workers = [pid for host in deployment.hosts for pid in host.children()]
                    killed[what] += bool(workers) and signal_quietly(rng.choice(workers))
                    continue
                process = rng.choice(deployment.hosts if what == "host" else deployment.servers)
                children = process.children()
                process.kill()
                died = time.monotonic()
                until(lambda children=children: not alive_now(children), 60.0, "the end of the orphans")
                longest_orphan_s = max(longest_orphan_s, time.monotonic() - died)
                killed[what] += 1
                process.start()
                until(process.ready, 4 * START_S, f"{process.name} again")
        deployment.finish(300.0)
        jobs = deployment.jobs()
        became = verdict(load.accepted, jobs)
        print(
            f"\n{len(load.accepted)} jobs accepted from 4 clients, {killed['worker']} workers, "
            f"{killed['host']} worker hosts and {killed['server']} servers killed in {time.monotonic() - began:.0f} s: "
            + ", ".join(f"{len(found)} {what}" for what, found in became.items())
            + f"; the last worker of a killed host was gone after {longest_orphan_s:.2f} s at most; "
            f"no job lost more than {max(job[4] for job in jobs)} workers"
        )
        assert len(load.accepted) >= JOBS
        assert became == WELL
        assert longest_orphan_s < ORPHAN_S
    finally:
        deployment.kill()
