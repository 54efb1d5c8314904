"""A balanced rotor as a table: one row per unbalance or correction."""

from __future__ import annotations

from service.render.page.table import Cell, write_table
from service.units import list_symbols
from synthesis.kinds.balancing.design import RotorDesign
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.model.dimension import Dimension


def write_rotor_table(design: RotorDesign, problem: BalancingProblem, title: str) -> str:
    """Write the unbalances of the rotor, and the masses added or removed, each with its place."""
    units = list_symbols(problem)
    mechanism = design.mechanism
    rows: list[list[Cell]] = [["unbalance", None, e.z, e.angle, e.unbalance, None, None] for e in mechanism.unbalances]
    rows += [
        ["removed" if e.removed else "added", e.plane + 1, e.z, e.angle, e.unbalance, e.mass, e.radius]
        for e in mechanism.corrections
    ]
    names = {"unbalance": Dimension.UNBALANCE, "mass": Dimension.MASS}
    heads = ("_".join(filter(None, (name, units[measure]))) for name, measure in names.items())
    unbalance, mass = (head.replace("·", "_") for head in heads)
    length = problem.length_unit
    return write_table(["what", "plane", f"z_{length}", "angle_deg", unbalance, mass, f"radius_{length}"], rows)
