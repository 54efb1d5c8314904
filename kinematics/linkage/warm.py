"""Compilation ahead of time: call every kernel of the package once, so that no later call waits for the compiler."""

from __future__ import annotations

import numpy as np

from kinematics.linkage import slider_crank
from kinematics.linkage.fourbar import closed_form as fourbar
from kinematics.linkage.fourbar.circuits import find_input_limits, stays_on_branch
from kinematics.linkage.fourbar.classification import barker_type
from kinematics.linkage.fourbar.transmission import find_transmission_extremes
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.variation import Task, measure_deviations, measure_shares


def warm_up() -> None:
    """Compile the kernels of the package, or load them from their cache."""
    angles = np.linspace(0.0, 1.0, 3)
    linkage = fourbar.Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, 1j)
    fourbar.positions(linkage, angles)
    fourbar.coupler_points(linkage, angles)
    fourbar.coupler_motion(linkage, angles)
    fourbar.motion(linkage, angles)
    find_input_limits(linkage)
    stays_on_branch(linkage, 0.0, 1.0)
    find_transmission_extremes(linkage, 0.0, 1.0)
    barker_type(linkage)
    at = fourbar.positions(linkage, angles)
    task = Task("poses", np.ones(3, np.int64), angles, points=at.p, angles=at.coupler_angle, used=(0.0, 1.0))
    made = np.array([[0.0, 0.0, 6.0, 0.0, 2.0, 7.0, 9.0, 0.0, 1.0]])
    measure_deviations(task, made)
    measure_shares(task, made)
    slider = slider_crank.SliderCrank.from_lengths(1.0, 3.0, 0.5, 1j)
    slider_crank.positions(slider, angles)
    slider_crank.coupler_points(slider, angles)
    slider_crank.motion(slider, angles)
    drive(catalogue.make_fourbar(linkage, 0.0), angles)
    stephenson_2 = {"O2": 0.0, "O4": 4.0, "A": 0.3 + 1j, "C": 0.8 + 0.6j, "B": 1.5 + 3j, "D": 3.0 + 2.2j, "E": 4.2 + 2j}
    drive(catalogue.make_sixbar("stephenson_2", stephenson_2), angles)
