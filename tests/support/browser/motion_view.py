"""Code that several tests share: motion view."""

import re
from functools import partial

from tests.support.browser import studio as studio_steps

solved = partial(studio_steps.solved, shown=".moving .live .link")


def motion_of(studio, server, number=0, steps=240):
    job = re.search(r"#job=(\w+)", studio.page.url).group(1)
    answer = server.client.get(f"/v1/jobs/{job}/designs/{number}/motion", params={"steps": steps})
    assert answer.status_code == 200
    return answer.json()


PLAIN_DIGITS = str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789")


def number(text):
    return float(text.translate(PLAIN_DIGITS).replace("·10", "e").rstrip("°"))
