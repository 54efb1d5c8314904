"""Masses and loads of fourbars, packed for compiled code that evaluates them for any fourbar from its joints.

A block of dynamics becomes one vector, :func:`pack_loads`. The data of a link are the sum of three parts, each with its
mass, first moment and polar second moment: bodies at points of the plane (with the linkage at its first target), bodies
at points of the link (from its first joint, along the direction to the second), and a plate about the link's joints.
The plate is a bar, or the widened convex hull of the joints, minus its holes, as in :mod:`kinematics.dynamics.shapes`.
:func:`weigh_links` combines the parts for the joints of one fourbar.

Everything is in the unit of the forces. Points are relative to the task's origin: a distant origin would cost digits.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from kinematics.dynamics.bodies import Body
from kinematics.dynamics.fourbar import COUPLER, OUTPUT, PIN_A, PIN_B, PIN_P
from kinematics.dynamics.fourbar import INPUT as CRANK
from kinematics.dynamics.shapes import EMPTY_SECTION, make_cylinder, make_polygon, make_rectangle
from synthesis.fit.chart import OPTIONS
from synthesis.model.dynamics.bodies import BodySpec, Part, Place, PolarPoint, Shape
from synthesis.model.dynamics.loads import LoadSpec
from synthesis.model.dynamics.request import DesignDynamics, LengthUnit

LINKS: Mapping[str, tuple[str, ...]] = {"input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")}
"""The moving links of a fourbar by their joints."""

ON_LINK = {"input": CRANK, "coupler": COUPLER, "output": OUTPUT}
ON_PIN = {"A": PIN_A, "B": PIN_B, "P": PIN_P}
FIXED = "O2", "O4"

SPEED, GRAVITY, AT_POINT, ABOUT, PINS, COUPLES, LOADS, BODIES = 0, 1, 3, 4, 6, 9, 12, 13
"""Indices of a block: the input's speed; gravity (x, y); whether shaking moments are about a given point, and that
point; masses at A, B and P; torques on the links; number of forces; beginning of the records of the links."""

IN_PLANE, IN_LINK, PLATE, LINK = 0, 4, 8, 15
"""Indices in a link's record: mass, first moment (x, y) and polar moment of bodies in the plane, and of bodies in the
link; density times thickness, width (0 without a plate), whether ends are square, overhang, and radii of the holes at
the joints. The last constant is the length of a record."""

FORCES = BODIES + 3 * LINK
"""Beginning of the forces. Each record: the part on which it acts, whether its point is given in the plane, the point,
the force, and whether the force turns with the link."""

FORCE = 7


class _UnsupportedBlockError(ValueError):
    """A block that cannot be packed into a vector."""


def pack_loads(block: DesignDynamics, unit: LengthUnit, origin: complex) -> Real | None:
    """Pack a block into a vector, or return None if it has elements that the vector cannot represent.

    Such elements are springs, friction, variable loads, polygons with corners in both frames, and links that a fourbar
    lacks.

    Parameters
    ----------
    block : DesignDynamics
        Masses and loads of a linkage with a rotating input.
    unit : str
        The length unit.
    origin : complex
        Origin of the task, in length units.
    """
    try:
        return _LoadPacker(block, unit, origin).pack()
    except _UnsupportedBlockError:
        return None


class _LoadPacker:
    """Converter of one block into a vector."""

    def __init__(self, stated: DesignDynamics, unit: LengthUnit, origin: complex) -> None:
        self.stated, self.scale, self.origin = stated, stated.scale(unit), origin

    def pack(self) -> Real:
        """Return all numbers in one vector."""
        stated = self.stated
        if stated.springs or stated.friction is not None or stated.speed_rpm is None:
            raise _UnsupportedBlockError
        if not stated.bodies.keys() <= LINKS.keys():
            raise _UnsupportedBlockError
        # Loads on fixed pivots act on the frame and move nothing.
        forces = [self._pack_force(load) for load in stated.loads if load.torque is None and load.joint not in FIXED]
        out = np.zeros(FORCES + FORCE * len(forces))
        out[SPEED], out[LOADS] = stated.speed_rpm * math.tau / 60.0, len(forces)
        gravity = 0j if stated.gravity is None else stated.gravity.vector
        out[GRAVITY : GRAVITY + 2] = gravity.real, gravity.imag
        if stated.moment_about is not None:
            about = self._pack_place(complex(*stated.moment_about))
            out[AT_POINT], out[ABOUT], out[ABOUT + 1] = 1.0, about.real, about.imag
        for mass in stated.point_masses:
            if mass.joint not in (*ON_PIN, *FIXED):
                raise _UnsupportedBlockError
            if mass.joint not in FIXED:
                out[PINS + "ABP".index(mass.joint)] += mass.mass
        for load in stated.loads:
            if load.torque is not None:
                if load.torque.constant is None or load.link is None or load.link not in LINKS:
                    raise _UnsupportedBlockError
                out[COUPLES + list(LINKS).index(load.link)] += load.torque.constant
        for n, (link, joints) in enumerate(LINKS.items()):
            body = stated.bodies.get(link)
            at = BODIES + n * LINK
            if body is not None:
                self._pack_body(body, joints, out[at : at + LINK])
            # The common plate applies to links that have no body of their own; the coupler is a hull, always with
            # round ends.
            elif stated.plate is not None:
                own = {joint: hole for joint, hole in stated.plate.holes.items() if joint in joints}
                plain = {"ends": "round", "overhang": 0.0} if len(joints) > 2 else {}
                shape = stated.plate.model_copy(update={"holes": own, **plain})
                self._pack_shape(shape, joints, out[at : at + LINK])
        out[FORCES:] = [number for force in forces for number in force]
        return out

    def _pack_place(self, place: complex) -> complex:
        return self.scale * (place - self.origin)

    def _resolve_place(self, place: Place) -> tuple[bool, complex]:
        """Return whether a place is given in the plane, and its coordinates."""
        if isinstance(place, PolarPoint):
            return False, self.scale * place.vector
        return True, self._pack_place(complex(*place))

    def _pack_force(self, load: LoadSpec) -> Sequence[float]:
        """Return the record of a constant force, see :data:`FORCES`."""
        constant = None if load.force is None else load.force.constant
        if constant is None:
            raise _UnsupportedBlockError
        if load.joint is not None:
            if load.joint not in ON_PIN:
                raise _UnsupportedBlockError
            return float(ON_PIN[load.joint]), 0.0, 0.0, 0.0, *constant, 0.0
        if load.link is None or load.link not in LINKS or load.point is None:
            raise _UnsupportedBlockError
        plane, place = self._resolve_place(load.point)
        turning = load.frame == "link"
        return float(ON_LINK[load.link]), float(plane), place.real, place.imag, *constant, float(turning)

    def _pack_body(self, body: BodySpec, joints: Sequence[str], out: Real) -> None:
        if body.shape is not None:
            self._pack_shape(body.shape, joints, out)
            return
        mass, inertia = body.mass or 0.0, body.inertia or 0.0
        # Without a centre of mass, the body is at the link's first joint.
        plane, centre = (False, 0j) if body.cg is None else self._resolve_place(body.cg)
        _add_body(out, plane, Body(np.asarray(mass), np.asarray(centre), np.asarray(inertia)))

    def _pack_shape(self, shape: Shape, joints: Sequence[str], out: Real) -> None:
        """Add the parts and the polygon of a shape to the link's bodies, and write its plate with holes."""
        for part in shape.parts:
            self._pack_part(part, shape.material_density, out)
        if shape.thickness is None:
            return
        density = shape.material_density * self.scale * shape.thickness
        if shape.polygon is not None:
            places = [self._resolve_place(corner) for corner in shape.polygon]
            frames = {plane for plane, _ in places}
            # Corners in both frames would change the polygon's shape with the linkage.
            if len(frames) > 1:
                raise _UnsupportedBlockError
            section = make_polygon([place for _, place in places])
            if not section.area > 0.0:
                raise _UnsupportedBlockError
            _add_body(out, frames.pop(), section.body(shape.material_density, self.scale * shape.thickness))
        elif shape.ends == "square" and len(joints) > 2:
            raise _UnsupportedBlockError
        if not shape.holes.keys() <= set(joints):
            raise _UnsupportedBlockError
        plate = out[PLATE:]
        plate[:4] = density, self.scale * (shape.width or 0.0), shape.ends == "square", self.scale * shape.overhang
        plate[4 : 4 + len(joints)] = [0.5 * self.scale * shape.holes.get(joint, 0.0) for joint in joints]

    def _pack_part(self, part: Part, of_shape: float, out: Real) -> None:
        """Add a prism or a cylinder; ``of_shape`` is the density if the part has none of its own."""
        plane, centre = self._resolve_place(part.at)
        density, length = of_shape if part.density is None else part.density, self.scale * part.length
        if part.form == "prism":
            section = EMPTY_SECTION.plus(make_rectangle(centre, length, self.scale * (part.width or 0.0)))
            _add_body(out, plane, section.body(density, self.scale * (part.thickness or 0.0)))
            return
        across, bore = self.scale * (part.diameter or 0.0), self.scale * part.bore
        _add_body(
            out, plane, make_cylinder(centre, across, length, density, bore=bore, in_plane=part.axis == "in_plane")
        )


def _add_body(out: Real, plane: bool, body: Body) -> None:
    """Add a body to those given in the plane, or in the link."""
    at = IN_PLANE if plane else IN_LINK
    mass, centre = float(body.mass), complex(body.cg)
    # Moments about the origin, so that parts add up; the parallel-axis theorem moves the inertia there.
    first = mass * centre
    out[at : at + 4] += mass, first.real, first.imag, float(body.inertia) + mass * abs(centre) ** 2


@njit(**OPTIONS)
def _square_magnitude(z: complex) -> float:
    return z.real * z.real + z.imag * z.imag


@njit(**OPTIONS)
def _integrate_bar(p: complex, q: complex, width: float, square: bool, overhang: float) -> tuple[float, complex, float]:
    """Integrate area, first moment and polar moment about the origin of a bar between two joints."""
    length, middle = abs(q - p), 0.5 * (p + q)
    if square:
        along = length + 2.0 * overhang
        area = along * width
        return area, area * middle, area * ((along * along + width * width) / 12.0 + _square_magnitude(middle))
    r, area = 0.5 * width, length * width
    polar = area * ((length * length + width * width) / 12.0 + _square_magnitude(middle))
    round_ends = math.pi * r * r
    # Two half discs; each has its centre 4r/3π beyond its joint.
    beyond, half = 4.0 * r / (3.0 * math.pi), 0.5 * round_ends
    off = 0.5 * length + beyond
    own = 0.25 * math.pi * r**4 - half * beyond * beyond
    polar += 2.0 * (own + half * off * off) + round_ends * _square_magnitude(middle)
    return area + round_ends, (area + round_ends) * middle, polar


@njit(**OPTIONS)
def _integrate_widened_hull(a: complex, b: complex, p: complex, width: float) -> tuple[float, complex, float]:
    """Integrate area and moments of the convex hull of three joints, widened by half the width all round."""
    corners = (a, b, p)
    turned = (b - a).real * (p - a).imag - (b - a).imag * (p - a).real
    # Collinear joints: the hull is the bar between the two that are farthest from each other.
    if turned == 0.0:
        one, two = a, b
        if abs(p - a) > abs(two - one):
            one, two = a, p
        if abs(p - b) > abs(two - one):
            one, two = b, p
        bar: tuple[float, complex, float] = _integrate_bar(one, two, width, False, 0.0)
        return bar
    # The sums below assume anticlockwise corners.
    if turned < 0.0:
        corners = (a, p, b)
    r = 0.5 * width
    area, first, polar = 0.0, 0j, 0.0
    for n in range(3):
        # Sum over the corners: the triangle to the origin, the strip along the side, and the sector at the corner.
        z, w, before = corners[n], corners[(n + 1) % 3], corners[(n + 2) % 3]
        doubled = z.real * w.imag - z.imag * w.real
        area += 0.5 * doubled
        first += doubled * (z + w) / 6.0
        polar += doubled * (_square_magnitude(z) + z.real * w.real + z.imag * w.imag + _square_magnitude(w)) / 12.0
        edge, length = w - z, abs(w - z)
        out, out_before = -1j * edge / length, -1j * (z - before) / abs(z - before)
        middle, strip = z + 0.5 * edge + 0.5 * r * out, length * r
        area += strip
        first += strip * middle
        polar += strip * ((length * length + r * r) / 12.0 + _square_magnitude(middle))
        # The sector's opening is the exterior angle; atan2 is accurate for flat and sharp corners.
        opening = abs(
            math.atan2(
                out_before.real * out.imag - out_before.imag * out.real,
                out_before.real * out.real + out_before.imag * out.imag,
            )
        )
        if opening > 0.0:
            sector = 0.5 * r * r * opening
            towards = out_before * complex(math.cos(0.5 * opening), math.sin(0.5 * opening))
            arm = 2.0 * r / 3.0 * math.sin(0.5 * opening) / (0.5 * opening) * towards
            area += sector
            first += sector * (z + arm)
            polar += 0.25 * r**4 * opening - sector * _square_magnitude(arm) + sector * _square_magnitude(z + arm)
    return area, first, polar


@njit(**OPTIONS)
def _subtract_holes(
    row: Real, reach: complex, third: complex, area: float, middle: complex, second_moment: float
) -> tuple[float, complex, float]:
    """Return area, first and second moment of a plate minus its holes at the joints."""
    for k in range(3):
        hole = row[PLATE + 4 + k]
        if hole > 0.0:
            centre = 0j if k == 0 else reach if k == 1 else third
            taken = math.pi * hole * hole
            area -= taken
            middle -= taken * centre
            second_moment -= taken * (0.5 * hole * hole + _square_magnitude(centre))
    return area, middle, second_moment


@njit(**OPTIONS)
def weigh_links(
    block: Real, joints: Complex, mass: Real, cg: Complex, inertia: Real, arms: Complex, forces: Complex
) -> bool:
    """Compute the bodies and forces of one fourbar, in the form of :class:`kinematics.dynamics.fourbar.Weights`.

    Parameters
    ----------
    block : float, shape (m,)
        Packed loads, see :func:`pack_loads`.
    joints : complex, shape (5,)
        O2, A, B, O4, P at the first target, from the task's origin, in the unit of the forces.
    mass, cg, inertia : shape (3,)
        Output, for input, coupler and output.
    arms, forces : complex, shape (loads,)
        Output: points of application and forces, in the form of the weights.

    Returns
    -------
    bool
        False if holes leave nothing of a plate.
    """
    o2, a, b, o4, p = joints
    sound = True
    for n in range(3):
        first = o2 if n == 0 else a if n == 1 else o4
        second = a if n == 0 else b
        unit = (second - first) / abs(second - first)
        at = BODIES + n * LINK
        row = block[at : at + LINK]
        # All moments are about the link's first joint, over the link's direction.
        m = row[IN_PLANE]
        moment = complex(row[IN_PLANE + 1], row[IN_PLANE + 2])
        # Move the part given in the plane to the link's first joint; the part given in the link is there already.
        polar = row[IN_PLANE + 3] - 2.0 * (moment * first.conjugate()).real + m * _square_magnitude(first)
        moment = (moment - m * first) * unit.conjugate()
        m += row[IN_LINK]
        moment += complex(row[IN_LINK + 1], row[IN_LINK + 2])
        polar += row[IN_LINK + 3]
        density, width = row[PLATE], row[PLATE + 1]
        if density > 0.0:
            reach = complex(abs(second - first), 0.0)
            third = (p - first) * unit.conjugate()
            area, middle, second_moment = 0.0, 0j, 0.0
            if width > 0.0:
                if n == 1:
                    area, middle, second_moment = _integrate_widened_hull(0j, reach, third, width)
                else:
                    area, middle, second_moment = _integrate_bar(0j, reach, width, row[PLATE + 2] > 0.0, row[PLATE + 3])
            area, middle, second_moment = _subtract_holes(row, reach, third, area, middle, second_moment)
            sound &= area > 0.0 or width == 0.0
            m += density * area
            moment += density * middle
            polar += density * second_moment
        mass[n] = m
        # A massless link has no centre of mass, and 0 avoids a NaN.
        cg[n] = moment / m if m > 0.0 else 0j
        inertia[n] = polar - m * _square_magnitude(cg[n])
        sound &= m >= 0.0
    for k in range(int(block[LOADS])):
        row = block[FORCES + k * FORCE : FORCES + (k + 1) * FORCE]
        on = int(row[0])
        first = o2 if on == CRANK else a if on == COUPLER else o4
        second = a if on == CRANK else b
        unit = (second - first) / abs(second - first)
        arms[k] = complex(row[2], row[3])
        # The kernel expects application points in the link's frame.
        if row[1] > 0.0:
            arms[k] = (arms[k] - first) * unit.conjugate()
        forces[k] = complex(row[4], row[5])
        # A force in the link's frame was requested relative to its direction at the first target.
        if row[6] > 0.0:
            forces[k] *= unit.conjugate()
    return sound
