"""The messages of an answer: found by the place of their texts, and written in another language there."""

from __future__ import annotations

import json

from pydantic import BaseModel, Field

from kinematics import message
from kinematics.message import compose, use_language
from synthesis.model.text_messages import list_messages, translate_answer


class Part(BaseModel):
    note: str
    figures: list[float] = [1.0, 2.0]


class Found(BaseModel):
    summary: str
    parts: dict[str, list[Part]] = Field(alias="the/parts")
    label: str = "sample"


def test_each_text_is_written_in_the_other_language_at_its_place(tmp_path, monkeypatch):
    (tmp_path / "messages.en.ftl").write_text("sample-width = width of { $width } mm\nsample-short = short\n", "utf-8")
    (tmp_path / "messages.de.ftl").write_text("sample-width = Breite { $width } mm\nsample-short = kurz\n", "utf-8")
    monkeypatch.setattr(message, "find_catalogues", lambda: {"sample": tmp_path})
    message._load_bundle.cache_clear()
    try:
        # A text of one word may be a name of the client and stays.
        short = compose("sample-short")
        widths = [compose("sample-width", width=width) for width in ("2.5", "3")]
        parts = {"a~b": [Part(note="none"), Part(note=widths[1])]}
        found = Found.model_validate({"summary": widths[0], "the/parts": parts, "label": short})
        answer = json.loads(found.model_dump_json(by_alias=True))
        answer["messages"] = [one.model_dump() for one in list_messages(found)]
        assert [one["path"] for one in answer["messages"]] == ["/summary", "/the~1parts/a~0b/1/note"]
        assert answer["messages"] == [one.model_dump() for one in list_messages(answer)]
        translate_answer(answer, "de")
        assert answer["summary"] == "Breite 2,5 mm"
        assert [part["note"] for part in answer["the/parts"]["a~b"]] == ["none", "Breite 3 mm"]
        assert answer["label"] == "short"
        with use_language("de"):
            assert compose("sample-width", width="2.5") == "Breite 2,5 mm"
        assert compose("sample-width", width="2.5") == "width of 2.5 mm"
    finally:
        message._load_bundle.cache_clear()
