"""Compiled kinematics and reactions of linkages built of dyads, closure by closure and back again.

In the forward pass each closure gives the rotations of its links and their first two rates. With the arms p, q from the
pins to the joint where two links meet, velocities and accelerations v, a of the pins, and X = p × q,

    RRR   ω₁ = (v_q − v_p)·q / X,     ω₂ = (v_q − v_p)·p / X,
          α₁ = g·q / X,               α₂ = g·p / X,       g = a_q − a_p + ω₁² p − ω₂² q;

where a joint slides on a line with the normal n, in another link (RRP) or in its own (RPR), p × n takes the place of X.

In the backward pass, the last closure first, each link requires the resultant N of its pins' forces and their moment K
about its pin (Norton, *Design of Machinery*, eq. 11.1). The force f that later links, masses and loads exert on a pin
is known by then:

    RRR   force of the joint on the second link  (K₂ p + (K₁ − p × f) q) / (q × p),
    RRP   normal force  λ = (K − p × f) / (p × n),
    RPR   λ = −K / (p × n),
    gear  the torque K on the link, −ratio K on the other.

The remainder acts on the pins; the driving link or slide comes last. Every step is done for many inputs at once, in
loops without branches over separate rows, which the compiler vectorizes. NaN stays in its own lane and is reported at
the end.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import KernelOptions, njit
from kinematics.linkage.planar.drive_kernels import GEAR, JOINT, KIND, LINK, OTHER_LINK, OTHER_PIN, PIN, RRP, RRR, SLIDE

MIN_SINE = 1e-7
"""Sine of the angle at a closure below which a position counts as a toggle, without finite forces."""

ON_LINK, ON_JOINT = range(2)
"""Codes for the target of a load."""

DRIVE, PIN_FORCE, SHAKING_X, SHAKING_Y, MOMENT = range(5)
"""Rows of the results: drive, largest pin force, components of the shaking force, and shaking moment."""

MAX_LANES = 64
"""Maximum number of inputs processed side by side by vector instructions; their data must fit into the first-level
cache."""

OPTIONS: KernelOptions = {"cache": True, "nogil": True, "error_model": "numpy"}
"""Options of the kernels: division by zero gives inf or NaN as in NumPy."""

INLINE_OPTIONS: KernelOptions = {**OPTIONS, "forceinline": True}
"""Options of a kernel that is called in one place and inlined there."""


@njit(**OPTIONS)
def eliminate(
    rows: Integers,
    ratios: Real,
    bases: Integers,
    exact: NDArray[np.bool_],
    carried: Integers,
    driver: Integers,
    joints: Complex,
    lines: Complex,
    normals: Complex,
    signs: Integers,
    mass: Real,
    cg: Complex,
    inertia: Real,
    pin_mass: Real,
    gravity: complex,
    on: Integers,
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
        See :class:`~kinematics.linkage.planar.drive_kernels.Code`; links by number, 0 is the ground.
    bases : int, shape (links,)
        The pin of each link, about which its moments are taken.
    exact : bool, shape (links,)
        Links whose rotation is known beyond a full turn: the input, and the links geared to it.
    carried : int, shape (links, 1 + joints)
        Number of joints that a link determines, and their indices.
    joints : complex, shape (D, joints)
        Positions in the reference configuration.
    lines, normals : complex, shape (D, slides)
        A point of each slide's line, relative to the pin of its link, and its normal; in the reference.
    signs : int, shape (steps, D)
        Assembly signs of the closures.
    mass, cg, inertia : shape (D, links)
        Bodies of the links; centres of gravity are relative to the link's pin, in the reference.
    pin_mass : float, shape (D, joints)
    gravity : complex
    on : int, shape (loads, 3)
        Target of each load (link or joint), its index, and whether the components turn with the link.
    arms : complex, shape (D, loads)
        Point of action relative to the link's pin, in the reference.
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
    links, count, inputs = len(bases), joints.shape[1], moved.shape[2]
    x, turn, angle = np.zeros((count, 6, MAX_LANES)), np.zeros((links, 4, MAX_LANES)), np.zeros((links, MAX_LANES))
    need, pins, whole = np.zeros((links, 3, MAX_LANES)), np.zeros((count, 2, MAX_LANES)), np.ones(MAX_LANES, np.bool_)
    fixed, results = np.zeros((len(rows), 8)), np.zeros((5, MAX_LANES))
    # The ground has rotation factor 1 and no rates.
    turn[0, 0] = 1.0
    gx, gy = gravity.real, gravity.imag
    # Blocks of equal size, at most MAX_LANES: two ceiling divisions.
    block = -(-inputs // -(-inputs // MAX_LANES)) if inputs else 1
    for d in range(joints.shape[0]):
        place = joints[d]
        for joint in range(count):
            x[joint] = 0.0
            x[joint, 0], x[joint, 1] = place[joint].real, place[joint].imag
        # Constants of the design, computed once for all inputs.
        _compute_reference(rows, place, lines[d], normals[d], bases, fixed)
        for start in range(0, inputs, block):
            lanes = min(block, inputs - start)
            # Lanes whose closures exist; the others are masked at the end.
            whole[:] = True
            first = driver[0]
            # A slide drives: its joint moves along the line, which is the normal turned back by 90°.
            if first < 0:
                joint, normal = driver[1], normals[d, driver[2]]
                for k in range(lanes):
                    at = start + k
                    for n in range(3):
                        x[joint, 2 * n, k] = moved[n, d, at] * normal.imag
                        x[joint, 2 * n + 1, k] = -moved[n, d, at] * normal.real
                    x[joint, 0, k] += place[joint].real
                    x[joint, 1, k] += place[joint].imag
            else:
                for k in range(lanes):
                    at = start + k
                    angle[first, k] = moved[0, d, at]
                    turn[first, 0, k], turn[first, 1, k] = math.cos(angle[first, k]), math.sin(angle[first, k])
                    turn[first, 2, k], turn[first, 3, k] = moved[1, d, at], moved[2, d, at]
                _move_joints(first, bases[first], place, carried, turn, x, lanes)
            _assemble_closures(
                rows,
                ratios,
                bases,
                exact,
                carried,
                place,
                lines[d],
                normals[d],
                signs,
                d,
                fixed,
                x,
                turn,
                angle,
                whole,
                lanes,
            )
            for joint in range(count):
                m = pin_mass[d, joint]
                for k in range(lanes):
                    # Weight and inertia of point masses act on the pins (d'Alembert).
                    pins[joint, 0, k], pins[joint, 1, k] = m * (gx - x[joint, 4, k]), m * (gy - x[joint, 5, k])
            for link in range(1, links):
                base, g, m = bases[link], cg[d, link], mass[d, link]
                for k in range(lanes):
                    c, s, w, alpha = turn[link, 0, k], turn[link, 1, k], turn[link, 2, k], turn[link, 3, k]
                    rx, ry = c * g.real - s * g.imag, s * g.real + c * g.imag
                    # m (a_G − g), with the acceleration of the centre from that of the pin.
                    fx = m * (x[base, 4, k] - w * w * rx - alpha * ry - gx)
                    fy = m * (x[base, 5, k] - w * w * ry + alpha * rx - gy)
                    need[link, 0, k], need[link, 1, k] = fx, fy
                    need[link, 2, k] = inertia[d, link] * alpha + rx * fy - ry * fx
            for link in range(couples.shape[0]):
                for k in range(lanes):
                    need[link, 2, k] -= couples[link, d, start + k]
            for n in range(len(on)):
                which, arm = on[n, 1], arms[d, n]
                for k in range(lanes):
                    force = strengths[n, d, start + k]
                    fx, fy = force.real, force.imag
                    if on[n, 0] == ON_JOINT:
                        pins[which, 0, k] += fx
                        pins[which, 1, k] += fy
                        continue
                    c, s = turn[which, 0, k], turn[which, 1, k]
                    rx, ry = c * arm.real - s * arm.imag, s * arm.real + c * arm.imag
                    # Components given in the link's frame turn with it.
                    if on[n, 2]:
                        fx, fy = c * force.real - s * force.imag, s * force.real + c * force.imag
                    need[which, 0, k] -= fx
                    need[which, 1, k] -= fy
                    need[which, 2, k] -= rx * fy - ry * fx
            _compute_reactions(
                rows, ratios, bases, carried, driver, normals[d], about[d], x, turn, need, pins, results, lanes
            )
            for k in range(lanes):
                for n in range(5):
                    # NaN only here, so that the loops above need no branches.
                    out[n, d, start + k] = results[n, k] if whole[k] else np.nan


@njit(**INLINE_OPTIONS)
def _compute_reference(
    rows: Integers, place: Complex, line: Complex, normal: Complex, bases: Integers, fixed: Real
) -> None:
    """Compute the constants of each closure: arms and squares of their lengths; for RPR the distance of the line."""
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
def _move_joints(link: int, pin: int, place: Complex, carried: Integers, turn: Real, x: Real, lanes: int) -> None:
    """Compute positions, velocities and accelerations of the joints that a link determines."""
    for n in range(1, carried[link, 0] + 1):
        joint = carried[link, n]
        arm = place[joint] - place[pin]
        for k in range(lanes):
            c, s, w, alpha = turn[link, 0, k], turn[link, 1, k], turn[link, 2, k], turn[link, 3, k]
            rx, ry = c * arm.real - s * arm.imag, s * arm.real + c * arm.imag
            x[joint, 0, k], x[joint, 1, k] = x[pin, 0, k] + rx, x[pin, 1, k] + ry
            x[joint, 2, k], x[joint, 3, k] = x[pin, 2, k] - w * ry, x[pin, 3, k] + w * rx
            x[joint, 4, k] = x[pin, 4, k] - w * w * rx - alpha * ry
            x[joint, 5, k] = x[pin, 5, k] - w * w * ry + alpha * rx


@njit(**INLINE_OPTIONS)
def _assemble_closures(
    rows: Integers,
    ratios: Real,
    bases: Integers,
    exact: NDArray[np.bool_],
    carried: Integers,
    place: Complex,
    line: Complex,
    normal: Complex,
    signs: Integers,
    d: int,
    fixed: Real,
    x: Real,
    turn: Real,
    angle: Real,
    whole: NDArray[np.bool_],
    lanes: int,
) -> None:
    """Compute rotations and rates of all links, and their joints; clear ``whole`` where a closure has no solution."""
    for row in range(len(rows)):
        kind, link, pin, joint = rows[row, KIND], rows[row, LINK], rows[row, PIN], rows[row, JOINT]
        other, slide, sign = rows[row, OTHER_LINK], rows[row, SLIDE], float(signs[row, d])
        if kind == RRR:
            far, b2, c2 = rows[row, OTHER_PIN], fixed[row, 2], fixed[row, 6]
            for k in range(lanes):
                bx, by = x[far, 0, k] - x[pin, 0, k], x[far, 1, k] - x[pin, 1, k]
                square = bx * bx + by * by
                along = 0.5 * (square + b2 - c2)
                height = b2 * square - along * along
                # height is the square of b c times the sine of the angle between both links.
                whole[k] &= height > MIN_SINE * MIN_SINE * b2 * c2
                height = -sign * math.sqrt(height)
                inverse = 1.0 / square
                # Position of the joint from the base, by the two circles.
                px, py = (bx * along - by * height) * inverse, (by * along + bx * height) * inverse
                qx, qy = px - bx, py - by
                # X = p × q: it vanishes at the toggle excluded above.
                inverse = 1.0 / (px * qy - py * qx)
                ex, ey = x[far, 2, k] - x[pin, 2, k], x[far, 3, k] - x[pin, 3, k]
                w, v = (ex * qx + ey * qy) * inverse, (ex * px + ey * py) * inverse
                ex = x[far, 4, k] - x[pin, 4, k] + w * w * px - v * v * qx
                ey = x[far, 5, k] - x[pin, 5, k] + w * w * py - v * v * qy
                turn[link, 2, k], turn[link, 3, k] = w, (ex * qx + ey * qy) * inverse
                turn[other, 2, k], turn[other, 3, k] = v, (ex * px + ey * py) * inverse
                turn[link, 0, k] = (px * fixed[row, 0] + py * fixed[row, 1]) * fixed[row, 3]
                turn[link, 1, k] = (py * fixed[row, 0] - px * fixed[row, 1]) * fixed[row, 3]
                turn[other, 0, k] = (qx * fixed[row, 4] + qy * fixed[row, 5]) * fixed[row, 7]
                turn[other, 1, k] = (qy * fixed[row, 4] - qx * fixed[row, 5]) * fixed[row, 7]
            _move_joints(other, far, place, carried, turn, x, lanes)
        elif kind == GEAR:
            for k in range(lanes):
                # Only the principal value is known of a link that a closure places; gears on it must not exceed ±π.
                if not exact[other]:
                    angle[other, k] = math.atan2(turn[other, 1, k], turn[other, 0, k])
                angle[link, k] = ratios[row] * angle[other, k]
                turn[link, 0, k], turn[link, 1, k] = math.cos(angle[link, k]), math.sin(angle[link, k])
                turn[link, 2, k], turn[link, 3, k] = ratios[row] * turn[other, 2, k], ratios[row] * turn[other, 3, k]
        elif kind == RRP:
            n, point, base = normal[slide], line[slide], bases[other]
            for k in range(lanes):
                c, s, w, alpha = turn[other, 0, k], turn[other, 1, k], turn[other, 2, k], turn[other, 3, k]
                nx, ny = c * n.real - s * n.imag, s * n.real + c * n.imag
                lx = x[base, 0, k] + c * point.real - s * point.imag
                ly = x[base, 1, k] + s * point.real + c * point.imag
                h = nx * (lx - x[pin, 0, k]) + ny * (ly - x[pin, 1, k])
                root = fixed[row, 2] - h * h
                whole[k] &= root > MIN_SINE * MIN_SINE * fixed[row, 2]
                root = sign * math.sqrt(root)
                px, py = nx * h + ny * root, ny * h - nx * root
                # The line's own motion at the joint, and the joint's motion along it (Coriolis term below).
                rx, ry = x[pin, 0, k] + px - x[base, 0, k], x[pin, 1, k] + py - x[base, 1, k]
                vx, vy = x[base, 2, k] - w * ry - x[pin, 2, k], x[base, 3, k] + w * rx - x[pin, 3, k]
                inverse = 1.0 / root
                v = (nx * vx + ny * vy) * inverse
                along = ny * (-v * py - vx) - nx * (v * px - vy)
                ax = x[base, 4, k] - w * w * rx - alpha * ry - x[pin, 4, k] + v * v * px
                ay = x[base, 5, k] - w * w * ry + alpha * rx - x[pin, 5, k] + v * v * py
                turn[link, 2, k], turn[link, 3, k] = v, (nx * ax + ny * ay + 2.0 * w * along) * inverse
                turn[link, 0, k] = (px * fixed[row, 0] + py * fixed[row, 1]) * fixed[row, 3]
                turn[link, 1, k] = (py * fixed[row, 0] - px * fixed[row, 1]) * fixed[row, 3]
        else:
            n, h = normal[slide], fixed[row, 0]
            for k in range(lanes):
                px, py = x[joint, 0, k] - x[pin, 0, k], x[joint, 1, k] - x[pin, 1, k]
                square = px * px + py * py
                root = square - h * h
                whole[k] &= root > MIN_SINE * MIN_SINE * square
                root = sign * math.sqrt(root)
                inverse = 1.0 / square
                nx, ny = (px * h + py * root) * inverse, (py * h - px * root) * inverse
                inverse = 1.0 / root
                vx, vy = x[joint, 2, k] - x[pin, 2, k], x[joint, 3, k] - x[pin, 3, k]
                w = -(nx * vx + ny * vy) * inverse
                ax, ay = x[joint, 4, k] - x[pin, 4, k], x[joint, 5, k] - x[pin, 5, k]
                turn[link, 2, k] = w
                turn[link, 3, k] = (w * w * h - nx * ax - ny * ay - 2.0 * w * (nx * vy - ny * vx)) * inverse
                turn[link, 0, k], turn[link, 1, k] = nx * n.real + ny * n.imag, ny * n.real - nx * n.imag
        _move_joints(link, pin, place, carried, turn, x, lanes)


@njit(**OPTIONS)
def _gather(
    link: int, base: int, but: int, carried: Integers, x: Real, need: Real, pins: Real, largest: Real, lanes: int
) -> None:
    """Subtract the forces on a link's joints, except one, from its required resultant and moment."""
    for n in range(1, carried[link, 0] + 1):
        joint = carried[link, n]
        if joint == but:
            continue
        for k in range(lanes):
            fx, fy = pins[joint, 0, k], pins[joint, 1, k]
            need[link, 0, k] -= fx
            need[link, 1, k] -= fy
            need[link, 2, k] -= (x[joint, 0, k] - x[base, 0, k]) * fy - (x[joint, 1, k] - x[base, 1, k]) * fx
            largest[k] = max(largest[k], fx * fx + fy * fy)


@njit(**INLINE_OPTIONS)
def _compute_reactions(
    rows: Integers,
    ratios: Real,
    bases: Integers,
    carried: Integers,
    driver: Integers,
    normal: Complex,
    about: complex,
    x: Real,
    turn: Real,
    need: Real,
    pins: Real,
    results: Real,
    lanes: int,
) -> None:
    """Compute reactions, the last closure first; the remainder is the drive and the force on the ground."""
    results[:] = 0.0
    drive, largest, moment = results[DRIVE], results[PIN_FORCE], results[MOMENT]
    shake_x, shake_y = results[SHAKING_X], results[SHAKING_Y]
    for row in range(len(rows) - 1, -1, -1):
        kind, link, pin, joint = rows[row, KIND], rows[row, LINK], rows[row, PIN], rows[row, JOINT]
        other, slide = rows[row, OTHER_LINK], rows[row, SLIDE]
        # The force at the joint where two links meet is the unknown of the closure.
        own = joint if kind in (RRR, RRP) else -1
        _gather(link, pin, own, carried, x, need, pins, largest, lanes)
        if kind == RRR:
            far = rows[row, OTHER_PIN]
            _gather(other, far, -1, carried, x, need, pins, largest, lanes)
            for k in range(lanes):
                px, py = x[joint, 0, k] - x[pin, 0, k], x[joint, 1, k] - x[pin, 1, k]
                qx, qy = x[joint, 0, k] - x[far, 0, k], x[joint, 1, k] - x[far, 1, k]
                hx, hy = pins[joint, 0, k], pins[joint, 1, k]
                inverse = 1.0 / (qx * py - qy * px)
                # The joint's force resolved along both arms: each moment determines one component.
                one = need[other, 2, k] * inverse
                two = (need[link, 2, k] - px * hy + py * hx) * inverse
                fx, fy = one * px + two * qx, one * py + two * qy
                ex, ey = need[other, 0, k] - fx, need[other, 1, k] - fy
                gx, gy = hx - fx, hy - fy
                dx, dy = need[link, 0, k] - gx, need[link, 1, k] - gy
                pins[far, 0, k] -= ex
                pins[far, 1, k] -= ey
                pins[pin, 0, k] -= dx
                pins[pin, 1, k] -= dy
                greatest = max(fx * fx + fy * fy, ex * ex + ey * ey)
                greatest = max(greatest, max(gx * gx + gy * gy, dx * dx + dy * dy))
                largest[k] = max(largest[k], greatest)
            continue
        if kind == GEAR:
            # A gear takes its torque from the other link and the remainder from the ground's bearings.
            for k in range(lanes):
                torque = need[link, 2, k]
                if other > 0:
                    need[other, 2, k] += ratios[row] * torque
                    torque -= ratios[row] * torque
                moment[k] -= torque
        elif kind == RRP:
            n, base = normal[slide], bases[other]
            for k in range(lanes):
                c, s = turn[other, 0, k], turn[other, 1, k]
                nx, ny = c * n.real - s * n.imag, s * n.real + c * n.imag
                px, py = x[joint, 0, k] - x[pin, 0, k], x[joint, 1, k] - x[pin, 1, k]
                fx, fy = pins[joint, 0, k], pins[joint, 1, k]
                push = (need[link, 2, k] - px * fy + py * fx) / (px * ny - py * nx)
                nx, ny = push * nx, push * ny
                fx, fy = fx + nx, fy + ny
                need[link, 0, k] -= fx
                need[link, 1, k] -= fy
                largest[k] = max(largest[k], fx * fx + fy * fy)
                # A line fixed in the ground pushes on the frame, not on a link.
                if other > 0:
                    need[other, 0, k] += nx
                    need[other, 1, k] += ny
                    need[other, 2, k] += (x[joint, 0, k] - x[base, 0, k]) * ny - (x[joint, 1, k] - x[base, 1, k]) * nx
                else:
                    shake_x[k] -= nx
                    shake_y[k] -= ny
                    moment[k] -= (x[joint, 0, k] - about.real) * ny - (x[joint, 1, k] - about.imag) * nx
        else:
            n = normal[slide]
            for k in range(lanes):
                c, s = turn[link, 0, k], turn[link, 1, k]
                nx, ny = c * n.real - s * n.imag, s * n.real + c * n.imag
                px, py = x[joint, 0, k] - x[pin, 0, k], x[joint, 1, k] - x[pin, 1, k]
                push = need[link, 2, k] / (px * ny - py * nx)
                nx, ny = push * nx, push * ny
                need[link, 0, k] -= nx
                need[link, 1, k] -= ny
                pins[joint, 0, k] -= nx
                pins[joint, 1, k] -= ny
        _pass_to_pin(link, pin, need, pins, largest, lanes)
    first = driver[0]
    if first > 0:
        _gather(first, bases[first], -1, carried, x, need, pins, largest, lanes)
        _pass_to_pin(first, bases[first], need, pins, largest, lanes)
        for k in range(lanes):
            drive[k] = need[first, 2, k]
            # The drive is a couple between ground and input link.
            moment[k] -= drive[k]
    else:
        joint, n = driver[1], normal[driver[2]]
        for k in range(lanes):
            fx, fy = pins[joint, 0, k], pins[joint, 1, k]
            # Component along the slide; the normal component acts on the frame.
            drive[k] = n.real * fy - n.imag * fx
            shake_x[k] += fx
            shake_y[k] += fy
            moment[k] += (x[joint, 0, k] - about.real) * fy - (x[joint, 1, k] - about.imag) * fx
    for n in range(1, carried[0, 0] + 1):
        joint = carried[0, n]
        for k in range(lanes):
            fx, fy = pins[joint, 0, k], pins[joint, 1, k]
            largest[k] = max(largest[k], fx * fx + fy * fy)
            shake_x[k] += fx
            shake_y[k] += fy
            moment[k] += (x[joint, 0, k] - about.real) * fy - (x[joint, 1, k] - about.imag) * fx
    for k in range(lanes):
        largest[k] = math.sqrt(largest[k])


@njit(**OPTIONS)
def _pass_to_pin(link: int, pin: int, need: Real, pins: Real, largest: Real, lanes: int) -> None:
    """Transfer the remaining required force of a link to its pin."""
    for k in range(lanes):
        fx, fy = need[link, 0, k], need[link, 1, k]
        pins[pin, 0, k] -= fx
        pins[pin, 1, k] -= fy
        largest[k] = max(largest[k], fx * fx + fy * fy)
