"""What is stated goes along in a link, and is there again when the page is opened again."""

import base64
import json
import zlib

import pytest

from synthesis.registry import KINDS, get_first_example, list_examples
from tests.browser.conftest import DESKTOP, Studio
from tests.support.browser.studio import PLAIN, state, stated

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]


MISFITS = """async every => {
  const { findMismatch } = await import("/studio/core/schema.js");
  const told = (await (await fetch("/v1/problems")).json()).problems;
  const schemas = Object.fromEntries(told.map(({ kind, schema }) => [kind, schema]));
  return every.map(([kind, one]) => findMismatch(one, schemas[kind], schemas[kind]));
}"""


def link_to(url, sent):
    packed = zlib.compress(json.dumps(sent).encode(), wbits=-15)
    return f"{url}/#statement={base64.urlsafe_b64encode(packed).decode().rstrip('=')}"


def jobs(page):
    return len(page.evaluate("fetch('/v1/jobs?limit=100').then(answer => answer.json())")["jobs"])


def test_a_link_has_the_statement_and_a_linkage_that_is_driven_where_it_is_opened(own_studio, chromium):
    page = own_studio.page
    own_studio.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.fill('[data-path="/problem/positions/1/angle"]', "-24")
    page.fill("#label", "A lid – für alle")
    own_studio.solve()
    page.wait_for_selector(".moving .live .link")
    page.click("#link")
    page.wait_for_selector("#link-told:has-text('the problem and the linkage')")
    own_studio.screen("link_copied")
    link = page.evaluate("navigator.clipboard.readText()")
    assert len(link) < 2000
    drawn = page.locator(".moving .curve").first.get_attribute("d")
    other = Studio(chromium, link.split("/#")[0], viewport=dict(DESKTOP), opened=link)
    try:
        asked = []
        other.page.on("request", lambda one: asked.append(one.url))
        before = jobs(other.page)
        other.page.reload()
        other.page.wait_for_selector(".moving .live .link")
        assert stated(other.page) == stated(page)
        assert other.page.input_value("#label") == "A lid – für alle"
        assert other.page.locator(".moving .curve").first.get_attribute("d") == drawn
        assert sum(one.endswith("/v1/analyses") for one in asked) >= 2
        assert jobs(other.page) == before
        told = other.page.locator("#numbers").inner_text()
        assert "This service has simulated it" in told
        assert "verified" not in told
        other.screen("link_opened")
        # What is stated then is the reader's own; one step back leads to what was sent.
        other.page.fill('[data-path="/problem/positions/1/angle"]', "-20")
        assert other.page.locator(".moving .live").count() == 0
        assert "#statement" not in other.page.url
        other.page.go_back()
        other.page.wait_for_selector(".moving .live .link")
        assert stated(other.page)["positions"][1]["angle"] == -24
    finally:
        other.close()


def test_what_an_address_claims_is_not_taken_on_trust(chromium, server):
    """Damaged, endless, foreign and impossible contents are refused with a sentence, and the page goes on."""
    motion = get_first_example("motion")
    links = {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B"], "output": ["O4", "B"]}
    skeleton = {
        "joints": {"O2": [0, 0], "O4": [9, 0], "A": [0, 1], "B": [9, 1]},
        "links": [{"name": name, "joints": joints} for name, joints in links.items()],
        "input_link": "nothing",
    }
    still = {"type": "fourbar", "skeleton": skeleton}
    studio = Studio(chromium, server.url, viewport=dict(DESKTOP))
    page = studio.page
    for address, told in (
        (f"{server.url}/#statement=AAAA", "truncated or was altered"),
        (link_to(server.url, {"problem": motion})[:-9], "truncated or was altered"),
        (link_to(server.url, "0" * 5_000_000), "longer than 1000000 characters"),
        (
            link_to(server.url, {"problem": {"kind": "constructor"}}),
            "a kind of problem that this service does not know",
        ),
        (link_to(server.url, {"problem": {**motion, "positions": 7}}), "an invalid value at positions"),
        (link_to(server.url, {"problem": {**motion, "positions": [{"x": {}}]}}), "an invalid value at positions/0/x"),
        (link_to(server.url, {"problem": motion, "mechanism": still}), "The linkage in the address is not shown: "),
    ):
        page.goto("about:blank")
        page.goto(address)
        page.wait_for_selector(f"#status:has-text('{told}')")
        assert page.locator(".moving .live").count() == 0
        assert stated(page) == motion
    studio.wrong = [one for one in studio.wrong if "422" not in one]
    studio.close()


def test_every_example_has_the_form_that_an_address_may_have(kept_studio):
    every = [[kind, one] for kind in KINDS for one in list_examples(kind)]
    assert kept_studio.page.evaluate(MISFITS, every) == [None] * len(every)


def test_a_draft_is_there_again_with_its_steps(own_studio):
    page = own_studio.page
    state(page, PLAIN)
    page.wait_for_timeout(800)
    page.fill('[data-path="/problem/positions/0/angle"]', "12")
    draft = stated(page)
    page.select_option("#kind", "cam")
    assert stated(page) == get_first_example("cam")
    page.select_option("#kind", "motion")
    assert stated(page) == draft
    page.reload()
    page.wait_for_selector("#draft:visible")
    assert stated(page) == draft
    assert page.locator(".moving .live").count() == 0, "no example moves beside what it does not answer"
    own_studio.screen("draft")
    page.click("#draft button")
    assert stated(page) == get_first_example("motion")
    assert page.is_hidden("#draft")
    # That was one step, as all others are, those of the page before too.
    page.click("#undo")
    assert stated(page) == draft
    page.reload()
    page.wait_for_selector("#draft:visible")
    assert stated(page) == draft
    page.keyboard.press("Control+z")
    assert stated(page) != draft


def test_what_is_edited_beside_answers_is_there_again_with_them(own_studio):
    page = own_studio.page
    example = list_examples("motion")[3]
    state(page, example)
    own_studio.solve()
    page.reload()
    page.wait_for_selector(".card")
    # The service has written out all defaults: it is the example yet, and not another statement.
    assert page.locator("#example option:checked").inner_text() == "Arm, five positions"
    assert page.is_hidden("#stale")
    state(page, {**example, "max_designs": 2})
    page.wait_for_selector("#stale:visible")
    page.reload()
    page.wait_for_selector(".card")
    page.wait_for_selector("#stale:visible")
    assert stated(page)["max_designs"] == 2
    assert page.locator("#example option:checked").inner_text() == "edited"
    page.get_by_role("button", name="Restore it").click()
    assert stated(page).get("max_designs") != 2
    page.reload()
    page.wait_for_selector(".card")
    assert page.is_hidden("#stale")


def test_a_browser_that_keeps_nothing_keeps_the_page_working(chromium, server):
    studio = Studio(chromium, server.url, viewport=dict(DESKTOP), before="""
      for (const name of ["localStorage", "sessionStorage"]) {
        Object.defineProperty(window, name, { get() { throw new DOMException("denied", "SecurityError"); } });
      }""")  # fmt: skip
    page = studio.page
    page.fill('[data-path="/problem/positions/0/angle"]', "12")
    draft = stated(page)
    page.select_option("#kind", "cam")
    page.select_option("#kind", "motion")
    assert stated(page) == draft
    page.reload()
    page.wait_for_selector("#fields .field")
    assert stated(page) == get_first_example("motion")
    studio.close()
