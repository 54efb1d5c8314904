"""Kinematics and reactions of a linkage built of dyads, closure by closure and back again: compiled.

Forwards each closure gives its links' rotations and two rates. With the arms p, q from the pins to the joint where two
links meet, velocities and accelerations v, a of the pins, and X = p × q,

    RRR   ω₁ = (v_q − v_p)·q / X,     ω₂ = (v_q − v_p)·p / X,
          α₁ = g·q / X,               α₂ = g·p / X,       g = a_q − a_p + ω₁² p − ω₂² q;

where a joint slides on a line with the normal n, in another link (RRP) or in its own (RPR), p × n takes the part of X.

Backwards, the last closure first, each link needs the resultant N of its pins' forces and their moment K about its pin
(Norton, *Design of Machinery*, eq. 11.1). What later links, masses and loads leave on a pin, f, is known by then:

    RRR   force of the joint on the second link  (K₂ p + (K₁ − p × f) q) / (q × p),
    RRP   normal force  λ = (K − p × f) / (p × n),
    RPR   λ = −K / (p × n),
    gear  the torque K on the link, −ratio K on the other.

The pins get what is left; the driving link, or the driving slide, comes last.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from kinematics.linkage.planar.drive_kernels import GEAR, JOINT, KIND, LINK, OTHER, OTHER_PIN, PIN, RRP, RRR, SLIDE

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Rows = NDArray[np.int64]

LEAST_SINE = 1e-7
"""Sine at a closure below which a position has no forces."""

ON_LINK, ON_JOINT = range(2)
"""What a load acts on."""

DRIVE, PIN_FORCE, SHAKING_X, SHAKING_Y, MOMENT = range(5)
"""Rows of the results."""

OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
"""How the kernels are compiled: products and sums may be fused, nothing else is relaxed."""

STEP: dict[str, Any] = OPTIONS | {"forceinline": True}
"""A step that is called in one place."""


@njit(**OPTIONS)
def eliminate(
    rows: Rows,
    ratios: Real,
    bases: Rows,
    exact: NDArray[np.bool_],
    carried: Rows,
    driver: Rows,
    joints: Complex,
    lines: Complex,
    normals: Complex,
    signs: Rows,
    mass: Real,
    cg: Complex,
    inertia: Real,
    pin_mass: Real,
    gravity: complex,
    on: Rows,
    arms: Complex,
    strengths: Complex,
    couples: Real,
    about: Complex,
    moved: Real,
    out: Real,
) -> None:
    """Fill drive, largest pin force, shaking force and moment of D designs at N inputs.

    Parameters
    ----------
    rows, ratios, driver
        Of :class:`~kinematics.linkage.planar.drive_kernels.Code`; links by number, 0 is the ground.
    bases : int, shape (links,)
        The pin of each link, about which its moments are taken.
    exact : bool, shape (links,)
        Links whose rotation is known beyond a full turn: the input, and what gears tie to it.
    carried : int, shape (links, 1 + joints)
        How many joints a link makes known, and which.
    joints : complex, shape (D, joints)
        In the reference.
    lines, normals : complex, shape (D, slides)
        A point of each slide's line, from the pin of the link that it is fixed in, and its normal; in the reference.
    signs : int, shape (steps, D)
        Assemblies.
    mass, cg, inertia : shape (D, links)
        Centres of gravity from the link's pin, in the reference.
    pin_mass : float, shape (D, joints)
    gravity : complex
    on : int, shape (loads, 3)
        A load acts on a link or a joint, which, and whether its components turn with the link.
    arms : complex, shape (D, loads)
        Where it acts on the link, from the link's pin, in the reference.
    strengths : complex, shape (loads, D, N)
    couples : float, shape (links, D, N), or (0, 0, 0)
        Torques on the links.
    about : complex, shape (D,)
        Point about which the shaking moment is taken.
    moved : float, shape (3, D, N)
        Rotation of the input from the reference (or its displacement), speed and acceleration.
    out : float, shape (5, D, N)
        Filled; NaN where a closure cannot be assembled or is a toggle.
    """
    links, count = len(bases), joints.shape[1]
    x, turn, angle = np.zeros((count, 6)), np.zeros((links, 4)), np.zeros(links)
    need, pins, fixed = np.zeros((links, 3)), np.zeros((count, 2)), np.zeros((len(rows), 8))
    turn[0, 0] = 1.0
    gx, gy = gravity.real, gravity.imag
    for d in range(joints.shape[0]):
        place = joints[d]
        for joint in range(count):
            x[joint, 0], x[joint, 1] = place[joint].real, place[joint].imag
            x[joint, 2:] = 0.0
        _reference(rows, place, lines[d], normals[d], bases, fixed)
        for at in range(moved.shape[2]):
            first = driver[0]
            if first < 0:
                joint = driver[1]
                normal = normals[d, driver[2]]
                for k in range(3):
                    x[joint, 2 * k] = moved[k, d, at] * normal.imag
                    x[joint, 2 * k + 1] = -moved[k, d, at] * normal.real
                x[joint, 0] += place[joint].real
                x[joint, 1] += place[joint].imag
            else:
                angle[first] = moved[0, d, at]
                turn[first, 0], turn[first, 1] = math.cos(angle[first]), math.sin(angle[first])
                turn[first, 2], turn[first, 3] = moved[1, d, at], moved[2, d, at]
                _carry(first, bases[first], place, carried, turn, x)
            if not _assemble(
                rows, ratios, bases, exact, carried, place, lines[d], normals[d], signs, d, fixed, x, turn, angle
            ):
                for k in range(5):
                    out[k, d, at] = np.nan
                continue
            for joint in range(count):
                m = pin_mass[d, joint]
                pins[joint, 0], pins[joint, 1] = m * (gx - x[joint, 4]), m * (gy - x[joint, 5])
            for link in range(1, links):
                base = bases[link]
                c, s, w, alpha = turn[link, 0], turn[link, 1], turn[link, 2], turn[link, 3]
                g = cg[d, link]
                rx, ry = c * g.real - s * g.imag, s * g.real + c * g.imag
                m = mass[d, link]
                fx = m * (x[base, 4] - w * w * rx - alpha * ry - gx)
                fy = m * (x[base, 5] - w * w * ry + alpha * rx - gy)
                need[link, 0], need[link, 1] = fx, fy
                need[link, 2] = inertia[d, link] * alpha + rx * fy - ry * fx
            for link in range(couples.shape[0]):
                need[link, 2] -= couples[link, d, at]
            for n in range(len(on)):
                force, which = strengths[n, d, at], on[n, 1]
                fx, fy = force.real, force.imag
                if on[n, 0] == ON_JOINT:
                    pins[which, 0] += fx
                    pins[which, 1] += fy
                    continue
                c, s, arm = turn[which, 0], turn[which, 1], arms[d, n]
                rx, ry = c * arm.real - s * arm.imag, s * arm.real + c * arm.imag
                if on[n, 2]:
                    fx, fy = c * force.real - s * force.imag, s * force.real + c * force.imag
                need[which, 0] -= fx
                need[which, 1] -= fy
                need[which, 2] -= rx * fy - ry * fx
            _give_back(rows, ratios, bases, carried, driver, normals[d], about[d], x, turn, need, pins, out, d, at)


@njit(**STEP)
def _reference(rows: Rows, place: Complex, line: Complex, normal: Complex, bases: Rows, fixed: Real) -> None:
    """What stays the same of a closure: the arms and the squares of their lengths; the line's distance of RPR."""
    for row in range(len(rows)):
        kind, pin, joint = rows[row, KIND], rows[row, PIN], rows[row, JOINT]
        if kind == GEAR:
            continue
        if kind not in (RRR, RRP):
            n = normal[rows[row, SLIDE]]
            offset = line[rows[row, SLIDE]]
            fixed[row, 0] = n.real * offset.real + n.imag * offset.imag
            continue
        arm = place[joint] - place[pin]
        fixed[row, 0], fixed[row, 1] = arm.real, arm.imag
        fixed[row, 2] = arm.real * arm.real + arm.imag * arm.imag
        fixed[row, 3] = 1.0 / fixed[row, 2]
        if kind == RRR:
            arm = place[joint] - place[rows[row, OTHER_PIN]]
            fixed[row, 4], fixed[row, 5] = arm.real, arm.imag
            fixed[row, 6] = arm.real * arm.real + arm.imag * arm.imag
            fixed[row, 7] = 1.0 / fixed[row, 6]


@njit(**OPTIONS)
def _carry(link: int, pin: int, place: Complex, carried: Rows, turn: Real, x: Real) -> None:
    """Places, velocities and accelerations of the joints that a link makes known."""
    c, s, w, alpha = turn[link, 0], turn[link, 1], turn[link, 2], turn[link, 3]
    for n in range(1, carried[link, 0] + 1):
        joint = carried[link, n]
        arm = place[joint] - place[pin]
        rx, ry = c * arm.real - s * arm.imag, s * arm.real + c * arm.imag
        x[joint, 0], x[joint, 1] = x[pin, 0] + rx, x[pin, 1] + ry
        x[joint, 2], x[joint, 3] = x[pin, 2] - w * ry, x[pin, 3] + w * rx
        x[joint, 4] = x[pin, 4] - w * w * rx - alpha * ry
        x[joint, 5] = x[pin, 5] - w * w * ry + alpha * rx


@njit(**STEP)
def _assemble(
    rows: Rows,
    ratios: Real,
    bases: Rows,
    exact: NDArray[np.bool_],
    carried: Rows,
    place: Complex,
    line: Complex,
    normal: Complex,
    signs: Rows,
    d: int,
    fixed: Real,
    x: Real,
    turn: Real,
    angle: Real,
) -> bool:
    """Rotations and rates of all links, and the joints that they carry; False where a closure has none."""
    for row in range(len(rows)):
        kind, link, pin, joint = rows[row, KIND], rows[row, LINK], rows[row, PIN], rows[row, JOINT]
        other, slide, sign = rows[row, OTHER], rows[row, SLIDE], float(signs[row, d])
        if kind == RRR:
            far, b2, c2 = rows[row, OTHER_PIN], fixed[row, 2], fixed[row, 6]
            bx, by = x[far, 0] - x[pin, 0], x[far, 1] - x[pin, 1]
            square = bx * bx + by * by
            along = 0.5 * (square + b2 - c2)
            height = b2 * square - along * along
            if not height > LEAST_SINE * LEAST_SINE * b2 * c2:
                return False
            height = -sign * math.sqrt(height)
            inverse = 1.0 / square
            px, py = (bx * along - by * height) * inverse, (by * along + bx * height) * inverse
            qx, qy = px - bx, py - by
            inverse = 1.0 / (px * qy - py * qx)
            ex, ey = x[far, 2] - x[pin, 2], x[far, 3] - x[pin, 3]
            w, v = (ex * qx + ey * qy) * inverse, (ex * px + ey * py) * inverse
            ex = x[far, 4] - x[pin, 4] + w * w * px - v * v * qx
            ey = x[far, 5] - x[pin, 5] + w * w * py - v * v * qy
            turn[link, 2], turn[link, 3] = w, (ex * qx + ey * qy) * inverse
            turn[other, 2], turn[other, 3] = v, (ex * px + ey * py) * inverse
            turn[link, 0] = (px * fixed[row, 0] + py * fixed[row, 1]) * fixed[row, 3]
            turn[link, 1] = (py * fixed[row, 0] - px * fixed[row, 1]) * fixed[row, 3]
            turn[other, 0] = (qx * fixed[row, 4] + qy * fixed[row, 5]) * fixed[row, 7]
            turn[other, 1] = (qy * fixed[row, 4] - qx * fixed[row, 5]) * fixed[row, 7]
            _carry(other, far, place, carried, turn, x)
        elif kind == GEAR:
            if not exact[other]:
                angle[other] = math.atan2(turn[other, 1], turn[other, 0])
            angle[link] = ratios[row] * angle[other]
            turn[link, 0], turn[link, 1] = math.cos(angle[link]), math.sin(angle[link])
            turn[link, 2], turn[link, 3] = ratios[row] * turn[other, 2], ratios[row] * turn[other, 3]
        elif kind == RRP:
            n, point, base = normal[slide], line[slide], bases[other]
            c, s, w, alpha = turn[other, 0], turn[other, 1], turn[other, 2], turn[other, 3]
            nx, ny = c * n.real - s * n.imag, s * n.real + c * n.imag
            lx = x[base, 0] + c * point.real - s * point.imag
            ly = x[base, 1] + s * point.real + c * point.imag
            h = nx * (lx - x[pin, 0]) + ny * (ly - x[pin, 1])
            root = fixed[row, 2] - h * h
            if not root > LEAST_SINE * LEAST_SINE * fixed[row, 2]:
                return False
            root = sign * math.sqrt(root)
            px, py = nx * h + ny * root, ny * h - nx * root
            # The line's own motion at the joint, and the joint's along it.
            rx, ry = x[pin, 0] + px - x[base, 0], x[pin, 1] + py - x[base, 1]
            vx, vy = x[base, 2] - w * ry - x[pin, 2], x[base, 3] + w * rx - x[pin, 3]
            inverse = 1.0 / root
            v = (nx * vx + ny * vy) * inverse
            along = ny * (-v * py - vx) - nx * (v * px - vy)
            ax = x[base, 4] - w * w * rx - alpha * ry - x[pin, 4] + v * v * px
            ay = x[base, 5] - w * w * ry + alpha * rx - x[pin, 5] + v * v * py
            turn[link, 2], turn[link, 3] = v, (nx * ax + ny * ay + 2.0 * w * along) * inverse
            turn[link, 0] = (px * fixed[row, 0] + py * fixed[row, 1]) * fixed[row, 3]
            turn[link, 1] = (py * fixed[row, 0] - px * fixed[row, 1]) * fixed[row, 3]
        else:
            n, h = normal[slide], fixed[row, 0]
            px, py = x[joint, 0] - x[pin, 0], x[joint, 1] - x[pin, 1]
            square = px * px + py * py
            root = square - h * h
            if not root > LEAST_SINE * LEAST_SINE * square:
                return False
            root = sign * math.sqrt(root)
            inverse = 1.0 / square
            nx, ny = (px * h + py * root) * inverse, (py * h - px * root) * inverse
            inverse = 1.0 / root
            vx, vy = x[joint, 2] - x[pin, 2], x[joint, 3] - x[pin, 3]
            w = -(nx * vx + ny * vy) * inverse
            ax, ay = x[joint, 4] - x[pin, 4], x[joint, 5] - x[pin, 5]
            turn[link, 2] = w
            turn[link, 3] = (w * w * h - nx * ax - ny * ay - 2.0 * w * (nx * vy - ny * vx)) * inverse
            turn[link, 0], turn[link, 1] = nx * n.real + ny * n.imag, ny * n.real - nx * n.imag
        _carry(link, pin, place, carried, turn, x)
    return True


@njit(**OPTIONS)
def _gather(link: int, base: int, but: int, carried: Rows, x: Real, need: Real, pins: Real) -> float:
    """Take what stands on a link's joints, but for one, from what it needs; the square of the largest force there."""
    largest = 0.0
    for n in range(1, carried[link, 0] + 1):
        joint = carried[link, n]
        if joint != but:
            fx, fy = pins[joint, 0], pins[joint, 1]
            need[link, 0] -= fx
            need[link, 1] -= fy
            need[link, 2] -= (x[joint, 0] - x[base, 0]) * fy - (x[joint, 1] - x[base, 1]) * fx
            largest = max(largest, fx * fx + fy * fy)
    return largest


@njit(**STEP)
def _give_back(
    rows: Rows,
    ratios: Real,
    bases: Rows,
    carried: Rows,
    driver: Rows,
    normal: Complex,
    about: complex,
    x: Real,
    turn: Real,
    need: Real,
    pins: Real,
    out: Real,
    d: int,
    at: int,
) -> None:
    """Reactions, the last closure first; what is left is the drive, and what stands on the ground."""
    largest = shake_x = shake_y = moment = 0.0
    for row in range(len(rows) - 1, -1, -1):
        kind, link, pin, joint = rows[row, KIND], rows[row, LINK], rows[row, PIN], rows[row, JOINT]
        other, slide = rows[row, OTHER], rows[row, SLIDE]
        own = joint if kind in (RRR, RRP) else -1
        largest = max(largest, _gather(link, pin, own, carried, x, need, pins))
        fx = fy = 0.0
        if kind == RRR:
            far = rows[row, OTHER_PIN]
            largest = max(largest, _gather(other, far, -1, carried, x, need, pins))
            px, py = x[joint, 0] - x[pin, 0], x[joint, 1] - x[pin, 1]
            qx, qy = x[joint, 0] - x[far, 0], x[joint, 1] - x[far, 1]
            hx, hy = pins[joint, 0], pins[joint, 1]
            inverse = 1.0 / (qx * py - qy * px)
            one = need[other, 2] * inverse
            two = (need[link, 2] - px * hy + py * hx) * inverse
            fx, fy = one * px + two * qx, one * py + two * qy
            largest = max(largest, fx * fx + fy * fy)
            ex, ey = need[other, 0] - fx, need[other, 1] - fy
            largest = max(largest, ex * ex + ey * ey)
            pins[far, 0] -= ex
            pins[far, 1] -= ey
            fx, fy = hx - fx, hy - fy
            largest = max(largest, fx * fx + fy * fy)
        elif kind == GEAR:
            torque = need[link, 2]
            moment -= torque
            if other > 0:
                need[other, 2] += ratios[row] * torque
                moment += ratios[row] * torque
        else:
            c, s, n = turn[other, 0], turn[other, 1], normal[slide]
            if kind != RRP:
                c, s = turn[link, 0], turn[link, 1]
            nx, ny = c * n.real - s * n.imag, s * n.real + c * n.imag
            px, py = x[joint, 0] - x[pin, 0], x[joint, 1] - x[pin, 1]
            if kind == RRP:
                fx, fy = pins[joint, 0], pins[joint, 1]
                push = (need[link, 2] - px * fy + py * fx) / (px * ny - py * nx)
                nx, ny = push * nx, push * ny
                fx, fy = fx + nx, fy + ny
                largest = max(largest, fx * fx + fy * fy)
                if other > 0:
                    base = bases[other]
                    need[other, 0] += nx
                    need[other, 1] += ny
                    need[other, 2] += (x[joint, 0] - x[base, 0]) * ny - (x[joint, 1] - x[base, 1]) * nx
                else:
                    shake_x -= nx
                    shake_y -= ny
                    moment -= (x[joint, 0] - about.real) * ny - (x[joint, 1] - about.imag) * nx
            else:
                push = -need[link, 2] / (px * ny - py * nx)
                fx, fy = -push * nx, -push * ny
                pins[joint, 0] -= fx
                pins[joint, 1] -= fy
        ex, ey = need[link, 0] - fx, need[link, 1] - fy
        largest = max(largest, ex * ex + ey * ey)
        pins[pin, 0] -= ex
        pins[pin, 1] -= ey
    first = driver[0]
    if first > 0:
        base = bases[first]
        largest = max(largest, _gather(first, base, -1, carried, x, need, pins))
        largest = max(largest, need[first, 0] ** 2 + need[first, 1] ** 2)
        pins[base, 0] -= need[first, 0]
        pins[base, 1] -= need[first, 1]
        drive = need[first, 2]
        moment -= drive
    else:
        joint, n = driver[1], normal[driver[2]]
        fx, fy = pins[joint, 0], pins[joint, 1]
        drive = n.real * fy - n.imag * fx
        shake_x += fx
        shake_y += fy
        moment += (x[joint, 0] - about.real) * fy - (x[joint, 1] - about.imag) * fx
    for k in range(1, carried[0, 0] + 1):
        joint = carried[0, k]
        fx, fy = pins[joint, 0], pins[joint, 1]
        largest = max(largest, fx * fx + fy * fy)
        shake_x += fx
        shake_y += fy
        moment += (x[joint, 0] - about.real) * fy - (x[joint, 1] - about.imag) * fx
    out[DRIVE, d, at], out[PIN_FORCE, d, at] = drive, math.sqrt(largest)
    out[SHAKING_X, d, at], out[SHAKING_Y, d, at], out[MOMENT, d, at] = shake_x, shake_y, moment
