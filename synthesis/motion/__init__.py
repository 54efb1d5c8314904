"""Motion generation: carry a body through given positions. The door is :func:`synthesis.motion.solver.solve_motion`."""
