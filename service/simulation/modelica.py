"""The Modelica model of a machine, built from components of Modelica.Mechanics.MultiBody 4.

The tree of bodies is written unchanged. In a planar loop the equations of one revolute joint would be dependent, so
each closure is a ``RevolutePlanarLoopConstraint``. Relations couple the flanges of joints by a model that the file
defines; the drive moves the flange of the input's joint at constant speed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from service.simulation.model import GROUND, Body, Multibody, Vector
from service.simulation.naming import format_number, join_lines

REVOLUTE_CLASS = "Modelica.Mechanics.MultiBody.Joints.Revolute"
PRISMATIC_CLASS = "Modelica.Mechanics.MultiBody.Joints.Prismatic"
CLOSURE_CLASS = "Modelica.Mechanics.MultiBody.Joints.RevolutePlanarLoopConstraint"
ARM_CLASS = "Modelica.Mechanics.MultiBody.Parts.FixedTranslation"
BODY_CLASS = "Modelica.Mechanics.MultiBody.Parts.Body"
ROTATIONAL_PACKAGE = "Modelica.Mechanics.Rotational"
TRANSLATIONAL_PACKAGE = "Modelica.Mechanics.Translational"

RELATION_MODEL = f"""\
  model Relation "Gears in mesh: the weighted sum of the shaft angles stays 0"
    parameter Real weights[:] "Weights of the shaft angles";
    {ROTATIONAL_PACKAGE}.Interfaces.Flange_a flange[size(weights, 1)];
    Modelica.Units.SI.Torque effort "Torque transmitted by the mesh for a weight of 1";
  equation
    weights * flange.phi = 0;
    flange.tau = weights * effort;
  end Relation;
"""


def write_modelica(machine: Multibody) -> str:
    """Write the model as text."""
    return "\n".join(_write_lines(machine)) + "\n"


def _write_lines(machine: Multibody) -> Iterator[str]:
    led, flanged = machine.by_name[machine.driven], _find_flanged(machine)
    for remark in machine.remarks:
        yield f"// {join_lines(remark)}"
    yield "// SI units; Modelica Standard Library 4.0.0 or newer. All joints are at 0 at the start."
    yield f"model Machine {_format_text(machine.title)}"
    if machine.relations:
        yield RELATION_MODEL
    pull = float(np.linalg.norm(machine.gravity))
    # World needs a unit direction even without gravity.
    down = tuple(part / pull for part in machine.gravity) if pull > 0.0 else (0.0, -1.0, 0.0)
    yield f"  inner Modelica.Mechanics.MultiBody.World world(g = {format_number(pull)}, n = {_format_vector(down)});"
    for body in machine.bodies:
        yield from _write_body(machine, body, body.name in flanged)
    for closure in machine.closures:
        yield f"  {CLOSURE_CLASS} {closure.name}(n = {{0, 0, 1}});"
        for end, name in (("a", closure.first), ("b", closure.second)):
            arm = _subtract(_get_place(machine, name), closure.place)
            yield f"  {ARM_CLASS} {closure.name}__{end}(r = {_format_vector(arm)}, animation = false);"
    for relation in machine.relations:
        weights = ", ".join(format_number(weight) for _, weight in relation.terms)
        yield f"  Relation {relation.name}(weights = {{{weights}}});"
    domain, coordinate = (ROTATIONAL_PACKAGE, "phi") if led.sort == "hinge" else (TRANSLATIONAL_PACKAGE, "s")
    yield f"  {domain}.Sources.Speed drive(exact = true, {coordinate}(start = 0, fixed = true));"
    yield f"  Modelica.Blocks.Sources.Constant speed(k = {format_number(machine.speed)});"
    yield "equation"
    for body in machine.bodies:
        yield f"  connect({_get_frame(machine, body.parent)}, {body.name}__at.frame_a);"
        yield f"  connect({body.name}__at.frame_b, {body.joint}.frame_a);"
        yield f"  connect({body.joint}.frame_b, {body.name}.frame_a);"
    for closure in machine.closures:
        yield f"  connect({_get_frame(machine, closure.first)}, {closure.name}__a.frame_a);"
        yield f"  connect({closure.name}__a.frame_b, {closure.name}.frame_a);"
        yield f"  connect({_get_frame(machine, closure.second)}, {closure.name}__b.frame_a);"
        yield f"  connect({closure.name}__b.frame_b, {closure.name}.frame_b);"
    for relation in machine.relations:
        for place, (name, _) in enumerate(relation.terms, 1):
            yield f"  connect({relation.name}.flange[{place}], {machine.by_name[name].joint}.axis);"
    yield f"  connect(speed.y, drive.{'w' if led.sort == 'hinge' else 'v'}_ref);"
    yield f"  connect(drive.flange, {led.joint}.axis);"
    yield (
        f"  annotation (experiment(StartTime = 0, StopTime = {format_number(machine.duration)}, "
        f'Interval = {format_number(float(machine.times[1]))}, Tolerance = 1e-8), uses(Modelica(version = "4.0.0")));'
    )
    yield "end Machine;"


def _find_flanged(machine: Multibody) -> set[str]:
    """Return the bodies whose joints have an axis flange."""
    return {machine.driven, *(name for relation in machine.relations for name, _ in relation.terms)}


def _write_body(machine: Multibody, body: Body, flange: bool) -> Iterator[str]:
    arm = _subtract(_get_place(machine, body.parent), body.place)
    yield f"  {ARM_CLASS} {body.name}__at(r = {_format_vector(arm)}, animation = false);"
    sort, coordinate, rate = (REVOLUTE_CLASS, "phi", "w") if body.sort == "hinge" else (PRISMATIC_CLASS, "s", "v")
    start = f"{coordinate}(start = 0), {rate}(start = {format_number(machine.rates[body.name])})"
    yield (
        f"  {sort} {body.joint}(n = {_format_vector(body.axis)}, useAxisFlange = {'true' if flange else 'false'}, "
        f"{start});"
    )
    centre = _format_vector(_subtract(body.place, body.centre))
    half, whole = format_number(0.5 * body.inertia), format_number(body.inertia)
    across = half if body.axis[:2] == (0.0, 0.0) or body.sort == "slide" else whole
    yield (
        f"  {BODY_CLASS} {body.name}(m = {format_number(body.mass)}, r_CM = {centre}, I_11 = {across}, I_22 = "
        f"{across}, I_33 = {whole}) {_format_text(body.label)};"
    )


def _get_place(machine: Multibody, name: str) -> Vector:
    return (0.0, 0.0, 0.0) if name == GROUND else machine.by_name[name].place


def _get_frame(machine: Multibody, name: str) -> str:
    """Return the frame at a body's place."""
    return "world.frame_b" if name == GROUND else f"{machine.by_name[name].joint}.frame_b"


def _subtract(origin: Vector, place: Vector) -> Vector:
    return place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]


def _format_vector(vector: tuple[float, ...]) -> str:
    return f"{{{', '.join(format_number(part) for part in vector)}}}"


def _format_text(text: str) -> str:
    """Return text as a Modelica string literal."""
    plain = join_lines(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{plain}"'
