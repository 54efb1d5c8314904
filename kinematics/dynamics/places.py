"""Motion of points of links, given by their position in the reference configuration.

A link that has turned by φ moves the point p of the reference to q = z + (p − z₀) e^{iφ}, with z one of its joints and
z₀ that joint's position in the reference. Derivatives follow from those of z and φ (Norton, Sec. 6.7, 7.3).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.drive import MechanismMotion
from kinematics.linkage.planar.mechanism import GROUND, Mechanism

REST_SPEED = 1e-12
"""Speed, as a share of the mechanism's size times the input's speed, up to which a point counts as at rest."""


class Places:
    """A mechanism in motion, in any unit of length.

    Parameters
    ----------
    mechanism : Mechanism
        Designs of shape S.
    motion : MechanismMotion
        Its motion with two derivatives or more; arrays of shape S + (N,).
    scale : float
        The length unit of the mechanism, expressed in that of the results.
    """

    def __init__(self, mechanism: Mechanism, motion: MechanismMotion, scale: float = 1.0) -> None:
        self.mechanism = mechanism
        self.scale = scale
        self.smooth = motion.smooth
        # A slide's input is a length and scales like one; an angle does not.
        travelled = scale if mechanism.has_slide_input else 1.0
        self.input: Real = motion.input if travelled == 1.0 else travelled * motion.input
        self.joints: dict[str, Complex] = {name: scale * jet[:3] for name, jet in motion.joints.items()}
        self.slides: tuple[Real, ...] = tuple(scale * jet[:3] for jet in motion.slides.values())
        self._still = np.zeros((3, *motion.smooth.shape))
        self.spins: dict[str, Real] = {GROUND: self._still}
        for link, jet in motion.angles.items():
            spin = jet[:3].copy()
            # Rotation relative to the reference, not the absolute angle.
            spin[0] -= mechanism.link_angle(link)[..., None]
            self.spins[link] = spin

    @cached_property
    def size(self) -> Real:
        """Size of the mechanism (largest distance from its first joint), shape S + (1,)."""
        places = np.stack([self.reference(joint) for joint in self.mechanism.joints])
        size = np.abs(places - places[:1]).max(axis=0)
        # A degenerate mechanism must not divide by zero.
        return np.asarray(np.where(size > 0.0, size, 1.0))[..., None]

    @property
    def rest(self) -> Real:
        """Speed up to which a point counts as at rest."""
        speed = np.abs(self.input[1])
        return np.asarray(REST_SPEED * (speed if self.mechanism.has_slide_input else speed * self.size))

    @property
    def turning_rest(self) -> Real:
        """Angular speed up to which a link counts as at rest."""
        return np.asarray(self.rest / self.size)

    def reference(self, joint: str) -> Complex:
        """Return the position of a joint in the reference, shape S."""
        return np.asarray(self.scale * self.mechanism.joints[joint])

    def base(self, link: str) -> str:
        """Return the base joint of a moving link, to which its points are relative."""
        return self.mechanism.link_line(link)[0]

    @cached_property
    def turns(self) -> dict[str, Complex]:
        """Rotation factors e^{iφ} of the links, and their first two derivatives."""
        turns: dict[str, Complex] = {}
        for link, (angle, speed, acceleration) in self.spins.items():
            unit = np.exp(1j * angle)
            turns[link] = np.stack([unit, 1j * speed * unit, (1j * acceleration - speed**2) * unit])
        return turns

    def point(self, link: str, place: Complex) -> Complex:
        """Return position, velocity and acceleration of a point of a link, given by its position in the reference."""
        # The ground has no motion; its points keep their reference position.
        if link == GROUND:
            resting = self._still.astype(np.complex128)
            resting[0] = np.asarray(place)[..., None]
            return resting
        base = self.base(link)
        return np.asarray(self.joints[base] + (place - self.reference(base))[..., None] * self.turns[link])

    def direction(self, slide: int) -> Complex:
        """Return the direction of a slide's line, and its first two derivatives."""
        line = self.mechanism.slides[slide]
        return np.asarray(np.exp(1j * line.angle)[..., None] * self.turns[line.link])


def cross(arm: Complex, force: Complex) -> Real:
    """Return the moment of a force about the start of its arm."""
    return np.asarray(arm.real * force.imag - arm.imag * force.real)


def dot(one: Complex, two: Complex) -> Real:
    """Return the scalar product of two vectors."""
    return np.asarray(one.real * two.real + one.imag * two.imag)
