"""Bodies of links from their given mass properties or shapes, in the unit of the forces."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from kinematics.dynamics import shapes
from kinematics.dynamics.bodies import Body, body, joined
from synthesis.model.bodies import Part, Place, PolarPlace, Shape, StatedBody


def token(name: str) -> str:
    """A name as a part of a JSON pointer."""
    return name.replace("~", "~0").replace("/", "~1")


class BlockError(ValueError):
    """A block that no machine can be made of; carries the field's path below the request."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


class LinkBodies:
    """Places and bodies of the links of one linkage in its reference configuration.

    Parameters
    ----------
    joints : mapping of str to complex
        Places by name, length units.
    links : mapping of str to sequence of str
        The joints of each link.
    scale : float
        The length unit in the unit of the forces.
    """

    def __init__(self, joints: Mapping[str, Any], links: Mapping[str, Sequence[str]], scale: float) -> None:
        self.joints = joints
        self.links = links
        self.scale = scale

    def place(self, link: str, stated: Place) -> complex:
        """A place on a link, in the reference configuration."""
        if not isinstance(stated, PolarPlace):
            return self.scale * complex(*stated)
        first, second = (complex(self.joints[joint]) for joint in self.links[link][:2])
        return self.scale * (first + stated.vector * (second - first) / abs(second - first))

    def body(self, link: str, stated: StatedBody) -> Body:
        """The body of a link."""
        if stated.shape is not None:
            return self._shaped(link, stated.shape)
        first = self.scale * complex(self.joints[self.links[link][0]])
        centre = first if stated.cg is None else self.place(link, stated.cg)
        return body(stated.mass or 0.0, centre, stated.inertia or 0.0)

    def _shaped(self, link: str, shape: Shape) -> Body:
        joints = {joint: self.scale * complex(self.joints[joint]) for joint in self.links[link]}
        bodies = [self._part(link, part, shape.heaviness) for part in shape.parts]
        if shape.thickness is not None:
            if shape.polygon is not None:
                plate = shapes.polygon([self.place(link, corner) for corner in shape.polygon])
            elif shape.ends == "square":
                start, end = joints.values()
                plate = shapes.square_bar(start, end, self.scale * (shape.width or 0.0), self.scale * shape.overhang)
            else:
                plate = shapes.widened_hull(list(joints.values()), self.scale * (shape.width or 0.0))
            for joint, diameter in shape.holes.items():
                plate = plate.plus(shapes.disc(joints[joint], self.scale * diameter / 2.0), -1.0)
            path = f"/dynamics/bodies/{token(link)}/shape"
            if not plate.area > 0.0 or not math.isfinite(plate.polar):
                raise BlockError(path, "the plate has no area; the polygon is flat, or the holes are too wide")
            for joint, diameter in shape.holes.items():
                wider = 0.0 if shape.width is None else diameter - shape.width
                if wider > 0.0 and self._at_edge(link, joint, wider):
                    raise BlockError(f"{path}/holes/{token(joint)}", "the hole extends beyond the edge of the plate")
            bodies.append(plate.body(shape.heaviness, self.scale * shape.thickness))
        return joined(bodies)

    def _at_edge(self, link: str, joint: str, wider: float) -> bool:
        """Whether a hole that is ``wider`` than the plate (length units) reaches beyond its edge at a joint."""
        import shapely  # holes are seldom that wide

        places = {name: complex(self.joints[name]) for name in self.links[link]}
        hull = shapely.MultiPoint([(place.real, place.imag) for place in places.values()]).convex_hull
        edge = hull.exterior if hull.geom_type == "Polygon" else hull
        return bool(2.0 * edge.distance(shapely.Point(places[joint].real, places[joint].imag)) < wider)

    def _part(self, link: str, part: Part, density: float) -> Body:
        centre, density = self.place(link, part.at), density if part.density is None else part.density
        length = self.scale * part.length
        if part.form == "prism":
            section = shapes.rectangle(centre, length, self.scale * (part.width or 0.0))
            return section.body(density, self.scale * (part.thickness or 0.0))
        return shapes.cylinder(
            centre,
            self.scale * (part.diameter or 0.0),
            length,
            density,
            bore=self.scale * part.bore,
            in_plane=part.axis == "in_plane",
        )
