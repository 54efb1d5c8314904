"""Simulations of designs run by MuJoCo and read by other programs, against the analysis and its forces."""

from __future__ import annotations

import re
import subprocess
import sys
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kinematics.dynamics import Body, Machine, Places, compute_reactions, make_body
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, GearPair, Mechanism, Slide
from service.simulation.export import write_simulation
from service.simulation.linkage import build_linkage
from service.simulation.mjcf import count_steps, write_mjcf
from service.simulation.model import Multibody
from service.simulation.modelica import write_modelica
from service.simulation.query import SimulationQuery
from service.simulation.urdf import write_urdf
from service.simulation.weights import Weights
from synthesis.dispatch import solve
from synthesis.registry import get_first_example, parse_problem
from tests.campaign import sampled
from tests.support.service.parts import MOTION, SLIDER

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(600)]

ANGLE = 1e-4
"""By which a joint may miss the analysis, radians."""

FORCE = 0.01
"""By which a force may, as a share of its peak."""

SAMPLES = 360

JOINTS = {"O2": 0j, "A": 0.0878 + 0.0479j, "O4": 0.3 + 0j, "B": 0.2865 + 0.1996j}
LINKS = {GROUND: ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B"), "output": ("O4", "B")}
CRANK = {"O2": 0j, "A": 0.05 + 0.03j}
ROD_END = 0.05 + float(np.sqrt(0.2**2 - 0.02**2)) + 0.01j

MECHANISMS = {
    "fourbar": Mechanism(JOINTS, LINKS, "input"),
    "sixbar": Mechanism(
        {**JOINTS, "C": 0.38 + 0.15j, "O6": 0.72 - 0.02j, "D": 0.70 + 0.25j},
        {
            GROUND: ("O2", "O4", "O6"),
            "input": ("O2", "A"),
            "coupler": ("A", "B"),
            "rocker": ("O4", "B", "C"),
            "link 5": ("C", "D"),
            "output": ("O6", "D"),
        },
        "input",
    ),
    "slider-crank": Mechanism(
        {**CRANK, "B": ROD_END},
        {GROUND: ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B")},
        "crank",
        (Slide("B", GROUND, np.asarray(0.01j), np.asarray(0.0)),),
    ),
    "inverted slider-crank": Mechanism(
        {**CRANK, "O4": 0.2 + 0j, "B": 0.2 + 0.1j},
        {GROUND: ("O2", "O4"), "crank": ("O2", "A"), "rocker": ("O4", "B")},
        "crank",
        (Slide("A", "rocker", np.asarray(0.2 + 0j), np.angle(0.05 + 0.03j - 0.2)),),
    ),
    "geared fivebar": Mechanism(
        {**CRANK, "C": 0.2 + 0.3j, "B": 0.33 + 0.03j, "O5": 0.3 + 0j},
        {
            GROUND: ("O2", "O5"),
            "input": ("O2", "A"),
            "coupler 1": ("A", "C"),
            "coupler 2": ("B", "C"),
            "output": ("O5", "B"),
        },
        "input",
        gears=(GearPair("input", "output", -2.0),),
    ),
}


def moved(mechanism: Mechanism, size: float) -> Mechanism:
    """The same, larger."""
    return Mechanism(
        {joint: size * place for joint, place in mechanism.joints.items()},
        mechanism.links,
        mechanism.input,
        tuple(slide._replace(point=size * slide.point) for slide in mechanism.slides),
        mechanism.gears,
    )


def weighed(mechanism: Mechanism, size: float = 1.0) -> dict[str, Body]:
    """Masses of all links, off their lines."""
    bodies = {}
    for n, link in enumerate(link for link in mechanism.links if link != GROUND):
        first, second = (complex(mechanism.joints[joint]) for joint in mechanism.links[link][:2])
        bodies[link] = make_body(0.4 + 0.2 * n, first + (0.4 + 0.1j) * (second - first), (0.001 + 0.002 * n) * size**2)
    return bodies


def made(
    mechanism: Mechanism, speed: float, turn: float, gravity: complex, size: float = 1.0
) -> tuple[Multibody, Machine]:
    """The machine that is simulated, and that of the analysis; with a mass on the slide's block, where there is one."""
    pins = {slide.joint: 0.3 for slide in mechanism.slides[:1]}
    bodies = weighed(mechanism, size)
    inputs = float(mechanism.reference_input) + np.linspace(0.0, turn, SAMPLES + 1)
    weights = Weights(bodies, pins, (0.0, 0.0), gravity, 0.02 * size, ())
    machine = Machine(mechanism, bodies, {joint: np.asarray(mass) for joint, mass in pins.items()}, gravity)
    return build_linkage(mechanism, inputs, speed, weights, 1.0, "machine"), machine


class Run:
    """What MuJoCo makes of a model: places of all joints on all links, and forces of constraints, at the samples."""

    def __init__(self, model: str, steps: int, mechanism: Mechanism, start: dict[str, complex]) -> None:
        import mujoco

        built = mujoco.MjModel.from_xml_string(model)
        data = mujoco.MjData(built)
        mujoco.mj_resetDataKeyframe(built, data, 0)
        mujoco.mj_forward(built, data)
        names = {link: re.sub(r"[^A-Za-z0-9]+", "_", f"link_{link}") for link in mechanism.links if link != GROUND}
        at = {link: data.body(name).xpos.copy() for link, name in names.items()}
        self.places: dict[tuple[str, str], list[complex]] = {}
        self.drive: list[float] = []
        self.pins: dict[str, list[float]] = {}
        for sample in range(SAMPLES + 1):
            mujoco.mj_forward(built, data)
            for link, name in names.items():
                placed = data.body(name)
                for joint in mechanism.links[link]:
                    arm = np.array([start[joint].real, start[joint].imag, 0.0]) - at[link]
                    x, y, z = placed.xpos + placed.xmat.reshape(3, 3) @ arm
                    assert z == 0.0
                    self.places.setdefault((link, joint), []).append(complex(x, y))
            for number in range(built.neq):
                rows = [
                    data.efc_force[row]
                    for row in range(data.nefc)
                    if data.efc_type[row] == mujoco.mjtConstraint.mjCNSTR_EQUALITY and data.efc_id[row] == number
                ]
                name = built.equality(number).name
                if name == "drive":
                    self.drive.append(float(rows[0]))
                elif len(rows) == 3:
                    self.pins.setdefault(name, []).append(float(np.hypot(rows[0], rows[1])))
            if sample < SAMPLES:
                mujoco.mj_step(built, data, steps)


def compared(
    mechanism: Mechanism, speed: float, turn: float, gravity: complex, size: float = 1.0
) -> tuple[float, float]:
    """The greatest turn by which a link misses the analysis, and the greatest share by which a force does."""
    simulated, machine = made(mechanism, speed, turn, gravity, size)
    inputs = float(mechanism.reference_input) + np.linspace(0.0, turn, SAMPLES + 1)
    driven = drive(mechanism, inputs, speed=speed, order=2)
    start = {joint: complex(jet[0, 0]) for joint, jet in driven.joints.items()}
    run = Run(write_mjcf(simulated), count_steps(simulated), mechanism, start)
    apart = 0.0
    for link, listed in mechanism.links.items():
        if link == GROUND:
            continue
        for one, other in combinations(listed, 2):
            found = np.array(run.places[link, other]) - np.array(run.places[link, one])
            expected = driven.joints[other][0] - driven.joints[one][0]
            apart = max(apart, float(np.abs(np.angle(found / expected)).max()))
        for joint in listed:
            missed = np.abs(np.array(run.places[link, joint]) - driven.joints[joint][0]).max()
            assert missed < ANGLE * float(mechanism.frame[1])
    forces = compute_reactions(machine, Places(mechanism, driven))
    shares = [np.abs(np.array(run.drive) - forces.drive).max() / np.abs(forces.drive).max()]
    for closure in simulated.closures:
        joint = closure.name.split("_")[1]
        labels = (simulated.by_name[closure.first].label, simulated.by_name[closure.second].label)
        *_, link = (label for label in labels if label in forces.joints[joint])
        known = np.abs(forces.joints[joint][link])
        shares.append(np.abs(np.array(run.pins[closure.name]) - known).max() / known.max())
    return apart, float(max(shares))


def test_linkages_move_and_bear_in_mujoco_what_the_analysis_says() -> None:
    for name, mechanism in MECHANISMS.items():
        turn, force = compared(mechanism, 4.0 * np.pi, 2.0 * np.pi, -9.81j)
        print(f"{name}: {turn:.1e} rad, forces {force:.1e} of their peaks")
        assert turn < ANGLE, name
        assert force < FORCE, name


@pytest.mark.parametrize("seed", range(sampled(200)))
def test_machines_of_any_size_speed_and_range_do(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mechanism = list(MECHANISMS.values())[seed % len(MECHANISMS)]
    size, speed = 10.0 ** rng.uniform(-2.0, 3.0), 10.0 ** rng.uniform(-2.0, 3.0)
    turn = rng.uniform(-2.0, 2.0) * np.pi
    away = 9.81 * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi))
    apart, force = compared(moved(mechanism, size), float(np.copysign(speed, turn)), turn, complex(away), size)
    assert apart < ANGLE
    assert force < FORCE


DESIGNS: dict[str, dict[str, Any]] = {
    "fourbar": MOTION,
    "slider": SLIDER,
    "sixbar": {**MOTION, "driver_dyad": True},
    "shaper": {"kind": "quick_return", "time_ratio": 1.4, "stroke": 100, "mechanism": "crank_shaper", "max_designs": 1},
    "train": {"kind": "gear_train", "ratio": "pi", "max_designs": 1, "module": 2.0},
    "planets": get_first_example("planetary_train"),
    "series": get_first_example("train_series"),
    "gearbox": get_first_example("gearbox"),
    "layshaft": get_first_example("layshaft_gearbox"),
}


def test_scripts_of_designs_run_and_find_the_motion_of_the_analysis(tmp_path: Path) -> None:
    for name, statement in DESIGNS.items():
        problem = parse_problem(statement)
        design = solve(problem).designs[0]
        path = tmp_path / f"{name}.py"
        path.write_text(write_simulation(design, problem, name, "sim.py", SimulationQuery()))
        ran = subprocess.run(
            [sys.executable, str(path), "--csv", str(tmp_path / f"{name}.csv")],
            capture_output=True,
            text=True,
            check=False,
        )
        assert ran.returncode == 0, ran.stdout + ran.stderr
        worst = max(float(found) for found in re.findall(r": ([0-9.]+e[-+][0-9]+) (?:rad|m) ", ran.stdout))
        print(f"{name}: {worst:.1e}")
        assert worst < ANGLE
        assert len((tmp_path / f"{name}.csv").read_text().splitlines()) == SAMPLES + 2


def test_a_script_says_so_where_joints_miss(tmp_path: Path) -> None:
    simulated, _ = made(MECHANISMS["fourbar"], 6.0, 6.28, 0j)
    from service.simulation.script import write_script

    text = write_script(simulated)
    path = tmp_path / "off.py"
    path.write_text(text.replace("MOTION = [\n", "MOTION = [\n    [0.001, 0, 0],\n", 1))
    ran = subprocess.run([sys.executable, str(path)], capture_output=True, text=True, check=False)
    assert ran.returncode == 1
    # It ran to its end, and did not break down.
    assert "greatest drive" in ran.stdout
    assert not ran.stderr


def test_mujoco_reads_the_urdf() -> None:
    import mujoco

    for mechanism in MECHANISMS.values():
        simulated, _ = made(mechanism, 4.0, 1.0, -9.81j)
        text = write_urdf(simulated)
        # MuJoCo merges what it takes for equal bodies, and scales inertias, unless it is told not to.
        head, tail = text.split("<robot ", 1)
        name, rest = tail.split(">", 1)
        compiler = '<mujoco><compiler fusestatic="false" balanceinertia="false"/></mujoco>'
        built = mujoco.MjModel.from_xml_string(f"{head}<robot {name}>{compiler}{rest}")
        data = mujoco.MjData(built)
        mujoco.mj_forward(built, data)
        for body_ in simulated.bodies:
            read = built.body(body_.name)
            assert read.mass[0] == pytest.approx(body_.mass, rel=1e-9)
            assert data.body(body_.name).xpos == pytest.approx(body_.place, abs=1e-12)
            assert built.joint(body_.joint).type[0] == (
                mujoco.mjtJoint.mjJNT_HINGE if body_.sort == "hinge" else mujoco.mjtJoint.mjJNT_SLIDE
            )


def test_a_parser_of_modelica_finds_every_part_connected_and_every_loop_closed() -> None:
    from pymoca import parser

    for name, mechanism in MECHANISMS.items():
        simulated, _ = made(mechanism, 4.0, 1.0, -9.81j)
        machine = parser.parse(write_modelica(simulated)).classes["Machine"]
        ends: dict[str, list[str]] = {}
        for equation in machine.equations:
            one, other = (str(side).replace("[None]", "") for side in (equation.left, equation.right))
            ends.setdefault(one, []).append(other)
            ends.setdefault(other, []).append(one)
        arms = {
            symbol: vector(machine.symbols[symbol]) for symbol in machine.symbols if has_vector(machine.symbols[symbol])
        }
        places = walked(ends, arms, machine)
        for closure in simulated.closures:
            one, other = (places[f"{closure.name}.frame_{end}"] for end in "ab")
            assert one == pytest.approx(closure.place, abs=1e-12)
            assert other == pytest.approx(closure.place, abs=1e-12)
        independent = sum(str(s.type).endswith("RevolutePlanarLoopConstraint") for s in machine.symbols.values())
        # Loops of a planar linkage: pins and slides less moving bodies, blocks among them.
        moving = len(mechanism.links) - 1 + len(mechanism.slides)
        pins = sum(
            sum(joint in listed for listed in mechanism.links.values())
            + sum(s.joint == joint for s in mechanism.slides)
            - 1
            for joint in mechanism.joints
        )
        assert independent == pins + len(mechanism.slides) - moving, name


def has_vector(symbol: Any) -> bool:
    return str(symbol.type).endswith("FixedTranslation")


def vector(symbol: Any) -> tuple[float, ...]:
    """The arm of a part."""
    stated = next(a.value for a in symbol.class_modification.arguments if a.value.component.name == "r")
    values = stated.modifications[0].values
    return tuple(number(value) for value in values)


def number(value: Any) -> float:
    if hasattr(value, "value"):
        return float(value.value)
    assert value.operator == "-" or str(value.operator) == "-"
    return -number(value.operands[0])


def walked(
    ends: dict[str, list[str]], arms: dict[str, tuple[float, ...]], machine: Any
) -> dict[str, tuple[float, ...]]:
    """Places of all frames that connections reach from the world; joints are at 0, closures are not passed."""
    places = {"world.frame_b": (0.0, 0.0, 0.0)}
    waiting = ["world.frame_b"]
    while waiting:
        frame = waiting.pop()
        here = places[frame]
        further = [(other, here) for other in ends.get(frame, [])]
        part, _, port = frame.rpartition(".")
        sort = str(machine.symbols[part].type)
        if part in arms and port == "frame_a":
            further.append((f"{part}.frame_b", tuple(a + b for a, b in zip(here, arms[part], strict=True))))
        elif sort.endswith((".Revolute", ".Prismatic")) and port == "frame_a":
            further.append((f"{part}.frame_b", here))
        for other, place in further:
            if other not in places:
                places[other] = place
                waiting.append(other)
    return places
