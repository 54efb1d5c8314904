"""Notifications of PostgreSQL: bundled, heard by all, and sent again after a restart."""

import time

import pytest

from service.jobs.cluster.listener import StoreListener
from service.jobs.cluster.notifier import (
    BUNDLE_S,
    CHANGES_CHANNEL,
    MAX_BUNDLE,
    WORK_CHANNEL,
    StoreNotifier,
    read_count,
    split_ids,
)
from tests.cluster.backend import CHOSEN
from tests.support.service.running import SOON_S, until

pytestmark = [pytest.mark.cluster]


def job_id(number):
    return f"{number:026d}"


@pytest.fixture
def notified(tmp_path):
    """A notifier, and what two listeners have heard by channel; both listen."""
    url = CHOSEN.store_url(tmp_path)
    heard = {CHANGES_CHANNEL: [], WORK_CHANNEL: []}
    threads = [StoreListener(url, channel, heard[channel].append) for channel in heard]
    notifier = StoreNotifier(url)
    threads.append(notifier)
    for thread in threads:
        thread.start()
    until(lambda: all(heard.values()), SOON_S, "the listeners")
    yield notifier, heard
    for thread in threads:
        thread.stop()
    for thread in threads:
        thread.join(SOON_S)
        assert not thread.is_alive()


def test_changes_are_heard_in_bundles(notified):
    notifier, heard = notified
    for n in range(MAX_BUNDLE // 2):
        notifier.announce_change(job_id(n))
        notifier.announce_work()

    def all_heard():
        work = sum(map(read_count, heard[WORK_CHANNEL][1:]))
        ids = [each for payload in heard[CHANGES_CHANNEL][1:] for each in split_ids(payload)]
        return work == MAX_BUNDLE // 2 and ids == [job_id(n) for n in range(MAX_BUNDLE // 2)]

    until(all_heard, SOON_S, "all changes")
    assert max(map(len, heard.values())) < MAX_BUNDLE // 4


def test_very_many_changes_are_heard_as_any(notified):
    notifier, heard = notified
    with notifier._news:  # so that they make one bundle
        for n in range(MAX_BUNDLE + 1):
            notifier._changed[job_id(n)] = None
        notifier._news.notify()
    until(lambda: len(heard[CHANGES_CHANNEL]) > 1, SOON_S, "the change")
    assert split_ids(heard[CHANGES_CHANNEL][1]) == [None]


def test_a_single_change_is_heard_at_once(notified):
    notifier, heard = notified
    waits = []
    for n in range(5):
        began = time.monotonic()
        notifier.announce_change(job_id(n))
        until(lambda n=n: heard[CHANGES_CHANNEL][-1] == job_id(n), SOON_S, "the change")
        waits.append(time.monotonic() - began)
        time.sleep(5.0 * BUNDLE_S)  # longer than a bundle, so that the next change has one of its own
    assert min(waits) < 0.5


def test_changes_are_heard_again_after_a_restart(notified):
    notifier, heard = notified
    CHOSEN.postgres.restart()

    def announced():
        notifier.announce_change(job_id(7))
        # A change that is lost with its connection is not sent again: leave this one time to arrive, then repeat it.
        time.sleep(5.0 * BUNDLE_S)
        return job_id(7) in heard[CHANGES_CHANNEL]

    until(announced, SOON_S, "a change")


def test_notifications_of_triggers_of_earlier_versions_are_understood():
    assert split_ids(job_id(1)) == [job_id(1)]
    assert read_count("") == read_count(None) == 1
