"""The Modelica model of a machine, built from components of Modelica.Mechanics.MultiBody 4.

The tree of bodies is written unchanged. In a planar loop the equations of one revolute joint would be dependent, so
each closure is a ``RevolutePlanarLoopConstraint``. Relations couple the flanges of joints by a model that the file
defines; the drive moves the flange of the input's joint at constant speed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from service.simulation.model import GROUND, Body, Multibody, Vector
from service.simulation.naming import number, one_line

REVOLUTE = "Modelica.Mechanics.MultiBody.Joints.Revolute"
PRISMATIC = "Modelica.Mechanics.MultiBody.Joints.Prismatic"
CLOSURE = "Modelica.Mechanics.MultiBody.Joints.RevolutePlanarLoopConstraint"
ARM = "Modelica.Mechanics.MultiBody.Parts.FixedTranslation"
BODY = "Modelica.Mechanics.MultiBody.Parts.Body"
ROTATIONAL = "Modelica.Mechanics.Rotational"
TRANSLATIONAL = "Modelica.Mechanics.Translational"

RELATION = f"""\
  model Relation "Gears in mesh: the weighted sum of the shaft angles stays 0"
    parameter Real weights[:] "Weights of the shaft angles";
    {ROTATIONAL}.Interfaces.Flange_a flange[size(weights, 1)];
    Modelica.Units.SI.Torque effort "Torque transmitted by the mesh for a weight of 1";
  equation
    weights * flange.phi = 0;
    flange.tau = weights * effort;
  end Relation;
"""


def modelica(machine: Multibody) -> str:
    """Write the model as text."""
    return "\n".join(_lines(machine)) + "\n"


def _lines(machine: Multibody) -> Iterator[str]:
    led, flanged = machine.by_name[machine.driven], _flanged(machine)
    for remark in machine.remarks:
        yield f"// {one_line(remark)}"
    yield "// SI units; Modelica Standard Library 4.0.0 or newer. All joints are at 0 at the start."
    yield f"model Machine {_text(machine.title)}"
    if machine.relations:
        yield RELATION
    pull = float(np.linalg.norm(machine.gravity))
    # World needs a unit direction even without gravity.
    down = tuple(part / pull for part in machine.gravity) if pull > 0.0 else (0.0, -1.0, 0.0)
    yield f"  inner Modelica.Mechanics.MultiBody.World world(g = {number(pull)}, n = {_vector(down)});"
    for body in machine.bodies:
        yield from _body(machine, body, body.name in flanged)
    for closure in machine.closures:
        yield f"  {CLOSURE} {closure.name}(n = {{0, 0, 1}});"
        for end, name in (("a", closure.first), ("b", closure.second)):
            arm = _from(_place(machine, name), closure.place)
            yield f"  {ARM} {closure.name}__{end}(r = {_vector(arm)}, animation = false);"
    for relation in machine.relations:
        weights = ", ".join(number(weight) for _, weight in relation.terms)
        yield f"  Relation {relation.name}(weights = {{{weights}}});"
    domain, coordinate = (ROTATIONAL, "phi") if led.sort == "hinge" else (TRANSLATIONAL, "s")
    yield f"  {domain}.Sources.Speed drive(exact = true, {coordinate}(start = 0, fixed = true));"
    yield f"  Modelica.Blocks.Sources.Constant speed(k = {number(machine.speed)});"
    yield "equation"
    for body in machine.bodies:
        yield f"  connect({_frame(machine, body.parent)}, {body.name}__at.frame_a);"
        yield f"  connect({body.name}__at.frame_b, {body.joint}.frame_a);"
        yield f"  connect({body.joint}.frame_b, {body.name}.frame_a);"
    for closure in machine.closures:
        yield f"  connect({_frame(machine, closure.first)}, {closure.name}__a.frame_a);"
        yield f"  connect({closure.name}__a.frame_b, {closure.name}.frame_a);"
        yield f"  connect({_frame(machine, closure.second)}, {closure.name}__b.frame_a);"
        yield f"  connect({closure.name}__b.frame_b, {closure.name}.frame_b);"
    for relation in machine.relations:
        for place, (name, _) in enumerate(relation.terms, 1):
            yield f"  connect({relation.name}.flange[{place}], {machine.by_name[name].joint}.axis);"
    yield f"  connect(speed.y, drive.{'w' if led.sort == 'hinge' else 'v'}_ref);"
    yield f"  connect(drive.flange, {led.joint}.axis);"
    yield (
        f"  annotation (experiment(StartTime = 0, StopTime = {number(machine.duration)}, "
        f'Interval = {number(float(machine.times[1]))}, Tolerance = 1e-8), uses(Modelica(version = "4.0.0")));'
    )
    yield "end Machine;"


def _flanged(machine: Multibody) -> set[str]:
    """Return the bodies whose joints have an axis flange."""
    return {machine.driven, *(name for relation in machine.relations for name, _ in relation.terms)}


def _body(machine: Multibody, body: Body, flange: bool) -> Iterator[str]:
    arm = _from(_place(machine, body.parent), body.place)
    yield f"  {ARM} {body.name}__at(r = {_vector(arm)}, animation = false);"
    sort, coordinate, rate = (REVOLUTE, "phi", "w") if body.sort == "hinge" else (PRISMATIC, "s", "v")
    start = f"{coordinate}(start = 0), {rate}(start = {number(machine.rates[body.name])})"
    yield f"  {sort} {body.joint}(n = {_vector(body.axis)}, useAxisFlange = {'true' if flange else 'false'}, {start});"
    centre = _vector(_from(body.place, body.centre))
    half, whole = number(0.5 * body.inertia), number(body.inertia)
    across = half if body.axis[:2] == (0.0, 0.0) or body.sort == "slide" else whole
    yield (
        f"  {BODY} {body.name}(m = {number(body.mass)}, r_CM = {centre}, I_11 = {across}, I_22 = {across}, "
        f"I_33 = {whole}) {_text(body.label)};"
    )


def _place(machine: Multibody, name: str) -> Vector:
    return (0.0, 0.0, 0.0) if name == GROUND else machine.by_name[name].place


def _frame(machine: Multibody, name: str) -> str:
    """Return the frame at a body's place."""
    return "world.frame_b" if name == GROUND else f"{machine.by_name[name].joint}.frame_b"


def _from(origin: Vector, place: Vector) -> Vector:
    return place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]


def _vector(vector: tuple[float, ...]) -> str:
    return f"{{{', '.join(number(part) for part in vector)}}}"


def _text(text: str) -> str:
    """Return text as a Modelica string literal."""
    plain = one_line(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{plain}"'
