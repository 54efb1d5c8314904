"""The program of a page of the gallery that speaks with a service, run as it stands."""

import json
import subprocess

import pytest

from tests.support.service.running import PROBLEM
from tools.site.gallery import Entry, shell_code


@pytest.mark.slow
def test_the_shell_program_of_a_machine_runs_against_a_service(server, tmp_path):
    entry = Entry("small", "Small one", "", "bodies", PROBLEM, {})
    program = shell_code(entry, ["svg", "gif"]).replace("http://127.0.0.1:8000", server.url)
    done = subprocess.run(["bash", "-e"], input=program, cwd=tmp_path, text=True, capture_output=True, check=True)
    assert json.loads(done.stdout)["status"] == "succeeded"
    assert "Small one, design 1" in (tmp_path / "small.svg").read_text("utf-8")
    assert (tmp_path / "small.gif").read_bytes().startswith(b"GIF89a")
