"""Driving a mechanism: positions, velocities, accelerations and jerks of every link and joint, closure by closure.

The work is done in unit coordinates: origin at the reference position of the first ground joint, unit the size of the
mechanism, so that tolerances are relative and digits are not lost to a far origin.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.linkage.closures import RECENT, Decomposition, Step, decompose
from kinematics.linkage.fourbar import ON_TOGGLE, one_shape, require
from kinematics.linkage.jets import Jet, RealJet, angle_of, product, solve_angle, turn
from kinematics.linkage.mechanism import GROUND, Complex, Mechanism, Real, Slide
from kinematics.linkage.triads import follow, loop_equations, rates

Mask = NDArray[np.bool_]
Signs = NDArray[np.int64]

AT_LIMIT = 16 * ON_TOGGLE
"""A margin this far below zero counts as zero, so that a mechanism exists at its own limits: a limit is known to the
rounding of an angle, which the margin's rate, up to some ten in unit coordinates, multiplies."""


class Pose(NamedTuple):
    """A link in motion: jets of its rotation φ from the reference, of e^{iφ}, and of where the origin has gone."""

    rotation: RealJet
    unit: Jet
    shift: Jet

    def carry(self, point: Complex) -> Jet:
        """Jet of a point of the link, given in the reference configuration; a trailing axis stands for the inputs."""
        moved: Jet = self.unit * point[..., None] + self.shift
        return moved


@dataclass(frozen=True)
class MechanismMotion:
    """What a mechanism does over designs × inputs; the first axis of a jet is value, velocity, acceleration, jerk.

    Attributes
    ----------
    valid : bool, shape S + (N,)
        Where the mechanism can be assembled; elsewhere positions are NaN.
    smooth : bool, shape S + (N,)
        Where derivatives exist too: valid and not at a toggle.
    input : float, shape (n,) + S + (N,)
        The input: angle of the input link, radians, or position along the slide.
    angles : dict of str to float, shape (n,) + S + (N,)
        Link angles, radians and rad/s^n: from the reference angle, continuous along the motion's sign choices.
    joints : dict of str to complex, shape (n,) + S + (N,)
        Joints in the mechanism's own coordinates and their derivatives per s^n.
    slides : dict of str to float, shape (n,) + S + (N,)
        Position of each slide's joint along its line, and its rates relative to the line's link.
    sines : dict of str to float, shape S + (N,)
        For each closure, by the name of its link: the sine that vanishes at its limit. Its magnitude is the sine of the
        transmission angle there; its sign changes from assembly to assembly.
    margins : dict of str to float, shape (2,) + S + (N,), or (1,) + S + (N,) without derivatives
        For each closure: a smooth function that is positive where it exists, zero at its limit and negative beyond, and
        its rate; NaN where the closures before it do not exist.
    """

    valid: Mask
    smooth: Mask
    input: RealJet
    angles: dict[str, RealJet]
    joints: dict[str, Jet]
    slides: dict[str, RealJet]
    sines: dict[str, Real]
    margins: dict[str, Real]


@dataclass(frozen=True)
class Frame:
    """Unit coordinates of a mechanism: origin and size, shape S, and the joints and slides in them."""

    origin: Complex
    size: Real
    joints: dict[str, Complex]
    lines: dict[int, Complex]


@lru_cache(maxsize=RECENT)
def unit_frame(mechanism: Mechanism) -> Frame:
    """The mechanism's unit coordinates."""
    ground = mechanism.links[GROUND]
    origin = mechanism.joints[ground[0]] if ground else next(iter(mechanism.joints.values()))
    spread = np.stack([np.abs(z - origin) for z in mechanism.joints.values()])
    size = spread.max(axis=0)
    size = np.where(size > 0.0, size, 1.0)
    joints = {name: np.asarray((z - origin) / size) for name, z in mechanism.joints.items()}
    lines = {k: np.asarray((s.point - origin) / size) for k, s in enumerate(mechanism.slides)}
    return Frame(np.asarray(origin), size, joints, lines)


def assembly_signs(mechanism: Mechanism, steps: tuple[Step, ...]) -> tuple[Signs, ...]:
    """The reference's choice at every closure, shape S each: +1 or −1; +1 where the reference is at a limit."""
    frame = unit_frame(mechanism)
    signs = []
    for step in steps:
        if not step.has_two_solutions:
            signs.append(np.ones(mechanism.shape, np.int64))
            continue
        k = _reference_k(frame, mechanism, step)
        signs.append(np.where(k.imag < 0.0, -1, 1))
    return tuple(signs)


def _check_arms(frame: Frame, step: Step) -> None:
    """Refuse a link that has no length between the joints by which it closes: any rotation would do."""
    arms = {"RRR": [(step.link, step.pin), (step.other, step.other_pin)], "RRP": [(step.link, step.pin)]}
    arms["carried"] = arms["RRP"]
    for link, pin in arms.get(step.kind, []):
        length = np.abs(frame.joints[step.joint] - frame.joints[pin])
        require(f"length of {link} from {pin} to {step.joint}", "positive", length, length > 0.0)


def _reference_k(frame: Frame, mechanism: Mechanism, step: Step) -> Complex:
    pin = frame.joints[step.pin]
    if step.kind == "RRR":
        return np.asarray(np.conj(frame.joints[step.joint] - pin) * (frame.joints[step.other_pin] - pin))
    assert step.slide is not None
    normal = 1j * np.exp(1j * step.slide.angle)
    arm = frame.joints[step.joint] - pin
    return np.asarray(normal * np.conj(arm) if step.kind == "RRP" else np.conj(normal) * arm)


def drive(
    mechanism: Mechanism,
    input: ArrayLike,
    *,
    speed: ArrayLike = 1.0,
    acceleration: ArrayLike = 0.0,
    jerk: ArrayLike = 0.0,
    signs: tuple[Signs, ...] | None = None,
    order: int = 3,
) -> MechanismMotion:
    """Drive a mechanism to inputs: by its dyadic closures, or by continuation from the reference where it has none.

    Parameters
    ----------
    mechanism : Mechanism
        Designs of shape S.
    input : float
        Absolute input angles, radians (or positions along the input slide), broadcasting with S + (1,); not reduced by
        full turns, which matters for gears.
    speed, acceleration, jerk : float
        Rates of the input, broadcasting with the inputs; with the defaults results are derivatives by the input.
    signs : tuple of int arrays, optional
        Assembly at each dyadic closure; the reference configuration's by default.
    order : int
        Highest derivative computed, 0 to 3; jets have the length ``order + 1``.

    Returns
    -------
    MechanismMotion
        Arrays of shape S + (N,).

    Raises
    ------
    TopologyError
        For a class III mechanism with slides or gears.
    DimensionError
        For an infinite input, signs other than +1 and −1 or not one for each closure, an order that is not 0 to 3, or a
        link without length between the joints by which it closes.
    ShapeError
        For inputs that do not broadcast.
    """
    require("order", "0, 1, 2 or 3", np.asarray(order), np.bool_(order in (0, 1, 2, 3)))
    return _Drive(mechanism, decompose(mechanism), input, (speed, acceleration, jerk)[:order], signs).run()


class _Drive:
    """One run through the closures: what is known so far, as poses and joints in unit coordinates."""

    def __init__(
        self,
        mechanism: Mechanism,
        decomposition: Decomposition,
        input: ArrayLike,
        rates: tuple[ArrayLike, ...],
        signs: tuple[Signs, ...] | None,
    ) -> None:
        self.mechanism, self.steps = mechanism, () if decomposition.left else decomposition.steps
        self.dyadic = not decomposition.left
        self.signs = assembly_signs(mechanism, self.steps) if signs is None else signs
        count = len(self.signs)
        require("signs", f"{len(self.steps)} arrays", np.asarray(count), np.bool_(count == len(self.steps)))
        for sign in self.signs:
            require("signs", "+1 or −1", np.asarray(sign), np.abs(sign) == 1)
        self.frame = unit_frame(mechanism)
        for step in self.steps:
            _check_arms(self.frame, step)
        q = np.asarray(input, np.float64)
        require("input", "finite", q, ~np.isinf(q))
        given = [np.asarray(rate, np.float64) for rate in rates]
        shape = one_shape(
            designs=(*mechanism.shape, 1),
            signs=(*np.broadcast_shapes(*(np.shape(s) for s in self.signs)), 1),
            input=q.shape,
            **{f"rate {n}": rate.shape for n, rate in enumerate(given, start=1)},
        )
        self.shape = shape
        self.input = np.stack([np.broadcast_to(x, shape) for x in (q, *given)])
        self.length = len(self.input)
        self.poses: dict[str, Pose] = {}
        self.points: dict[str, Jet] = {}
        self.sines: dict[str, Real] = {}
        self.margins: dict[str, Real] = {}

    def run(self) -> MechanismMotion:
        still = np.zeros((self.length, *self.shape), np.complex128)
        unmoved = still.copy()
        unmoved[0] = 1.0
        self._know(GROUND, Pose(still.real, unmoved, still))
        self._know_input()
        for step, sign in zip(self.steps, self.signs, strict=True):
            getattr(self, f"_{step.kind}")(step, np.asarray(sign)[..., None])
        if not self.dyadic:
            self._follow_loops()
        valid = np.all([np.isfinite(p[0]) for p in self.points.values()], axis=0)
        smooth = valid & np.all([np.isfinite(p).all(axis=0) for p in self.points.values()], axis=0)
        return self._result(valid, smooth)

    def _know(self, link: str, pose: Pose) -> None:
        self.poses[link] = pose
        for joint in self.mechanism.links[link]:
            if joint not in self.points:
                self.points[joint] = pose.carry(self.frame.joints[joint])

    def _know_input(self) -> None:
        mechanism = self.mechanism
        moved = self.input.copy()
        moved[0] -= mechanism.reference_input[..., None]
        if mechanism.driven_by_slide:
            slide = next(s for s in mechanism.slides if s.joint == mechanism.input and s.link == GROUND)
            along = np.exp(1j * slide.angle)[..., None] / self.frame.size[..., None]
            point = moved * along
            point[0] += self.frame.joints[mechanism.input][..., None]
            self.points[mechanism.input] = point
        else:
            self._turn(mechanism.input, mechanism.input_pivot, moved)

    def _turn(self, link: str, pin: str, rotation: RealJet) -> None:
        """A link that turns by ``rotation`` about a known pin."""
        unit = turn(rotation)
        shift = self.points[pin] - unit * self.frame.joints[pin][..., None]
        self._know(link, Pose(rotation, unit, shift))

    def _follow_loops(self) -> None:
        """All links of a class III mechanism, design by design."""
        mechanism = self.mechanism
        order = [link for link in mechanism.links if link not in (GROUND, mechanism.input)]
        rotations = np.full((len(order), self.length, *self.shape), np.nan)
        turned = self.input.copy()
        turned[0] -= mechanism.reference_input[..., None]
        for design in np.ndindex(*self.shape[:-1]):
            own = design[len(design) - len(mechanism.shape) :]
            index = tuple(n if size > 1 else 0 for n, size in zip(own, mechanism.shape, strict=True))
            loops = loop_equations(mechanism, {name: complex(z[index]) for name, z in self.frame.joints.items()})
            here = turned[(slice(None), *design)]
            angles = follow(loops, here[0])
            rotations[(slice(None), 0, *design)] = angles
            if self.length > 1:
                found = rates(loops, here[0], angles, here[1:])
                rotations[(slice(None), slice(1, self.length), *design)] = np.moveaxis(found, 0, 1)
        unknown = list(order)
        while unknown:
            link = next(w for w in unknown if any(joint in self.points for joint in mechanism.links[w]))
            pin = next(joint for joint in mechanism.links[link] if joint in self.points)
            self._turn(link, pin, rotations[order.index(link)])
            unknown.remove(link)

    def _gear(self, step: Step, _sign: Signs) -> None:
        self._turn(step.link, step.pin, step.ratio * self.poses[step.other].rotation)

    def _carried(self, step: Step, _sign: Signs) -> None:
        self._turn_towards(step.link, step.pin, step.joint)

    def _turn_towards(self, link: str, pin: str, joint: str) -> None:
        """A link on two known joints."""
        reference = self.frame.joints[joint] - self.frame.joints[pin]
        rotation = angle_of((self.points[joint] - self.points[pin]) / reference[..., None])
        self._turn(link, pin, rotation)

    def _RRP(self, step: Step, sign: Signs) -> None:
        assert step.slide is not None
        pose, normal, on_line = self._line(step.slide)
        arm = (self.frame.joints[step.joint] - self.frame.joints[step.pin])[..., None]
        normals = pose.unit * normal
        gap = pose.carry(on_line) - self.points[step.pin]
        self._close(step, normals * np.conj(arm), product(np.conj(normals), gap).real, sign)

    def _RPR(self, step: Step, sign: Signs) -> None:
        assert step.slide is not None
        index = self.mechanism.slides.index(step.slide)
        normal = (1j * np.exp(1j * step.slide.angle))[..., None]
        on_line = self.frame.lines[index] - self.frame.joints[step.pin]
        reach = (np.conj(normal) * on_line[..., None]).real
        r = np.zeros((self.length, *self.shape))
        r[0] = reach
        self._close(step, np.conj(normal) * (self.points[step.joint] - self.points[step.pin]), r, sign)

    def _RRR(self, step: Step, sign: Signs) -> None:
        first = (self.frame.joints[step.joint] - self.frame.joints[step.pin])[..., None]
        second = (self.frame.joints[step.joint] - self.frame.joints[step.other_pin])[..., None]
        base = self.points[step.other_pin] - self.points[step.pin]
        r = product(base, np.conj(base)).real / 2.0
        r[0] += (np.abs(first) - np.abs(second)) * (np.abs(first) + np.abs(second)) / 2.0
        self._close(step, np.conj(first) * base, r, sign)
        self._turn_towards(step.other, step.other_pin, step.joint)
        # sin of the angle between the two links: the base's part of |k| is not the force's
        with np.errstate(divide="ignore", invalid="ignore"):
            self.sines[step.link] = self.sines[step.link] * np.abs(base[0]) / np.abs(second)

    def _close(self, step: Step, k: Jet, r: RealJet, sign: Signs) -> None:
        angle = solve_angle(k, r, sign, AT_LIMIT)
        self.sines[step.link], self.margins[step.link] = angle.sine, angle.margin
        self._turn(step.link, step.pin, angle.rotation)

    def _line(self, slide: Slide) -> tuple[Pose, Complex, Complex]:
        index = self.mechanism.slides.index(slide)
        return self.poses[slide.link], (1j * np.exp(1j * slide.angle))[..., None], self.frame.lines[index]

    def _result(self, valid: Mask, smooth: Mask) -> MechanismMotion:
        mechanism, size, origin = self.mechanism, self.frame.size[..., None], self.frame.origin[..., None]
        known = np.stack([valid, smooth, smooth, smooth][: self.length])
        joints = {}
        for name in mechanism.joints:
            point = self.points[name] * size
            point[0] += origin
            joints[name] = np.where(known, point, np.complex128(complex(np.nan, np.nan)))
        angles = {}
        for link, pose in self.poses.items():
            if link == GROUND:
                continue
            angle = pose.rotation.copy()
            angle[0] += mechanism.link_angle(link)[..., None]
            angles[link] = np.where(known, angle, np.nan)
        slides = {}
        for k, slide in enumerate(mechanism.slides):
            pose, _, on_line = self._line(slide)
            along = np.exp(1j * slide.angle)[..., None]
            offset = self.points[slide.joint] - pose.carry(on_line)
            travel = product(np.conj(pose.unit * along), offset).real * size
            name = slide.joint if sum(s.joint == slide.joint for s in mechanism.slides) == 1 else f"{slide.joint}_{k}"
            slides[name] = np.where(known, travel, np.nan)
        sines = {link: np.where(valid, sine, np.nan) for link, sine in self.sines.items()}
        return MechanismMotion(valid, smooth, self.input, angles, joints, slides, sines, self.margins)


__all__ = ["Frame", "MechanismMotion", "Pose", "assembly_signs", "decompose", "drive", "unit_frame"]
