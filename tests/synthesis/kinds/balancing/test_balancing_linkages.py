"""Linkages balanced exactly: what moves keeps its centre of gravity, and where nothing balances that is said."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from synthesis.analyses.linkages.requested_motion import place_machine
from synthesis.dispatch import solve
from synthesis.kinds.balancing.linkage.force_balance import find_force_balances, is_balanceable, list_unpinned_links
from synthesis.kinds.balancing.linkage.motion import build_balancing_task
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verification.linkage import build_answer_machine, verify_linkage
from synthesis.registry import list_examples
from tests.support.synthesis.balanced_linkages import fourbar, sixbar, stated


def problem_of(statement: dict[str, Any]) -> BalancingProblem:
    problem = BalancingProblem.model_validate(statement)
    problem.require_consistent()
    return problem


def centre_of_gravity(problem: BalancingProblem, design: Any) -> tuple[Any, float]:
    """Over the motion: Σ m r of all that moves, and the sum of the masses."""
    machine = build_answer_machine(problem, design.mechanism, design.dynamics)
    task = build_balancing_task(problem)
    now = place_machine(machine, task.list_positions(50))
    moments = sum(float(part.mass) * now.point(link, part.cg)[0] for link, part in machine.bodies.items())
    moments = moments + sum(float(mass) * now.joints[joint][0] for joint, mass in machine.pin_masses.items())
    return moments, sum(float(part.mass) for part in machine.bodies.values())


@pytest.mark.parametrize("make", [fourbar, sixbar])
def test_the_centre_of_gravity_stands_still(make: Any) -> None:
    rng = np.random.default_rng(8)
    for _ in range(10):
        problem = problem_of(stated(rng, make, counterweights={"radius": float(rng.uniform(30.0, 200.0))}))
        result = solve(problem)
        assert result.designs
        assert result.search.complete
        for design in result.designs:
            assert design.verification.passed
            moments, mass = centre_of_gravity(problem, design)
            assert np.abs(moments - moments[0]).max() < 1e-12 * mass
            assert all(w.radius == pytest.approx(problem.counterweights.radius) for w in design.counterweights)


def test_berkof_and_lowens_moments_are_found_by_themselves() -> None:
    """Norton 12.8: m2 b2 e^{jφ2} = m3 (b3 (l2/l3) e^{jφ3} − l2) and m4 b4 e^{jφ4} = −m3 b3 (l4/l3) e^{jφ3}."""
    rng = np.random.default_rng(9)
    for _ in range(10):
        statement = stated(rng)
        problem = problem_of({**statement, "counterweights": {"mass": 0.7}})
        design = solve(problem).designs[0]
        joints = {name: complex(*z) for name, z in statement["mechanism"]["skeleton"]["joints"].items()}
        given = statement["dynamics"]["bodies"]
        line = joints["B"] - joints["A"]
        part = given["coupler"]["mass"] * (complex(*given["coupler"]["cg"]) - joints["A"]) / line
        new = design.dynamics["bodies"]
        for link, pivot, pin, needed in (
            ("input", "O2", "A", part - given["coupler"]["mass"]),
            ("output", "O4", "B", -part),
        ):
            moment = new[link]["mass"] * (complex(*new[link]["cg"]) - joints[pivot])
            assert moment / (joints[pin] - joints[pivot]) == pytest.approx(needed, rel=1e-9, abs=1e-9)


def test_a_weight_on_the_coupler_of_a_slider_crank_balances_it_and_none_on_the_crank_does() -> None:
    masses = {
        "bodies": {
            "crank": {"mass": 0.5, "cg": {"distance": 20.0}, "inertia": 1e-4},
            "coupler": {"mass": 0.6, "cg": {"distance": 60.0}, "inertia": 1e-3},
        },
        "point_masses": [{"joint": "B", "mass": 0.8}],
    }
    mechanism = {
        "type": "slider_crank",
        "fixed_pivot": [0.0, 0.0],
        "links": {"crank": 50.0, "coupler": 180.0},
        "slide": {"point": [0.0, 10.0], "angle": 0.0},
    }
    base = {"kind": "balancing", "object": "linkage", "mechanism": mechanism, "dynamics": masses}
    problem = problem_of({**base, "counterweights": {"radius": 90.0}})
    design = solve(problem).designs[0]
    assert design.verification.passed
    weights = {weight.link: weight for weight in design.counterweights}
    # Σ m r of the coupler about the crank's pin, 0.6 · 60 + 0.8 · 180 = 180 kg·mm, takes 2 kg at 90 mm.
    assert weights["coupler"].mass == pytest.approx(2.0, rel=1e-6)
    assert weights["coupler"].radius == pytest.approx(90.0, rel=1e-6)
    alone = solve(problem_of({**base, "counterweights": {"links": ["crank"]}}))
    assert alone.designs == []
    assert alone.search.complete
    assert "weights on other links do" in alone.summary


def trammel() -> dict[str, Any]:
    """A bar whose ends slide on two lines of the ground: it has no pin with it."""
    return {
        "type": "skeleton",
        "skeleton": {
            "joints": {"O": [0.0, 0.0], "A": [60.0, 0.0], "B": [0.0, 80.0]},
            "links": [{"name": "ground", "joints": ["O"]}, {"name": "bar", "joints": ["A", "B"]}],
            "slides": [
                {"joint": "A", "link": "ground", "point": [0.0, 0.0], "angle": 0.0},
                {"joint": "B", "link": "ground", "point": [0.0, 0.0], "angle": 90.0},
            ],
            "input_link": "A",
        },
    }


def test_a_link_without_a_path_of_pins_is_named() -> None:
    masses = {"bodies": {"bar": {"mass": 2.0, "cg": [30.0, 40.0], "inertia": 0.01}}}
    base = {"kind": "balancing", "object": "linkage", "mechanism": trammel(), "dynamics": masses}
    problem = problem_of({**base, "motion": {"from": 20.0, "to": 80.0, "speed": 100.0}})
    assert list_unpinned_links(build_balancing_task(problem).machine.mechanism) == ["bar"]
    result = solve(problem)
    assert result.designs == []
    assert result.search.complete
    assert "None exists" in result.summary
    assert "bar" in result.summary


def test_the_theorem_and_the_rank_agree() -> None:
    """Links that reach the ground by pins can be balanced: Tepper and Lowen's condition against the linear system's."""
    rng = np.random.default_rng(10)
    for make in (fourbar, sixbar):
        for _ in range(5):
            task = build_balancing_task(problem_of(stated(rng, make)))
            assert list_unpinned_links(task.machine.mechanism) == []
            assert is_balanceable(task)


def test_a_weight_that_is_moved_fails_the_proof() -> None:
    problem = problem_of(stated(np.random.default_rng(12)))
    task = build_balancing_task(problem)
    weights = find_force_balances(task, problem.counterweights)[0]
    assert verify_linkage(problem, task, task.machine.mechanism, weights, {}).verification.passed
    wrong = [weights[0]._replace(at=weights[0].at + 1e-6), *weights[1:]]
    assert not verify_linkage(problem, task, task.machine.mechanism, wrong, {}).verification.passed


@pytest.mark.parametrize("inertia", [0.0, 0.002, 0.02])
def test_couplers_of_any_inertia_are_two_masses_with_what_is_added(inertia: float) -> None:
    """Too little inertia gets more, too much a mass in the middle between the pins."""
    statement = {**list_examples("balancing")[3], "counterweights": {"density": 7800.0, "thickness": 30.0}}
    coupler = {"mass": 1.0, "cg": {"distance": 120.0}, "inertia": inertia}
    bodies = {**statement["dynamics"]["bodies"], "coupler": coupler}
    problem = problem_of({**statement, "dynamics": {"bodies": bodies, "point_masses": [{"joint": "B", "mass": 0.2}]}})
    design = solve(problem).designs[0]
    assert design.verification.passed
    assert design.metrics.shaking_moment < 1e-9 * design.metrics.unbalanced_shaking_moment
    # Against the definition: twice the angular momentum of all that turns, over the motion, is constant 0.
    machine = build_answer_machine(problem, design.mechanism, design.dynamics)
    now = place_machine(machine, np.linspace(0.0, 6.0, 40))
    momentum = sum(
        float(part.mass) * (np.conj(now.point(link, part.cg)[0]) * now.point(link, part.cg)[1]).imag
        + float(part.inertia) * now.spins[link][1]
        for link, part in machine.bodies.items()
    )
    momentum = momentum + 0.2 * (np.conj(now.joints["B"][0]) * now.joints["B"][1]).imag
    parts = sum(float(part.inertia) * np.abs(now.spins[link][1]) for link, part in machine.bodies.items())
    assert np.abs(momentum).max() < 1e-12 * parts.max()


@pytest.mark.parametrize(
    ("coupler", "why"),
    [
        ({"mass": 1.0, "cg": {"distance": 120.0, "angle": 5.0}, "inertia": 0.01}, "off the line"),
        ({"mass": 1.0, "cg": {"distance": 120.0}, "inertia": 0.08}, "thicker"),
    ],
)
def test_what_gears_cannot_balance_is_said(coupler: dict[str, Any], why: str) -> None:
    statement = {**list_examples("balancing")[3], "counterweights": {"density": 7800.0, "thickness": 1.0}}
    bodies = {**statement["dynamics"]["bodies"], "coupler": coupler}
    result = solve(problem_of({**statement, "dynamics": {"bodies": bodies}}))
    assert result.designs == []
    assert not result.search.complete
    assert why in result.summary


def test_a_turned_mirrored_linkage_gets_the_same_weights() -> None:
    statement = stated(np.random.default_rng(14), counterweights={"radius": 80.0})
    first = solve(problem_of(statement)).designs[0]
    turn = complex(math.cos(0.7), math.sin(0.7))

    def moved(z: list[float]) -> list[float]:
        w = complex(*z).conjugate() * turn + (300.0 - 200.0j)
        return [w.real, w.imag]

    skeleton = statement["mechanism"]["skeleton"]
    joints = {name: moved(z) for name, z in skeleton["joints"].items()}
    bodies = {link: {**body, "cg": moved(body["cg"])} for link, body in statement["dynamics"]["bodies"].items()}
    motion = {
        "from": math.degrees(0.7) - statement["motion"]["from"],
        "to": math.degrees(0.7) - statement["motion"]["to"],
        "speed_rpm": 300.0,
    }
    mechanism = {"type": "skeleton", "skeleton": {**skeleton, "joints": joints}}
    mirrored = {**statement, "mechanism": mechanism, "dynamics": {"bodies": bodies}, "motion": motion}
    second = solve(problem_of(mirrored)).designs[0]
    for one, other in zip(first.counterweights, second.counterweights, strict=True):
        assert one.mass == pytest.approx(other.mass, rel=1e-9)
        assert one.angle == pytest.approx(-other.angle, rel=1e-9)


def test_what_is_balanced_already_is_said_to_be() -> None:
    problem = problem_of(stated(np.random.default_rng(2), fourbar, counterweights={"radius": 80.0}))
    design = solve(problem).designs[0]
    again = problem.model_dump(mode="json", exclude_unset=True)
    again |= {"mechanism": design.mechanism.model_dump(mode="json"), "dynamics": design.dynamics}
    result = solve(problem_of(again))
    assert result.summary == "The linkage is already balanced."
    assert result.search.complete
    assert result.designs[0].counterweights == []
    assert result.designs[0].metrics.value < 1e-12


@pytest.mark.parametrize("radius", [10.0, 60.0, 200.0])
def test_a_weight_that_is_allowed_and_of_no_use_is_left_out(radius: float) -> None:
    weights = {"links": ["coupler", "input", "output"], "radius": radius}
    result = solve(problem_of({**list_examples("balancing")[2], "counterweights": weights}))
    (design,) = result.designs
    assert [weight.link for weight in design.counterweights] == ["input", "output"]
    assert design.metrics.value < 1e-12
