"""A process that is killed while it makes or upgrades the tables leaves the store as it was, or as it is to be."""

import pytest

from tests.service.upgrades import dies_everywhere


@pytest.mark.embedded
@pytest.mark.parametrize("revision", [None, "0002"])
def test_a_killed_upgrade_is_done_again(tmp_path, revision):
    assert dies_everywhere(tmp_path, revision, "after", (7, 10)) == 2
