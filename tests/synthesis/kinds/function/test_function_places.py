"""Where a function generator is put, and how large it is: stated pivots, regions and lengths."""

import math

import numpy as np
import pytest

from kinematics.linkage import SliderCrank, slider_crank
from tests.support.synthesis.function_tasks import (
    CASES,
    UNBOUNDED,
    holds,
    pairs_of,
    planted_fourbar,
    proportions,
    solved,
    task_of,
)


def box(places, margin):
    """The region around places, with a margin on all sides."""
    x, y = [complex(z).real for z in places], [complex(z).imag for z in places]
    return {"x": [min(x) - margin, max(x) + margin], "y": [min(y) - margin, max(y) + margin]}


class TestPlaceAndSize:
    @pytest.mark.parametrize(("origin", "size"), [(0.0, 1e-6), (1e6, 1.0), (-1e5, 1e5)])
    def test_the_pivots_are_where_they_are_stated(self, origin, size):
        pivots = {"input": [origin, origin], "output": [origin + size, origin + size]}
        lengths, inputs, outputs = planted_fourbar(np.random.default_rng(2), 5)
        result = solved(pairs=pairs_of(inputs, outputs), fixed_pivots=pivots, constraints=UNBOUNDED)
        assert any(np.allclose(proportions(design), lengths, rtol=1e-5) for design in result.designs)
        assert result.designs[0].mechanism.fixed_pivots.input == (origin, origin)

    @pytest.mark.slow
    def test_sizes_and_regions_are_kept(self):
        task = task_of(CASES[3])
        limits = {"link_length": {"min": 20.0, "max": 90.0}}
        links = solved(**{**task, "constraints": limits}).designs[0].mechanism.links
        assert min(links.ground, links.input, links.coupler, links.output) >= 20.0 * (1.0 - 1e-9)
        assert max(links.ground, links.input, links.coupler, links.output) <= 90.0 * (1.0 + 1e-9)
        region = {"x": [-10.0, -5.0], "y": [3.0, 4.0]}
        pivots = solved(**{**task, "constraints": {"fixed_pivot_region": region}}).designs[0].mechanism.fixed_pivots
        assert -10.0 <= pivots.input[0] < pivots.output[0] <= -5.0

    @pytest.mark.parametrize("seed", range(8))
    def test_a_planted_linkage_is_put_where_regions_and_lengths_let_it_be(self, seed):
        rng = np.random.default_rng(seed)
        (a, b, c), inputs, outputs = planted_fourbar(rng, 5)
        o2, along = complex(*rng.normal(size=2)) * 200.0, 80.0 * np.exp(1j * rng.uniform(0.0, math.tau))
        pin = o2 + along * a * np.exp(1j * math.radians(inputs[0]))
        joint = o2 + along * (1.0 + c * np.exp(1j * math.radians(outputs[0])))
        lengths = [80.0, 80.0 * a, 80.0 * b, 80.0 * c]
        demands = {
            **UNBOUNDED,
            "fixed_pivot_region": box([o2, o2 + along], 4.0),
            "moving_pivot_region": box([pin, joint], 4.0),
            "link_length": {"min": 0.95 * min(lengths), "max": 1.05 * max(lengths)},
        }
        result = solved(pairs=pairs_of(inputs, outputs), constraints=demands)
        assert result.search.complete
        assert holds(result, (a, b, c))
        # Away from there it is proven that none fits.
        demands["moving_pivot_region"] = box([pin + 1000.0], 4.0)
        nowhere = solved(pairs=pairs_of(inputs, outputs), constraints=demands)
        assert (nowhere.designs, nowhere.search.complete) == ([], True)

    def test_a_slider_crank_is_turned_into_its_region(self):
        rng = np.random.default_rng(5)
        for _ in range(5):
            a, b, e = 10.0, rng.uniform(14.0, 40.0), rng.uniform(-3.0, 3.0)
            linkage = SliderCrank(0.0, 1j * e, 0.0, a, b)
            inputs = 20.0 + np.array([0.0, 20.0, 45.0, 80.0, 110.0])
            at = slider_crank.positions(linkage, np.radians(inputs))
            o2, along = complex(*rng.normal(size=2)) * 50.0, np.exp(1j * rng.uniform(0.0, math.tau))
            demands = {
                **UNBOUNDED,
                "fixed_pivot_region": box([o2], 1.0),
                "moving_pivot_region": box([o2 + along * complex(at.a[0]), o2 + along * complex(at.b[0])], 1.0),
            }
            result = solved(mechanism="slider_crank", pairs=pairs_of(inputs, at.travel), constraints=demands)
            assert result.search.complete
            assert any(
                np.allclose((d.mechanism.links.crank, d.mechanism.links.coupler), (a, b)) for d in result.designs
            )
