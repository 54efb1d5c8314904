"""Points of links in motion, by their places in the reference configuration.

A link that has turned by φ carries the point p of the reference to q = z + (p − z₀) e^{iφ}, z one of its joints and z₀
that joint's place in the reference. Derivatives follow from those of z and φ (Norton, Sec. 6.7, 7.3).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from kinematics.linkage.planar.drive import Jet, MechanismMotion, RealJet
from kinematics.linkage.planar.mechanism import GROUND, Complex, Mechanism, Real

REST = 1e-12
"""Speed, as a share of the mechanism's size times the input's speed, up to which a point is at rest: rounding."""


class Places:
    """A mechanism in motion, in lengths of a unit of one's choice.

    Parameters
    ----------
    mechanism : Mechanism
        Designs of shape S.
    motion : MechanismMotion
        Its motion with two derivatives or more; arrays of shape S + (N,).
    scale : float
        The unit of the mechanism's lengths in that of the results.
    """

    def __init__(self, mechanism: Mechanism, motion: MechanismMotion, scale: float = 1.0) -> None:
        self.mechanism = mechanism
        self.scale = scale
        self.smooth = motion.smooth
        travelled = scale if mechanism.driven_by_slide else 1.0
        self.input: RealJet = motion.input if travelled == 1.0 else travelled * motion.input
        self.joints: dict[str, Jet] = {name: scale * jet[:3] for name, jet in motion.joints.items()}
        self.slides: tuple[RealJet, ...] = tuple(scale * jet[:3] for jet in motion.slides.values())
        self._still = np.zeros((3, *motion.smooth.shape))
        self.spins: dict[str, RealJet] = {GROUND: self._still}
        for link, jet in motion.angles.items():
            spin = jet[:3].copy()
            spin[0] -= mechanism.link_angle(link)[..., None]
            self.spins[link] = spin

    @cached_property
    def size(self) -> Real:
        """The size of the mechanism, shape S + (1,)."""
        places = np.stack([self.reference(joint) for joint in self.mechanism.joints])
        size = np.abs(places - places[:1]).max(axis=0)
        return np.asarray(np.where(size > 0.0, size, 1.0))[..., None]

    @property
    def rest(self) -> Real:
        """Speed up to which a point is at rest."""
        speed = np.abs(self.input[1])
        return np.asarray(REST * (speed if self.mechanism.driven_by_slide else speed * self.size))

    @property
    def turning_rest(self) -> Real:
        """Rotational speed up to which a link is at rest."""
        return np.asarray(self.rest / self.size)

    def reference(self, joint: str) -> Complex:
        """The place of a joint in the reference, shape S."""
        return np.asarray(self.scale * self.mechanism.joints[joint])

    def base(self, link: str) -> str:
        """The joint of a moving link by which its points are told."""
        return self.mechanism.link_line(link)[0]

    @cached_property
    def turns(self) -> dict[str, Jet]:
        """e^{iφ} of every link, and two derivatives."""
        turns: dict[str, Jet] = {}
        for link, (angle, speed, acceleration) in self.spins.items():
            unit = np.exp(1j * angle)
            turns[link] = np.stack([unit, 1j * speed * unit, (1j * acceleration - speed**2) * unit])
        return turns

    def point(self, link: str, place: Complex) -> Jet:
        """A point of a link by its place (shape S) in the reference: place, velocity and acceleration."""
        if link == GROUND:
            resting = self._still.astype(np.complex128)
            resting[0] = np.asarray(place)[..., None]
            return resting
        base = self.base(link)
        return np.asarray(self.joints[base] + (place - self.reference(base))[..., None] * self.turns[link])

    def direction(self, slide: int) -> Jet:
        """The direction of a slide's line, and two derivatives."""
        line = self.mechanism.slides[slide]
        return np.asarray(np.exp(1j * line.angle)[..., None] * self.turns[line.link])


def cross(arm: Complex, force: Complex) -> Real:
    """Moment of a force on an arm."""
    return np.asarray(arm.real * force.imag - arm.imag * force.real)


def dot(one: Complex, two: Complex) -> Real:
    """Scalar product of two vectors."""
    return np.asarray(one.real * two.real + one.imag * two.imag)
