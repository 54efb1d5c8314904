"""Messages: composition, memory, translation, and the form in which they are stored."""

from __future__ import annotations

import json

import pytest

from kinematics import message
from kinematics.message import (
    Message,
    UnknownMessage,
    compose,
    find_message,
    from_json,
    join_messages,
    make_sentence,
    to_json,
    translate,
)

ENGLISH = """
sample-width = the width is { $width } mm
sample-found = { $count ->
    [one] One linkage was found;
          { $rest }
   *[other] { $count } linkages were found; { $rest }
  }
"""
GERMAN = """
sample-width = die Breite beträgt { $width } mm
sample-found = { $count ->
    [one] Ein Getriebe wurde gefunden; { $rest }
   *[other] { $count } Getriebe wurden gefunden; { $rest }
  }
"""


@pytest.fixture(autouse=True)
def catalogue(tmp_path, monkeypatch):
    folder = tmp_path / "sample"
    folder.mkdir()
    (folder / "messages.en.ftl").write_text(ENGLISH, "utf-8")
    (folder / "messages.de.ftl").write_text(GERMAN, "utf-8")
    monkeypatch.setattr(message, "find_catalogues", lambda: {"sample": folder})
    message._load_bundle.cache_clear()
    yield
    message._load_bundle.cache_clear()


def test_a_text_is_translated_with_the_messages_and_numbers_in_it():
    text = compose("sample-found", count=12345, rest=compose("sample-width", width=f"{2.5:.3g}"))
    assert text == "12\u202f345 linkages were found; the width is 2.5 mm"
    known = find_message(text)
    assert known is not None
    assert known.id == "sample-found"
    assert translate(known, "de") == "12\u202f345 Getriebe wurden gefunden; die Breite beträgt 2,5 mm"


def test_the_count_selects_the_plural_and_line_breaks_become_spaces():
    text = compose("sample-found", count=1, rest="stop")
    assert text == "One linkage was found; stop"


def test_joined_texts_and_sentences_are_translated_in_their_parts():
    text = make_sentence(join_messages([compose("sample-width", width="3"), "", "as given"], "; "))
    assert text == "The width is 3 mm; as given."
    known = find_message(text)
    assert known is not None
    assert translate(known, "de") == "Die Breite beträgt 3 mm; as given."
    assert join_messages(["", "alone"]) == "alone"
    assert find_message("alone") is None


def test_a_message_survives_json():
    text = make_sentence(join_messages([compose("sample-found", count=2, rest="x"), "y"]))
    known = find_message(text)
    assert known is not None
    assert from_json(json.loads(json.dumps(to_json(known)))) == known


@pytest.mark.parametrize("made", [Message("sample-none", {}), Message("sample-width", {}), Message("none-such", {})])
def test_an_unknown_message_or_a_missing_value_is_an_error(made):
    with pytest.raises(UnknownMessage):
        translate(made, "en")


def test_old_messages_are_forgotten(monkeypatch):
    monkeypatch.setattr(message, "MAX_REMEMBERED", 3)
    texts = [compose("sample-width", width=str(k)) for k in range(5)]
    assert [find_message(text) is not None for text in texts] == [False, False, True, True, True]
