"""Errors of the core carry the id and the values of their message, and compose the text when it is read."""

from __future__ import annotations

import ast
import pickle
from pathlib import Path

import numpy as np
import pytest
from fluent.syntax import FluentParser
from fluent.syntax import ast as fluent
from fluent.syntax.visitor import Visitor

from kinematics import message
from kinematics.errors import ID_PREFIX, DimensionError, MechanismError
from kinematics.linkage import TopologyError
from kinematics.linkage.batch import require
from kinematics.linkage.clearance.scene import RangeError

ROOT = Path(__file__).parents[2]
LAZY = {"DimensionError", "TopologyError", "require"}


class _Variables(Visitor):
    def __init__(self) -> None:
        self.names: set[str] = set()

    def visit_VariableReference(self, node: fluent.VariableReference) -> None:
        self.names.add(node.id.name)


def variables() -> dict[str, set[str]]:
    """The values of each message of the core."""
    found = {}
    for entry in FluentParser().parse((ROOT / "kinematics/messages.en.ftl").read_text("utf-8")).body:
        if isinstance(entry, fluent.Message):
            visitor = _Variables()
            visitor.visit(entry)
            found[entry.id.name] = visitor.names
    return found


def test_the_text_of_a_dimension_is_composed_when_it_is_read(monkeypatch):
    composed = []
    monkeypatch.setattr(message, "remember", lambda sent, real=message.remember: composed.append(sent) or real(sent))
    error = DimensionError("links", "kinematics-even-and-at-least", 3, least=4)
    assert not composed
    assert str(error) == "links must be even and at least 4, got 3"
    assert composed
    known = message.find_message(str(error))
    assert known is not None
    assert message.translate(known, "de") == "links: gefordert gerade und mindestens 4, angegeben 3"


def test_names_of_dimensions_are_translated_and_texts_stay():
    error = DimensionError("kinematics-slide", "kinematics-finite", 0.5, joint="B")
    known = message.find_message(str(error))
    assert str(error) == "slide of B must be finite, got 0.5"
    assert known is not None
    assert message.translate(known, "de") == "Führung von B: gefordert endlich, angegeben 0,5"
    assert str(DimensionError("links", "two or more", 1)) == "links must be two or more, got 1"
    assert str(MechanismError("out of reach")) == "out of reach"


@pytest.mark.parametrize(
    "error",
    [
        DimensionError("links", "kinematics-even-and-at-least", 3, least=4),
        RangeError(12.0, 6.28),
        TopologyError("kinematics-joint-on-no-link", joint="'Q'"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_errors_can_be_sent_to_other_processes(error):
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is type(error)
    assert str(copy) == str(error)
    assert vars(copy) == vars(error)


def test_require_names_the_first_bad_value():
    length, ends = np.array([1.0, -2.0, -3.0]), {"link": "AB", "first": "A", "second": "B"}
    with pytest.raises(DimensionError, match=r"^length of AB from A to B must be positive, got -2\.0$") as caught:
        require("kinematics-link-length", "kinematics-positive", length, length > 0.0, **ends)
    assert caught.value.value == -2.0


def test_every_error_has_the_values_of_its_messages():
    known, faults, count = variables(), [], 0
    for path in sorted((ROOT / "kinematics").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Call) or ast.unparse(node.func) not in LAZY:
                continue
            # An id that a variable holds is not known here; test_message_catalogues.py checks that it exists.
            if any(isinstance(part, ast.Name | ast.IfExp) for part in node.args[:2]):
                continue
            ids = [part.value for part in node.args if isinstance(part, ast.Constant) and isinstance(part.value, str)]
            needed = set().union(*(known[name] for name in ids if name.startswith(ID_PREFIX)))
            given = {word.arg for word in node.keywords}
            # A call that passes all values on has the keyword None.
            if None not in given and given != needed:
                faults.append(f"{path.relative_to(ROOT)}:{node.lineno}: {ids} gets {given}, needs {needed}")
            count += bool(ids)
    assert count > 50
    assert not faults, "\n".join(faults)
