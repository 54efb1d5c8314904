"""Shift table of a planetary train: ratio and speeds for each choice of engaged clutches and brakes.

A brake holds a member. A clutch connects two members, or the input shaft to a member. In a train with f degrees of
freedom, every speed is determined by f − 1 engaged elements if the input shaft is fixed to a member, and by f elements
if clutches connect it to members. Each choice of that many elements is a state, unless it holds the output or its
elements contradict one another.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Annotated

from pydantic import Field

from kinematics.gear.planetary import Train, solve_speeds
from kinematics.gear.power import solve_power_flow
from kinematics.message import compose
from synthesis.model.answer import Answer
from synthesis.model.gears.ratio_target import parse_decimal
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Statement

INPUT_NAME = "input"
"""Name of the input shaft in a clutch, if the input shaft is not fixed to a member."""

MAX_STATES = 5000
"""Maximum number of choices of engaged elements."""

Name = Annotated[str, Field(min_length=1, max_length=40)]


class GivenElement(Statement):
    """A brake or a clutch; exactly one of `brake` and `clutch`."""

    name: Name
    brake: Name | None = Field(default=None, description="Member that the brake holds.")
    clutch: tuple[Name, Name] | None = Field(
        default=None, description="The two members that the clutch connects; `input` for the input shaft."
    )

    @property
    def list_bodies(self) -> tuple[str, ...]:
        """Members on which the element acts."""
        return self.clutch or (str(self.brake),)

    def find_driven_member(self, driving: str | None) -> str | None:
        """Return the member that the clutch connects to the input shaft; None if it connects none.

        ``driving`` is the member to which the input shaft is fixed, or None.
        """
        if driving is not None or self.clutch is None or INPUT_NAME not in self.clutch:
            return None
        return next((body for body in self.clutch if body != INPUT_NAME), INPUT_NAME)


class ShiftState(Answer):
    """Elements that are engaged together, and the resulting ratio and speeds."""

    engaged: list[str]
    ratio: float = Field(description="Input speed over output speed.")
    exact_ratio: str
    speeds: dict[str, float] = Field(description="Speeds of all bodies over the speed of the input.")
    efficiency: float | None = Field(
        description="Efficiency if one member receives the power; null with clutches between members (unknown torque)."
    )


def list_default_elements(train: Train, driving: str, driven: str) -> list[GivenElement]:
    """Return the default elements: a brake on every member except input and output, and a clutch between any two."""
    brakes = [GivenElement(name=f"brake {body}", brake=body) for body in train.members if body not in (driving, driven)]
    clutches = [
        GivenElement(name=f"clutch {one}-{other}", clutch=(one, other))
        for one, other in itertools.combinations(train.members, 2)
    ]
    return [*brakes, *clutches]


def find_element_errors(train: Train, driving: str | None, elements: Sequence[GivenElement]) -> list[tuple[str, str]]:
    """Return errors of the given elements, as pairs (JSON pointer, detail)."""
    faults = []
    known = [*train.members, *([INPUT_NAME] if driving is None and INPUT_NAME not in train.members else [])]
    for k, element in enumerate(elements):
        path = f"/elements/{k}"
        if (element.brake is None) == (element.clutch is None):
            faults.append((path, compose("analyses-brake-or-clutch")))
            continue
        if element.name in [other.name for other in elements[:k]]:
            faults.append((f"{path}/name", compose("analyses-element-name-repeats")))
        unknown = [body for body in element.list_bodies if body not in known]
        part = "brake" if element.clutch is None else "clutch"
        if unknown or (element.brake == INPUT_NAME and INPUT_NAME not in train.members):
            faults.append((f"{path}/{part}", compose("analyses-element-member-unknown", names=", ".join(known))))
        elif len(set(element.list_bodies)) < len(element.list_bodies):
            faults.append((f"{path}/clutch", compose("analyses-clutch-of-one-member")))
        elif (
            driving is None
            and element.clutch is not None
            and INPUT_NAME in element.clutch
            and INPUT_NAME in train.members
        ):
            detail = compose("analyses-member-named-input")
            faults.append((f"{path}/clutch", detail))
    return faults


def count_states(train: Train, driving: str | None, elements: Sequence[GivenElement]) -> int:
    """Count the choices of engaged elements."""
    return math.comb(len(elements), _count_engaged(train, driving))


def _count_engaged(train: Train, driving: str | None) -> int:
    # A member fixed to the input shaft takes one freedom.
    return max(0, solve_speeds(train, {}).freedom - (driving is not None))


def build_shift_table(
    train: Train, driving: str | None, driven: str, elements: Sequence[GivenElement], efficiency: float
) -> list[JsonObject]:
    """Build the states of a train as :class:`ShiftState`, largest ratio first, backward ones last.

    Parameters
    ----------
    train : Train
    driving : str or None
        Member that is fixed to the input shaft; None if clutches connect members to it.
    driven : str
        Output member.
    elements : sequence of GivenElement
        Clutches and brakes without errors.
    efficiency : float
        Efficiency of every mesh as an ordinary pair.
    """
    found = list(_iterate_states(train, driving, driven, elements, efficiency))
    # Ties in the ratio are ordered by name, so that the table does not depend on the order of the elements.
    return sorted(found, key=lambda state: (state["ratio"] < 0.0, -abs(state["ratio"]), state["engaged"]))


def _iterate_states(
    train: Train, driving: str | None, driven: str, elements: Sequence[GivenElement], efficiency: float
) -> Iterator[JsonObject]:
    for engaged in itertools.combinations(elements, _count_engaged(train, driving)):
        inputs = [] if driving is None else [driving]
        inputs += [body for element in engaged if (body := element.find_driven_member(driving)) is not None]
        held = [str(element.brake) for element in engaged if element.brake is not None]
        joined = [
            element.clutch for element in engaged if element.clutch and element.find_driven_member(driving) is None
        ]
        # Without a member on the input shaft nothing turns, and a member that is held cannot be driven.
        if not inputs or set(inputs) & set(held):
            continue
        known = {**dict.fromkeys(held, 0), **dict.fromkeys(inputs, 1)}
        solution = solve_speeds(train, known, joined)
        output = solution.values[driven]
        # Elements that repeat or contradict one another, or that leave the output at rest, give no state.
        if solution.open or solution.contradiction is not None or not output:
            continue
        rates = {body: rate for body, rate in solution.values.items() if rate is not None}
        flow = None
        # With clutches or two driven members, the division of the torque is unknown, and so is the efficiency.
        if not joined and len(inputs) == 1:
            loads = [*inputs, driven, *held]
            # If the output is also the input, it has no torque of its own.
            if len(set(loads)) == len(loads):
                flow = solve_power_flow(train, rates, loads, {inputs[0]: Fraction(1)}, parse_decimal(efficiency))
        yield {
            "engaged": [element.name for element in engaged],
            "ratio": float(1 / output),
            "exact_ratio": str(1 / output),
            "speeds": {body: float(rate) for body, rate in rates.items()},
            "efficiency": None if flow is None or flow.efficiency is None else float(flow.efficiency),
        }
