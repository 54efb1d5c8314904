"""Norton's examples of motion generation, solved and verified."""

from __future__ import annotations

import cmath
import math
from typing import Any

import pytest

from synthesis.dispatch import solve
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.registry import parse_problem
from tests.cases import Case, cases
from tests.support.synthesis.motion_literature import vector


def quiet(fraction: float, message: str) -> None:
    pass


def positions(case: Case) -> list[dict[str, float]]:
    assert case.inputs is not None
    later = [k for k in (2, 3) if f"P{k}1" in case.inputs]
    points = [0j, *(vector(case.inputs[f"P{k}1"]) for k in later)]
    angles = [0.0, *(case.inputs[f"alpha{k}"] for k in later)]
    return [{"x": p.real, "y": p.imag, "angle": a} for p, a in zip(points, angles, strict=True)]


def only_design(**statement: Any) -> LinkageDesign:
    result = solve(parse_problem({"kind": "motion", **statement}), quiet)
    assert result.search.complete
    assert result.search.candidates == 1
    assert len(result.designs) == 1
    assert result.designs[0].verification.passed
    return result.designs[0]


def polar(name: str, z: complex) -> dict[str, float]:
    return {
        f"{name}_x": z.real,
        f"{name}_y": z.imag,
        f"{name}_mag": abs(z),
        f"{name}_ang": math.degrees(cmath.phase(z)),
    }


def measured(design: LinkageDesign) -> dict[str, Any]:
    """Everything that the tables print, from the design's dimensions and skeleton."""
    joints = {name: complex(*point) for name, point in design.mechanism.skeleton.joints.items()}
    links, start = design.mechanism.links, [target.input_angle for target in design.targets]
    w, z = joints["A"] - joints["O2"], joints["P"] - joints["A"]
    u, s = joints["B"] - joints["O4"], joints["P"] - joints["B"]
    ground = math.degrees(cmath.phase(joints["O4"] - joints["O2"]))
    found: dict[str, Any] = {
        **polar("W", w),
        **polar("Z", z),
        **polar("U", u),
        **polar("S", s),
        **polar("V", z - s),
        **polar("G", w + (z - s) - u),
        **polar("O2", joints["O2"]),
        **polar("O4", joints["O4"]),
        "link1": links.ground,
        "link2": links.input,
        "link3": links.coupler,
        "link4": links.output,
        "AP": design.mechanism.coupler_point.distance,
        "coupler_angle": design.mechanism.coupler_point.angle,
        "theta2_start": start[0] - ground,
        "theta2_final": start[-1] - ground,
        "theta2_step": start[1] - start[0],
        "circuit": design.mechanism.assembly,
        "same_circuit": next(c.passed for c in design.verification.checks if c.name == "same_circuit"),
    }
    for k, angle in enumerate(start[1:], start=2):
        found[f"beta{k}"] = angle - start[0]
    return found


def output_rotations(design: LinkageDesign, statement: list[dict[str, float]]) -> dict[str, float]:
    """γ2, γ3: rotations of the output from where the body carries B."""
    joints = {name: complex(*point) for name, point in design.mechanism.skeleton.joints.items()}
    first = joints["B"] - joints["O4"]
    found = {}
    for k, position in enumerate(statement[1:], start=2):
        turn = cmath.exp(1j * math.radians(position["angle"]))
        pin = complex(position["x"], position["y"]) + turn * (joints["B"] - joints["P"])
        found[f"gamma{k}"] = math.degrees(cmath.phase((pin - joints["O4"]) / first))
    return found


@pytest.mark.parametrize("case", cases("motion_2pos"))
def test_two_positions_with_z_phi_and_beta(case: Case) -> None:
    """Example 5-1: Z and β given, W found. The dyad stands on the input side; the other side is any that closes."""
    assert case.inputs is not None
    side = {
        "rotations": [case.inputs["beta2"]],
        "coupler_vector": {"length": case.inputs["Z"]["mag"], "angle": case.inputs["Z"]["ang"]},
    }
    other = {"rotations": [85.6], "coupler_vector": {"length": 1.035, "angle": 104.1}}
    if side == other:
        other = {"rotations": [38.4], "coupler_vector": {"length": 1.298, "angle": 26.5}}
    design = only_design(positions=positions(case), input_side=side, output_side=other)
    case.check(**measured(design))


@pytest.mark.parametrize("case", cases("motion_3pos"))
def test_three_positions_with_rotations(case: Case) -> None:
    """Example 5-2 and Table 5-1: β2, β3, γ2, γ3 given. The linkage is assembled crossed."""
    assert case.inputs is not None
    design = only_design(
        positions=positions(case),
        input_side={"rotations": [case.inputs["beta2"], case.inputs["beta3"]]},
        output_side={"rotations": [case.inputs["gamma2"], case.inputs["gamma3"]]},
    )
    case.check(**measured(design))
    assert design.mechanism.assembly == "crossed"
    assert design.metrics.same_branch
    assert design.metrics.visits_in_order
    assert design.metrics.barker == "RRR1"


@pytest.mark.parametrize("case", cases("path_timing"))
def test_three_points_with_crank_rotations(case: Case) -> None:
    """Path generation with timing has the equations of Example 5-2: β is prescribed, α the free choice."""
    assert case.inputs is not None
    x = case.inputs
    points = [0j, *(cmath.rect(x[name]["mag"], math.radians(x[name]["ang"])) for name in ("P21", "P31"))]
    turned = [0.0, x["alpha2"], x["alpha3"]]
    design = only_design(
        positions=[{"x": p.real, "y": p.imag, "angle": a} for p, a in zip(points, turned, strict=True)],
        input_side={"rotations": [x["beta2"], x["beta3"]]},
        output_side={"rotations": [x["gamma2"], x["gamma3"]]},
    )
    joints = {name: complex(*point) for name, point in design.mechanism.skeleton.joints.items()}
    w, z = joints["A"] - joints["O2"], joints["P"] - joints["A"]
    case.check(W_x=w.real, W_y=w.imag, Z_x=z.real, Z_y=z.imag)


@pytest.mark.parametrize("case", cases("motion_3pos_fixed_pivots"))
def test_three_positions_with_fixed_pivots(case: Case) -> None:
    """Example 5-3 and Problems 5-11, 5-19, 5-26: both fixed pivots given."""
    assert case.inputs is not None
    statement = positions(case)
    design = only_design(
        positions=statement,
        input_side={"fixed_pivot": case.inputs["O2"]},
        output_side={"fixed_pivot": case.inputs["O4"]},
    )
    case.check(**measured(design), **output_rotations(design, statement))


def test_three_rotations_as_moving_pivots() -> None:
    """Example 5-2 stated by its moving pivots gives the same linkage."""
    case = next(param.values[0] for param in cases("motion_3pos") if param.id == "ch5-ex5-2")
    assert isinstance(case, Case)
    assert case.inputs is not None
    by_rotations = only_design(
        positions=positions(case),
        input_side={"rotations": [case.inputs["beta2"], case.inputs["beta3"]]},
        output_side={"rotations": [case.inputs["gamma2"], case.inputs["gamma3"]]},
    )
    joints = by_rotations.mechanism.skeleton.joints
    by_pivots = only_design(
        positions=positions(case),
        input_side={"moving_pivot": joints["A"]},
        output_side={"moving_pivot": joints["B"]},
    )
    for name, point in joints.items():
        assert by_pivots.mechanism.skeleton.joints[name] == pytest.approx(point, abs=1e-12), name
