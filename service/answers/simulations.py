"""Simulation models of a design of a solved job."""

from __future__ import annotations

from kinematics.message import compose
from service.answers.job_result import SolvedJob, parse_design_index
from service.refusals import Refusal, refuse_invalid_request, refuse_not_found
from service.simulation.query import Form, NoSimulation, NotSimulated, SimulationQuery


def simulate_design(job: SolvedJob, number: str, form: Form, query: SimulationQuery) -> tuple[int, str]:
    """Return the index of a design, and its model in a format.

    Raises
    ------
    Refusal
        404, 409 or 422.
    """
    from service.render import make_heading
    from service.simulation.export import write_simulation

    designs = job.load_result().designs
    n = parse_design_index(number, len(designs))
    problem = job.load_problem()
    try:
        return n, write_simulation(designs[n], problem, make_heading(problem, job.label, n), form, query)
    except NoSimulation:
        raise refuse_not_found(compose("service-simulation-unavailable")) from None
    except NotSimulated as error:
        if error.path:
            raise refuse_invalid_request([(error.path, str(error))]) from None
        raise Refusal(409, "no-simulation", "service-title-no-simulation", str(error)) from None


def open_in_pmks(job: SolvedJob, number: str) -> tuple[str, float]:
    """Return the URL at which PMKS+ opens a design, and the scale of its lengths there.

    Raises
    ------
    Refusal
        404 or 409.
    """
    from service.simulation.export import open_in_pmks

    designs = job.load_result().designs
    n = parse_design_index(number, len(designs))
    try:
        return open_in_pmks(designs[n], job.load_problem())
    except NoSimulation:
        raise refuse_not_found(compose("service-pmks-opens-linkages-only")) from None
    except NotSimulated as error:
        raise Refusal(409, "no-simulation", "service-title-no-simulation", str(error)) from None
