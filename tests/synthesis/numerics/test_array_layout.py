"""Layouts of packed arrays: where parts lie, and what compiled code reads there."""

import numpy as np
import pytest

from kinematics.compiling import njit
from synthesis.numerics.array_layout import ArrayLayout

LAYOUT = ArrayLayout(pose=3, weight=1, boxes=4)
POSE, WEIGHT, BOXES = LAYOUT.slice("pose"), LAYOUT.index("weight"), LAYOUT.slice("boxes")


def test_parts_fill_an_array_without_gaps():
    values = np.arange(LAYOUT.size)
    parts = [values[LAYOUT.slice(name)] for name in ("pose", "weight", "boxes")]
    assert np.array_equal(np.concatenate(parts), values)
    assert [len(part) for part in parts] == [3, 1, 4]
    assert LAYOUT.slice("weight", "boxes") == slice(3, 8)


def test_a_layout_continues_another_one():
    further = ArrayLayout(LAYOUT.size, steps=2, room=4)
    assert (further.start("steps"), further.start("room"), further.size) == (8, 10, 14)


def test_a_part_of_several_entries_has_no_single_index():
    with pytest.raises(ValueError, match="boxes has 4 entries"):
        LAYOUT.index("boxes")


@pytest.mark.parametrize("width", [0, -1])
def test_a_part_needs_an_entry(width):
    with pytest.raises(ValueError, match="weight must have at least one entry"):
        ArrayLayout(pose=3, weight=width)


@njit()
def read(values):
    return values[POSE].sum() * values[WEIGHT] + values[BOXES][3]


def test_compiled_code_reads_named_parts():
    values = np.arange(float(LAYOUT.size))
    assert read(values) == read.py_func(values) == 3.0 * 3.0 + 7.0
