"""Bodies of links, built from given mass properties or shapes, in the unit of the forces."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import SupportsComplex

from kinematics.dynamics import shapes
from kinematics.dynamics.bodies import Body, join_bodies, make_body
from kinematics.message import compose
from synthesis.model.dynamics.bodies import BodySpec, Part, Place, PolarPoint, Shape


def escape_pointer(name: str) -> str:
    """Escape a name for a JSON pointer."""
    return name.replace("~", "~0").replace("/", "~1")


class BlockError(ValueError):
    """Raised for a block from which no machine can be built; carries the path of the field in the request."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


class LinkBodies:
    """Builder of points and bodies on the links of one linkage, in its reference configuration.

    Parameters
    ----------
    joints : mapping of str to complex
        Positions of the joints by name, length units.
    links : mapping of str to sequence of str
        The joints of each link.
    scale : float
        The length unit in the unit of the forces.
    """

    def __init__(self, joints: Mapping[str, SupportsComplex], links: Mapping[str, Sequence[str]], scale: float) -> None:
        self.joints = joints
        self.links = links
        self.scale = scale

    def resolve_place(self, link: str, place_spec: Place) -> complex:
        """Return a point of a link in the reference configuration, in the unit of the forces."""
        if not isinstance(place_spec, PolarPoint):
            return self.scale * complex(*place_spec)
        first, second = (complex(self.joints[joint]) for joint in self.links[link][:2])
        return self.scale * (first + place_spec.vector * (second - first) / abs(second - first))

    def build_body(self, link: str, body_spec: BodySpec) -> Body:
        """Build the body of a link."""
        if body_spec.shape is not None:
            return self._build_shape(link, body_spec.shape)
        # A body without a given centre of gravity is at the first joint of its link.
        first = self.scale * complex(self.joints[self.links[link][0]])
        centre = first if body_spec.cg is None else self.resolve_place(link, body_spec.cg)
        return make_body(body_spec.mass or 0.0, centre, body_spec.inertia or 0.0)

    def _build_shape(self, link: str, shape: Shape) -> Body:
        joints = {joint: self.scale * complex(self.joints[joint]) for joint in self.links[link]}
        bodies = [self._build_part(link, part, shape.material_density) for part in shape.parts]
        if shape.thickness is not None:
            if shape.polygon is not None:
                plate = shapes.make_polygon([self.resolve_place(link, corner) for corner in shape.polygon])
            elif shape.ends == "square":
                start, end = joints.values()
                plate = shapes.make_square_bar(
                    start, end, self.scale * (shape.width or 0.0), self.scale * shape.overhang
                )
            else:
                plate = shapes.make_widened_hull(list(joints.values()), self.scale * (shape.width or 0.0))
            # A hole is a disc of negative area.
            for joint, diameter in shape.holes.items():
                plate = plate.plus(shapes.make_disc(joints[joint], self.scale * diameter / 2.0), -1.0)
            path = f"/dynamics/bodies/{escape_pointer(link)}/shape"
            # A degenerate polygon has no area, and too large holes leave none.
            if not plate.area > 0.0 or not math.isfinite(plate.polar):
                raise BlockError(path, compose("mechanisms-plate-without-area"))
            for joint, diameter in shape.holes.items():
                # A hole that is not wider than the plate stays inside its round ends.
                wider = 0.0 if shape.width is None else diameter - shape.width
                if wider > 0.0 and self._is_at_edge(link, joint, wider):
                    raise BlockError(f"{path}/holes/{escape_pointer(joint)}", compose("mechanisms-hole-beyond-edge"))
            bodies.append(plate.body(shape.material_density, self.scale * shape.thickness))
        return join_bodies(bodies)

    def _is_at_edge(self, link: str, joint: str, wider: float) -> bool:
        """Return whether a hole that is ``wider`` than the plate (length units) extends beyond its edge at a joint."""
        import shapely  # imported on demand, because holes are seldom that wide

        places = {name: complex(self.joints[name]) for name in self.links[link]}
        hull = shapely.MultiPoint([(place.real, place.imag) for place in places.values()]).convex_hull
        edge = hull.exterior if hull.geom_type == "Polygon" else hull
        # In a wide hull, even a large hole may be far from the edge.
        return bool(2.0 * edge.distance(shapely.Point(places[joint].real, places[joint].imag)) < wider)

    def _build_part(self, link: str, part: Part, density: float) -> Body:
        centre, density = self.resolve_place(link, part.at), density if part.density is None else part.density
        length = self.scale * part.length
        if part.form == "prism":
            section = shapes.make_rectangle(centre, length, self.scale * (part.width or 0.0))
            return section.body(density, self.scale * (part.thickness or 0.0))
        return shapes.make_cylinder(
            centre,
            self.scale * (part.diameter or 0.0),
            length,
            density,
            bore=self.scale * part.bore,
            in_plane=part.axis == "in_plane",
        )
