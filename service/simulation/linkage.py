"""A linkage as a tree of bodies, and the pins that close its loops.

The tree is grown from the ground, breadth first. At each pin the body that is reached first is the *hub*: bodies not
yet in the tree hang from it by hinges, all others are closed to it. A joint on a slide is a block, a body of its own
that slides in its link and turns about the joint's pin. It is reached together with its link, so that slides are joints
of the tree and every closure is a pin.
"""

from __future__ import annotations

import cmath
from collections import deque
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.bodies import Body as Weight
from kinematics.dynamics.bodies import join_bodies
from kinematics.dynamics.bodies import make_body as weight
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose, join_messages
from service.simulation.model import GROUND, Body, Closure, Multibody, Relation, Vector, ensure_masses
from service.simulation.naming import Names
from service.simulation.query import NotSimulated
from service.simulation.weights import Weights

Z: Vector = (0.0, 0.0, 1.0)


@dataclass
class _Node:
    """A link or a block while the tree grows."""

    name: str
    label: str
    joints: tuple[str, ...]
    slide: int | None = None
    parent: str = ""
    sort: Literal["hinge", "slide"] = "hinge"
    at: str = ""
    along: int | None = None
    carried: int = 1
    weights: list[Weight] = field(default_factory=list)


def build_linkage(
    mechanism: Mechanism,
    inputs: Real,
    speed: float,
    weights: Weights,
    scale: float,
    title: str,
) -> Multibody:
    """Build a linkage driven along given inputs.

    Parameters
    ----------
    mechanism : Mechanism
        One design, in length units.
    inputs : float, shape (n + 1,)
        Evenly spaced from the start to the end of the motion: radians, or length units along the input slide.
    speed : float
        Speed of the input in its unit per second, with the sign of the inputs' direction.
    weights : Weights
        The mass of a pin belongs to the block there, or else to the first link.
    scale : float
        Metres in a length unit.

    Raises
    ------
    NotSimulated
        If the mechanism cannot be assembled at some of the inputs.
    """
    # Order 1: the joint rates at the start are needed, too.
    driven = drive(mechanism, inputs, speed=speed, order=1)
    if not driven.smooth.all():
        raise NotSimulated(compose("simulation-passes-toggle"))
    return _Tree(mechanism, driven, scale).build_machine(inputs, speed, weights, title)


class _Tree:
    def __init__(self, mechanism: Mechanism, driven: MechanismMotion, scale: float) -> None:
        self._mechanism, self._driven, self._scale = mechanism, driven, scale
        # Links and blocks share one set of identifiers.
        names = Names()
        self._links: dict[str, str] = {}
        self._nodes: dict[str, _Node] = {}
        for link, joints in mechanism.links.items():
            name = GROUND if link == GROUND else names.make_name("link", link)
            self._links[link] = name
            self._nodes[name] = _Node(name, link, joints)
        for number, slide in enumerate(mechanism.slides):
            label = compose("simulation-block", joint=slide.joint)
            name = names.make_name("block", mechanism.slide_names[number])
            self._nodes[name] = _Node(name, label, (slide.joint,), slide=number)
        # Pins are a separate kind of element in all formats.
        self._pins = Names()
        self._order: list[str] = []
        self._closures: list[Closure] = []

    def build_machine(self, inputs: Real, speed: float, weights: Weights, title: str) -> Multibody:
        """Grow the tree and return the machine."""
        mechanism, remarks, gravity = self._mechanism, weights.remarks, weights.gravity
        self._grow()
        self._load(weights)
        if not any(float(part.mass) > 0.0 for node in self._nodes.values() for part in node.weights):
            raise NotSimulated(compose("simulation-no-mass"))
        # Size in metres; it scales the minimum inertias.
        size = self._scale * float(mechanism.frame[1])
        bodies, given = ensure_masses(
            tuple(self._make_body(self._nodes[name], weights.width) for name in self._order), size
        )
        if given:
            listed = join_messages(given, ", ")
            remarks = (*remarks, compose("simulation-negligible-masses", bodies=listed))
        led = self._find_input_body()
        coordinates = {name: self._compute_coordinate(self._nodes[name]) for name in self._order}
        led_speed = float(coordinates[led][1][0])
        return Multibody(
            title=title,
            bodies=bodies,
            closures=tuple(self._closures),
            relations=tuple(self._make_relation(number) for number in range(len(mechanism.gears))),
            gravity=(gravity.real, gravity.imag, 0.0),
            driven=led,
            speed=led_speed,
            times=np.abs(inputs - inputs[0]) / abs(speed),
            motion={name: jet[0] - jet[0, 0] for name, jet in coordinates.items()},
            rates={name: float(jet[1, 0]) for name, jet in coordinates.items()},
            size=size,
            remarks=remarks,
        )

    # The tree

    def _grow(self) -> None:
        reached = {GROUND}
        # Breadth first: every body gets the shortest chain of joints to the ground.
        waiting = deque([GROUND])
        opened: set[str] = set()

        def attach(node: _Node, parent: str, sort: Literal["hinge", "slide"], at: str, along: int | None) -> None:
            node.parent, node.sort, node.at, node.along = parent, sort, at, along
            reached.add(node.name)
            # Parents precede their children, as all formats require.
            self._order.append(node.name)
            waiting.append(node.name)
            attach_slides(node)

        def attach_slides(node: _Node) -> None:
            """Reach the blocks that slide in a body, or the link in which a block slides."""
            for number, slide in enumerate(self._mechanism.slides):
                owner = self._nodes[self._links[slide.link]]
                block = next(other for other in self._nodes.values() if other.slide == number)
                if owner is node and block.name not in reached:
                    # The block moves in its link, and its joint coordinate is that of the slide. In the other case
                    # below, the link moves on its block.
                    block.carried = 1
                    attach(block, owner.name, "slide", slide.joint, number)
                elif block is node and owner.name not in reached:
                    owner.carried = -1
                    attach(owner, block.name, "slide", slide.joint, number)

        attach_slides(self._nodes[GROUND])
        while waiting:
            hub = self._nodes[waiting.popleft()]
            for joint in hub.joints:
                if joint in opened:
                    continue
                opened.add(joint)
                for node in self._nodes.values():
                    if node is hub or joint not in node.joints:
                        continue
                    # A body that is already in the tree closes a loop here; a new one hangs from the hub.
                    if node.name in reached:
                        name = self._pins.make_name("pin", f"{joint} {hub.label} {node.label}")
                        self._closures.append(Closure(name, hub.name, node.name, self._start(joint)))
                    else:
                        attach(node, hub.name, "hinge", joint, None)

    # Positions and masses

    def _start(self, joint: str) -> Vector:
        place = self._scale * complex(self._driven.joints[joint][0, 0])
        return place.real, place.imag, 0.0

    def _measure_turn(self, link: str) -> complex:
        """Return the rotation of a link from the reference position to the start of the motion.

        The rotation is a unit complex number.
        """
        if link == GROUND:
            return 1.0 + 0.0j
        return cmath.exp(1j * (float(self._driven.angles[link][0, 0]) - float(self._mechanism.link_angle(link))))

    def _load(self, weights: Weights) -> None:
        for node in self._nodes.values():
            if node.slide is not None:
                x, y, _ = self._start(node.joints[0])
                node.weights.append(weight(weights.block[0], complex(x, y), weights.block[1]))
        for link, part in weights.links.items():
            base = self._mechanism.link_line(link)[0]
            # Arm from the link's base joint to its centre of mass, in the reference position.
            away = complex(part.cg) - self._scale * complex(self._mechanism.joints[base])
            centre = self._scale * complex(self._driven.joints[base][0, 0]) + away * self._measure_turn(link)
            moved = weight(float(part.mass), centre, float(part.inertia))
            self._nodes[self._links[link]].weights.append(moved)
        for joint, mass in weights.pins.items():
            carriers = [node for node in self._nodes.values() if joint in node.joints and node.name != GROUND]
            if carriers:
                # Blocks carry the pin's mass before links do: max picks the first candidate with a slide.
                carrier = max(carriers, key=lambda node: node.slide is not None)
                x, y, _ = self._start(joint)
                carrier.weights.append(weight(float(mass), complex(x, y)))

    def _make_body(self, node: _Node, width: float) -> Body:
        place = self._start(node.at)
        axis = Z
        if node.along is not None:
            slide = self._mechanism.slides[node.along]
            along = cmath.exp(1j * float(slide.angle)) * self._measure_turn(slide.link)
            axis = (along.real, along.imag, 0.0)
        whole = join_bodies(node.weights) if node.weights else weight(0.0)
        centre = complex(whole.cg) if float(whole.mass) > 0.0 else complex(place[0], place[1])
        return Body(
            name=node.name,
            label=node.label,
            parent=node.parent,
            sort=node.sort,
            place=place,
            axis=axis,
            mass=float(whole.mass),
            centre=(centre.real, centre.imag, 0.0),
            inertia=float(whole.inertia),
            marks=tuple(self._start(joint) for joint in node.joints),
            width=width,
        )

    # How they move

    def _compute_rotation(self, node: _Node) -> Real:
        """Return the angle and angular rate of a body; a block rotates with the link in which it slides."""
        link = node.label if node.slide is None else self._mechanism.slides[node.slide].link
        if link == GROUND:
            return np.zeros((2, self._driven.input.shape[-1]))
        return np.asarray(self._driven.angles[link][:2])

    def _compute_coordinate(self, node: _Node) -> Real:
        """Return the joint coordinate of a body and its rate, shape (2, n + 1)."""
        if node.along is not None:
            name = self._mechanism.slide_names[node.along]
            return np.asarray(node.carried * self._scale * self._driven.slides[name][:2])
        relative = self._compute_rotation(node) - self._compute_rotation(self._nodes[node.parent])
        # Joint coordinates must be continuous over full turns.
        return np.stack([np.unwrap(relative[0]), relative[1]])

    def _find_input_body(self) -> str:
        mechanism = self._mechanism
        if not mechanism.has_slide_input:
            return self._links[mechanism.input]
        return next(
            name
            for name in self._order
            if (number := self._nodes[name].slide) is not None
            and mechanism.slides[number].joint == mechanism.input
            and mechanism.slides[number].link == GROUND
        )

    def _make_relation(self, number: int) -> Relation:
        """Return the constraint of a gear pair.

        The angle of the second link minus the ratio times that of the first is constant, both relative to the ground.
        """
        gear = self._mechanism.gears[number]
        terms: dict[str, float] = {}
        for link, weighed in ((gear.second, 1.0), (gear.first, -gear.ratio)):
            name = self._links[link]
            # The absolute angle of a link is the sum of the hinge coordinates on its path to the ground.
            while name != GROUND:
                node = self._nodes[name]
                if node.sort == "hinge":
                    terms[name] = terms.get(name, 0.0) + weighed
                name = node.parent
        # Coordinates on the common path of both links cancel.
        kept = tuple((name, value) for name, value in terms.items() if value != 0.0)
        return Relation(f"gears_{number + 1}", kept)
