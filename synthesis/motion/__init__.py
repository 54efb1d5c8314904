"""Motion generation: carry a body through given positions."""

from synthesis.motion.solver import solve_motion

__all__ = ["solve_motion"]
