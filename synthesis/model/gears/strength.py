"""Tooth stresses of a pair of gears under load: request, answer, and the face width that carries the power.

This is a first estimate by the equations of Lewis and AGMA (:mod:`kinematics.gear.strength`). Their factors are given
by the client or computed by textbook formulas. Bearings, lubrication, wear and life are ignored.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from kinematics.errors import DimensionError
from kinematics.gear import strength
from kinematics.gear.flanks import Contact
from kinematics.gear.strength import Factors, Load
from kinematics.gear.teeth import Gear, Mesh
from kinematics.gear.train import TrainStage
from kinematics.message import compose, join_messages
from synthesis.model.answer import Answer, optional_field
from synthesis.model.dimension import ROTATIONAL_SPEED, Length
from synthesis.model.gears.answer import apply_tool_contact
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import PositiveNumber, Statement

Positive = Annotated[float, Field(strict=True, ge=1e-6, le=1e6)]

AGMA_FACTORS = ("size", "load_distribution", "rim", "bending_geometry", "contact_geometry", "elastic")
"""Factors of the AGMA equations that Lewis's equation does not have."""

RATED_STAGE_TYPES = ("external", "internal", "helical")
"""Types of stages whose strength is estimated."""

REVERSED_BENDING_FACTOR = 0.7
"""Share of the allowable bending stress that AGMA permits for teeth that are bent in both directions in every turn,
such as those of an idler (Shigley, Sec. 14-4)."""

EQUALITY_TOLERANCE = 1e-12
"""Relative deficit of power that is ignored as rounding."""

WIDTH_COUNT = 400
"""Number of steps of the face width, in equal ratios, in the search for the minimum width that carries the load."""


class StrengthFactors(Statement):
    """Factors that replace computed ones; pairs are for the first and the second gear."""

    form: tuple[Positive, Positive] | None = Field(
        default=None,
        description="Lewis's Y, also used by the size factor; by default from the true profile, loaded at the tip.",
    )
    overload: Positive = 1.0
    dynamic: Positive | None = Field(
        default=None,
        description="Dynamic factor; by default (1200 + V)/1200 for cut teeth with V in ft/min (Lewis), or by the "
        "quality number (AGMA).",
    )
    size: tuple[Positive, Positive] | None = Field(
        default=None, description="Size factor; by default 1.192 (F √Y / P)^0.0535, at least 1."
    )
    load_distribution: Positive | None = Field(
        default=None,
        description="Load distribution factor; by default for uncrowned teeth close to both bearings, in a commercial "
        "enclosed unit.",
    )
    rim: Positive = 1.0
    bending_geometry: tuple[Positive, Positive] | None = Field(
        default=None,
        description="AGMA's J; by default from the true profile. Fillets have a radius of 0.38 modules (ISO 53); "
        "tables for racks with 0.25 give about a tenth less. For rings and helical gears it has to be given.",
    )
    contact_geometry: Positive | None = Field(
        default=None,
        description="AGMA's I; for helical gears it has to be given if the face is narrower than an axial pitch.",
    )
    elastic: Positive | None = Field(default=None, description="AGMA's C_p, √MPa; by default 191, for steel on steel.")


class StrengthMethod(Statement):
    """Strength method, its factors, and the allowable stresses of the material."""

    method: Literal["lewis", "agma"] = "agma"
    quality: Annotated[float, Field(strict=True, ge=3.0, le=11.5)] = Field(
        default=6.0, description="AGMA's quality number Q_v, for the dynamic factor."
    )
    factors: StrengthFactors = StrengthFactors()
    allowable_bending: tuple[Positive, Positive] | None = Field(
        default=None, description="Allowable bending stress of both gears, MPa."
    )
    allowable_contact: tuple[Positive, Positive] | None = Field(
        default=None, description="Allowable contact stress of both gears, MPa; AGMA only."
    )
    max_face_width: Annotated[float, Field(strict=True, ge=1.0, le=100.0)] = Field(
        default=16.0, description="Maximum face width, in modules, when the minimum width is searched."
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find, by the path below this statement."""
        if self.method != "lewis":
            return []
        faults = []
        if self.allowable_contact is not None:
            faults.append(("/allowable_contact", compose("model-lewis-without-contact-stress")))
        if _is_given(self, "quality"):
            faults.append(("/quality", compose("model-lewis-without-quality")))
        return faults + [
            (f"/factors/{name}", compose("model-lewis-without-factor"))
            for name in AGMA_FACTORS
            if _is_given(self.factors, name)
        ]

    def find_ring_errors(self) -> list[tuple[str, str]]:
        """Return errors for a pair whose second gear is a ring, for which the form of the teeth must be given."""
        name = "form" if self.method == "lewis" else "bending_geometry"
        if self.allowable_bending is None or getattr(self.factors, name) is not None:
            return []
        return [("/allowable_bending", compose("model-ring-bending-needs-factor", name=name))]

    def find_helix_errors(self) -> list[tuple[str, str]]:
        """Return errors for helical teeth, whose bending geometry factor is read from charts and must be given."""
        if self.method == "lewis":
            return [("/method", compose("model-lewis-only-spur"))]
        if self.allowable_bending is None or self.factors.bending_geometry is not None:
            return []
        detail = compose("model-helix-bending-needs-factor")
        return [("/allowable_bending", detail)]

    @property
    def required_safeties(self) -> list[str]:
        """Names of the safety factors whose allowable stresses are given."""
        stated = {"bending_safety": self.allowable_bending, "contact_safety": self.allowable_contact}
        return [name for name, allowable in stated.items() if allowable is not None]


def _is_given(statement: Statement, name: str) -> bool:
    """Return whether a field differs from its default."""
    return bool(getattr(statement, name) != type(statement).model_fields[name].default)


class StrengthSpec(StrengthMethod):
    """Strength method and the transmitted power, for pairs without a torque and a speed."""

    power_kw: PositiveNumber


class CarriedPower(StrengthSpec):
    """Power that a train has to carry; pairs are for the driving and the driven gear of every mesh."""

    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] = Field(
        description="Speed of the input shaft, revolutions per minute."
    )

    @property
    def power(self) -> float:
        """Power on the input shaft, W, and on all other shafts, since losses are neglected."""
        return 1000.0 * self.power_kw

    @property
    def speed(self) -> float:
        """Speed of the input shaft, rad/s."""
        return self.speed_rpm * math.pi / 30.0

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find, by the path below this statement."""
        if self.required_safeties:
            return super().find_errors()
        return [*super().find_errors(), ("/allowable_bending", compose("model-allowable-stress-missing"))]


class StressedGear(Answer):
    """Stresses (MPa) and safety factors of one gear; null if an input is missing or a value unknown."""

    form: float | None = Field(
        description="Lewis's form factor Y, for helical gears in the normal plane; null for a ring without a given "
        "value."
    )
    size_factor: float | None
    bending_geometry: float | None
    bending_stress: float | None
    contact_stress: float | None
    bending_safety: float | None = Field(description="Allowable over actual bending stress.")
    contact_safety: float | None = Field(description="Allowable over actual contact stress.")
    bent_both_ways: bool | None = optional_field(
        f"True for an idler, and for a planet gear that meshes on both flanks. Every turn bends its teeth in both "
        f"directions, so that `bending_safety` uses {REVERSED_BENDING_FACTOR} of the allowable bending stress."
    )
    bending_judged: bool | None = optional_field(
        "False for a ring of a planetary train without a given geometry factor: its bending stress is unknown and not "
        "checked."
    )


class PairStrength(Answer):
    """Stresses of a pair at a face width."""

    method: str
    estimate: str
    tangential_force: float = Field(description="Tangential force on the working pitch circles, N.")
    pitch_line_velocity: float = Field(description="m/s")
    dynamic: float
    load_distribution: float | None
    contact_geometry: float | None
    sharing_ratio: float | None = optional_field(
        "AGMA's m_N of helical teeth: face width over the minimum total length of the lines of contact. Left out if "
        "the face is narrower than an axial pitch; without `contact_geometry` the contact stress is then unknown."
    )
    face_width: Length | None = Field(
        description="Given face width, or the minimum that carries the load; in the unit of the module."
    )
    least_face_width: Length | None = optional_field(
        "Minimum face width within all given allowable stresses; left out if none is given, if no width up to "
        "`max_face_width` suffices, or if a stress is unknown."
    )
    load_sharing: float | None = optional_field(
        "Load sharing factor of planetary trains: force on the most loaded planet over an equal share. The force and "
        "all stresses include it."
    )
    gears: list[StressedGear]


class LoadedPair(NamedTuple):
    """A pair of gears and its load.

    Attributes
    ----------
    contact : Contact
        The gears in millimetres; helical gears in the plane of rotation.
    power : float
        Transmitted power, W.
    speed : float
        Speed of the first gear, rad/s.
    both_ways : pair of bool
        Whether the teeth of the first and of the second gear are bent in both directions.
    spares_rings : bool
        Whether the unknown bending stress of a ring is not judged.
    helix_angle : float
        Helix angle, radians; 0 for spur gears.
    """

    contact: Contact
    power: float
    speed: float
    both_ways: tuple[bool, bool] = (False, False)
    spares_rings: bool = False
    helix_angle: float = 0.0

    @property
    def module(self) -> float:
        """Module in the normal plane, millimetres."""
        return self.contact.mesh.pinion.module * math.cos(self.helix_angle)

    def project_to_normal_plane(self, gear: Gear) -> Gear:
        """Return the equivalent spur gear of a helical gear, with z / cos³ β teeth; a spur gear is unchanged."""
        if self.helix_angle == 0.0:
            return gear
        shrunk = math.cos(self.helix_angle)
        return replace(
            gear,
            teeth=gear.teeth / shrunk**3,
            module=self.module,
            pressure_angle=math.atan(math.tan(gear.pressure_angle) * shrunk),
            addendum=gear.addendum / shrunk,
            dedendum=gear.dedendum / shrunk,
            shift=gear.shift / shrunk,
        )

    def compute_load_sharing(self, width: float) -> float | None:
        """Compute AGMA's m_N for a face width: 1 for spur teeth, None if the face is narrower than an axial pitch."""
        if self.helix_angle == 0.0:
            return 1.0
        mesh = self.contact.mesh
        helix = math.atan(math.tan(abs(self.helix_angle)) * math.cos(mesh.pinion.pressure_angle))
        if width * math.tan(helix) < mesh.pinion.base_pitch or mesh.contact_ratio < 1.0:
            return None
        return strength.compute_load_sharing(mesh.contact_ratio, mesh.pinion.base_pitch, helix, width)

    @property
    def working_diameters(self) -> tuple[float, float]:
        """Diameters of the working pitch circles."""
        mesh = self.contact.mesh
        wide = math.cos(mesh.pinion.pressure_angle) / math.cos(mesh.pressure_angle)
        return 2.0 * mesh.pinion.pitch_radius * wide, 2.0 * mesh.gear.pitch_radius * wide

    def compute_load(self, width: float) -> Load:
        """Compute the load, with its tangential force (N) and speed (m/s), for a face width in millimetres."""
        diameters = self.working_diameters
        velocity = self.speed * 0.5e-3 * diameters[0]
        return Load(self.power / velocity, velocity, width, self.contact.mesh.pinion.module, min(diameters))


class Stresses(NamedTuple):
    """Stresses at a face width: the load, the factors common to both gears, and a row of values for each gear."""

    load: Load
    dynamic: float
    load_distribution: float | None
    contact_geometry: float | None
    gears: list[JsonObject]
    sharing: float | None = None

    def select_safeties(self, names: list[str]) -> list[tuple[str, float | None]]:
        """Return pairs (name, value) of the named safety factors of both gears, except those that are not judged."""
        judged = [(row, name) for row in self.gears for name in names]
        return [(name, row[name]) for row, name in judged if name != "bending_safety" or "bending_judged" not in row]

    def has_safeties(self, names: list[str]) -> bool:
        """Return whether the named safety factors of both gears are known and at least 1."""
        return all(safety is not None and safety >= 1.0 for _, safety in self.select_safeties(names))


class StressCalculator:
    """Calculator of the stresses of a pair as functions of its face width.

    Quantities that do not depend on the width are computed once.
    """

    def __init__(self, loaded: LoadedPair, stated: StrengthMethod) -> None:
        self._loaded, self._stated = loaded, stated
        mesh, factors = loaded.contact.mesh, stated.factors
        given = factors.form, factors.bending_geometry
        self._forms: list[float | None] = []
        self._bending: list[float | None] = []
        for place, gear in enumerate((mesh.pinion, mesh.gear)):
            self._forms.append(
                given[0][place] if given[0] else self._compute_lewis_factor(loaded.project_to_normal_plane(gear))
            )
            self._bending.append(given[1][place] if given[1] else self._compute_agma_factor(gear, place))

    @staticmethod
    def _compute_lewis_factor(gear: Gear) -> float | None:
        """Compute Lewis's form factor; None for a ring, or if the tooth profile is not that of a beam."""
        try:
            return None if gear.internal else strength.compute_lewis_form(gear)
        except DimensionError:
            return None

    def _compute_agma_factor(self, gear: Gear, place: int) -> float | None:
        """Compute AGMA's bending geometry factor; None if it is unknown or not needed by the method."""
        try:
            known = self._stated.method == "agma" and not gear.internal and self._loaded.helix_angle == 0.0
            return strength.compute_bending_geometry(self._loaded.contact, place == 1) if known else None
        except DimensionError:
            return None

    def replace_power(self, power: float, turning: float) -> StressCalculator:
        """Return a calculator for the same pair with another power (W) and another speed of its first gear (rad/s)."""
        # A shallow copy shares the geometry factors and the cached maximum force, which do not depend on the power.
        other = copy(self)
        other._loaded = self._loaded._replace(power=power, speed=turning)
        return other

    def compute_stresses(self, width: float) -> Stresses:
        """Compute the stresses for a face width in millimetres."""
        stated, factors, load = self._stated, self._stated.factors, self._loaded.compute_load(width)
        mesh = self._loaded.contact.mesh
        if stated.method == "lewis":
            dynamic = self._compute_dynamic_factor(load)
            rows = [
                self._build_gear_row(k, form, None, self._compute_lewis_stress(load, form, dynamic), None)
                for k, form in enumerate(self._forms)
            ]
            return Stresses(load, dynamic, None, None, rows)
        dynamic = self._compute_dynamic_factor(load)
        spread = factors.load_distribution or strength.compute_load_distribution(width, load.pinion_diameter)
        teeth, sharing = sorted((mesh.pinion.teeth, mesh.gear.teeth)), self._loaded.compute_load_sharing(width)
        geometry = factors.contact_geometry
        if geometry is None and sharing is not None:
            ratio = teeth[1] / teeth[0]
            geometry = strength.compute_contact_geometry(mesh.pressure_angle, ratio, mesh.gear.internal, sharing)
        rows = []
        for place, (form, bending) in enumerate(zip(self._forms, self._bending, strict=True)):
            size = factors.size[place] if factors.size else None
            if size is None and form is not None:
                size = strength.compute_size_factor(width, self._loaded.module, form)
            found = Factors(factors.overload, dynamic, size or 1.0, spread, factors.rim)
            bent = None if bending is None else strength.compute_bending_stress(load, bending, found)
            pressed = None
            if geometry is not None:
                pressed = strength.compute_contact_stress(
                    load, geometry, found, factors.elastic or strength.STEEL_ELASTIC_COEFFICIENT
                )
            rows.append(self._build_gear_row(place, form, size, bent, pressed))
        return Stresses(load, dynamic, spread, geometry, rows, sharing)

    def _compute_lewis_stress(self, load: Load, form: float | None, dynamic: float) -> float | None:
        return (
            None if form is None else strength.compute_lewis_stress(load, form, dynamic * self._stated.factors.overload)
        )

    def _build_gear_row(
        self, place: int, form: float | None, size: float | None, bent: float | None, pressed: float | None
    ) -> JsonObject:
        bending, contact = self._stated.allowable_bending, self._stated.allowable_contact
        both_ways = self._loaded.both_ways[place]
        share = REVERSED_BENDING_FACTOR if both_ways else 1.0
        remarks = {"bent_both_ways": True} if both_ways else {}
        gear = (self._loaded.contact.mesh.pinion, self._loaded.contact.mesh.gear)[place]
        if bent is None and gear.internal and self._loaded.spares_rings:
            remarks["bending_judged"] = False
        return {
            "form": form,
            "size_factor": size,
            "bending_geometry": self._bending[place],
            "bending_stress": bent,
            "contact_stress": pressed,
            "bending_safety": share * bending[place] / bent if bending and bent is not None else None,
            "contact_safety": contact[place] / pressed if contact and pressed is not None else None,
            **remarks,
        }

    @cached_property
    def max_dynamic_force(self) -> float:
        """Maximum tangential force times dynamic factor that a permitted face width bears, N; 0 if a stress is unknown.

        The widest face bears the largest force: up to 100 modules, the product of K_m and K_s grows more slowly than
        the 0.83rd power of the width. Bending stress is proportional to the force, contact stress to its square root.
        """
        names, found = self._stated.required_safeties, self.compute_stresses(self._list_widths()[-1])
        shares = found.select_safeties(names)
        # The contact safety is squared because contact stress rises with the square root of the force.
        known = [0.0 if s is None else s * s if name == "contact_safety" else s for name, s in shares]
        return min(known, default=0.0) * found.load.force * found.dynamic

    def compute_max_power(self, turning: float) -> float:
        """Compute the maximum power (W) that a permitted face width carries at a speed of the first gear (rad/s).

        At constant power, the force falls with rising speed by more than the dynamic factor rises, so that this power
        rises with the speed.
        """
        load = self._loaded._replace(power=1.0, speed=turning).compute_load(1.0)
        return self.max_dynamic_force / (load.force * self._compute_dynamic_factor(load))

    def _list_widths(self) -> list[float]:
        """Return face widths in equal ratios up to the maximum, millimetres."""
        most = self._stated.max_face_width * self._loaded.module
        return [most * math.pow(1e-3, 1.0 - k / WIDTH_COUNT) for k in range(WIDTH_COUNT + 1)]

    def _compute_dynamic_factor(self, load: Load) -> float:
        stated = self._stated
        if stated.factors.dynamic:
            return stated.factors.dynamic
        if stated.method == "lewis":
            return strength.compute_barth_factor(load.speed)
        return strength.compute_dynamic_factor(load.speed, stated.quality)

    def find_min_width(self) -> float | None:
        """Find the minimum face width within the allowable stresses, millimetres.

        Return None if no width up to the maximum suffices, if no allowable stress is given, or if a stress is unknown.
        """
        names, before = self._stated.required_safeties, 0.0
        if not names:
            return None
        for width in self._list_widths():
            if self.compute_stresses(width).has_safeties(names):
                # Bisect between the last width that fails and the first that suffices, to rounding level.
                for _ in range(60):
                    middle = 0.5 * (before + width)
                    kept = middle > 0.0 and self.compute_stresses(middle).has_safeties(names)
                    before, width = (before, middle) if kept else (middle, width)
                return width
            before = width
        return None


def find_common_width(judges: list[StressCalculator], names: list[str]) -> float | None:
    """Find the minimum face width, millimetres, at which the named safety factors of all pairs are at least 1.

    Return None if there is no such width.
    """
    least = [judge.find_min_width() for judge in judges]
    known = [width for width in least if width is not None]
    if len(known) < len(least):
        return None
    width = max(known)
    # The factors depend on the width, so the width that one pair needs must be verified for the others.
    return width if all(judge.compute_stresses(width).has_safeties(names) for judge in judges) else None


def describe_power_rejections(failed: int) -> str:
    """Return the sentence that a design carries the power, with the number of better trains that do not."""
    if not failed:
        return compose("model-power-carried-by-all-checked")
    return compose("model-power-carried-after-failures", count=failed)


def describe_too_weak(required: CarriedPower, failed: int, every: bool, strongest: float) -> str:
    """Return the sentences that no train carries the power.

    ``failed`` trains were checked, which are all possible ones if ``every``. ``strongest`` is the power that the
    strongest of them carries, W; 0 if it is unknown.
    """
    sentences = [
        compose(
            "model-power-carried-by-no-possible" if every else "model-power-carried-by-no-best",
            count=failed,
            power=f"{required.power_kw:.6g}",
            width=f"{required.max_face_width:g}",
        )
    ]
    if strongest:
        sentences.append(compose("model-strongest-train", power=f"{strongest / 1000.0:.3g}"))
    if not every:
        sentences.append(compose("model-further-trains-unchecked"))
    return join_messages(sentences)


def build_stage_contact(stage: TrainStage, place: int, pressure_angle: float, unit: float) -> Contact:
    """Build a mesh of a stage in millimetres, with its gears in the order of the power flow.

    Parameters
    ----------
    stage : TrainStage
        The stage.
    place : int
        Index of the mesh in the stage, from 0; stages with idlers have several meshes.
    pressure_angle : float
        Pressure angle, radians.
    unit : float
        Millimetres per unit of the module.
    """
    gears = replace(stage, module=stage.module * unit).cut_gears(pressure_angle)
    return apply_tool_contact(Mesh(gears[place], gears[place + 1]), helix_angle=stage.helix_angle)


def mark_idlers(stage: TrainStage, place: int) -> tuple[bool, bool]:
    """Return which of both gears of a mesh are idlers; ``place`` is the index of the mesh in the stage, from 0."""
    return place > 0, place + 2 < len(stage.gears)


def describe_strength(loaded: LoadedPair, method: StrengthMethod, face_width: float | None, unit: float) -> JsonObject:
    """Describe the strength of a pair by the fields of :class:`PairStrength`; ``unit`` is the length unit in mm."""
    judge = StressCalculator(loaded, method)
    least = judge.find_min_width()
    width = least if face_width is None else face_width * unit
    # Without a width, only values that do not depend on it are reported; they are computed for an arbitrary 1 mm.
    found = judge.compute_stresses(1.0 if width is None else width)
    rows = found.gears
    if width is None:
        depending = ("size_factor", "bending_stress", "contact_stress", "bending_safety", "contact_safety")
        rows = [{name: None if name in depending else value for name, value in row.items()} for row in rows]
    answer = {
        "method": method.method,
        "estimate": compose("model-strength-estimate"),
        "tangential_force": found.load.force,
        "pitch_line_velocity": found.load.speed,
        "dynamic": found.dynamic,
        "load_distribution": None if width is None else found.load_distribution,
        "contact_geometry": found.contact_geometry if width is not None or loaded.helix_angle == 0.0 else None,
        "face_width": None if width is None else width / unit,
        "gears": rows,
    }
    if loaded.helix_angle != 0.0 and width is not None and found.sharing is not None:
        answer["sharing_ratio"] = found.sharing
    return answer if least is None else {**answer, "least_face_width": least / unit}
