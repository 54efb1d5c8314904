"""What moves when the page opens is what the service answers."""

import json
from pathlib import Path

import numpy as np
import pytest

import service
from tools.studio.opening import opening

FILE = Path(service.__file__).parent / "studio" / "opening.json"


def compared(kept, now, size, at=""):
    """Equal but for rounding, and for what is nothing beside the size of the linkage."""
    if isinstance(kept, dict):
        assert list(kept) == list(now), at
        for name in kept:
            compared(kept[name], now[name], size, f"{at}/{name}")
    elif isinstance(kept, list):
        assert len(kept) == len(now), at
        for k, (one, other) in enumerate(zip(kept, now, strict=True)):
            compared(one, other, size, f"{at}/{k}")
    elif isinstance(kept, bool | str) or kept is None:
        assert kept == now, at
    else:
        assert now == pytest.approx(kept, rel=1e-4, abs=1e-6 * size), at


@pytest.mark.slow
def test_the_page_opens_with_the_services_own_answer(client):
    kept = json.loads(FILE.read_text("utf-8"))
    joints = np.array(list(kept["design"]["mechanism"]["skeleton"]["joints"].values()))
    compared(kept, opening(client), float(np.ptp(joints)))


@pytest.mark.slow
def test_another_answer_would_be_found_out():
    kept = json.loads(FILE.read_text("utf-8"))
    other = json.loads(FILE.read_text("utf-8"))
    other["motion"]["joints"]["A"]["x"][7] += 0.1
    with pytest.raises(AssertionError, match="/motion/joints/A/x/7"):
        compared(kept, other, 100.0)
