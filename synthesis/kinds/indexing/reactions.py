"""Motion and forces during an index, computed from the path of the roller instead of the closed forms.

Seen along the wheel's axis the roller is a point z(α) of the complex plane about that axis, and the slot is the ray
through it, so that the wheel's angle is arg z: φ' = Im(z'/z), and so on for higher derivatives of log z. The force on
the slot's side is square to the ray, with a moment about the wheel's axis that is the wheel's torque; its moment about
the crank's axis is the drive torque.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.indexing.geneva import Motion
from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar
from kinematics.linkage.planar.catalogue import make_fourbar as planar_fourbar
from kinematics.linkage.planar.drive import MechanismMotion, drive
from synthesis.kinds.indexing.design import GenevaMechanism, SphericalGenevaMechanism
from synthesis.kinds.indexing.forces import Load


@dataclass(frozen=True)
class DrivenIndex:
    """A drive over crank angles from the middle of an index.

    Attributes
    ----------
    place : complex128, shape (n,)
        The roller seen along the wheel's axis, which is the origin; the crank's axis is on +x.
    turn : float, shape (n,)
        Direction of the slot, radians.
    motion : Motion
        The wheel's angle from the middle, positive in its direction of rotation, and its derivatives.
    wheel_torque, pin_force, drive_torque : float, shape (n,)
    """

    place: Complex
    turn: Real
    motion: Motion
    wheel_torque: Real
    pin_force: Real
    drive_torque: Real


def drive_link(mechanism: GenevaMechanism, angle: Real) -> MechanismMotion:
    """Drive the drag link of a mechanism by the analysis core, over angles of its input, radians."""
    link = mechanism.drag_link
    assert link is not None
    pivots = complex(*link.input_pivot), complex(mechanism.center_distance)
    fourbar = Fourbar(pivots[0], pivots[1], link.input, link.coupler, link.output, 0j)
    # Its ground line points along −x, from the input's pivot to the crank's axis.
    return drive(planar_fourbar(fourbar, math.pi + float(angle[0]), OPEN_ASSEMBLY), math.pi + angle)


def compute_crank_motion(mechanism: GenevaMechanism | SphericalGenevaMechanism, angle: Real) -> Motion:
    """Compute the crank's angle from the middle of the index, and its derivatives by the input's angle (radians).

    A drag link is driven by the analysis core; otherwise the crank is the input.
    """
    if not isinstance(mechanism, GenevaMechanism) or mechanism.drag_link is None:
        return Motion(angle, np.ones_like(angle), np.zeros_like(angle), np.zeros_like(angle))
    moved = drive_link(mechanism, angle)
    output = moved.angles["output"]
    arm = moved.joints["B"][0] - mechanism.center_distance
    towards = math.pi if mechanism.type == "geneva_external" else 0.0
    first = float(np.angle(arm[0] * np.exp(1j * (math.radians(mechanism.drag_link.crank_offset) - towards))))
    return Motion(first + output[0] - output[0, 0], output[1], output[2], output[3])


def drive_roller(
    mechanism: GenevaMechanism | SphericalGenevaMechanism, load: Load, scale: float, angle: Real
) -> DrivenIndex:
    """Drive the roller of a mechanism through its slot.

    Parameters
    ----------
    mechanism : GenevaMechanism or SphericalGenevaMechanism
        Its dimensions only.
    load : Load
    scale : float
        The length unit in the unit of torque over force.
    angle : float, shape (n,)
        Input angles, radians: from the middle of the index for a crank, otherwise the drag link's own.
    """
    place, rates = _compute_path(mechanism, compute_crank_motion(mechanism, angle))
    # Derivatives of log z from those of z.
    first, second, third = (rate / place for rate in rates)
    sense = -1.0 if mechanism.type == "geneva_external" else 1.0
    motion = Motion(
        sense * np.angle(place),
        sense * first.imag,
        sense * (second - first**2).imag,
        sense * (third - 3.0 * first * second + 2.0 * first**3).imag,
    )
    torque = load.inertia * load.speed**2 * motion.a + load.torque
    force = torque / (scale * np.abs(place))
    # The unit vector normal to the slot, in the wheel's direction of rotation.
    along = sense * 1j * place / np.abs(place)
    # Power of the force at the roller's own velocity; the component along the slot does no work.
    drive = force * scale * (along.conj() * rates[0]).real
    return DrivenIndex(place, np.angle(place), motion, torque, force, drive)


def _compute_path(
    mechanism: GenevaMechanism | SphericalGenevaMechanism, crank: Motion
) -> tuple[Complex, list[Complex]]:
    """Compute the roller seen along the wheel's axis, and its three derivatives by the input's angle."""
    place, (first, second, third) = _compute_circle(mechanism, crank.s)
    return place, [
        first * crank.v,
        second * crank.v**2 + first * crank.a,
        third * crank.v**3 + 3.0 * second * crank.v * crank.a + first * crank.j,
    ]


def _compute_circle(
    mechanism: GenevaMechanism | SphericalGenevaMechanism, alpha: Real
) -> tuple[Complex, list[Complex]]:
    """Compute the roller and its derivatives by the crank's own angle."""
    if isinstance(mechanism, SphericalGenevaMechanism):
        cone = math.radians(mechanism.cone_angle)
        near, aside = mechanism.sphere_radius * math.cos(cone), mechanism.sphere_radius * math.sin(cone)
        sine, cosine = 1j * aside * np.sin(alpha), 1j * aside * np.cos(alpha)
        return near + sine, [cosine, -sine, -cosine]
    sense = 1.0 if mechanism.type == "geneva_external" else -1.0
    arm = -sense * mechanism.crank_radius * np.exp(1j * alpha)
    return mechanism.center_distance + arm, [1j * arm, -arm, -1j * arm]
