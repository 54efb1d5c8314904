"""The log for people: whatever a client has sent, a record is one line that does nothing to a terminal."""

import subprocess
import sys
import unicodedata

import pytest

from tests.support.service.running import ROOT

HOSTILE = "a\x1b[2Jb\nforged\r\x9b1mc\u202ed\u2028e\x00\x7f"
SPELT = r"a\x1b[2Jb\nforged\r\x9b1mc\u202ed\u2028e\x00\x7f"
BEGIN = f"""
import logging, structlog
from service.observability import logs
logs.configure("info", "text")
log, hostile = structlog.get_logger("test"), {HOSTILE!r}
"""
RECORDS = {
    "event": "log.info(hostile)",
    "value": "log.info('asked', path=hostile)",
    "name of a value": "log.info('asked', **{hostile: 1})",
    "library": "logging.getLogger('somebody').warning('%s', hostile)",
}
ERROR = """
try:
    raise ValueError(hostile)
except ValueError:
    log.exception("refused")
"""


def written(program):
    """The lines that a program leaves in the log; none of them has a control character."""
    done = subprocess.run([sys.executable, "-c", BEGIN + program], cwd=ROOT, capture_output=True, timeout=60)
    assert done.returncode == 0
    lines = done.stderr.decode().removesuffix("\n").split("\n")
    assert not [c for c in "".join(lines) if unicodedata.category(c) in ("Cc", "Cf", "Zl", "Zp")]
    return lines


@pytest.mark.parametrize("where", RECORDS)
def test_controls_are_spelt_out(where):
    (line,) = written(RECORDS[where])
    assert SPELT in line


def test_the_message_of_an_error_is_no_record_of_its_own():
    record, *rest = written(ERROR)
    assert "refused" in record
    assert any("Traceback" in line for line in rest)
    assert all(line.startswith("    ") for line in rest)


def test_what_is_no_control_stays():
    (line,) = written("log.info('Drehwinkel φ = 30°', label='曲柄')")
    assert "Drehwinkel φ = 30°" in line
    assert "label=曲柄" in line
