"""The studio in German: nothing is left in English, numbers have a decimal comma, and axe-core finds nothing.

Whether anything is left is seen in a language made up for it, in which every word stands in brackets: what stands
outside of them has not been looked up.
"""

import json
import re

import pytest

from synthesis.registry import list_examples
from tests.browser.conftest import DESKTOP, Studio
from tests.support.browser.accessibility import violations
from tests.support.browser.form import OPEN_ALL
from tests.support.browser.studio import drawn, state
from tests.support.service.running import until
from tools.studio.messages import collect_texts, read_messages

pytestmark = [pytest.mark.browser, pytest.mark.timeout(400)]

KINDS = {
    "motion": list_examples("motion")[0],
    "gear_train": list_examples("gear_train")[0],
    "cam": list_examples("cam")[0],
}
TABS = ("explore", "files", "jobs", "plots", "numbers")
PHONE = {"width": 390, "height": 844}

READ = """() => {
  const read = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT | NodeFilter.SHOW_ELEMENT);
  while (walker.nextNode()) {
    const node = walker.currentNode;
    const element = node instanceof Element ? node : node.parentElement;
    if (element.closest("[lang]:not(html), textarea, script, noscript") || !element.checkVisibility()) continue;
    if (node instanceof Element) {
      for (const name of ["aria-label", "title", "placeholder", "alt", "aria-valuetext"])
        if (node.hasAttribute(name)) read.push(node.getAttribute(name));
    } else if (node.textContent.trim()) read.push(node.textContent.trim());
  }
  return [...new Set(read)];
}"""
"""What a person may read or hear of the page as it is now; what says that it is in English is left out."""

BRACKETED = re.compile(r"⟦[^⟦⟧]*⟧")
NAMES = re.compile(r"\b(?:MuJoCo|Modelica|mechsynth|rev|min|[A-Z0-9+]+)\b|\brad[²³]?")
"""What has the same name in every language: programs, units, kinds of files."""

MADE_UP = """
const asked = fetch;
const bracket = (text) => text.split(" ").map((word) => `⟦${word}⟧`).join(" ");
// Texts of the service are in the language of the page. Other strings in an answer are single words.
const translate = (value, key) => {
  if (typeof value === "string") return key === "described" || value.includes(" ") ? bracket(value) : value;
  if (Array.isArray(value)) return value.map((item) => translate(item, key));
  if (value === null || typeof value !== "object") return value;
  return Object.fromEntries(Object.entries(value).map(([name, item]) =>
    [name, name === "problem" || name === "messages" ? item : translate(item, name)]));
};
window.fetch = async (where, ...more) => {
  if (String(where).includes("/studio/messages/")) return new Response(JSON.stringify(%s));
  const answer = await asked(where, ...more);
  const { status, headers } = answer;
  if (!/\\/v1\\/(jobs|analyses)/.test(String(where)) || !headers.get("Content-Type")?.includes("json")) return answer;
  return new Response(JSON.stringify(translate(await answer.json())), { status, headers });
};
"""


def outside(text):
    """What of a text stands in no brackets; a text in brackets may have others in it."""
    while (bare := BRACKETED.sub("", text)) != text:
        text = bare
    return NAMES.sub("", text)


def unspoken(page):
    return [text for text in page.evaluate(READ) if re.search(r"[A-Za-z]{3}", outside(text))]


def emptied(server):
    """No job of another test is listed: what somebody has called it is read in every language as it stands."""
    while jobs := server.client.get("/v1/jobs", params={"limit": 100}).raise_for_status().json()["jobs"]:
        for job in jobs:
            server.client.delete(f"/v1/jobs/{job['id']}").raise_for_status()


def unfolded(page):
    page.locator("details:not(#fields details, #key)").evaluate_all("all => all.forEach(one => { one.open = true; })")


def test_every_text_that_is_read_has_been_looked_up(chromium, server):
    emptied(server)
    made_up = MADE_UP % json.dumps({text: " ".join(f"⟦{word}⟧" for word in text.split()) for text in collect_texts()})
    studio = Studio(chromium, server.url, before=made_up, locale="de-DE", viewport=dict(DESKTOP))
    page = studio.page
    page.wait_for_selector("#pane-numbers .figures")
    assert unspoken(page) == []
    for key in ("?", "g"):
        page.keyboard.press(key)
        page.wait_for_selector("dialog[open]")
        assert unspoken(page) == []
        page.keyboard.press("Escape")
    for kind, problem in KINDS.items():
        state(page, problem)
        page.evaluate(OPEN_ALL)
        assert unspoken(page) == [], kind
        studio.solve()
        until(lambda: drawn(page), 90, "the drawing")
        for tab in TABS:
            page.click(f"#tab-{tab}")
            unfolded(page)
            assert unspoken(page) == [], (kind, tab)
    studio.close()


def test_german_is_spoken_with_decimal_commas(open_studio, server):
    emptied(server)
    studio = open_studio(locale="de-DE", reduced_motion="reduce")
    page = studio.page
    assert page.evaluate("document.documentElement.lang") == "de"
    english = {text for text, told in read_messages("de").items() if told != text}
    state(page, KINDS["motion"])
    page.evaluate(OPEN_ALL)
    assert english.intersection(page.evaluate(READ)) == set()
    studio.solve()
    until(lambda: drawn(page), 90, "the drawing")
    for size, scheme in ((DESKTOP, "light"), (PHONE, "dark")):
        page.set_viewport_size(dict(size))
        page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
        for tab in TABS:
            page.click(f"#tab-{tab}")
            assert english.intersection(page.evaluate(READ)) == set()
            assert violations(page) == [], (scheme, tab)
            studio.screen(f"german-{tab}-{size['width']}")
    told = page.locator(".figures td").all_inner_texts()
    assert sum(bool(re.search(r"\d,\d", text)) for text in told) > 10
    assert [text for text in told if re.search(r"\d\.\d", text)] == []
    page.set_viewport_size(dict(DESKTOP))
    with page.expect_navigation():
        page.select_option("#language", "en")
    page.wait_for_selector(studio.ready)
    assert page.evaluate("document.documentElement.lang") == "en"
    assert page.inner_text("#solve") == "Solve"
    page.wait_for_selector(".figures td")
    assert any(re.search(r"\d\.\d", text) for text in page.locator(".figures td").all_inner_texts())


def test_a_gear_is_engaged_by_what_the_service_calls_it(open_studio):
    studio = open_studio(locale="de-DE", reduced_motion="reduce")
    page = studio.page
    state(page, list_examples("layshaft_gearbox")[0])
    studio.solve()
    page.wait_for_selector(".speeds")
    reverse = page.locator("#engaged option", has_text="Rückwärtsgang: −")
    output = page.locator(".speeds dd").last
    assert not output.inner_text().startswith("−")
    page.select_option("#engaged", reverse.get_attribute("value"))
    until(lambda: output.inner_text().startswith("−"), 30, "another direction")
