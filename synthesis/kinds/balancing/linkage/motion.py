"""A linkage with its masses over the motion for which it is balanced."""

from __future__ import annotations

from dataclasses import replace

from kinematics.dynamics.friction import Friction
from kinematics.dynamics.machine import Machine
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.analyses.linkages.requested_motion import Task, build_task
from synthesis.kinds.balancing.problem import BalancingProblem


def build_balancing_task(problem: BalancingProblem) -> Task:
    """Build the machine and the motion of a problem without contradictions."""
    assert problem.mechanism is not None
    assert problem.dynamics is not None
    return build_task(problem.mechanism, problem.dynamics, problem.length_unit, problem.motion)


def strip_loads(machine: Machine) -> Machine:
    """Return the machine with its masses only, without gravity, loads or friction."""
    return replace(machine, gravity=0j, loads=(), friction=Friction())


def list_moving_links(mechanism: Mechanism) -> list[str]:
    """List the moving links."""
    return [link for link in mechanism.links if link != GROUND]


def find_pivot(mechanism: Mechanism, link: str) -> str:
    """Return the joint from which a weight on a link is measured: its fixed pivot, or its first joint."""
    fixed = [joint for joint in mechanism.links[link] if joint in mechanism.links[GROUND]]
    return fixed[0] if fixed else mechanism.link_line(link)[0]


def is_on_fixed_pivot(mechanism: Mechanism, link: str) -> bool:
    """Return whether a link turns about a fixed pivot."""
    return find_pivot(mechanism, link) in mechanism.links[GROUND]
