"""Every message that the code composes is in the catalogues of all languages, with the same values, and no other is."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from fluent.syntax import FluentParser
from fluent.syntax import ast as fluent
from fluent.syntax.visitor import Visitor

from kinematics.message import LANGUAGES, SOURCE_LANGUAGE, find_catalogues, translate
from kinematics.message import Message as ComposedMessage

ROOT = Path(__file__).parents[1]
PACKAGES = ("kinematics", "synthesis", "service", "mechsynth")


class _Variables(Visitor):
    def __init__(self) -> None:
        self.names: set[str] = set()

    def visit_VariableReference(self, node: fluent.VariableReference) -> None:
        self.names.add(node.id.name)


@cache
def read_catalogue(folder: Path, language: str) -> dict[str, frozenset[str]]:
    """The ids in a catalogue, with the names of their values."""
    source = FluentParser().parse((folder / f"messages.{language}.ftl").read_text("utf-8"))
    found: dict[str, frozenset[str]] = {}
    for entry in source.body:
        assert not isinstance(entry, fluent.Junk), f"{folder}, {language}: {entry.content}"
        if isinstance(entry, fluent.Message):
            assert entry.id.name not in found, f"{folder}, {language}: {entry.id.name} is there twice"
            variables = _Variables()
            variables.visit(entry)
            found[entry.id.name] = frozenset(variables.names)
    return found


def composed() -> Iterator[tuple[str, frozenset[str] | None, str]]:
    """The ids in calls of ``compose`` with the names of their values, None where they are not known, and the place."""
    beginnings = tuple(f"{folder}-" for folder in find_catalogues())
    for path in [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]:
        text = path.read_text("utf-8")
        if not any(beginning in text for beginning in beginnings):
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "compose":
                names = (
                    None
                    if any(word.arg is None for word in node.keywords)
                    else frozenset(word.arg for word in node.keywords if word.arg)
                )
                for constant in ast.walk(node.args[0]):
                    if isinstance(constant, ast.Constant) and is_id(constant.value):
                        yield constant.value, names, f"{path.relative_to(ROOT)}:{node.lineno}"
            elif isinstance(node, ast.Constant) and is_id(node.value):
                # An id in a table, which is composed elsewhere.
                yield node.value, None, f"{path.relative_to(ROOT)}:{node.lineno}"


def is_id(value: object) -> bool:
    """Whether a constant is the id of a message: the name of a folder with catalogues, and words in lower case."""
    if not isinstance(value, str) or not value.isascii() or " " in value:
        return False
    folder, hyphen, rest = value.partition("-")
    return bool(hyphen) and folder in find_catalogues() and rest.replace("-", "").replace("_", "").isalnum()


@pytest.mark.parametrize("folder", find_catalogues().values(), ids=lambda folder: folder.name)
def test_the_languages_of_a_package_have_the_same_messages_and_values(folder):
    english = read_catalogue(folder, SOURCE_LANGUAGE)
    assert all(name.startswith(f"{folder.name}-") for name in english)
    for language in LANGUAGES:
        assert read_catalogue(folder, language) == english


def test_every_composed_message_exists_and_every_message_is_composed():
    known = {
        name: values for folder in find_catalogues().values() for name, values in read_catalogue(folder, "en").items()
    }
    faults = []
    used = set()
    for name, values, place in composed():
        used.add(name)
        if name not in known:
            faults.append(f"{place}: no catalogue has {name}")
        elif values is not None and values != known[name]:
            faults.append(f"{place}: {name} gets {sorted(values)}, its text has {sorted(known[name])}")
    faults += [f"{name} is never composed" for name in known.keys() - used]
    assert not faults, "\n".join(faults)


def test_every_message_can_be_written_in_every_language():
    for folder in find_catalogues().values():
        for name, values in read_catalogue(folder, SOURCE_LANGUAGE).items():
            for count in (1, 2):
                sample = ComposedMessage(name, dict.fromkeys(values, count))
                assert all(translate(sample, language).strip() for language in LANGUAGES)
