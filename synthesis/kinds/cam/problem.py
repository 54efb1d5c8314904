"""Cams: a motion program, a follower, limits, and the quantity to minimize."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.kinds.cam.statement.followers import (
    BarrelRoller,
    Follower,
    FollowerDynamics,
    OscillatingFlat,
    RateRange,
    TranslatingFlat,
    TranslatingRoller,
    find_follower_contradictions,
)
from synthesis.kinds.cam.statement.limits import CamLimits
from synthesis.kinds.cam.statement.program import ProgramStatement
from synthesis.kinds.cam.statement.segments import Move, Segment
from synthesis.model.dimension import ROTATIONAL_SPEED
from synthesis.model.problem import Contradiction, Count, Flag, PositiveNumber, ProblemBase

METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 1.0}
"""Factor from length units for which F = m a holds with newtons and kilograms; lbf, lbf s²/in and inches are
consistent, so that their factor is 1."""

Criterion = Literal[
    "size",
    "peak_velocity",
    "peak_acceleration",
    "peak_jerk",
    "rms_velocity",
    "rms_acceleration",
    "rms_jerk",
    "peak_torque",
    "rms_torque",
    "peak_contact_force",
]


class CamProblem(ProblemBase):
    """A motion program and the smallest feasible cam for it.

    Every segment follows the one before; their angles add up to one turn. Displacement, velocity and acceleration must
    be continuous all around, the fundamental law of cam design, unless ``accept_discontinuity`` is set.
    """

    model_config = ConfigDict(
        title="Cam",
        json_schema_extra={
            "examples": [
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "dwell", "angle": 90.0},
                        {"motion": "rise", "angle": 90.0, "lift": 25.0, "law": "modified_sine"},
                        {"motion": "dwell", "angle": 90.0},
                        {"motion": "return", "angle": 90.0, "law": "cycloidal"},
                    ],
                    "follower": {"type": "translating_roller", "roller_radius": 10.0},
                    "limits": {"pressure_angle": 30.0, "curvature_ratio": 2.0},
                    "speed_rpm": 60.0,
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "rise", "angle": 90.0, "lift": 1.0, "law": "optimal"},
                        {"motion": "fall", "angle": 90.0, "lift": 1.0, "law": "optimal"},
                        {"motion": "dwell", "angle": 180.0},
                    ],
                    "follower": {"type": "translating_roller", "roller_radius": 0.5, "offset": "free"},
                    "limits": {"pressure_angle": 30.0, "curvature_ratio": 2.0, "jerk": 30.0},
                    "minimize": "peak_acceleration",
                    "speed_rpm": 143.24,
                    "length_unit": "in",
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "constant_velocity", "angle": 180.0, "lift": 5.0},
                        {"motion": "return", "angle": 180.0, "law": "optimal"},
                    ],
                    "follower": {"type": "translating_roller", "roller_radius": 1.0},
                    "limits": {"pressure_angle": 30.0, "curvature_ratio": 2.0, "jerk": 19.351},
                    "minimize": "peak_acceleration",
                    "speed_rpm": 60.0,
                    "length_unit": "in",
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "rise", "angle": 62.0, "lift": 9.0, "law": "optimal"},
                        {"motion": "fall", "angle": 62.0, "lift": 9.0, "law": "optimal"},
                        {"motion": "dwell", "angle": 236.0},
                    ],
                    "follower": {"type": "translating_flat"},
                    "limits": {"min_radius": 3.0, "jerk": 350.0, "face_width": 32.0},
                    "dynamics": {"mass": 0.12, "spring_rate": 30.0, "least_force": 100.0},
                    "minimize": "peak_contact_force",
                    "speed_rpm": 3000.0,
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "rise", "angle": 150.0, "lift": 40.0, "law": "modified_sine"},
                        {"motion": "dwell", "angle": 30.0},
                        {"motion": "return", "angle": 150.0, "law": "modified_sine"},
                        {"motion": "dwell", "angle": 30.0},
                    ],
                    "follower": {"type": "barrel_roller", "roller_radius": 8.0},
                    "limits": {"pressure_angle": 35.0, "curvature_ratio": 1.5},
                    "speed_rpm": 120.0,
                },
            ]
        },
    )

    kind: Literal["cam"]
    segments: list[Segment] = Field(min_length=1, description="The segments of one turn, in order.")
    follower: Follower
    limits: CamLimits = CamLimits()
    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Cam speed, revolutions per minute."
    )
    rotation: Literal["ccw", "cw"] = Field(default="ccw", description="Sense of rotation of the cam.")
    minimize: Criterion = Field(
        default="peak_acceleration",
        description="Quantity that automatic and optimal motions minimize; the cam is then made as small as possible.",
    )
    closure: Literal["force", "form", "conjugate"] = Field(
        default="force",
        description="How the cam keeps the follower in contact: by force; by a groove whose two walls guide the "
        "roller; "
        "or by a second cam on the shaft, conjugate to the first, with a roller of its own on the other side.",
    )
    dynamics: FollowerDynamics | None = None
    continuity: Literal["acceleration", "jerk"] = Field(
        default="acceleration", description="Highest derivative that is continuous in optimal motions."
    )
    accept_discontinuity: Flag = Field(
        default=False,
        description="Accept a program whose acceleration jumps, or whose velocity jumps up if a force holds the "
        "follower. Sudden drops of the velocity, and any velocity jump in a groove, are always refused: the cam would "
        "need an edge that no follower can track.",
    )
    profile_points: Annotated[Count, Field(ge=180, le=7200)] = Field(
        default=720,
        description="Points of the profile at equal cam angles; more if the motion needs them. Points within 2 % of a "
        "step from a jump of a derivative of the motion are replaced by one at the jump, and so are points between "
        "others that are closer together than a tenth of a step.",
    )

    @property
    def is_oscillating(self) -> bool:
        """True if displacements are degrees of an arm."""
        return self.follower.type.startswith("oscillating")

    @property
    def displacement_unit(self) -> float:
        """Factor from requested displacements to the solver's: radians of an arm, or lengths."""
        return math.pi / 180.0 if self.is_oscillating else 1.0

    @property
    def program(self) -> ProgramStatement:
        """The motion program, in the solver's displacements."""
        return ProgramStatement(self.segments, self.displacement_unit)

    def find_contradictions(self) -> list[Contradiction]:
        """Return contradictions between several fields."""
        contradictions = [
            *self.program.find_segment_contradictions(),
            *self._check_closure(),
            *find_follower_contradictions(self.follower),
            *self._check_inputs(),
            *self._check_limits(),
            *self._check_overturning(),
        ]
        # Check joints only if the segments themselves are sound, because their ends are undefined otherwise.
        return contradictions or self.program.find_joint_contradictions(self.accept_discontinuity, self.is_form_closed)

    @property
    def is_form_closed(self) -> bool:
        """True if the follower runs between two walls, or two cams, so that no force has to hold it."""
        return self.closure != "force" or isinstance(self.follower, BarrelRoller)

    def _check_closure(self) -> list[Contradiction]:
        """Check the form closure: a groove or two cams can only guide a roller."""
        if self.closure != "force" and isinstance(self.follower, TranslatingFlat | OscillatingFlat):
            fault = "cam-pair-needs-rollers" if self.closure == "conjugate" else "cam-groove-needs-roller"
            return [Contradiction("/closure", compose(fault))]
        if self.closure == "conjugate" and isinstance(self.follower, BarrelRoller):
            return [Contradiction("/closure", compose("cam-barrel-has-walls"))]
        if self.closure == "conjugate" and isinstance(self.follower, TranslatingRoller) and self.follower.overhang:
            return [Contradiction("/follower/overhang", compose("cam-yoke-has-no-overhang"))]
        return []

    def _check_spring(self, dynamics: FollowerDynamics) -> list[Contradiction]:
        """Check a free spring, and the maximum speed at which it must hold the follower."""
        contradictions, rate, speed = [], dynamics.spring_rate, self.speed_rpm
        assert speed is not None
        # Spring and motion cannot both be optimized for the contact force.
        free, sought = (
            not isinstance(rate, float),
            any(isinstance(segment, Move) and segment.follows_criterion for segment in self.segments),
        )
        if isinstance(rate, RateRange) and rate.min >= rate.max:
            contradictions.append(Contradiction("/dynamics/spring_rate/max", compose("cam-max-not-above-min")))
        elif isinstance(rate, RateRange) and dynamics.min_frequency_ratio is not None:
            least = (
                dynamics.mass * METRES[self.length_unit] * (dynamics.min_frequency_ratio * speed * math.pi / 30.0) ** 2
            )
            if least > rate.max:
                detail = compose("cam-spring-range-too-low", least=f"{least:.6g}")
                contradictions.append(Contradiction("/dynamics/min_frequency_ratio", detail))
        if dynamics.damping is not None:
            if dynamics.damping_ratio > 0.0:
                contradictions.append(Contradiction("/dynamics/damping", compose("cam-damping-twice")))
            elif free:
                # The search for a spring keeps the damping ratio, so that the coefficient changes with the rate.
                contradictions.append(Contradiction("/dynamics/damping", compose("cam-damping-needs-given-spring")))
        if dynamics.train_damping_ratio > 0.0 and dynamics.train_stiffness is None:
            detail = compose("cam-train-stiffness-missing")
            contradictions.append(Contradiction("/dynamics/train_damping_ratio", detail))
        if dynamics.max_rpm is not None and dynamics.max_rpm < speed:
            contradictions.append(Contradiction("/dynamics/max_rpm", compose("cam-max-rpm-below-speed")))
        if self.is_form_closed:
            if free:
                contradictions.append(Contradiction("/dynamics/spring_rate", compose("cam-walls-need-no-spring")))
            if dynamics.max_rpm is not None:
                contradictions.append(Contradiction("/dynamics/max_rpm", compose("cam-groove-keeps-contact")))
        if self.minimize == "peak_contact_force" and sought:
            if free:
                detail = compose("cam-spring-and-motion-unknown")
                contradictions.append(Contradiction("/dynamics/spring_rate", detail))
            if dynamics.max_rpm is not None:
                detail = compose("cam-contact-force-at-one-speed")
                contradictions.append(Contradiction("/dynamics/max_rpm", detail))
        return contradictions

    def _check_overturning(self) -> list[Contradiction]:
        """Check the limit on the overturning moment: it requires forces, and a slide with a known lever arm."""
        follower, contradictions = self.follower, []
        forces = self.dynamics is not None
        if isinstance(follower, TranslatingRoller) and follower.overhang is not None:
            if not forces:
                detail = compose("cam-overhang-needs-dynamics")
                contradictions.append(Contradiction("/follower/overhang", detail))
            elif follower.overhang <= max(max(pair) for pair in self.program.heights()):
                detail = compose("cam-overhang-too-short")
                contradictions.append(Contradiction("/follower/overhang", detail))
        if isinstance(follower, TranslatingFlat) and follower.offset == "free" and not forces:
            detail = compose("cam-free-offset-needs-dynamics")
            contradictions.append(Contradiction("/follower/offset", detail))
        if self.limits.overturning_moment is None:
            return contradictions
        place = "/limits/overturning_moment"
        if not isinstance(follower, TranslatingRoller | TranslatingFlat):
            contradictions.append(Contradiction(place, compose("cam-moment-needs-slide")))
        elif not forces:
            contradictions.append(Contradiction(place, compose("cam-moment-needs-dynamics")))
        elif isinstance(follower, TranslatingRoller) and follower.overhang is None:
            contradictions.append(Contradiction("/follower/overhang", compose("cam-moment-needs-overhang")))
        return contradictions

    def _check_limits(self) -> list[Contradiction]:
        """Check that limits on the motion are only given if some motion is left to choose."""
        if any(isinstance(segment, Move) and segment.follows_criterion for segment in self.segments):
            return []
        detail = compose("cam-limits-need-free-law")
        return [
            Contradiction(f"/limits/{name}", detail)
            for name in ("velocity", "acceleration", "jerk")
            if getattr(self.limits, name) is not None
        ]

    def _check_inputs(self) -> list[Contradiction]:
        """Check the inputs that a criterion needs."""
        contradictions = []
        force = self.minimize == "peak_contact_force"
        if force and self.dynamics is None:
            contradictions.append(Contradiction("/dynamics", compose("cam-contact-force-needs-dynamics")))
        if force and self.is_form_closed:
            contradictions.append(Contradiction("/minimize", compose("cam-groove-has-no-contact-force")))
        if self.dynamics is not None and self.dynamics.least_force > 0.0 and self.is_form_closed:
            detail = compose("cam-groove-has-no-least-force")
            contradictions.append(Contradiction("/dynamics/least_force", detail))
        if self.dynamics is not None and self.speed_rpm is None:
            contradictions.append(Contradiction("/speed_rpm", compose("cam-forces-need-speed")))
        elif self.dynamics is not None:
            contradictions += self._check_spring(self.dynamics)
        optimal = any(isinstance(segment, Move) and segment.law == "optimal" for segment in self.segments)
        if optimal and self.minimize == "size" and self.is_oscillating:
            detail = compose("cam-least-size-needs-translation")
            contradictions.append(Contradiction("/minimize", detail))
        if optimal and self.minimize == "size" and isinstance(self.follower, BarrelRoller):
            detail = compose("cam-least-barrel-by-velocity")
            contradictions.append(Contradiction("/minimize", detail))
        return contradictions
