"""Common points of quadrics that are known beforehand: of products of lines and planes, and of curves that touch."""

from __future__ import annotations

import numpy as np
import pytest

from synthesis.numerics.quadrics import find_common_points

Real = np.ndarray


def product(*factors: Real) -> Real:
    """The quadric that is two planes, as a symmetric matrix of unit norm."""
    form = np.outer(*factors)
    form = form + form.T
    return np.asarray(form / np.linalg.norm(form))


def same_points(found: Real, expected: Real, tolerance: float = 1e-9) -> bool:
    """Whether two lists of unit vectors are the same points, in any order."""
    closeness = np.abs(found @ expected.T)
    return len(found) == len(expected) and bool((closeness.max(axis=0) > 1.0 - tolerance).all())


@pytest.mark.parametrize("m", [2, 3, 4])
def test_pairs_of_planes_meet_in_all_their_points(m: int) -> None:
    rng = np.random.default_rng(m)
    for _ in range(20):
        planes = rng.normal(size=(m - 1, 2, m))
        expected = []
        for choice in np.ndindex(*([2] * (m - 1))):
            _, _, vh = np.linalg.svd(np.array([planes[k, side] for k, side in enumerate(choice)]))
            expected.append(vh[-1])
        found = find_common_points(np.array([product(*pair) for pair in planes]))
        assert found.finite
        assert len(found.unproved) == 0
        assert not found.double.any()
        assert same_points(found.real, np.array(expected))


@pytest.mark.parametrize("m", [3, 4])
def test_quadrics_without_real_points(m: int) -> None:
    """A sphere has none; the complex ones are proved to be complex."""
    rng = np.random.default_rng(m)
    forms = rng.normal(size=(m - 1, m, m))
    forms[0] = np.diag(rng.uniform(0.5, 2.0, m))
    forms = forms + forms.transpose(0, 2, 1)
    found = find_common_points(forms / np.linalg.norm(forms, axis=(1, 2))[:, None, None])
    assert found.finite
    assert len(found.real) == 0
    assert len(found.unproved) == 0


def test_a_double_point_is_said() -> None:
    """The unit circle and the parabola y = x² − 1 touch at (0, −1) and cross at (±1, 0)."""
    circle = np.diag([1.0, 1.0, -1.0]) / np.sqrt(3.0)
    parabola = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -0.5], [0.0, -0.5, -1.0]])
    found = find_common_points(np.array([circle, parabola / np.linalg.norm(parabola)]))
    assert len(found.unproved) == 2
    points = found.real[:, :2] / found.real[:, 2:]
    order = np.lexsort((points[:, 0],))
    assert points[order] == pytest.approx(np.array([[-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]]), abs=1e-7)
    assert found.double[order].tolist() == [False, True, False]


def test_a_common_line_is_said() -> None:
    rng = np.random.default_rng(5)
    line, one, other = rng.normal(size=(3, 3))
    assert not find_common_points(np.array([product(line, one), product(line, other)])).finite
