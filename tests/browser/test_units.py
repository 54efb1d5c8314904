"""Every number of a design has its unit beside it, and it is the unit that the service knows."""

import pytest

from service.api.measures import measures
from service.units import symbols
from synthesis.registry import KINDS, examples, parse_problem
from tests.browser.test_studio import PLAIN, state

pytestmark = pytest.mark.browser

ASKED = """async asked => {
  const { symbolOf } = await import("/studio/units.js");
  return asked.map(([problem, dimensions]) => dimensions.map(one => symbolOf(one, problem)));
}"""


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_has_the_units_of_the_service(kept_studio, kind):
    """In millimetres and in inches; a field that an example leaves out has its default there, as jobs have it."""
    wanted = sorted(set(measures(KINDS[kind].result).values()))
    stated = [parse_problem({**one, "length_unit": unit}) for one in examples(kind) for unit in ("mm", "in")]
    asked = [[one.model_dump(mode="json", by_alias=True), [str(of) for of in wanted]] for one in stated]
    told = kept_studio.page.evaluate(ASKED, asked)
    for problem, units in zip(stated, told, strict=True):
        assert dict(zip(wanted, units, strict=True)) == {of: symbols(problem)[of] for of in wanted}


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
    assert float(value) == pytest.approx(metrics["size"], rel=1e-4)
    assert unit == "in"
    assert rows["Min transmission angle"].endswith("°")
    assert float(rows["Quality"]) == pytest.approx(metrics["quality"], rel=1e-4)
    assert rows["Links coupler"].endswith(" in")
    assert rows["Fixed pivots input"].endswith(" in")
