"""Designs for programs that simulate them: MuJoCo, Gazebo and other readers of URDF, Modelica (docs/simulation.md).

:mod:`~service.simulation.model` says what is simulated, :mod:`~service.simulation.linkage` and
:mod:`~service.simulation.trains` make it of a design, and one module writes each form. Text alone: none of these
programs is asked here.
"""
