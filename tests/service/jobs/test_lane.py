"""What a lane does with a store that refuses a write, and with one that is out of reach."""

import pytest
from sqlalchemy.exc import IntegrityError, OperationalError

from service.jobs.workers import lane
from service.jobs.workers.lane import Lane, Stores


@pytest.fixture
def idle(monkeypatch):
    """A lane that has not been started."""
    monkeypatch.setattr(lane, "RETRY_PERIOD_S", 0.0)
    return Lane("lane", None, Stores(None, None), None, 1.0, None, None, ())


def write(errors, calls):
    def once(value):
        calls.append(value)
        if len(calls) > 3:
            raise AssertionError("it is tried again and again")
        if errors:
            raise errors.pop()
        return value

    return once


def test_a_write_waits_for_a_store_that_is_out_of_reach(idle):
    calls = []
    assert idle._write_with_retries(write([OperationalError("", {}, Exception())] * 2, calls), 1) == 1
    assert calls == [1, 1, 1]


def test_a_write_that_is_refused_is_not_tried_for_ever(idle):
    calls = []
    with pytest.raises(IntegrityError):
        idle._write_with_retries(write([IntegrityError("", {}, Exception())] * 9, calls), 1)
    assert calls == [1]
