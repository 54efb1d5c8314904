"""Every example has a name, a group and a line, and a picture in the studio."""

from pathlib import Path
from typing import get_args
from xml.etree import ElementTree

import service
from synthesis.model.kind import Group
from synthesis.registry import KINDS, list_examples

SVG = "{http://www.w3.org/2000/svg}"


def test_examples_are_named_in_their_order(client):
    told = client.get("/v1/problems").json()["problems"]
    assert [kind["kind"] for kind in told] == list(KINDS)
    for kind in told:
        assert len(kind["examples"]) == len(kind["schema"]["examples"]) == len(list_examples(kind["kind"]))
        assert kind["example"] == kind["schema"]["examples"][0]
        assert kind["examples"] == [one._asdict() for one in KINDS[kind["kind"]].gallery]


def test_names_are_told_apart_and_lines_are_short_sentences():
    named = [one for kind in KINDS.values() for one in kind.gallery]
    assert len({one.name for one in named}) == len(named)
    assert {one.group for one in named} == set(get_args(Group))
    for one in named:
        assert len(one.name) <= 32
        assert len(one.line) <= 100
        assert one.line.endswith(".")


def test_every_example_has_its_picture():
    drawn = ElementTree.parse(Path(service.__file__).parent / "studio" / "gallery.svg").getroot()
    symbols = {symbol.get("id"): len(list(symbol.iter())) for symbol in drawn.iter(f"{SVG}symbol")}
    assert set(symbols) == {f"{kind}-{n}" for kind in KINDS for n in range(len(list_examples(kind)))}
    assert min(symbols.values()) > 1
