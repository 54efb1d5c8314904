"""A design of a solved job for programs that simulate it."""

from __future__ import annotations

from service.answers.job_result import SolvedJob, design_index
from service.refusals import Refusal, invalid_request, not_found
from service.simulation.query import Form, NoSimulation, NotSimulated, SimulationQuery


def simulate_design(job: SolvedJob, number: str, form: Form, query: SimulationQuery) -> tuple[int, str]:
    """The index of a design, and its model in a form.

    Raises
    ------
    Refusal
        404, 409 or 422.
    """
    from service.render import make_heading
    from service.simulation.export import write_simulation

    designs = job.answer().designs
    n = design_index(number, len(designs))
    problem = job.statement()
    try:
        return n, write_simulation(designs[n], problem, make_heading(problem, job.label, n), form, query)
    except NoSimulation:
        raise not_found("This type of mechanism has no simulations; linkages and gear trains have.") from None
    except NotSimulated as error:
        if error.path:
            raise invalid_request([(error.path, str(error))]) from None
        raise Refusal(409, "no-simulation", "No simulation", str(error)) from None


def open_in_pmks(job: SolvedJob, number: str) -> tuple[str, float]:
    """The address at which PMKS+ opens a design, and the scale of its lengths there.

    Raises
    ------
    Refusal
        404 or 409.
    """
    from service.simulation.export import open_in_pmks

    designs = job.answer().designs
    n = design_index(number, len(designs))
    try:
        return open_in_pmks(designs[n], job.statement())
    except NoSimulation:
        raise not_found("PMKS+ opens linkages only.") from None
    except NotSimulated as error:
        raise Refusal(409, "no-simulation", "No simulation", str(error)) from None
