"""A linkage as a tree of bodies and the pins that close its loops.

The tree is grown from the ground, breadth first. At each pin the first body that is reached is the *hub*: bodies that
nothing has reached yet hang from it by hinges, all others are closed to it. A joint on a slide is a block, a body of
its own that slides in its link and turns about the joint's pin; it is reached with its link, so that slides are joints
of the tree and every closure is a pin.
"""

from __future__ import annotations

import cmath
from collections import deque
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from kinematics.dynamics.bodies import Body as Weight
from kinematics.dynamics.bodies import body as weight
from kinematics.dynamics.bodies import joined
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism
from service.simulation.model import GROUND, Body, Closure, Multibody, Real, Relation, Vector, weighty
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


def linkage(
    mechanism: Mechanism,
    inputs: Real,
    speed: float,
    weights: Weights,
    scale: float,
    title: str,
) -> Multibody:
    """A linkage that is driven along inputs.

    Parameters
    ----------
    mechanism : Mechanism
        One design, in length units.
    inputs : float, shape (n + 1,)
        Evenly from the start to the end of the motion: radians, or length units along the input slide.
    speed : float
        Of the input, in its unit a second, with the sense of the inputs.
    weights : Weights
        Masses of pins are carried by the block there, or else by the first link.
    scale : float
        Metres to a length unit.

    Raises
    ------
    NotSimulated
        Where the mechanism cannot be assembled all along the inputs.
    """
    driven = drive(mechanism, inputs, speed=speed, order=1)
    if not driven.smooth.all():
        raise NotSimulated("The design cannot be driven all along its motion: a toggle lies in it.")
    return _Tree(mechanism, driven, scale).grown(inputs, speed, weights, title)


class _Tree:
    def __init__(self, mechanism: Mechanism, driven: MechanismMotion, scale: float) -> None:
        self._mechanism, self._driven, self._scale = mechanism, driven, scale
        names = Names()
        self._links: dict[str, str] = {}
        self._nodes: dict[str, _Node] = {}
        for link, joints in mechanism.links.items():
            name = GROUND if link == GROUND else names.of("link", link)
            self._links[link] = name
            self._nodes[name] = _Node(name, link, joints)
        for number, slide in enumerate(mechanism.slides):
            label = f"block at {slide.joint}"
            name = names.of("block", mechanism.slide_names[number])
            self._nodes[name] = _Node(name, label, (slide.joint,), slide=number)
        self._pins = Names()
        self._order: list[str] = []
        self._closures: list[Closure] = []

    def grown(self, inputs: Real, speed: float, weights: Weights, title: str) -> Multibody:
        """The machine."""
        mechanism, remarks, gravity = self._mechanism, weights.remarks, weights.gravity
        self._grow()
        self._load(weights)
        if not any(float(part.mass) > 0.0 for node in self._nodes.values() for part in node.weights):
            raise NotSimulated("Nothing that moves has any mass.")
        size = self._scale * float(mechanism.frame[1])
        bodies, given = weighty(tuple(self._body(self._nodes[name], weights.width) for name in self._order), size)
        if given:
            told = ", ".join(given)
            remarks = (*remarks, f"Without mass or inertia of their own, and given a millionth: {told}.")
        led = self._input_body()
        coordinates = {name: self._coordinate(self._nodes[name]) for name in self._order}
        led_speed = float(coordinates[led][1][0])
        return Multibody(
            title=title,
            bodies=bodies,
            closures=tuple(self._closures),
            relations=tuple(self._relation(number) for number in range(len(mechanism.gears))),
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
        waiting = deque([GROUND])
        opened: set[str] = set()

        def reach(node: _Node, parent: str, sort: Literal["hinge", "slide"], at: str, along: int | None) -> None:
            node.parent, node.sort, node.at, node.along = parent, sort, at, along
            reached.add(node.name)
            self._order.append(node.name)
            waiting.append(node.name)
            slid(node)

        def slid(node: _Node) -> None:
            """Reach what slides in a body, or what a block slides in."""
            for number, slide in enumerate(self._mechanism.slides):
                owner = self._nodes[self._links[slide.link]]
                block = next(other for other in self._nodes.values() if other.slide == number)
                if owner is node and block.name not in reached:
                    block.carried = 1
                    reach(block, owner.name, "slide", slide.joint, number)
                elif block is node and owner.name not in reached:
                    owner.carried = -1
                    reach(owner, block.name, "slide", slide.joint, number)

        slid(self._nodes[GROUND])
        while waiting:
            hub = self._nodes[waiting.popleft()]
            for joint in hub.joints:
                if joint in opened:
                    continue
                opened.add(joint)
                for node in self._nodes.values():
                    if node is hub or joint not in node.joints:
                        continue
                    if node.name in reached:
                        name = self._pins.of("pin", f"{joint} {hub.label} {node.label}")
                        self._closures.append(Closure(name, hub.name, node.name, self._start(joint)))
                    else:
                        reach(node, hub.name, "hinge", joint, None)

    # Where bodies are, and what they weigh

    def _start(self, joint: str) -> Vector:
        place = self._scale * complex(self._driven.joints[joint][0, 0])
        return place.real, place.imag, 0.0

    def _turned(self, link: str) -> complex:
        """By how much a link has turned from the reference to the start."""
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
            away = complex(part.cg) - self._scale * complex(self._mechanism.joints[base])
            centre = self._scale * complex(self._driven.joints[base][0, 0]) + away * self._turned(link)
            moved = weight(float(part.mass), centre, float(part.inertia))
            self._nodes[self._links[link]].weights.append(moved)
        for joint, mass in weights.pins.items():
            carriers = [node for node in self._nodes.values() if joint in node.joints and node.name != GROUND]
            if carriers:
                carrier = max(carriers, key=lambda node: node.slide is not None)
                x, y, _ = self._start(joint)
                carrier.weights.append(weight(float(mass), complex(x, y)))

    def _body(self, node: _Node, width: float) -> Body:
        place = self._start(node.at)
        axis = Z
        if node.along is not None:
            slide = self._mechanism.slides[node.along]
            along = cmath.exp(1j * float(slide.angle)) * self._turned(slide.link)
            axis = (along.real, along.imag, 0.0)
        whole = joined(node.weights) if node.weights else weight(0.0)
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

    def _rotation(self, node: _Node) -> Real:
        """Angle of a body and its rate; a block turns with its link."""
        link = node.label if node.slide is None else self._mechanism.slides[node.slide].link
        if link == GROUND:
            return np.zeros((2, self._driven.input.shape[-1]))
        return np.asarray(self._driven.angles[link][:2])

    def _coordinate(self, node: _Node) -> Real:
        """The joint coordinate of a body and its rate, shape (2, n + 1)."""
        if node.along is not None:
            name = self._mechanism.slide_names[node.along]
            return np.asarray(node.carried * self._scale * self._driven.slides[name][:2])
        relative = self._rotation(node) - self._rotation(self._nodes[node.parent])
        return np.stack([np.unwrap(relative[0]), relative[1]])

    def _input_body(self) -> str:
        mechanism = self._mechanism
        if not mechanism.driven_by_slide:
            return self._links[mechanism.input]
        return next(
            name
            for name in self._order
            if (number := self._nodes[name].slide) is not None
            and mechanism.slides[number].joint == mechanism.input
            and mechanism.slides[number].link == GROUND
        )

    def _relation(self, number: int) -> Relation:
        """A gear pair: the second link's turn less the ratio times the first one's, both against the ground."""
        gear = self._mechanism.gears[number]
        terms: dict[str, float] = {}
        for link, weighed in ((gear.second, 1.0), (gear.first, -gear.ratio)):
            name = self._links[link]
            while name != GROUND:
                node = self._nodes[name]
                if node.sort == "hinge":
                    terms[name] = terms.get(name, 0.0) + weighed
                name = node.parent
        kept = tuple((name, value) for name, value in terms.items() if value != 0.0)
        return Relation(f"gears_{number + 1}", kept)
