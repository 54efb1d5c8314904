"""The elimination dyad by dyad in plain numpy, by names and complex numbers, all positions at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinematics.dynamics import JointForce, Machine, PointForce, Torque
from kinematics.linkage.planar.closures import Step, decompose
from kinematics.linkage.planar.drive import find_assembly_signs
from kinematics.linkage.planar.mechanism import GROUND, Mechanism

Jet = tuple[Any, Any, Any]


def cross(u: Any, v: Any) -> Any:
    return u.real * v.imag - u.imag * v.real


def dot(u: Any, v: Any) -> Any:
    return u.real * v.real + u.imag * v.imag


class Twin:
    """A machine moved to inputs (S + (N,)) at constant speed: drive, largest pin force, shaking force and moment."""

    def __init__(self, machine: Machine, at: Any, speed: float) -> None:
        self.machine, self.mechanism = machine, machine.mechanism
        self.place = {joint: z[..., None] for joint, z in self.mechanism.joints.items()}
        still = np.zeros(at.shape)
        self.turn: dict[str, Jet] = {GROUND: (still + 1.0, still, still)}
        self.base = {GROUND: ""}
        self.moving: dict[str, Jet] = {}
        self.given: dict[str, list[str]] = {}
        self.largest = still.copy()
        self.input = np.stack([at, still + speed, still])
        mechanism, steps = self.mechanism, decompose(self.mechanism).steps
        moved = at - np.asarray(mechanism.reference_input)[..., None]
        if mechanism.has_slide_input:
            self.line = next(s for s in mechanism.slides if s.joint == mechanism.input and s.link == GROUND)
            along = np.exp(1j * self.line.angle)[..., None]
            self.moving[mechanism.input] = (self.place[mechanism.input] + moved * along, speed * along + still, still)
        self._know(GROUND, "")
        if not mechanism.has_slide_input:
            self.turn[mechanism.input] = (np.exp(1j * moved), still + speed, still)
            self.angle = {mechanism.input: moved}
            self._know(mechanism.input, mechanism.input_pivot)
        for step, sign in zip(steps, find_assembly_signs(mechanism, steps), strict=True):
            self._close(step, sign[..., None])
        self._reactions(steps)

    def _arm(self, link: str, joint: str) -> Any:
        return self.turn[link][0] * (self.place[joint] - self.place[self.base[link]])

    def _point(self, link: str, place: Any) -> Jet:
        u, w, alpha = self.turn[link]
        if link == GROUND:
            return place + 0.0 * u, 0.0 * u, 0.0 * u
        z, v, a = self.moving[self.base[link]]
        arm = u * (place - self.place[self.base[link]])
        return z + arm, v + 1j * w * arm, a + (1j * alpha - w**2) * arm

    def _know(self, link: str, base: str) -> None:
        self.base[link] = base
        self.given[link] = [joint for joint in self.mechanism.links[link] if joint not in self.moving]
        for joint in self.given[link]:
            self.moving[joint] = self._point(link, self.place[joint])

    def _close(self, step: Step, sign: Any) -> None:
        link, place, (z, v, a) = step.link, self.place, self.moving[step.pin]
        if step.kind == "gear":
            rotation = self.angle.get(step.other, np.angle(self.turn[step.other][0]))
            self.angle[link] = step.ratio * rotation
            self.turn[link] = (
                np.exp(1j * self.angle[link]),
                step.ratio * self.turn[step.other][1],
                step.ratio * self.turn[step.other][2],
            )
        elif step.kind == "RRR":
            y, vy, ay = self.moving[step.other_pin]
            one, two = place[step.joint] - place[step.pin], place[step.joint] - place[step.other_pin]
            square = np.abs(y - z) ** 2
            along = 0.5 * (square + np.abs(one) ** 2 - np.abs(two) ** 2)
            p = (y - z) * (along - 1j * sign * np.sqrt(np.abs(one) ** 2 * square - along**2)) / square
            q = p - (y - z)
            w, w2 = dot(vy - v, q) / cross(p, q), dot(vy - v, p) / cross(p, q)
            g = ay - a + w**2 * p - w2**2 * q
            self.turn[link] = (p / one, w, dot(g, q) / cross(p, q))
            self.turn[step.other] = (q / two, w2, dot(g, p) / cross(p, q))
        else:
            assert step.slide is not None
            normal, point = 1j * np.exp(1j * step.slide.angle)[..., None], step.slide.point[..., None]
            arm = place[step.joint] - place[step.pin]
            if step.kind == "RRP":
                u, w_line, _ = self.turn[step.slide.link]
                n = u * normal
                h = dot(n, self._point(step.slide.link, point)[0] - z)
                p = n * (h - 1j * sign * np.sqrt(np.abs(arm) ** 2 - h**2))
                # The point of the line that the joint passes, as one of its link.
                passed = (z + p - self._point(step.slide.link, point)[0]) / u + point
                _, v_line, a_line = self._point(step.slide.link, passed)
                w = dot(n, v_line - v) / cross(p, n)
                slip = dot(-1j * n, v + 1j * w * p - v_line)
                alpha = (dot(n, a_line - a + w**2 * p) + 2.0 * w_line * slip) / cross(p, n)
                self.turn[link] = (p / arm, w, alpha)
            else:
                y, vy, ay = self.moving[step.joint]
                h, p = dot(normal, point - place[step.pin]), y - z
                n = p * (h - 1j * sign * np.sqrt(np.abs(p) ** 2 - h**2)) / np.abs(p) ** 2
                w = -dot(n, vy - v) / cross(n, p)
                alpha = (w**2 * h - dot(n, ay - a) - 2.0 * w * cross(n, vy - v)) / cross(n, p)
                self.turn[link] = (n / normal, w, alpha)
        self._know(link, step.pin)
        if step.kind == "RRR":
            self._know(step.other, step.other_pin)

    def _reactions(self, steps: tuple[Step, ...]) -> None:
        machine, moving, none = self.machine, self.moving, 0j * self.largest
        pins = {joint: none.copy() for joint in moving}
        for joint, mass in machine.pin_masses.items():
            pins[joint] += np.asarray(mass)[..., None] * (machine.gravity - moving[joint][2])
        force = {link: none.copy() for link in self.turn}
        couple = {link: none.real.copy() for link in self.turn}
        for link, part in machine.bodies.items():
            at, _, a = self._point(link, np.asarray(part.cg)[..., None])
            needed = np.asarray(part.mass)[..., None] * (a - machine.gravity)
            force[link] += needed
            couple[link] += cross(at - moving[self.base[link]][0], needed)
            couple[link] += np.asarray(part.inertia)[..., None] * self.turn[link][2]
        for load in machine.loads:
            assert isinstance(load, PointForce | JointForce | Torque)
            strength = load.course(self.input)
            if isinstance(load, Torque):
                couple[load.link] -= strength
            elif isinstance(load, JointForce):
                pins[load.joint] += strength
            else:
                strength = strength * self.turn[load.link][0] if load.turning else strength
                at = self._point(load.link, np.asarray(load.place)[..., None])[0]
                force[load.link] -= strength
                couple[load.link] -= cross(at - moving[self.base[load.link]][0], strength)

        def felt(push: Any) -> Any:
            self.largest = np.maximum(self.largest, np.abs(push))
            return push

        def gather(link: str, but: str) -> None:
            for joint in self.given[link]:
                if joint != but:
                    force[link] -= felt(pins[joint])
                    couple[link] -= cross(moving[joint][0] - moving[self.base[link]][0], pins[joint])

        ground, moment = none.copy(), self.largest.copy()
        for step in reversed(steps):
            link = step.link
            gather(link, step.joint if step.kind in ("RRR", "RRP") else "")
            push = none
            if step.kind == "RRR":
                gather(step.other, "")
                p, q = (moving[step.joint][0] - moving[pin][0] for pin in (step.pin, step.other_pin))
                on_other = (couple[step.other] * p + (couple[link] - cross(p, pins[step.joint])) * q) / cross(q, p)
                pins[step.other_pin] -= felt(force[step.other] - felt(on_other))
                push = felt(pins[step.joint] - on_other)
            elif step.kind == "gear":
                moment = moment - couple[link] * (1.0 if step.other == GROUND else 1.0 - step.ratio)
                couple[step.other] += step.ratio * couple[link]
            else:
                assert step.slide is not None
                on = step.slide.link
                n = self.turn[on][0] * 1j * np.exp(1j * step.slide.angle)[..., None]
                p = moving[step.joint][0] - moving[step.pin][0]
                if step.kind == "RRP":
                    normal = (couple[link] - cross(p, pins[step.joint])) / cross(p, n) * n
                    push = felt(pins[step.joint] + normal)
                    if on == GROUND:
                        ground, moment = ground - normal, moment - cross(moving[step.joint][0] - machine.about, normal)
                    else:
                        force[on] += normal
                        couple[on] += cross(moving[step.joint][0] - moving[self.base[on]][0], normal)
                else:
                    push = couple[link] / cross(p, n) * n
                    pins[step.joint] -= push
            pins[step.pin] -= felt(force[link] - push)
        mechanism = self.mechanism
        if mechanism.has_slide_input:
            left, joint = pins[mechanism.input], moving[mechanism.input][0]
            self.drive = -dot(np.exp(1j * self.line.angle)[..., None], left)
            ground, moment = ground + left, moment + cross(joint - machine.about, left)
        else:
            gather(mechanism.input, "")
            pins[mechanism.input_pivot] -= felt(force[mechanism.input])
            self.drive = couple[mechanism.input]
            moment = moment - self.drive
        for joint in self.given[GROUND]:
            ground, moment = ground + felt(pins[joint]), moment + cross(moving[joint][0] - machine.about, pins[joint])
        self.shaking_force, self.shaking_moment = ground, moment


def makes(mechanism: Mechanism) -> bool:
    """Whether nothing but dyads, gears and slides closes it."""
    found = decompose(mechanism)
    return not found.left and all(step.kind != "carried" for step in found.steps)
