"""The rules of axe-core find nothing in the page, light and dark, wide and narrow, with an answer shown."""

import pytest

from synthesis.registry import KINDS, list_examples
from tests.campaign import further
from tests.support.browser.accessibility import violations
from tests.support.browser.form import OPEN_ALL
from tests.support.browser.studio import PLAIN, drawn, state, unfold
from tests.support.service.running import until

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

CASES = {
    "motion": PLAIN,
    "path": list_examples("path")[1],
    "cam": list_examples("cam")[0],
    "gear_train": list_examples("gear_train")[0],
}
OTHERS = {"function": 2, "dwell": 1}
"""The example of each further kind that is soon solved, where that is not the first."""

WIDE, NARROW = (1360, 1000), (390, 844)
LOOKS = [(scheme, size) for scheme in ("light", "dark") for size in (WIDE, NARROW)]
LIGHT_WIDE, LIGHT_NARROW, DARK_WIDE, DARK_NARROW = LOOKS
OFTEN = [
    ("motion", (LIGHT_WIDE, DARK_NARROW)),
    ("path", (LIGHT_NARROW, DARK_WIDE)),
    ("cam", (LIGHT_NARROW, DARK_WIDE)),
    ("gear_train", (LIGHT_WIDE, DARK_NARROW)),
]
"""What is looked at in every run: linkages and other machines each in all looks. The campaign has all looks of all."""

TABS = ("task", "answers", "explore", "files", "jobs", "plots", "numbers")


@pytest.mark.parametrize(("kind", "looks"), further([*OFTEN, *((kind, LOOKS) for kind in KINDS)], OFTEN))
def test_no_violation(open_studio, kind, looks):
    studio = open_studio(reduced_motion="reduce")
    page = studio.page
    state(page, CASES.get(kind) or list_examples(kind)[OTHERS.get(kind, 0)])
    studio.solve()
    until(lambda: drawn(page), 90, "the drawing")
    page.evaluate(OPEN_ALL)
    page.locator("details:not(#fields details, #key)").evaluate_all("all => all.forEach(one => { one.open = true; })")
    for scheme, (width, height) in looks:
        page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
        page.set_viewport_size({"width": width, "height": height})
        tabs = [one for one in TABS if width < 860 or one not in ("task", "answers")]
        for tab in tabs:
            page.click(f"#tab-{tab}")
            assert violations(page) == [], (scheme, width, tab)
        studio.screen(f"{kind}-{scheme}-{width}")
        page.click("#mode-state")
        assert violations(page) == [], (scheme, width, "state")
        page.click("#mode-watch")
        page.click("#key summary")
        assert violations(page) == [], (scheme, width, "key")
        page.click("#key summary")


def test_a_refused_statement_and_a_report_have_no_violation(studio):
    page = studio.page
    unfold(page)
    page.fill('[data-path="/problem/max_designs"]', "0")
    page.click("#solve")
    page.wait_for_selector('[data-path="/problem/max_designs"][aria-invalid="true"]')
    assert violations(page) == []
    studio.wrong.clear()
    state(page, PLAIN)
    studio.solve()
    job = page.url.rpartition("=")[2]
    page.goto(f"{studio.url}/v1/jobs/{job}/report.html")
    page.wait_for_selector("figure svg")
    assert violations(page) == []


def test_a_violation_would_be_found(studio):
    page = studio.page
    page.evaluate("document.querySelector('label[for=kind]').remove()")
    assert [one["rule"] for one in violations(page)] == ["select-name"]
