"""The MuJoCo model of a machine (MJCF).

The tree of bodies is written unchanged. A closure is an equality ``connect``; a relation is an equality of two joints,
or of a fixed tendon if it has more terms. MuJoCo's constraints are soft: their time constant is two steps, and a step
is a fixed share of the motion's time, so that joint angles are accurate at any speed. The drive is a *lead*: a body
whose inertia is so large that its speed stays constant, coupled to the input's joint; the force of that constraint is
the drive force. The solver's tolerance is 0, because relative to the lead's inertia every improvement looks small.
The keyframe ``start`` holds all coordinates and rates at the start of the motion.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from service.simulation.model import GROUND, Body, Multibody, Vector
from service.simulation.naming import escape_attribute, escape_comment, format_number, format_numbers

STEPS_PER_SAMPLE = 56
"""Steps between two samples of the motion, unless gravity requires more."""

MAX_STEP_RATIO = 0.05
"""Longest step as a multiple of √(size/g). A weight pulls a soft constraint open by its fall within the time constant,
which is long in slow motions.
"""

MAX_STEPS_PER_SAMPLE = 5600
"""Maximum number of steps between two samples."""

TIME_CONSTANT_STEPS = 2.0
"""Time constant of the constraints in steps, the smallest that MuJoCo permits."""

IMPEDANCE = "0.9999 0.9999 0.001 0.5 2"

LEAD_BODY = "lead"
"""Name of the body that leads the drive."""

COLOURS = ("0.30 0.47 0.66 1", "0.95 0.56 0.17 1", "0.35 0.63 0.31 1", "0.88 0.34 0.35 1", "0.46 0.72 0.70 1")


def write_mjcf(machine: Multibody) -> str:
    """Write the model as text."""
    return "\n".join(_write_lines(machine)) + "\n"


def count_steps(machine: Multibody) -> int:
    """Return the number of integration steps from one sample of the motion to the next."""
    # Gravity is the only load that may require a shorter step.
    pull, step = math.hypot(*machine.gravity), float(machine.times[1]) / STEPS_PER_SAMPLE
    longest = MAX_STEP_RATIO * math.sqrt(machine.size / pull) if pull > 0.0 else math.inf
    return min(math.ceil(STEPS_PER_SAMPLE * max(1.0, step / longest)), MAX_STEPS_PER_SAMPLE)


def _write_lines(machine: Multibody) -> Iterator[str]:
    step = float(machine.times[1]) / count_steps(machine)
    yield '<?xml version="1.0" encoding="utf-8"?>'
    yield f"<!-- {escape_comment(machine.title)} -->"
    for remark in machine.remarks:
        yield f"<!-- {escape_comment(remark)} -->"
    yield f'<mujoco model="{escape_attribute(machine.title)}">'
    yield '  <compiler angle="radian" autolimits="true" inertiafromgeom="false" boundmass="0" boundinertia="0"/>'
    yield (
        f'  <option timestep="{format_number(step)}" gravity="{format_numbers(*machine.gravity)}" integrator="Euler" '
        'solver="Newton" iterations="100" tolerance="0" cone="pyramidal" jacobian="dense">'
    )
    yield '    <flag contact="disable" eulerdamp="disable"/>'
    yield "  </option>"
    stat = format_numbers(*_find_middle(machine))
    yield f'  <statistic extent="{format_number(max(machine.size, 1e-6))}" center="{stat}"/>'
    yield "  <default>"
    yield '    <geom contype="0" conaffinity="0" group="1"/>'
    yield f'    <equality solref="{format_number(TIME_CONSTANT_STEPS * step)} 1" solimp="{IMPEDANCE}"/>'
    yield "  </default>"
    yield "  <worldbody>"
    yield '    <light pos="0 0 10" dir="0 0 -1" directional="true"/>'
    children: dict[str, list[Body]] = {}
    for body in machine.bodies:
        children.setdefault(body.parent, []).append(body)
    for body in children.get(GROUND, []):
        yield from _write_body(machine, children, body, (0.0, 0.0, 0.0), "    ")
    driven = machine.by_name[machine.driven]
    lead = machine.lead
    yield f'    <body name="{LEAD_BODY}">'
    # Only the inertia of a hinge or the mass of a slide has an effect; the other one is arbitrary.
    yield f'      <inertial pos="0 0 0" mass="{format_number(lead)}" diaginertia="{format_numbers(lead, lead, lead)}"/>'
    yield f'      <joint name="{LEAD_BODY}" type="{driven.sort}" axis="{format_numbers(*driven.axis)}"/>'
    yield "    </body>"
    yield "  </worldbody>"
    yield from _write_constraints(machine)
    joints = [body.name for body in _iterate_depth_first(children, GROUND)]
    yield "  <sensor>"
    for body in machine.bodies:
        yield f'    <jointpos name="{body.joint}" joint="{body.joint}"/>'
    yield "  </sensor>"
    yield "  <keyframe>"
    # All joint coordinates, and the lead's, are 0 at the start.
    zero = format_numbers(*(0.0 for _ in joints), 0.0)
    rates = format_numbers(*(machine.rates[name] for name in joints), machine.speed)
    yield f'    <key name="start" qpos="{zero}" qvel="{rates}"/>'
    yield "  </keyframe>"
    yield "</mujoco>"


def _find_middle(machine: Multibody) -> Vector:
    places = np.array([body.place for body in machine.bodies])
    x, y, z = 0.5 * (places.min(axis=0) + places.max(axis=0))
    return float(x), float(y), float(z)


def _iterate_depth_first(children: dict[str, list[Body]], parent: str) -> Iterator[Body]:
    for body in children.get(parent, []):
        yield body
        yield from _iterate_depth_first(children, body.name)


def _write_body(
    machine: Multibody, children: dict[str, list[Body]], body: Body, origin: Vector, indent: str
) -> Iterator[str]:
    yield f'{indent}<body name="{body.name}" pos="{format_numbers(*_subtract(origin, body.place))}">'
    yield (
        f'{indent}  <inertial pos="{format_numbers(*_subtract(body.place, body.centre))}" '
        f'mass="{format_number(body.mass)}" diaginertia="{format_numbers(*get_inertias(body))}"/>'
    )
    yield f'{indent}  <joint name="{body.joint}" type="{body.sort}" axis="{format_numbers(*body.axis)}"/>'
    colour = COLOURS[machine.bodies.index(body) % len(COLOURS)]
    for geom in _write_geoms(body):
        yield f'{indent}  <geom {geom} rgba="{colour}"/>'
    for child in children.get(body.name, []):
        yield from _write_body(machine, children, child, body.place, indent + "  ")
    yield f"{indent}</body>"


def get_inertias(body: Body) -> Vector:
    """Return the moments about the three axes: those of a flat plate in the plane of motion, else all equal."""
    if body.axis[:2] == (0.0, 0.0) or body.sort == "slide":
        return 0.5 * body.inertia, 0.5 * body.inertia, body.inertia
    # Bodies on axes in the plane: only the inertia about the joint axis matters.
    return body.inertia, body.inertia, body.inertia


def _write_geoms(body: Body) -> Iterator[str]:
    if body.radius > 0.0:
        half = [0.5 * body.width * part for part in body.axis]
        ends = format_numbers(*(-h for h in half), *half)
        yield f'type="cylinder" fromto="{ends}" size="{format_number(body.radius)}"'
        return
    radius = 0.5 * body.width
    if radius <= 0.0:
        return
    marks = [_subtract(body.place, mark) for mark in body.marks]
    drawn = False
    for n, one in enumerate(marks):
        for other in marks[n + 1 :]:
            if one != other:
                yield f'type="capsule" fromto="{format_numbers(*one, *other)}" size="{format_number(0.35 * radius)}"'
                drawn = True
    if not drawn:
        yield f'type="box" size="{format_numbers(radius, 0.7 * radius, 0.4 * radius)}"'


def _write_constraints(machine: Multibody) -> Iterator[str]:
    # A joint equality couples exactly two joints; longer sums need a fixed tendon.
    long = [relation for relation in machine.relations if len(relation.terms) != 2]
    names = machine.by_name
    if long:
        yield "  <tendon>"
        for relation in long:
            yield f'    <fixed name="{relation.name}">'
            for name, weight in relation.terms:
                yield f'      <joint joint="{names[name].joint}" coef="{format_number(weight)}"/>'
            yield "    </fixed>"
        yield "  </tendon>"
    yield "  <equality>"
    for closure in machine.closures:
        anchor = format_numbers(
            *_subtract(names[closure.first].place if closure.first != GROUND else (0, 0, 0), closure.place)
        )
        first = "world" if closure.first == GROUND else closure.first
        second = "world" if closure.second == GROUND else closure.second
        yield f'    <connect name="{closure.name}" body1="{first}" body2="{second}" anchor="{anchor}"/>'
    for relation in machine.relations:
        if relation in long:
            yield f'    <tendon name="{relation.name}" tendon1="{relation.name}"/>'
        else:
            (one, weight), (other, by) = relation.terms
            # MuJoCo expresses joint1 as a polynomial of joint2.
            ratio = format_number(-by / weight)
            yield (
                f'    <joint name="{relation.name}" joint1="{names[one].joint}" joint2="{names[other].joint}" '
                f'polycoef="0 {ratio} 0 0 0"/>'
            )
    yield f'    <joint name="drive" joint1="{names[machine.driven].joint}" joint2="{LEAD_BODY}" polycoef="0 1 0 0 0"/>'
    yield "  </equality>"


def _subtract(origin: Vector, place: Vector) -> Vector:
    return place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]
