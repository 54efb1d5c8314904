"""The model of a machine in URDF.

URDF describes trees only. Its root is called :data:`ROOT_LINK`, the name that readers fix to the ground: Gazebo takes a
root of another name for a moving body, and drops it with everything attached if it has no mass. The tree is written
unchanged; the pins that close its loops are joints of SDF in a ``<gazebo>`` block, which Gazebo adds to the model, and
comments for all other readers. Gears between two joints of the ground are ``mimic``; other relations are comments.
"""

from __future__ import annotations

from collections.abc import Iterator

from service.simulation.mjcf import get_inertias
from service.simulation.model import GROUND, Body, Multibody, Vector
from service.simulation.naming import escape_attribute, escape_comment, format_number, format_numbers

ROOT_LINK = "world"
"""Name of the ground that URDF readers fix."""


def write_urdf(machine: Multibody) -> str:
    """Write the model as text."""
    return "\n".join(_write_lines(machine)) + "\n"


def _write_lines(machine: Multibody) -> Iterator[str]:
    yield '<?xml version="1.0" encoding="utf-8"?>'
    yield f"<!-- {escape_comment(machine.title)} -->"
    for remark in machine.remarks:
        yield f"<!-- {escape_comment(remark)} -->"
    if machine.closures or machine.relations:
        yield (
            "<!-- URDF is a tree: loops are closed in the gazebo block below, as joints of SDF. Programs that do not "
            "read it must add these pins themselves; the MJCF file of this design has all of them. -->"
        )
    yield f'<robot name="{escape_attribute(machine.title)}">'
    yield "  <!-- The world frame is the design's, in metres; all joints are 0 at the start of the motion. -->"
    yield f'  <link name="{ROOT_LINK}"/>'
    origins: dict[str, Vector] = {GROUND: (0.0, 0.0, 0.0)}
    mimics, told = _find_mimics(machine)
    for body in machine.bodies:
        origins[body.name] = body.place
        yield from _write_link(body)
        yield from _write_joint(machine, body, origins[body.parent], mimics.get(body.name, ""))
    for line in told:
        yield f"  <!-- {escape_comment(line)} -->"
    for closure in machine.closures:
        yield from _write_closure(closure.name, closure.first, closure.second, closure.place, origins)
    yield "</robot>"


def _write_link(body: Body) -> Iterator[str]:
    xx, yy, zz = get_inertias(body)
    yield f'  <link name="{body.name}">'
    yield "    <inertial>"
    yield f'      <origin xyz="{format_numbers(*_subtract(body.place, body.centre))}" rpy="0 0 0"/>'
    yield f'      <mass value="{format_number(body.mass)}"/>'
    yield (
        f'      <inertia ixx="{format_number(xx)}" ixy="0" ixz="0" iyy="{format_number(yy)}" iyz="0" '
        f'izz="{format_number(zz)}"/>'
    )
    yield "    </inertial>"
    yield "  </link>"


def _write_joint(machine: Multibody, body: Body, origin: Vector, mimic: str) -> Iterator[str]:
    yield f'  <joint name="{body.joint}" type="{"continuous" if body.sort == "hinge" else "prismatic"}">'
    yield f'    <parent link="{_get_link_name(body.parent)}"/>'
    yield f'    <child link="{body.name}"/>'
    yield f'    <origin xyz="{format_numbers(*_subtract(origin, body.place))}" rpy="0 0 0"/>'
    yield f'    <axis xyz="{format_numbers(*body.axis)}"/>'
    if body.sort == "slide":
        # A tenth of the machine's size beyond the motion, so that the limit does not interfere.
        travelled = machine.motion[body.name]
        room = 0.1 * machine.size
        low, high = float(travelled.min()) - room, float(travelled.max()) + room
        yield f'    <limit lower="{format_number(low)}" upper="{format_number(high)}" effort="1e9" velocity="1e9"/>'
    if mimic:
        yield f"    {mimic}"
    yield "  </joint>"


def _find_mimics(machine: Multibody) -> tuple[dict[str, str], list[str]]:
    """Return the ``mimic`` element of each following body, and the relations that ``mimic`` cannot express."""
    names, mimics, told = machine.by_name, {}, []
    for relation in machine.relations:
        terms = relation.terms
        # A joint may mimic one other joint only, and the driven joint leads.
        follower = next((name for name, _ in terms if name != machine.driven and name not in mimics), "")
        if len(terms) == 2 and follower:
            weight = dict(terms)[follower]
            ((leader, by),) = ((name, value) for name, value in terms if name != follower)
            mimics[follower] = (
                f'<mimic joint="{names[leader].joint}" multiplier="{format_number(-by / weight)}" offset="0"/>'
            )
        else:
            total = " + ".join(f"{format_number(weight)} {names[name].joint}" for name, weight in terms)
            told.append(f"Gears in mesh: {total} = 0")
    return mimics, told


def _write_closure(name: str, first: str, second: str, place: Vector, origins: dict[str, Vector]) -> Iterator[str]:
    own = format_numbers(*_subtract(origins[first], place))
    other = format_numbers(*_subtract(origins[second], place))
    yield f"  <!-- {name}: a pin at {own} of {_get_link_name(first)} and at {other} of {second} closes a loop. -->"
    yield "  <gazebo>"
    yield f'    <joint name="{name}" type="revolute">'
    yield f"      <parent>{_get_link_name(first)}</parent>"
    yield f"      <child>{second}</child>"
    yield f"      <pose>{other} 0 0 0</pose>"
    yield "      <axis><xyz>0 0 1</xyz></axis>"
    yield "    </joint>"
    yield "  </gazebo>"


def _get_link_name(name: str) -> str:
    return ROOT_LINK if name == GROUND else name


def _subtract(origin: Vector, place: Vector) -> Vector:
    return place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]
