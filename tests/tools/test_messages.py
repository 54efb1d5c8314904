"""The languages of the studio: each says all that the page says in English, and nothing else."""

import re

import pytest

from tools.studio.messages import STUDIO, collect_texts, page_texts, prose, read_messages, tagged_texts, terms

LANGUAGES = sorted(path.stem for path in (STUDIO / "messages").glob("*.json"))
PLACE = re.compile(r"\{\d+\}")


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_language_says_everything_and_nothing_else(language):
    here, said = read_messages(language), set(collect_texts())
    assert sorted(said - here.keys()) == [], f"python -m tools.studio.messages {language} lists what to fill in"
    assert sorted(here.keys() - said) == [], "nothing says this any more"
    assert [text for text, told in here.items() if sorted(PLACE.findall(text)) != sorted(PLACE.findall(told))] == []
    assert [text for text, told in here.items() if not told.strip()] == []


def test_what_stays_open_is_told_in_words():
    assert [text for text in collect_texts() if re.search(r"\bnull\b", text)] == []


def test_each_language_is_listed_in_the_head_of_the_page():
    listed = re.findall(r'hreflang="(\w+)" title="\w+"[^>]* href="/studio/messages/(\w+)\.json"', page())
    assert listed == [(language, language) for language in LANGUAGES]


def test_texts_are_found_where_they_are():
    source = 'el(t`Design ${n + 1} of ${all.map((one) => `${one} }`).join(t`, or`)}`, "t`not this`", at`not this`)'
    assert list(tagged_texts(source)) == ["Design {0} of {1}", ", or", "not this"]
    on_page, known_terms = set(page_texts()), set(terms())
    assert {"Solve", "Gallery", "Copy link", "Language", "{0} of {1} designs meet it."} <= on_page
    assert {"min transmission angle", "crank rocker", "same branch", "queued", "steering"} <= known_terms
    assert prose("Of the\n`crank`.\n\nMore.") in {"Of the crank."}


def page():
    return (STUDIO / "index.html").read_text("utf-8")
