"""Marks of what has been compiled: they count for the sources that they were made with, and are made by one process."""

from pathlib import Path

import pytest

from kinematics import compiled
from kinematics.compiled import claimed, is_compiled, mark_compiled


@pytest.fixture
def source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file of a project of its own, whose kernels are kept beside it."""
    file = tmp_path / "synthesis" / "part.py"
    file.parent.mkdir()
    file.write_text("TEETH = 17\n")
    monkeypatch.setattr(compiled, "ROOT", tmp_path)
    monkeypatch.setattr(compiled, "_folder", lambda: tmp_path / "kept")
    monkeypatch.setattr(compiled, "_state", compiled._state.__wrapped__)
    return file


def test_a_mark_counts_for_its_part_and_its_sources(source: Path) -> None:
    assert not is_compiled("path")
    mark_compiled("path")
    assert is_compiled("path")
    assert not is_compiled("dwell")
    source.write_text("TEETH = 18\n")
    assert not is_compiled("path")
    source.write_text("TEETH = 17\n")
    assert is_compiled("path")


def test_a_mark_counts_for_its_processor(source: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mark_compiled("path")
    codegen = compiled.cpu_target.target_context.codegen()
    monkeypatch.setattr(type(codegen), "magic_tuple", lambda self: ("x86_64", "another", "+none"))
    assert not is_compiled("path")


def test_a_part_is_compiled_by_one(source: Path) -> None:
    with claimed("path") as first, claimed("path") as second, claimed("dwell") as other:
        assert (first, second, other) == (True, False, True)
    with claimed("path") as again:
        assert again
