"""A mechanism in the layout of the compiled sweep: its closures as rows of numbers, its designs in unit coordinates.

Unit coordinates have their origin at the reference position of the first ground joint and the size of the mechanism as
unit, so that tolerances are relative and a far origin does not cost digits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Integers, Real, Scalar
from kinematics.linkage.fourbar.closed_form import require
from kinematics.linkage.planar import drive_kernels as kernels
from kinematics.linkage.planar.closures import CACHE_SIZE, Step, decompose
from kinematics.linkage.planar.mechanism import GROUND, MIN_LENGTH, Mechanism, TopologyError

KIND_CODES = {
    "gear": kernels.GEAR,
    "carried": kernels.CARRIED_LINK,
    "RRP": kernels.RRP,
    "RPR": kernels.RPR,
    "RRR": kernels.RRR,
}


@dataclass(frozen=True)
class Frame:
    """Unit coordinates of a mechanism: origin and size, shape S, and the joints and slides in them."""

    origin: Complex
    size: Real
    joints: dict[str, Complex]
    lines: dict[int, Complex]


class Program(NamedTuple):
    """A mechanism's closures in order, the names behind the kernel's numbers, and the kernel's ``code``.

    ``links`` are in the kernel's order, the ground first. ``closing`` are the links with two assemblies, ``signs`` the
    reference's assemblies by step, ``reference_input`` the inputs there, shape (M,).
    """

    steps: tuple[Step, ...]
    class_iii: bool
    links: tuple[str, ...]
    closing: tuple[str, ...]
    signs: tuple[Integers, ...]
    reference_input: Real
    code: kernels.Code


@lru_cache(maxsize=CACHE_SIZE)
def compute_unit_frame(mechanism: Mechanism) -> Frame:
    """Compute the mechanism's unit coordinates."""
    origin, size = mechanism.frame
    joints = {name: np.asarray((z - origin) / size) for name, z in mechanism.joints.items()}
    lines = {k: np.asarray((s.point - origin) / size) for k, s in enumerate(mechanism.slides)}
    return Frame(origin, size, joints, lines)


def find_assembly_signs(mechanism: Mechanism, steps: tuple[Step, ...]) -> tuple[Integers, ...]:
    """Find the reference's assembly at every closure, shape S each: +1 or −1; +1 if the reference is at a limit."""
    frame = compute_unit_frame(mechanism)
    signs = []
    for step in steps:
        if not step.has_two_solutions:
            signs.append(np.ones(mechanism.shape, np.int64))
            continue
        k = _compute_reference_k(frame, mechanism, step)
        # Im k = 0 at a limit, where both assemblies agree.
        signs.append(np.where(k.imag < 0.0, -1, 1))
    return tuple(signs)


def _compute_reference_k(frame: Frame, mechanism: Mechanism, step: Step) -> Complex:
    pin = frame.joints[step.pin]
    if step.kind == "RRR":
        return np.asarray(np.conj(frame.joints[step.joint] - pin) * (frame.joints[step.other_pin] - pin))
    assert step.slide is not None
    normal = 1j * np.exp(1j * step.slide.angle)
    arm = frame.joints[step.joint] - pin
    return np.asarray(normal * np.conj(arm) if step.kind == "RRP" else np.conj(normal) * arm)


@lru_cache(maxsize=CACHE_SIZE)
def build_program(mechanism: Mechanism) -> Program:
    """Build the program of a mechanism.

    Raises
    ------
    DimensionError
        For a link without length between the joints by which it closes.
    """
    decomposition, frame = decompose(mechanism), compute_unit_frame(mechanism)
    # A class III group is solved as a whole, so single closures are not used.
    steps = () if decomposition.left else decomposition.steps
    for step in steps:
        _check_arms(frame, step)
    links = (GROUND, *(link for link in mechanism.links if link != GROUND))
    numbers = _Numbers(mechanism, links)
    driver = numbers.drive()
    closing: list[str] = []
    rows: list[tuple[int, ...]] = []
    for step in steps:
        rows.append(numbers.row(step, len(closing) if step.has_two_solutions else -1))
        closing += [step.link] if step.has_two_solutions else []
    if decomposition.left:
        rows = numbers.tree()
    designs = int(np.prod(mechanism.shape, dtype=np.int64))

    def stack_rows(values: Sequence[ArrayLike], dtype: type[Scalar]) -> NDArray[Scalar]:
        out = np.empty((designs, len(values)), dtype)
        for n, value in enumerate(values):
            out[:, n] = np.broadcast_to(value, mechanism.shape).ravel()
        return out

    code = kernels.Code(
        np.array(rows, np.int64).reshape(len(rows), 8),
        np.array([step.ratio for step in steps] or [0.0] * len(rows)),
        numbers.gives,
        stack_rows(list(frame.joints.values()), np.complex128),
        stack_rows(list(frame.lines.values()), np.complex128),
        stack_rows([s.angle for s in mechanism.slides], np.float64),
        stack_rows([0.0, *(mechanism.link_angle(link) for link in links[1:])], np.float64),
        stack_rows([frame.origin, frame.size], np.complex128),
        np.array([(numbers.joint[s.joint], numbers.link[s.link]) for s in mechanism.slides], np.int64).reshape(-1, 2),
        np.array(driver, np.int64),
    )
    signs, reference_input = find_assembly_signs(mechanism, steps), mechanism.reference_input.ravel()
    return Program(steps, bool(decomposition.left), links, tuple(closing), signs, reference_input, code)


class _Numbers:
    """Numbers of links, joints and slides, and the joints determined by each link, in the order of the rows."""

    def __init__(self, mechanism: Mechanism, links: tuple[str, ...]) -> None:
        self.mechanism = mechanism
        self.links = links
        self.link = {name: n for n, name in enumerate(links)}
        self.joint = {name: n for n, name in enumerate(mechanism.joints)}
        self.gives = np.zeros((len(links), len(self.joint) + 1), np.int64)
        self.known: set[str] = set()
        self._mark_known(GROUND)

    def _mark_known(self, link: str) -> None:
        joints = [joint for joint in self.mechanism.links[link] if joint not in self.known]
        self.known.update(joints)
        self.gives[self.link[link], : len(joints) + 1] = len(joints), *(self.joint[joint] for joint in joints)

    def drive(self) -> list[int]:
        """Return the kernel's ``driver``, and mark the joints that the input determines as known."""
        mechanism = self.mechanism
        if not mechanism.has_slide_input:
            self._mark_known(mechanism.input)
            return [self.link[mechanism.input], self.joint[mechanism.input_pivot], -1]
        slide = next(n for n, s in enumerate(mechanism.slides) if s.joint == mechanism.input and s.link == GROUND)
        self.known.add(mechanism.input)
        return [-1, self.joint[mechanism.input], slide]

    def row(self, step: Step, closing: int) -> tuple[int, ...]:
        """Return the row of a closure, and mark the joints that it determines as known."""
        slide, other = -1, step.other
        if step.slide is not None:
            slide = next(n for n, s in enumerate(self.mechanism.slides) if s is step.slide)
            other = step.slide.link
        self._mark_known(step.link)
        if step.kind == "RRR":
            self._mark_known(step.other)
        joint, pin = self.joint.get(step.joint, -1), self.joint[step.pin]
        other_pin = self.joint.get(step.other_pin, -1)
        return (
            KIND_CODES[step.kind],
            self.link[step.link],
            pin,
            joint,
            self.link.get(other, -1),
            other_pin,
            slide,
            closing,
        )

    def tree(self) -> list[tuple[int, ...]]:
        """Return rows of links with given rotations, each on a joint that is known by then.

        Raises
        ------
        TopologyError
            For links that only slides hold, such as the yoke of a Scotch yoke: no rotation determines their position.
        """
        rows: list[tuple[int, ...]] = []
        waiting = [link for link in self.links if link not in (GROUND, self.mechanism.input)]
        while waiting:
            link = next((w for w in waiting if self.known & set(self.mechanism.links[w])), None)
            if link is None:
                raise TopologyError("kinematics-links-held-by-slides", links=", ".join(waiting))
            pin = next(joint for joint in self.mechanism.links[link] if joint in self.known)
            rows.append((kernels.GIVEN_ROTATION, self.link[link], self.joint[pin], -1, -1, -1, -1, -1))
            self._mark_known(link)
            waiting.remove(link)
        return rows


def _check_arms(frame: Frame, step: Step) -> None:
    """Reject a link without length between the joints by which it closes: any rotation would fit."""
    arms = {"RRR": [(step.link, step.pin), (step.other, step.other_pin)], "RRP": [(step.link, step.pin)]}
    arms["carried"] = arms["RRP"]
    for link, pin in arms.get(step.kind, []):
        length = np.abs(frame.joints[step.joint] - frame.joints[pin])
        require(
            "kinematics-link-length", "kinematics-positive", length, length > MIN_LENGTH,
            link=link, first=pin, second=step.joint,
        )  # fmt: skip
