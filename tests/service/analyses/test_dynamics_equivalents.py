"""Masses, springs and dampers as other links feel them, and flywheels of a disc: Norton, ch. 10 to 15, through HTTP.

What is measured is the drive: of a mass by an acceleration of 1 from rest, of a spring by a displacement, of a damper
by a speed. All in consistent units.
"""

from __future__ import annotations

import math
from typing import Any

import httpx
import pytest

from tests.cases import Case, cases
from tests.support.service.dynamics_literature import analysed

Statement = dict[str, Any]

SLIDER = {
    "joints": {"O2": [0.0, -1.0], "A": [0.0, 0.0], "B": [1.0, 0.0]},
    "links": [{"name": "ground", "joints": ["O2"]}, {"name": "bar", "joints": ["A", "B"]}],
    "slides": [
        {"joint": "A", "link": "ground", "point": [0.0, 0.0], "angle": 0.0},
        {"joint": "B", "link": "ground", "point": [0.0, 0.0], "angle": 0.0},
    ],
    "input_link": "A",
}
"""A bar that only moves along x."""

LEVER = {
    "joints": {"O2": [0.0, 0.0], "A": [50.0, 0.0], "B": [150.0, 0.0]},
    "links": [{"name": "ground", "joints": ["O2"]}, {"name": "input", "joints": ["O2", "A", "B"]}],
    "input_link": "input",
}


def driven(client: httpx.Client, skeleton: Statement, block: Statement, **motion: float) -> float:
    """The drive at one position."""
    body = {
        "mechanism": {"type": "skeleton", "skeleton": skeleton},
        "motion": {"at": 0.0, "speed": 0.0, "acceleration": 0.0} | motion,
        "dynamics": {"units": "consistent"} | block,
    }
    return float(analysed(client, body)["dynamics"]["drive"][0])


def geared(ratio: float) -> Statement:
    """An input and a link of length 1 that turns ``ratio`` times as far."""
    return {
        "joints": {"O2": [0.0, 0.0], "A": [1.0, 0.0], "O4": [5.0, 0.0], "B": [6.0, 0.0]},
        "links": [
            {"name": "ground", "joints": ["O2", "O4"]},
            {"name": "input", "joints": ["O2", "A"]},
            {"name": "output", "joints": ["O4", "B"]},
        ],
        "gears": [{"links": ["input", "output"], "ratio": ratio}],
        "input_link": "input",
    }


def between(place: float, **spring: float) -> Statement:
    """A spring, a damper or both from the ground to the bar, as long as it is free at rest."""
    ends = [{"link": "ground", "point": [place - 20.0, 0.0]}, {"link": "bar", "point": [place, 0.0]}]
    return {"ends": ends, "free_length": 20.0, **spring}


@pytest.mark.parametrize("case", cases("series_parallel", "dynamics"))
def test_springs_and_dampers_in_series_and_side_by_side(client: httpx.Client, case: Case) -> None:
    """Side by side they act on one bar. In a row each carries the same force, each moves as it will."""
    given: dict[str, Any] = case.inputs or {}
    name, moved = {"springs": ("rate", "at"), "dampers": ("damping", "speed")}[given["elements"]]
    one, other = (between(n, **{name: value}) for n, value in enumerate(given["values"]))
    step = 0.5
    parallel = driven(client, SLIDER, {"springs": [one, other]}, **{moved: step}) / step
    softness = [step / driven(client, SLIDER, {"springs": [each]}, **{moved: step}) for each in (one, other)]
    force = 3.0
    in_row = [
        driven(client, SLIDER, {"springs": [each]}, **{moved: force * soft})
        for each, soft in zip((one, other), softness, strict=True)
    ]
    assert in_row == pytest.approx([force, force], rel=1e-12)
    case.check(parallel=parallel, series=force / (force * sum(softness)))


@pytest.mark.parametrize("case", cases("reflected_mass", "dynamics"))
def test_mass_as_the_input_feels_it(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    block = {"point_masses": [{"joint": "B", "mass": given["weight"] / given["g"]}]}
    case.check(m_eff=driven(client, geared(given["overall_speed_ratio"]), block, acceleration=1.0))


@pytest.mark.parametrize("case", cases("reflected_spring", "dynamics"))
def test_spring_as_the_input_feels_it(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    block = {"springs": [{"torsion": given["rate"], "links": ["ground", "output"]}]}
    case.check(k_eff=driven(client, geared(given["lever_ratio"]), block, at=20.0) / math.radians(20.0))


@pytest.mark.parametrize("case", cases("lever_equivalents", "dynamics"))
def test_mass_and_spring_on_a_lever(client: httpx.Client, case: Case) -> None:
    """A spring without free length from where A stood has the torque k a² sin θ."""
    given: dict[str, Any] = case.inputs or {}
    assert (given["a"], given["b"]) == (50, 150)
    mass = driven(client, LEVER, {"point_masses": [{"joint": "B", "mass": given["m_at_B"]}]}, acceleration=1.0)
    ends = [{"link": "ground", "point": [50.0, 0.0]}, {"link": "input", "point": [50.0, 0.0]}]
    spring = driven(client, LEVER, {"springs": [{"ends": ends, "rate": given["k_at_A"]}]}, at=30.0)
    case.check(m_eff_at_A=mass / 50.0**2, k_eff_at_B=spring / math.sin(math.radians(30.0)) / 150.0**2)


@pytest.mark.parametrize("case", [c for c in cases("one_dof", "dynamics") if "m" in c.values[0].inputs])
def test_natural_frequencies_from_the_drive(client: httpx.Client, case: Case) -> None:
    """With one mass, spring and damper the drive is m a + c v + k x: each of them by itself."""
    given: dict[str, Any] = case.inputs or {}
    block = {
        "bodies": {"bar": {"mass": given["m"], "cg": [0.5, 0.0]}},
        "springs": [between(0.0, rate=given["k"], damping=given["c"])],
    }
    m, c, k = (driven(client, SLIDER, block, **{name: 1.0}) for name in ("acceleration", "speed", "at"))
    natural = math.sqrt(k / m)
    ratio = c / (2.0 * m * natural)
    case.check(wn=natural, wd=natural * math.sqrt(1.0 - ratio**2), cc=2.0 * m * natural)


@pytest.mark.parametrize("case", [c for c in cases("one_dof", "dynamics") if "wn" in c.values[0].inputs])
def test_period_of_a_natural_frequency(client: httpx.Client, case: Case) -> None:
    """A mass of 1 on the spring of that frequency needs no drive on its own swing, a whole one in the period."""
    given: dict[str, Any] = case.inputs or {}
    natural = given["wn"]
    block = {"bodies": {"bar": {"mass": 1.0, "cg": [0.5, 0.0]}}, "springs": [between(0.0, rate=natural**2)]}
    place, acceleration = 0.5, -(natural**2) * 0.5
    assert driven(client, SLIDER, block, at=place, acceleration=acceleration) == pytest.approx(0.0, abs=1e-9)
    rate = math.sqrt(-acceleration / place)
    case.check(T_n=2.0 * math.pi / rate)


@pytest.mark.parametrize("case", cases("flywheel_disk", "dynamics"))
def test_disc_of_a_given_moment_of_inertia(client: httpx.Client, case: Case) -> None:
    """Of radius q times its thickness: its inertia turns out as wanted, and its weight is its mass."""
    given: dict[str, Any] = case.inputs or {}
    masses = {}
    for share in given["ratio_r_over_t"]:
        radius = (2.0 * share * given["I"] / (math.pi * given["density"])) ** 0.2
        disc = {"form": "cylinder", "axis": "normal", "at": [0.0, 0.0], "diameter": 2.0 * radius}
        disc |= {"length": radius / share, "density": given["density"]}
        shape = {"bodies": {"input": {"shape": {"density": 1.0, "parts": [disc]}}}}
        alone = {name: LEVER[name] for name in ("joints", "links", "input_link")}
        assert driven(client, alone, shape, acceleration=1.0) == pytest.approx(given["I"], rel=1e-12)
        body = {
            "mechanism": {"type": "skeleton", "skeleton": alone},
            "motion": {"at": 0.0, "speed": 0.0},
            "dynamics": {"units": "consistent", "gravity": {"magnitude": 1.0}, **shape},
        }
        masses[f"mass_{share}"] = analysed(client, body)["dynamics"]["joints"]["O2"]["input"]["y"][0]
    case.check(**masses)
