"""The plain twin of the compiled sweep that drives mechanisms: the same closures by NumPy, quantity by quantity.

Jets are arrays whose first axis holds value, velocity, acceleration and jerk, or the first few of them.
"""

from math import comb
from typing import NamedTuple

import numpy as np

from kinematics.linkage.kernels import TOGGLE_SINE
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import MechanismMotion
from kinematics.linkage.planar.drive_kernels import COINCIDENCE_TOLERANCE, LIMIT_TOLERANCE
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.linkage.planar.program import compute_unit_frame, find_assembly_signs


def product(a, b):
    """Product of two jets of one length."""
    rows = [sum(comb(n, k) * a[k] * b[n - k] for k in range(n + 1)) for n in range(len(a))]
    return np.stack(rows)


def turn(angle):
    """e^{iφ} of a real jet φ."""
    u = np.exp(1j * angle[0])
    rows = [u]
    if len(angle) > 1:
        w = angle[1]
        rows.append(1j * w * u)
    if len(angle) > 2:
        alpha = angle[2]
        rows.append((1j * alpha - w * w) * u)
    if len(angle) > 3:
        rows.append((1j * (angle[3] - w**3) - 3.0 * w * alpha) * u)
    return np.stack(rows)


def angle_of(direction):
    """Jet of the angle of a jet that does not vanish; its length may change."""
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = direction / direction[0]
    rows = [np.angle(direction[0])]
    if len(unit) > 1:
        rows.append(unit[1].imag)
    if len(unit) > 2:
        rows.append((unit[2] - unit[1] * unit[1]).imag)
    if len(unit) > 3:
        rows.append((unit[3] - 3.0 * unit[1] * unit[2] + 2.0 * unit[1] ** 3).imag)
    return np.stack(rows)


class Angle(NamedTuple):
    """The angle's jet, the sine that vanishes at its limit, and the jet of |k|² − r²."""

    rotation: np.ndarray
    sine: np.ndarray
    margin: np.ndarray


def solve_angle(k, r, sign, reach, slack=0.0):
    """Angle φ with Re(e^{−iφ} k) = r by arctangents: φ = κ − sign · arccos(r / |k|)."""
    length = np.abs(k[0])
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = (length - r[0]) * (length + r[0])
        margin = [excess]
        if len(k) > 1:
            margin.append(2.0 * ((np.conj(k[0]) * k[1]).real - r[0] * r[1]))
        exists = (excess >= -LIMIT_TOLERANCE * length * np.maximum(length, slack)) & (
            length > COINCIDENCE_TOLERANCE * reach
        )
        root = np.sqrt(np.where(exists, np.maximum(excess, 0.0), np.nan))
        rows = [np.angle(k[0]) - sign * np.arctan2(root, r[0])]
        determinant = sign * root
        if len(k) > 1:
            e = np.exp(-1j * rows[0])
            sound = (root > TOGGLE_SINE * length) & (length > TOGGLE_SINE * reach)
            scale = np.where(sound, 1.0 / determinant, np.nan)
            w = (r[1] - (e * k[1]).real) * scale
            rows.append(w)
        if len(k) > 2:
            alpha = (r[2] - (e * (k[2] - 2j * w * k[1] - w * w * k[0])).real) * scale
            rows.append(alpha)
        if len(k) > 3:
            third = k[3] - 3j * w * k[2] - 3.0 * (1j * alpha + w * w) * k[1] + (1j * w**3 - 3.0 * w * alpha) * k[0]
            rows.append((r[3] - (e * third).real) * scale)
        sine = determinant / length
    return Angle(np.stack(rows), sine, np.stack(margin))


class Pose(NamedTuple):
    """Jets of a link's rotation φ from the reference, of e^{iφ}, and of where the origin has gone."""

    rotation: np.ndarray
    unit: np.ndarray
    shift: np.ndarray

    def carry(self, point):
        return self.unit * point[..., None] + self.shift


def drive(mechanism, input, rates, signs=None):
    """As :func:`kinematics.linkage.planar.drive.drive` for a mechanism that closes by dyads."""
    return _Drive(mechanism, input, rates, signs).run()


class _Drive:
    """One run through the closures: what is known so far, as poses and joints in unit coordinates."""

    def __init__(self, mechanism, input, rates, signs):
        self.mechanism, self.steps = mechanism, decompose(mechanism).steps
        self.signs = find_assembly_signs(mechanism, self.steps) if signs is None else signs
        self.frame = compute_unit_frame(mechanism)
        given = [np.asarray(x, float) for x in (input, *rates)]
        signs_shape = np.broadcast_shapes(*(np.shape(sign) for sign in self.signs))
        self.shape = np.broadcast_shapes((*mechanism.shape, 1), (*signs_shape, 1), *(x.shape for x in given))
        self.input = np.stack([np.broadcast_to(x, self.shape) for x in given])
        self.length = len(self.input)
        self.poses, self.points, self.sines, self.margins = {}, {}, {}, {}

    def run(self):
        still = np.zeros((self.length, *self.shape), np.complex128)
        unmoved = still.copy()
        unmoved[0] = 1.0
        self._know(GROUND, Pose(still.real, unmoved, still))
        self._know_input()
        for step, sign in zip(self.steps, self.signs, strict=True):
            getattr(self, f"_{step.kind}")(step, np.asarray(sign)[..., None])
        valid = np.all([np.isfinite(p[0]) for p in self.points.values()], axis=0)
        smooth = valid & np.all([np.isfinite(p).all(axis=0) for p in self.points.values()], axis=0)
        return self._result(valid, smooth)

    def _know(self, link, pose):
        self.poses[link] = pose
        for joint in self.mechanism.links[link]:
            if joint not in self.points:
                self.points[joint] = pose.carry(self.frame.joints[joint])

    def _know_input(self):
        mechanism = self.mechanism
        moved = self.input.copy()
        moved[0] -= mechanism.reference_input[..., None]
        if mechanism.has_slide_input:
            slide = next(s for s in mechanism.slides if s.joint == mechanism.input and s.link == GROUND)
            along = np.exp(1j * slide.angle)[..., None] / self.frame.size[..., None]
            point = moved * along
            point[0] += self.frame.joints[mechanism.input][..., None]
            self.points[mechanism.input] = point
        else:
            self._turn(mechanism.input, mechanism.input_pivot, moved)

    def _turn(self, link, pin, rotation):
        """A link that turns by ``rotation`` about a known pin."""
        unit = turn(rotation)
        shift = self.points[pin] - unit * self.frame.joints[pin][..., None]
        self._know(link, Pose(rotation, unit, shift))

    def _gear(self, step, _sign):
        self._turn(step.link, step.pin, step.ratio * self.poses[step.other].rotation)

    def _carried(self, step, _sign):
        self._turn_towards(step.link, step.pin, step.joint)

    def _turn_towards(self, link, pin, joint):
        """A link on two known joints."""
        reference = self.frame.joints[joint] - self.frame.joints[pin]
        rotation = angle_of((self.points[joint] - self.points[pin]) / reference[..., None])
        self._turn(link, pin, rotation)

    def _RRP(self, step, sign):
        assert step.slide is not None
        pose, normal, on_line = self._line(step.slide)
        arm = (self.frame.joints[step.joint] - self.frame.joints[step.pin])[..., None]
        normals = pose.unit * normal
        gap = pose.carry(on_line) - self.points[step.pin]
        self._close(
            step, normals * np.conj(arm), product(np.conj(normals), gap).real, sign, np.abs(arm), np.abs(arm) ** 2
        )

    def _RPR(self, step, sign):
        assert step.slide is not None
        index = self.mechanism.slides.index(step.slide)
        normal = (1j * np.exp(1j * step.slide.angle))[..., None]
        on_line = self.frame.lines[index] - self.frame.joints[step.pin]
        reach = (np.conj(normal) * on_line[..., None]).real
        r = np.zeros((self.length, *self.shape))
        r[0] = reach
        self._close(step, np.conj(normal) * (self.points[step.joint] - self.points[step.pin]), r, sign, 1.0, 1.0)

    def _RRR(self, step, sign):
        """Both links by the law of cosines; of the two rotations the shorter link's own is the better one."""
        first = (self.frame.joints[step.joint] - self.frame.joints[step.pin])[..., None]
        second = (self.frame.joints[step.joint] - self.frame.joints[step.other_pin])[..., None]
        base = self.points[step.other_pin] - self.points[step.pin]
        half = product(base, np.conj(base)).real / 2.0
        difference = (np.abs(first) - np.abs(second)) * (np.abs(first) + np.abs(second)) / 2.0
        one, other = half.copy(), half.copy()
        one[0] += difference
        other[0] -= difference
        slack = 2.0 * half[0]
        mine = solve_angle(np.conj(first) * base, one, sign, np.abs(first), slack)
        theirs = solve_angle(-np.conj(second) * base, other, -sign, np.abs(second), slack)
        shorter = np.broadcast_to(np.abs(second) < np.abs(first), self.shape)
        joint = np.where(
            shorter,
            self._tip(step.other_pin, theirs.rotation, second),
            self._tip(step.pin, mine.rotation, first),
        )
        toward_mine = angle_of((joint - self.points[step.pin]) / first)
        toward_theirs = angle_of((joint - self.points[step.other_pin]) / second)
        self._turn(step.link, step.pin, np.where(shorter, toward_mine, mine.rotation))
        self._turn(step.other, step.other_pin, np.where(shorter, theirs.rotation, toward_theirs))
        # sin of the angle between the two links: the base's part of |k| is not the force's
        with np.errstate(divide="ignore", invalid="ignore"):
            by_mine, by_theirs = (
                sine * np.abs(base[0]) / np.abs(arm) for sine, arm in ((mine.sine, second), (-theirs.sine, first))
            )
        self.sines[step.link] = np.where(shorter, by_theirs, by_mine)
        square = np.abs(first * second) ** 2
        self.margins[step.link] = np.where(shorter, theirs.margin, mine.margin) / square

    def _tip(self, pin, rotation, arm):
        """The far end of a link that turns by ``rotation`` about a known pin."""
        return self.points[pin] + turn(rotation) * arm

    def _close(self, step, k, r, sign, reach, square):
        angle = solve_angle(k, r, sign, reach)
        self.sines[step.link], self.margins[step.link] = angle.sine, angle.margin / square
        self._turn(step.link, step.pin, angle.rotation)

    def _line(self, slide):
        index = self.mechanism.slides.index(slide)
        return self.poses[slide.link], (1j * np.exp(1j * slide.angle))[..., None], self.frame.lines[index]

    def _result(self, valid, smooth):
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
