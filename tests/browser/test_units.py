"""Every number of a design has its unit beside it, and it is the unit that the service knows."""

import pytest

from service.api.http.metric_units import collect_measures
from service.units import list_symbols
from synthesis.registry import KINDS, list_examples, parse_problem
from tests.support.browser.studio import PLAIN, state

pytestmark = pytest.mark.browser

ASKED = """async asked => {
  const { unitSymbol } = await import("/studio/core/units.js");
  return asked.map(([problem, dimensions]) => dimensions.map(one => unitSymbol(one, problem)));
}"""


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_has_the_units_of_the_service(kept_studio, kind):
    """In millimetres and in inches; a field that an example leaves out has its default there, as jobs have it."""
    wanted = sorted(set(collect_measures(KINDS[kind].result).values()))
    stated = [parse_problem({**one, "length_unit": unit}) for one in list_examples(kind) for unit in ("mm", "in")]
    asked = [[one.model_dump(mode="json", by_alias=True), [str(of) for of in wanted]] for one in stated]
    told = kept_studio.page.evaluate(ASKED, asked)
    for problem, units in zip(stated, told, strict=True):
        assert dict(zip(wanted, units, strict=True)) == {of: list_symbols(problem)[of] for of in wanted}


def test_numbers_have_their_units_beside_them(studio, server):
    page = studio.page
    state(page, {**PLAIN, "length_unit": "in"})
    studio.solve()
    job = page.evaluate("location.hash.slice(5)")
    metrics = server.job(job)["result"]["designs"][0]["metrics"]
    rows = dict(
        page.locator("#numbers tr").evaluate_all("all => all.map(row => [...row.cells].map(one => one.innerText))")
    )
    value, unit = rows["Size"].split()
    assert float(value) == float(f"{metrics['size']:.3g}")
    assert unit == "in"
    assert rows["Min transmission angle"].endswith("°")
    assert float(rows["Quality"]) == float(f"{metrics['quality']:.3g}")
    assert rows["Links coupler"].endswith(" in")
    assert rows["Fixed pivots input"].endswith(" in")
    # What a shop makes has more digits than what is judged, and all digits are where the pointer rests.
    coupler = server.job(job)["result"]["designs"][0]["mechanism"]["links"]["coupler"]
    assert float(rows["Links coupler"].split()[0]) == pytest.approx(coupler, rel=1e-4)
    whole = dict(
        page.locator("#numbers tr").evaluate_all("all => all.map(row => [row.cells[0].innerText, row.cells[1].title])")
    )
    assert whole["Size"] == f"{metrics['size']!r} in"
    assert float(whole["Quality"]) == metrics["quality"]
    assert float(whole["Links coupler"].split()[0]) == coupler
    # What is missed by rounding alone is exact; the number is told there, too.
    assert metrics["rms_residual"] < 1e-9
    assert rows["Rms residual"] == "exact"
    assert float(whole["Rms residual"]) == metrics["rms_residual"]
    assert "_" not in page.locator("#numbers").inner_text()


def test_only_what_is_missed_by_rounding_is_exact(kept_studio):
    """A residual that a tolerance allows is a number, and so is a small quantity that is no residual."""
    asked = [
        ["rms_residual", 3e-16, None, 0],
        ["reaches_targets", 4e-16, None, 0],
        ["max_error", 1e-8, "length", 108.0],
        ["max_error", 1e-6, "length", 108.0],
        ["max_error", 1e-15, "length", 0],
        ["sum_of_squares", 7e-27, "area", 122.0],
        ["sum_of_squares", 1e-9, "area", 122.0],
        ["rms_residual", 1e-6, None, 0],
        ["ratio_error", -2.7e-7, None, 0],
        ["ratio_error", 0, None, 0],
        ["inertia", 1e-12, None, 0],
        ["residual_unbalance", 1e-12, "unbalance", 0],
    ]
    told = kept_studio.page.evaluate(
        """async asked => {
          const { isExact } = await import("/studio/design/design_metrics.js");
          return asked.map(([name, value, dimension, size]) => isExact(name, value, dimension ?? undefined, size));
        }""",
        asked,
    )
    assert told == [True, True, True, False, False, True, False, False, False, True, False, False]
