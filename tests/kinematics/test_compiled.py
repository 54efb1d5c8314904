"""Marks of what has been compiled: they count for the sources that they were made with, and are made by one process."""

from pathlib import Path

import pytest

from kinematics import kernel_marks
from kinematics.kernel_marks import claim_part, is_compiled, mark_compiled


@pytest.fixture
def source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file of a project of its own, whose kernels are kept beside it."""
    file = tmp_path / "synthesis" / "part.py"
    file.parent.mkdir()
    file.write_text("TEETH = 17\n")
    monkeypatch.setattr(kernel_marks, "ROOT", tmp_path)
    monkeypatch.setattr(kernel_marks, "_find_cache_folder", lambda: tmp_path / "kept")
    monkeypatch.setattr(kernel_marks, "_compute_state_digest", kernel_marks._compute_state_digest.__wrapped__)
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
    codegen = kernel_marks.cpu_target.target_context.codegen()
    monkeypatch.setattr(type(codegen), "magic_tuple", lambda self: ("x86_64", "another", "+none"))
    assert not is_compiled("path")


def test_a_part_is_compiled_by_one(source: Path) -> None:
    with claim_part("path") as first, claim_part("path") as second, claim_part("dwell") as other:
        assert (first, second, other) == (True, False, True)
    with claim_part("path") as again:
        assert again
