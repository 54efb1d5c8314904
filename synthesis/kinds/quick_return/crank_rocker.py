"""The crank-rocker of given swing and time ratio with the best transmission angle, in closed form.

While the crank turns by φ = π ± δ, δ = π (T − 1)/(T + 1), from the position in which crank and coupler extend each
other to that in which they overlap, the rocker turns by ψ in the same direction. With a = 1, ρ = b/a, S = sin(ψ/2) and
η = (φ − ψ)/2 the triangles O2 B1 B2 and O4 B1 B2 give

    c S = √(sin²(φ/2) + ρ² cos²(φ/2)),        d S = √(sin² η + ρ² cos² η),

so that ρ is the one free choice (Alt; Norton, Sec. 3.9). The minimum transmission angle μ occurs when the crank lies
along the ground line:

    cos μ = (|b² + c² − a² − d²| + 2ad)/2bc = (|cos(φ/2) sin η| (ρ² − 1) + d S)/(ρ c S).

In q = 1/ρ², with κ = cot²(φ/2) and λ = cot² η, its derivative is a quartic with the factors q − κλ and

    q³ + 2κ q² − κ q − κ (1 + κ) λ = 0,

the cubic of Freudenstein and Primrose (1973), which has one positive root. At q = κλ and at q = 1 cos μ is 1, a change
point; between them both limit positions lie on one circuit, beyond them they do not. Hence

* a design exists just where κλ < 1, that is π/2 + ψ/2 < φ < 3π/2 + ψ/2, and the root is then the only extreme of cos μ
  between the ends: the optimum;
* the time ratio is below (3π − ψ)/(π + ψ) for φ < π and below (3π + ψ)/(π − ψ), which is more, for φ > π; every lower
  one is reached, for every swing below π. No crank-rocker swings by π.

With T = 1 (κ = 0) the root is q = 0: μ grows with ρ towards π/2 − ψ/2 and reaches it for no linkage (Brodell and Soni
1970 give the member of the family for a chosen μ). Lengths over the crank's grow with ρ, and the link ratio is never
below 1/S.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

from scipy.optimize import brentq

from kinematics.message import compose
from synthesis.kinds.quick_return.alternatives import (
    LIMIT_TOLERANCE,
    MAX_LINK_RATIO,
    RANGE_END_TOLERANCE,
    list_shorter_members,
)
from synthesis.kinds.quick_return.design import RatioRange
from synthesis.kinds.quick_return.problem import QuickReturnProblem, compute_stroke_imbalance
from synthesis.model.linkage.answer import CouplerPoint, FixedPivots, FourbarLinks, FourbarMechanism
from synthesis.model.linkage.conversion import build_skeleton, to_point

BEST_ANGLE_TOLERANCE = math.radians(0.005)
"""Tolerance of the best transmission angle, radians: half of the hundredth of a degree that answers show."""

MAX_COUPLER_RATIO = 1e6
"""Maximum ratio of coupler to crank. The transmission angle of longer couplers equals its bound to rounding."""


class CrankRockerFamily(NamedTuple):
    """Family of crank-rockers: the rocker swings by ψ while the crank turns by φ from extension to overlap, radians."""

    phi: float
    psi: float

    @property
    def kappa(self) -> float:
        """κ = cot²(φ/2)."""
        return math.tan(0.5 * (math.pi - self.phi)) ** 2

    @property
    def lam(self) -> float:
        """λ = cot² η."""
        return math.tan(0.5 * (math.pi - self.phi + self.psi)) ** 2

    @property
    def exists(self) -> bool:
        """Whether any member turns through on one circuit."""
        # Equivalent to κλ < 1, see the module's docstring.
        mean = self.phi - 0.5 * self.psi
        inside = 0.5 * math.pi + RANGE_END_TOLERANCE < mean < 1.5 * math.pi - RANGE_END_TOLERANCE
        return 0.0 < self.psi < math.pi - RANGE_END_TOLERANCE and inside

    def compute_lengths(self, rho: float) -> tuple[float, float, float]:
        """Return coupler, rocker and ground in lengths of the crank."""
        s, eta = math.sin(0.5 * self.psi), 0.5 * (self.phi - self.psi)
        c = math.hypot(math.sin(0.5 * self.phi), rho * math.cos(0.5 * self.phi)) / s
        return rho, c, math.hypot(math.sin(eta), rho * math.cos(eta)) / s

    def compute_cosine(self, rho: float) -> float:
        """Return the cosine of the minimum transmission angle; 1 at a change point."""
        _, c, d = self.compute_lengths(rho)
        s, eta = math.sin(0.5 * self.psi), 0.5 * (self.phi - self.psi)
        # (ρ − 1)(ρ + 1) instead of ρ² − 1 keeps the digits near ρ = 1.
        bend = abs(math.cos(0.5 * self.phi) * math.sin(eta)) * (rho - 1.0) * (rho + 1.0)
        return (bend / s + d) / (rho * c)

    def compute_transmission(self, rho: float) -> float:
        """Return the minimum transmission angle, radians."""
        return math.acos(min(self.compute_cosine(rho), 1.0))

    def link_ratio(self, rho: float) -> float:
        """Return the longest link over the crank, which is the shortest."""
        return max(self.compute_lengths(rho))

    def find_longest(self, limit: float) -> float:
        """Return the ρ at which the link ratio equals the limit; below 1 if every member exceeds it."""
        s, eta = math.sin(0.5 * self.psi), 0.5 * (self.phi - self.psi)
        bounds = [limit]
        for angle in (0.5 * self.phi, eta):
            room = (limit * s - math.sin(angle)) * (limit * s + math.sin(angle))
            # A length independent of ρ excludes no member, or all of them.
            bounds.append(math.sqrt(max(room, 0.0)) / max(abs(math.cos(angle)), 1e-300))
        return min(bounds)

    def find_best(self) -> float:
        """Return the ρ of the best transmission angle; infinite for a time ratio of 1."""
        kappa, lam = self.kappa, self.lam
        if kappa == 0.0:
            return math.inf

        def evaluate_cubic(q: float) -> float:
            return ((q + 2.0 * kappa) * q - kappa) * q - kappa * (1.0 + kappa) * lam

        # κλ and 1 are the ends of the range, where cos μ is 1; the cubic changes its sign once between them.
        return 1.0 / math.sqrt(brentq(evaluate_cubic, kappa * lam, 1.0, xtol=1e-300, rtol=1e-15))

    @property
    def supremum(self) -> float:
        """The best transmission angle, radians, or for a time ratio of 1 its bound, which no member reaches."""
        best = self.find_best()
        return self.compute_transmission(best) if math.isfinite(best) else 0.5 * (math.pi - self.psi)

    def find_near_best(self, demanded: float) -> float:
        """Return the ρ of the best member, or of a shorter one that transmits almost as well if the best is very long.

        The shorter member has at least the ``demanded`` transmission angle, radians, if the best member has it.
        """
        best = min(self.find_best(), MAX_COUPLER_RATIO)
        # Up to this ratio the optimum itself is practical.
        if self.link_ratio(best) <= MAX_LINK_RATIO:
            return best
        wanted = self.supremum - BEST_ANGLE_TOLERANCE
        # The requirement is between the near-best angle and the bound: satisfy it rather than shorten the links.
        if wanted < demanded < self.supremum:
            wanted = min(demanded, self.compute_transmission(best))
        return float(brentq(lambda rho: self.compute_transmission(rho) - wanted, 1.0, best, xtol=1e-12, rtol=1e-12))


def list_families(time_ratio: float, swing: float) -> list[CrankRockerFamily]:
    """Return the families with a time ratio and a swing (radians) that have members, φ > π first."""
    delta = compute_stroke_imbalance(time_ratio)
    # With a ratio of 1 the second family is the mirror image of the first.
    signs = (1.0,) if delta == 0.0 else (1.0, -1.0)
    both = [CrankRockerFamily(math.pi + sign * delta, swing) for sign in signs]
    return [family for family in both if family.exists]


def compute_ratio_range(problem: QuickReturnProblem) -> RatioRange:
    """Return the time ratios of crank-rockers with the given swing."""
    swing = problem.swing_angle or 0.0
    greatest = (540.0 + swing) / (180.0 - swing) if swing < 180.0 else 1.0
    reaches = bool(list_families(problem.time_ratio, math.radians(swing)))
    if swing >= 180.0:
        reason = compose("quick_return-crank-rocker-swing")
    else:
        reason = compose("quick_return-crank-rocker-two-circuits", ratio=f"{greatest:.6g}", swing=f"{swing:g}")
    return RatioRange(
        type="fourbar", least=1.0, least_included=swing < 180.0, greatest=greatest, reaches=reaches, reason=reason
    )


def build_crank_rockers(problem: QuickReturnProblem) -> list[FourbarMechanism]:
    """Return the best crank-rocker of each family within the limit of the link ratio, and some with shorter links."""
    assert problem.swing_angle is not None
    limit = problem.link_ratio_limit
    demanded = math.radians(problem.constraints.min_transmission_angle or 0.0)
    mechanisms: list[FourbarMechanism] = []
    for family in list_families(problem.time_ratio, math.radians(problem.swing_angle)):
        best = family.find_near_best(demanded)
        # The transmission angle increases up to the optimum, so that the limit itself is best below it.
        rho = best if limit is None else min(best, family.find_longest(limit * (1.0 - LIMIT_TOLERANCE)))
        if rho <= 1.0:
            continue  # every member has a larger link ratio
        members = [rho, *list_shorter_members(rho, family.find_longest, family.compute_transmission)]
        mechanisms += [_build_mechanism(problem, family, member) for member in members]
    return mechanisms


def _build_mechanism(problem: QuickReturnProblem, family: CrankRockerFamily, rho: float) -> FourbarMechanism:
    """Build the member of a family at the beginning of its slow stroke."""
    b, c, d = family.compute_lengths(rho)
    turn = complex(math.cos(family.psi), math.sin(family.psi))
    overlap = complex(math.cos(family.phi), math.sin(family.phi))
    # Crank along +x in the position of extension; B goes from 1 + ρ to −(ρ − 1) e^{iφ}.
    b1, b2 = complex(rho + 1.0), (1.0 - rho) * overlap
    o4 = (b2 - b1 * turn) / (1.0 - turn)
    extended = family.phi >= math.pi
    # The slow stroke begins in extension for φ > π, in overlap for φ < π.
    at_b, at_a = (b1, 1.0 + 0j) if extended else (b2, overlap)
    scale = problem.compute_scale(1.0, max(b, c, d), c)
    angle = math.radians(problem.direction)
    place = scale * complex(math.cos(angle), math.sin(angle)) * o4.conjugate() / abs(o4)
    ground = scale * d * complex(math.cos(angle), math.sin(angle))
    pole = problem.pole
    o2 = problem.o2 if pole is None else pole - ground
    joints = {
        "O2": o2,
        "O4": o2 + ground if pole is None else pole,
        "A": o2 + place * at_a,
        "B": o2 + place * at_b,
    }
    body: dict[str, complex] = {}
    standing = None
    if problem.positions is not None:
        # The rocker turns counter-clockwise from extension to overlap.
        standing = problem.positions[0 if extended == (problem.rotation > 0.0) else 1]
        body = {"C": standing.point}
    diagonal, coupler = o4 - at_a, at_b - at_a
    return FourbarMechanism(
        fixed_pivots=FixedPivots(input=to_point(o2), output=to_point(joints["O4"])),
        links=FourbarLinks(ground=scale * d, input=scale, coupler=scale * b, output=scale * c),
        coupler_point=CouplerPoint(distance=0.0, angle=0.0),
        assembly="open" if (diagonal.conjugate() * coupler).imag >= 0.0 else "crossed",
        reference_input_angle=math.degrees(cmath.phase(place * at_a)),
        reference_body_angle=None if standing is None else standing.angle,
        skeleton=build_skeleton(
            joints | body,
            {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B"], "output": ["O4", "B", *body]},
        ),
    )
