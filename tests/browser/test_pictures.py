"""The pictures on the page of the studio are taken of it, and are those that it shows now."""

import io

import numpy as np
import pytest
from PIL import Image

from synthesis.registry import KINDS
from tests.browser.conftest import SCREENS
from tests.campaign import further
from tools.studio.pictures import PICTURES, path_of, taken, write

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

ALIKE = 2.5
"""Mean difference of a pixel, of 255: fonts and how lines are smoothed differ from machine to machine."""

PLACE, PLACE_ALIKE = 16, 25.0
"""The same of a place of 128 pixels square: moved by two pixels, the densest text differs by 12; a stage without its
assembly, which WebGL draws in software, differs by 45, and yet only by 1.8 over the whole picture."""


ALWAYS = ("studio", "studio_gallery", "studio_room", "gear_train")


@pytest.mark.parametrize("name", further([*PICTURES, *KINDS], ALWAYS))
def test_a_picture_in_the_docs_is_what_the_page_shows(open_studio, name):
    studio = open_studio(reduced_motion="reduce")
    picture = taken(studio.page, studio.url, name)
    SCREENS.mkdir(parents=True, exist_ok=True)
    write(picture, SCREENS / f"docs-{name}.png")
    now, kept = (Image.open(one).convert("L") for one in (io.BytesIO(picture), path_of(name)))
    assert now.size == kept.size, "python -m tools.studio.pictures takes them anew"
    # Small shifts of a word say nothing.
    small = [
        np.asarray(one.resize((one.width // 8, one.height // 8), Image.Resampling.BOX), float) for one in (now, kept)
    ]
    differs = np.abs(small[0] - small[1])
    assert differs.mean() < ALIKE, "python -m tools.studio.pictures takes them anew"
    rows, columns = (range(0, length, PLACE) for length in differs.shape)
    places = [differs[v : v + PLACE, u : u + PLACE].mean() for v in rows for u in columns]
    assert max(places) < PLACE_ALIKE, "python -m tools.studio.pictures takes them anew"
    assert np.std(small[0]) > 5.0, "not an empty page"
