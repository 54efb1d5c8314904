"""Code that several tests share: access."""

import subprocess
import sys

import httpx

from tests.support.service.running import PROBLEM, REAL, environment
from tests.support.service.scripted_server import INSTANT


def keys(folder, *arguments, **settings):
    return subprocess.run(
        [sys.executable, *REAL, "keys", *arguments],
        env=environment(folder, **settings),
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
    )


def made(folder, tenant, *more):
    done = keys(folder, "create", tenant, *more)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def client_with(server, key):
    return httpx.Client(base_url=server.url, timeout=30.0, headers={"Authorization": f"Bearer {key}"})


def post(client, seed=INSTANT, wait=20, **headers):
    sent = {**headers, **({"Prefer": f"wait={wait}"} if wait else {})}
    return client.post("/v1/jobs", json={"problem": {**PROBLEM, "seed": seed}}, headers=sent)
