"""A machine of pins simulated forwards in time by Exudyn, an independent multibody program (J. Gerstmayr, Innsbruck).

Every link is a rigid body with three coordinates, every pin a constraint, and another one holds the crank at constant
speed; the equations of motion are integrated by the generalized-alpha method, and the constraint's multiplier is the
torque that drives. Nothing of what is tested is used but places and velocities at the start. ``make campaign`` installs
the program.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.dynamics import Machine, Places, Spring
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND

RADIUS = 0.6
"""Spectral radius of the integrator: below 1 it damps oscillations that constraints would keep up from step to step."""


class Simulated(NamedTuple):
    """Input angles after each step, and the drive's torque there."""

    input: np.ndarray
    torque: np.ndarray


def simulated(machine: Machine, speed: float, steps: int) -> Simulated:
    """One turn from the reference on in so many steps; machines with loads other than :class:`Spring` are refused."""
    import exudyn as exu
    from exudyn import itemInterface as item

    mechanism = machine.mechanism
    assert not mechanism.shape
    assert not mechanism.slides
    assert not mechanism.gears
    assert not machine.pin_masses
    start = float(mechanism.reference_input)
    now = Places(mechanism, drive(mechanism, [start], speed=speed, order=2))
    system = exu.SystemContainer().AddSystem()
    frame = system.AddObject(item.ObjectGround())
    nodes: dict[str, int] = {}
    bodies: dict[str, tuple[int, complex]] = {GROUND: (frame, 0j)}
    for link, part in machine.bodies.items():
        cg, velocity = complex(part.cg), complex(now.point(link, part.cg)[1][0])
        nodes[link] = system.AddNode(
            item.NodeRigidBody2D(
                referenceCoordinates=[cg.real, cg.imag, 0.0],
                initialVelocities=[velocity.real, velocity.imag, float(now.spins[link][1][0])],
            )
        )
        body = system.AddObject(
            item.ObjectRigidBody2D(mass=float(part.mass), inertia=float(part.inertia), nodeNumber=nodes[link])
        )
        bodies[link] = body, cg
        weight = float(part.mass) * machine.gravity
        centre = system.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=[0.0, 0.0, 0.0]))
        system.AddLoad(item.LoadForceVector(markerNumber=centre, loadVector=[weight.real, weight.imag, 0.0]))

    def marker(link: str, place: complex) -> int:
        body, origin = bodies[link]
        local = [(place - origin).real, (place - origin).imag, 0.0]
        return int(system.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=local)))

    for joint, z in mechanism.joints.items():
        first, *others = [link for link, listed in mechanism.links.items() if joint in listed]
        for other in others:
            pin = [marker(first, complex(z)), marker(other, complex(z))]
            system.AddObject(item.ObjectJointRevolute2D(markerNumbers=pin))
    for spring in machine.loads:
        assert isinstance(spring, Spring)
        assert not spring.one_sided
        ends = [marker(link, complex(z)) for link, z in zip(spring.links, spring.places, strict=True)]
        system.AddObject(
            item.ObjectConnectorSpringDamper(
                markerNumbers=ends,
                referenceLength=spring.free_length,
                stiffness=spring.rate,
                damping=spring.damping,
                force=spring.preload,
            )
        )
    still = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=system.AddNode(item.NodePointGround()), coordinate=0))
    turning = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=nodes[mechanism.input], coordinate=2))
    held = system.AddObject(
        item.ObjectConnectorCoordinate(markerNumbers=[still, turning], velocityLevel=True, offset=speed)
    )
    torque = system.AddSensor(
        item.SensorObject(objectNumber=held, outputVariableType=exu.OutputVariableType.Force, storeInternal=True)
    )
    system.Assemble()
    turn = 2.0 * np.pi / abs(speed)
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = turn
    settings.timeIntegration.newton.relativeTolerance = 1e-10
    settings.timeIntegration.newton.absoluteTolerance = 1e-12
    settings.timeIntegration.generalizedAlpha.spectralRadius = RADIUS
    settings.timeIntegration.generalizedAlpha.computeInitialAccelerations = True
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = turn / steps
    assert system.SolveDynamic(settings)
    time, multiplier = system.GetSensorStoredData(torque).T
    return Simulated(start + speed * time, -multiplier)
