"""Export of designs to MuJoCo, Gazebo and other readers of URDF, and Modelica (docs/mechanisms/simulation.md).

:mod:`~service.simulation.model` defines the simulated machine, :mod:`~service.simulation.linkage` and
:mod:`~service.simulation.trains` build it from a design, and one module writes each format. The output is text; none
of these programs is run here.
"""
