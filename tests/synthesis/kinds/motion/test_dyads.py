"""Dyads against the closed forms of the book, and against planted answers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.kinds.motion.dyads.candidates import build_conditions, find_side_dyads
from synthesis.kinds.motion.dyads.equations import DyadConditions, Dyads, solve_dyads
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.pivot_regions import list_side_areas
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.registry import parse_problem
from tests.cases import Case, cases
from tests.support.synthesis.motion_literature import vector
from tests.support.synthesis.planted import inverted_images, plant

ANY_START = Dyads(np.array([0.3 + 0.4j]), np.array([-0.2 + 0.7j]))


def task_of(points: list[complex], angles: list[float]) -> MotionTask:
    return MotionTask(np.array(points), np.exp(1j * np.radians(angles)), 0j, 1.0)


def only(task: MotionTask, **conditions: object) -> tuple[complex, complex]:
    dyads, found = solve_dyads(task, DyadConditions(**conditions), ANY_START)
    assert found.tolist() == [True]
    return complex(dyads.fixed[0]), complex(dyads.moving[0])


def random_task(rng: np.random.Generator, n: int) -> MotionTask:
    points = rng.normal(size=n) + 1j * rng.normal(size=n)
    angles = rng.uniform(-90.0, 90.0, n)
    return task_of([0j, *(points[1:] - points[0])], [0.0, *angles[1:]])


@pytest.mark.parametrize("case", [p for p in cases("motion_3pos_constants") if "constants" in p.id])
def test_constants_of_the_determinant_form(case: Case) -> None:
    """Norton 5.25 and 5.30: W and Z from the printed constants A..N equal the dyad from the same rotations.

    The constants carry four decimals; the system's condition makes 5e-3 of that.
    """
    assert case.inputs is not None
    x = {name: expected.value for name, expected in case.expected.items()}
    matrix = [
        [x["A"], -x["B"], x["C"], -x["D"]],
        [x["F"], -x["G"], x["H"], -x["K"]],
        [x["B"], x["A"], x["D"], x["C"]],
        [x["G"], x["F"], x["K"], x["H"]],
    ]
    w1x, w1y, z1x, z1y = np.linalg.solve(matrix, [x["E"], x["L"], x["M"], x["N"]])
    task = task_of(
        [0j, vector(case.inputs["P21"]), vector(case.inputs["P31"])],
        [0.0, case.inputs["alpha2"], case.inputs["alpha3"]],
    )
    rotations = tuple(np.asarray(math.radians(case.inputs[name])) for name in ("beta2", "beta3"))
    fixed, moving = only(task, rotations=rotations)
    assert moving - fixed == pytest.approx(complex(w1x, w1y), abs=5e-3)
    assert -moving == pytest.approx(complex(z1x, z1y), abs=5e-3)


@pytest.mark.parametrize("case", cases("fixed_pivot_constants"))
def test_constants_of_the_fixed_pivot_form(case: Case) -> None:
    """Norton 5.34: the printed K1, K2, K3 give β3 by half angles; the dyad of the fixed pivot turns as printed."""
    assert case.inputs is not None
    x = {name: expected.value for name, expected in case.expected.items()}
    task = task_of(
        [0j, vector(case.inputs["P21"]), vector(case.inputs["P31"])],
        [0.0, case.inputs["alpha2"], case.inputs["alpha3"]],
    )
    fixed, moving = only(task, rotations=(None, None), fixed_pivot=np.asarray(vector(case.inputs["O"])))
    links = task.images(np.asarray(moving)) - fixed
    turned = np.degrees(np.angle(links / links[0]))
    assert case.expected["angle2"].agrees(turned[1])
    assert case.expected["angle3"].agrees(turned[2])
    root = math.sqrt(x["K1"] ** 2 + x["K2"] ** 2 - x["K3"] ** 2)
    halves = [2.0 * math.degrees(math.atan2(x["K2"] + sign * root, x["K1"] + x["K3"])) for sign in (1.0, -1.0)]
    gaps = [abs(math.remainder(half - turned[2], 360.0)) for half in halves]
    other = halves[int(np.argmax(gaps))]
    assert min(gaps) < 1.0
    assert abs(math.remainder(other - case.inputs["alpha3"], 360.0)) < 1.0  # the trivial root β = α


def test_two_positions_against_the_book() -> None:
    """W = (δ − Z(e^{iα} − 1)) / (e^{iβ} − 1) (Norton 5.8), over random data."""
    rng = np.random.default_rng(1)
    for _ in range(50):
        task = random_task(rng, 2)
        z, beta = complex(*rng.normal(size=2)), rng.uniform(0.2, 3.0)
        w = (task.points[1] - z * (task.turns[1] - 1.0)) / (np.exp(1j * beta) - 1.0)
        fixed, moving = only(task, rotations=(np.asarray(beta),), moving_pivot=np.asarray(-z))
        assert moving == pytest.approx(-z, abs=1e-12)
        assert moving - fixed == pytest.approx(complex(w), rel=1e-11)


def test_three_positions_against_circumcentres() -> None:
    """A given moving pivot has the centre of the circle through its images for its fixed pivot, and the reverse."""
    rng = np.random.default_rng(2)
    for _ in range(50):
        task = random_task(rng, 3)
        given = complex(*rng.normal(size=2))
        fixed, _ = only(task, rotations=(None, None), moving_pivot=np.asarray(given))
        assert np.ptp(np.abs(task.images(np.asarray(given)) - fixed)) < 1e-10 * (1.0 + abs(fixed)) ** 2
        _, moving = only(task, rotations=(None, None), fixed_pivot=np.asarray(given))
        assert np.ptp(np.abs(inverted_images(task, np.asarray(given)) - moving)) < 1e-10 * (1.0 + abs(moving)) ** 2


def test_three_rotations_against_cramers_rule() -> None:
    """W(e^{iβk} − 1) + Z(e^{iαk} − 1) = δk for k = 2, 3 (Norton 5.35) as a complex 2 × 2 system."""
    rng = np.random.default_rng(3)
    for _ in range(50):
        task = random_task(rng, 3)
        beta = rng.uniform(-3.0, 3.0, 2)
        matrix = np.stack([np.exp(1j * beta) - 1.0, task.turns[1:] - 1.0], axis=1)
        w, z = np.linalg.solve(matrix, task.points[1:])
        if max(abs(w), abs(z)) > 1e3:
            continue
        fixed, moving = only(task, rotations=(np.asarray(beta[0]), np.asarray(beta[1])))
        assert moving - fixed == pytest.approx(complex(w), rel=1e-9)
        assert -moving == pytest.approx(complex(z), rel=1e-9)


THREE = [
    ("b2", "b3"),
    ("moving",),
    ("fixed",),
    ("z", "phi"),
    ("theta", "phi"),
    ("theta", "z"),
    ("b2", "theta"),
    ("b2", "z"),
    ("b3", "phi"),
]
TWO = [
    ("theta", "phi", "b2"),
    ("z", "phi", "b2"),
    ("moving", "b2"),
    ("fixed", "b2"),
    ("moving", "theta"),
    ("fixed", "theta"),
    ("fixed", "phi"),
    ("fixed", "z"),
    ("theta", "z", "b2"),
    ("theta", "z", "phi"),
]


@pytest.mark.parametrize("names", [*TWO, *THREE], ids="-".join)
def test_every_way_of_stating_a_dyad_finds_the_planted_one(names: tuple[str, ...]) -> None:
    rng = np.random.default_rng(4)
    n = 2 if names in TWO else 3
    for trial in range(25):
        scale = 10.0 ** rng.uniform(-5.0, 5.0)
        offset = scale * complex(*rng.uniform(-100.0, 100.0, 2))
        planted = plant(rng, n, scale, offset)
        side = planted.input_side if trial % 2 else planted.output_side
        choices = DyadChoices.model_validate(side.choices(*names))
        problem = parse_problem({"kind": "motion", "positions": planted.positions, "input_side": side.choices(*names)})
        task = make_motion_task(problem)
        cloud = find_side_dyads(task, problem, 0, list_side_areas(problem)[0], np.random.default_rng(trial), 1)
        gaps = np.abs(cloud.dyads.fixed - task.to_task(side.fixed_pivot))
        gaps += np.abs(cloud.dyads.moving - task.to_task(side.moving_pivot))
        assert gaps.min(initial=math.inf) < 1e-7, (trial, names)
        assert cloud.complete
        if build_conditions(task, problem, choices).is_linear:
            assert len(gaps) == 1


def test_directions_are_met_forwards_only() -> None:
    """A link angle turned by 180° asks for a link of negative length, which does not exist."""
    rng = np.random.default_rng(5)
    planted = plant(rng, 2)
    stated = planted.input_side.choices("moving", "theta")
    stated["link_angle"] += 180.0
    problem = parse_problem({"kind": "motion", "positions": planted.positions, "input_side": stated})
    cloud = find_side_dyads(make_motion_task(problem), problem, 0, list_side_areas(problem)[0], rng, 1)
    assert len(cloud.dyads.fixed) == 0


def test_jacobian_against_differences() -> None:
    """Newton's rows are differentiated right: a step of 1e-6 changes each residual as the Jacobian says."""
    from synthesis.kinds.motion.dyads.equations import _evaluate_rows

    rng = np.random.default_rng(6)
    task = random_task(rng, 3)
    sets = [
        {"rotations": (None, None), "link_angle": 0.3, "coupler_length": 0.7},
        {"rotations": (0.4, None), "coupler_angle": -1.0},
        {"rotations": (None, 0.2), "coupler_length": 0.7},
        {"rotations": (None, None), "fixed_pivot": 0.3 + 0.1j},
        {"rotations": (None, None), "moving_pivot": 0.3 + 0.1j},
        {"rotations": (0.4, -0.3)},
    ]
    for conditions in sets:
        wrapped = {k: v if k == "rotations" else np.asarray(v) for k, v in conditions.items()}
        wrapped["rotations"] = tuple(None if b is None else np.asarray(b) for b in conditions["rotations"])
        stated = DyadConditions(**wrapped)
        x = rng.normal(size=4)

        def rows(x: np.ndarray, stated: DyadConditions = stated) -> tuple[np.ndarray, np.ndarray]:
            values, jacobian = _evaluate_rows(task, stated, np.array([x[0] + 1j * x[1]]), np.array([x[2] + 1j * x[3]]))
            return values[0], jacobian[0]

        _, jacobian = rows(x)
        for column in range(4):
            h = np.zeros(4)
            h[column] = 1e-6
            difference = (rows(x + h)[0] - rows(x - h)[0]) / 2e-6
            assert jacobian[:, column] == pytest.approx(difference, abs=1e-8)
