"""Stresses in the teeth of a pair that carries a power: what is stated and told, and the width that carries it.

It is a first estimate: the equations of Lewis and of AGMA (:mod:`kinematics.gear.strength`) with factors that a client
states, or that formulas of the textbook give. It knows no bearings, no lubricant, no wear and no life.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field

from kinematics.errors import DimensionError
from kinematics.gear import strength
from kinematics.gear.flanks import Contact
from kinematics.gear.strength import Factors, Load
from kinematics.gear.teeth import Gear, Mesh
from kinematics.gear.train import TrainStage
from synthesis.model.answer import Answer, optional
from synthesis.model.counting import counted
from synthesis.model.dimension import ROTATIONAL_SPEED, Length
from synthesis.model.gear_answer import tool_contact
from synthesis.model.statement import PositiveNumber, Statement

Positive = Annotated[float, Field(strict=True, ge=1e-6, le=1e6)]

ESTIMATE = (
    "A first estimate by textbook formulas: life, temperature, lubrication, mounting and material data beyond the "
    "stated allowable stresses are not looked at. Size gears by the standard that applies."
)

OF_AGMA = ("size", "load_distribution", "rim", "bending_geometry", "contact_geometry", "elastic")
"""Factors that Lewis's equation does not have."""

CARRYING_TYPES = ("external", "internal", "helical")
"""Types of stages whose strength is estimated."""

BENT_BOTH_WAYS = 0.7
"""Share of the allowable bending stress that teeth bear which are bent both ways in every turn, as an idler's are, by
AGMA (Shigley, Sec. 14-4)."""

EQUAL = 1e-12
"""Share by which a mesh may fall short of the power in rounding."""

WIDTHS = 400
"""Widths that are tried, in equal ratios, in search of the least that carries the load."""


class StatedFactors(Statement):
    """Factors in place of those that formulas give; pairs are of the first gear and the second."""

    form: tuple[Positive, Positive] | None = Field(
        default=None, description="Lewis's Y, for the size factor too; from the true profile with the load at the tip."
    )
    overload: Positive = 1.0
    dynamic: Positive | None = Field(
        default=None, description="Lewis: (1200 + V)/1200 of cut teeth, V in ft/min. AGMA: by the quality number."
    )
    size: tuple[Positive, Positive] | None = Field(default=None, description="1.192 (F √Y / P)^0.0535, at least 1.")
    load_distribution: Positive | None = Field(
        default=None, description="Of uncrowned teeth close to both bearings, in a commercial enclosed unit."
    )
    rim: Positive = 1.0
    bending_geometry: tuple[Positive, Positive] | None = Field(
        default=None,
        description="AGMA's J; from the true profile. Its fillets have the 0.38 modules of ISO 53: tables for racks of "
        "0.25 have values about a tenth lower. Of rings and helical gears it is known only where it is stated.",
    )
    contact_geometry: Positive | None = Field(
        default=None, description="AGMA's I; of helical gears known over faces of an axial pitch or more."
    )
    elastic: Positive | None = Field(default=None, description="AGMA's C_p, √MPa; 191 of steel on steel.")


class StrengthMethod(Statement):
    """The method, its factors, and what the material may bear."""

    method: Literal["lewis", "agma"] = "agma"
    quality: Annotated[float, Field(strict=True, ge=3.0, le=11.5)] = Field(
        default=6.0, description="AGMA's quality number Q_v, for the dynamic factor."
    )
    factors: StatedFactors = StatedFactors()
    allowable_bending: tuple[Positive, Positive] | None = Field(default=None, description="MPa, of both gears.")
    allowable_contact: tuple[Positive, Positive] | None = Field(default=None, description="MPa, of both; AGMA only.")
    max_face_width: Annotated[float, Field(strict=True, ge=1.0, le=100.0)] = Field(
        default=16.0, description="The widest face in search of the least, in modules."
    )

    def faults(self) -> list[tuple[str, str]]:
        """What no single field shows, by the path below this statement."""
        if self.method != "lewis":
            return []
        faults = []
        if self.allowable_contact is not None:
            faults.append(("/allowable_contact", "Lewis's equation knows no contact stress; leave it out or take agma"))
        if _is_stated(self, "quality"):
            faults.append(("/quality", "Lewis's equation knows no quality number; leave it out or take agma"))
        return faults + [
            (f"/factors/{name}", "Lewis's equation has no such factor; leave it out or take agma")
            for name in OF_AGMA
            if _is_stated(self.factors, name)
        ]

    def faults_of_ring(self) -> list[tuple[str, str]]:
        """What is wrong where the second gear is a ring: no formula here gives the shape of its teeth."""
        name = "form" if self.method == "lewis" else "bending_geometry"
        if self.allowable_bending is None or getattr(self.factors, name) is not None:
            return []
        return [("/allowable_bending", f"the bending stress of a ring is not known without factors/{name}; state that")]

    def faults_of_helix(self) -> list[tuple[str, str]]:
        """What is wrong where the teeth are helical: what shares the load is read from charts, or not known."""
        if self.method == "lewis":
            return [("/method", "Lewis's equation is of spur teeth; take agma for helical ones")]
        if self.allowable_bending is None or self.factors.bending_geometry is not None:
            return []
        detail = "the bending stress of helical teeth is not known without factors/bending_geometry; state that"
        return [("/allowable_bending", detail)]

    @property
    def kept(self) -> list[str]:
        """Names of the safeties for which allowable stresses are stated."""
        stated = {"bending_safety": self.allowable_bending, "contact_safety": self.allowable_contact}
        return [name for name, allowable in stated.items() if allowable is not None]


def _is_stated(statement: Statement, name: str) -> bool:
    """Whether a field says anything but what it says where it is left out."""
    return bool(getattr(statement, name) != type(statement).model_fields[name].default)


class StatedStrength(StrengthMethod):
    """The power besides, where it is not known from a torque and a speed."""

    power_kw: PositiveNumber


class CarriedPower(StatedStrength):
    """What a train that is looked for has to carry; pairs are of the driving gear of every mesh and the driven one."""

    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] = Field(
        description="Of the input shaft, revolutions a minute."
    )

    @property
    def power(self) -> float:
        """On the input shaft, and without losses on all others, W."""
        return 1000.0 * self.power_kw

    @property
    def speed(self) -> float:
        """Of the input shaft, rad/s."""
        return self.speed_rpm * math.pi / 30.0

    def faults(self) -> list[tuple[str, str]]:
        """What no single field shows, by the path below this statement."""
        if self.kept:
            return super().faults()
        return [*super().faults(), ("/allowable_bending", "state it, or allowable_contact: what the teeth may bear")]


class StressedGear(Answer):
    """One gear: stresses in MPa, and how far below what it may bear; null where nothing is stated or known."""

    form: float | None = Field(
        description="Lewis's Y; null for a ring of which none is stated; of helical gears that of the normal plane."
    )
    size_factor: float | None
    bending_geometry: float | None
    bending_stress: float | None
    contact_stress: float | None
    bending_safety: float | None = Field(description="Allowable over actual bending stress.")
    contact_safety: float | None = Field(description="Allowable over actual contact stress.")
    bent_both_ways: bool | None = optional(
        f"True of an idler, and of a planet gear that meshes on both flanks: every turn bends its teeth both ways, and "
        f"they bear {BENT_BOTH_WAYS} of the allowable bending stress; `bending_safety` counts that."
    )
    bending_judged: bool | None = optional(
        "False of a ring of a planetary train whose geometry factor is not stated: its bending is not known, and no "
        "part of what is judged."
    )


class PairStrength(Answer):
    """Stresses of a pair at a face width."""

    method: str
    estimate: str
    tangential_force: float = Field(description="On the working pitch circles, N.")
    pitch_line_velocity: float = Field(description="m/s")
    dynamic: float
    load_distribution: float | None
    contact_geometry: float | None
    sharing_ratio: float | None = optional(
        "AGMA's m_N of helical teeth: the face over the least length of all lines of contact. Left out where the face "
        "overlaps by less than an axial pitch: the contact stress is then not known, unless `contact_geometry` is "
        "stated."
    )
    face_width: Length | None = Field(description="As stated, or the least that carries the load; the module's unit.")
    least_face_width: Length | None = optional(
        "The least that keeps all stated allowable stresses; left out where none are stated, where no width up to "
        "`max_face_width` keeps them, or where one of the stresses is not known."
    )
    load_sharing: float | None = optional(
        "Of planetary trains: the force on the most loaded planet over an equal share of it; the force and all "
        "stresses have it."
    )
    gears: list[StressedGear]


class Loaded(NamedTuple):
    """A pair in millimetres and what it carries; which of its gears are bent both ways.

    ``spares_rings``: the bending of a ring is no part of what is judged, where it is not known. Helical gears are those
    of the plane of rotation, with their ``helix_angle``, radians.
    """

    contact: Contact
    power: float
    speed: float
    both_ways: tuple[bool, bool] = (False, False)
    spares_rings: bool = False
    helix_angle: float = 0.0

    @property
    def module(self) -> float:
        """That of the normal plane."""
        return self.contact.mesh.pinion.module * math.cos(self.helix_angle)

    def in_normal_plane(self, gear: Gear) -> Gear:
        """A gear of the pair, of a helical one the spur gear that the normal plane shows: z / cos³ β teeth."""
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

    def sharing(self, width: float) -> float | None:
        """AGMA's m_N over a face of this width: 1 of spur teeth, None of a face that overlaps by less than a pitch."""
        if self.helix_angle == 0.0:
            return 1.0
        mesh = self.contact.mesh
        helix = math.atan(math.tan(abs(self.helix_angle)) * math.cos(mesh.pinion.pressure_angle))
        if width * math.tan(helix) < mesh.pinion.base_pitch or mesh.contact_ratio < 1.0:
            return None
        return strength.load_sharing(mesh.contact_ratio, mesh.pinion.base_pitch, helix, width)

    @property
    def working_diameters(self) -> tuple[float, float]:
        """Diameters of the working pitch circles."""
        mesh = self.contact.mesh
        wide = math.cos(mesh.pinion.pressure_angle) / math.cos(mesh.pressure_angle)
        return 2.0 * mesh.pinion.pitch_radius * wide, 2.0 * mesh.gear.pitch_radius * wide

    def load(self, width: float) -> Load:
        """The tangential load, N and m/s, over a face of this width."""
        diameters = self.working_diameters
        velocity = self.speed * 0.5e-3 * diameters[0]
        return Load(self.power / velocity, velocity, width, self.contact.mesh.pinion.module, min(diameters))


class Stresses(NamedTuple):
    """What a width leads to: the load, factors common to both gears, and rows of each gear."""

    load: Load
    dynamic: float
    load_distribution: float | None
    contact_geometry: float | None
    gears: list[dict[str, Any]]
    sharing: float | None = None

    def safeties(self, names: list[str]) -> list[tuple[str, float | None]]:
        """The safeties of these names of both gears, by name, but for those that are not judged."""
        judged = [(row, name) for row in self.gears for name in names]
        return [(name, row[name]) for row, name in judged if name != "bending_safety" or "bending_judged" not in row]

    def keep(self, names: list[str]) -> bool:
        """Whether the safeties of these names are known of both gears, and at least 1."""
        return all(safety is not None and safety >= 1.0 for _, safety in self.safeties(names))


class Judge:
    """The stresses of a pair over widths; what does not depend on the width is found once."""

    def __init__(self, loaded: Loaded, stated: StrengthMethod) -> None:
        self._loaded, self._stated = loaded, stated
        mesh, factors = loaded.contact.mesh, stated.factors
        given = factors.form, factors.bending_geometry
        self._forms: list[float | None] = []
        self._bending: list[float | None] = []
        for place, gear in enumerate((mesh.pinion, mesh.gear)):
            self._forms.append(given[0][place] if given[0] else self._form(loaded.in_normal_plane(gear)))
            self._bending.append(given[1][place] if given[1] else self._geometry(gear, place))

    @staticmethod
    def _form(gear: Gear) -> float | None:
        """Lewis's factor; None of a ring, and of a tooth that is no beam."""
        try:
            return None if gear.internal else strength.lewis_form(gear)
        except DimensionError:
            return None

    def _geometry(self, gear: Gear, place: int) -> float | None:
        """AGMA's factor; None as above, and where it is not asked for."""
        try:
            known = self._stated.method == "agma" and not gear.internal and self._loaded.helix_angle == 0.0
            return strength.bending_geometry(self._loaded.contact, place == 1) if known else None
        except DimensionError:
            return None

    def under(self, power: float, turning: float) -> Judge:
        """The same pair under another power, W, its first gear turning so fast, rad/s."""
        other = copy(self)
        other._loaded = self._loaded._replace(power=power, speed=turning)
        return other

    def at(self, width: float) -> Stresses:
        """Stresses over a face of this width, millimetres."""
        stated, factors, load = self._stated, self._stated.factors, self._loaded.load(width)
        mesh = self._loaded.contact.mesh
        if stated.method == "lewis":
            dynamic = self._dynamic(load)
            rows = [
                self._row(k, form, None, self._lewis(load, form, dynamic), None) for k, form in enumerate(self._forms)
            ]
            return Stresses(load, dynamic, None, None, rows)
        dynamic = self._dynamic(load)
        spread = factors.load_distribution or strength.load_distribution_factor(width, load.pinion_diameter)
        teeth, sharing = sorted((mesh.pinion.teeth, mesh.gear.teeth)), self._loaded.sharing(width)
        geometry = factors.contact_geometry
        if geometry is None and sharing is not None:
            ratio = teeth[1] / teeth[0]
            geometry = strength.contact_geometry(mesh.pressure_angle, ratio, mesh.gear.internal, sharing)
        rows = []
        for place, (form, bending) in enumerate(zip(self._forms, self._bending, strict=True)):
            size = factors.size[place] if factors.size else None
            if size is None and form is not None:
                size = strength.size_factor(width, self._loaded.module, form)
            found = Factors(factors.overload, dynamic, size or 1.0, spread, factors.rim)
            bent = None if bending is None else strength.bending_stress(load, bending, found)
            pressed = None
            if geometry is not None:
                pressed = strength.contact_stress(load, geometry, found, factors.elastic or strength.STEEL_ON_STEEL)
            rows.append(self._row(place, form, size, bent, pressed))
        return Stresses(load, dynamic, spread, geometry, rows, sharing)

    def _lewis(self, load: Load, form: float | None, dynamic: float) -> float | None:
        return None if form is None else strength.lewis_stress(load, form, dynamic * self._stated.factors.overload)

    def _row(
        self, place: int, form: float | None, size: float | None, bent: float | None, pressed: float | None
    ) -> dict[str, Any]:
        bending, contact = self._stated.allowable_bending, self._stated.allowable_contact
        both_ways = self._loaded.both_ways[place]
        share = BENT_BOTH_WAYS if both_ways else 1.0
        told = {"bent_both_ways": True} if both_ways else {}
        gear = (self._loaded.contact.mesh.pinion, self._loaded.contact.mesh.gear)[place]
        if bent is None and gear.internal and self._loaded.spares_rings:
            told["bending_judged"] = False
        return {
            "form": form,
            "size_factor": size,
            "bending_geometry": self._bending[place],
            "bending_stress": bent,
            "contact_stress": pressed,
            "bending_safety": share * bending[place] / bent if bending and bent is not None else None,
            "contact_safety": contact[place] / pressed if contact and pressed is not None else None,
            **told,
        }

    @cached_property
    def bearable(self) -> float:
        """The greatest tangential force times dynamic factor that a face up to the widest bears, N.

        It is the widest that bears most: over faces of 100 modules at most K_m and K_s rise together by less than the
        0.83rd power of the width. Bending stress rises with the force, contact stress with its root. 0 where one of the
        stresses is not known.
        """
        names, found = self._stated.kept, self.at(self._widths()[-1])
        shares = found.safeties(names)
        known = [0.0 if s is None else s * s if name == "contact_safety" else s for name, s in shares]
        return min(known, default=0.0) * found.load.force * found.dynamic

    def carried_power(self, turning: float) -> float:
        """The greatest power, W, that a face up to the widest carries where the first gear turns so fast, rad/s.

        The force falls with the speed by more than its dynamic factor rises, so that this power rises with the speed.
        """
        load = self._loaded._replace(power=1.0, speed=turning).load(1.0)
        return self.bearable / (load.force * self._dynamic(load))

    def _widths(self) -> list[float]:
        """Widths in equal ratios up to the widest, millimetres."""
        most = self._stated.max_face_width * self._loaded.module
        return [most * math.pow(1e-3, 1.0 - k / WIDTHS) for k in range(WIDTHS + 1)]

    def _dynamic(self, load: Load) -> float:
        stated = self._stated
        if stated.factors.dynamic:
            return stated.factors.dynamic
        if stated.method == "lewis":
            return strength.barth_factor(load.speed)
        return strength.dynamic_factor(load.speed, stated.quality)

    def least_width(self) -> float | None:
        """The least width that keeps the allowable stresses, millimetres.

        None where no width up to the widest does, where none are stated, or where one of the stresses is not known.
        """
        names, before = self._stated.kept, 0.0
        if not names:
            return None
        for width in self._widths():
            if self.at(width).keep(names):
                for _ in range(60):
                    middle = 0.5 * (before + width)
                    kept = middle > 0.0 and self.at(middle).keep(names)
                    before, width = (before, middle) if kept else (middle, width)
                return width
            before = width
        return None


def common_width(judges: list[Judge], names: list[str]) -> float | None:
    """The least width, millimetres, over which all pairs keep the safeties of these names; None: there is none."""
    least = [judge.least_width() for judge in judges]
    known = [width for width in least if width is not None]
    if len(known) < len(least):
        return None
    width = max(known)
    return width if all(judge.at(width).keep(names) for judge in judges) else None


def carrying_words(failed: int) -> str:
    """That the power decided, and how many trains it ruled out."""
    before = counted(failed, "train does not", "trains do not") if failed else "all do"
    return f"It carries the power, by a first estimate; of those judged {before}."


def too_weak_words(stated: CarriedPower, failed: int, every: bool, strongest: float) -> str:
    """That no train carries the power, and what the strongest does, W; 0 where that is not known."""
    which = f"the {failed} trains there are" if every else f"the first {failed} trains"
    told = f"None of {which} carries {stated.power_kw:.6g} kW with a face of {stated.max_face_width:g} modules."
    if strongest:
        told += f" The strongest carries {strongest / 1000.0:.3g} kW, by a first estimate."
    return told if every else f"{told} Others were not judged."


def stage_contact(stage: TrainStage, place: int, pressure_angle: float, unit: float) -> Contact:
    """A mesh of a stage in millimetres, its gears as they stand in the order of the power.

    Parameters
    ----------
    place : int
        Of the mesh in the stage, counted from 0; more than one with idlers.
    unit : float
        Millimetres in the unit of the module.
    """
    gears = replace(stage, module=stage.module * unit).cut_gears(pressure_angle)
    return tool_contact(Mesh(gears[place], gears[place + 1]), helix_angle=stage.helix_angle)


def bent_both_ways(stage: TrainStage, place: int) -> tuple[bool, bool]:
    """Which gears of a mesh of a stage, counted from 0, are idlers."""
    return place > 0, place + 2 < len(stage.gears)


def told(loaded: Loaded, stated: StrengthMethod, face_width: float | None, unit: float) -> dict[str, Any]:
    """The strength of a pair in the shape of :class:`PairStrength`; widths in units of ``unit`` millimetres."""
    judge = Judge(loaded, stated)
    least = judge.least_width()
    width = least if face_width is None else face_width * unit
    # Without any width the load and what belongs to it are told, and no stresses.
    found = judge.at(1.0 if width is None else width)
    rows = found.gears
    if width is None:
        depending = ("size_factor", "bending_stress", "contact_stress", "bending_safety", "contact_safety")
        rows = [{name: None if name in depending else value for name, value in row.items()} for row in rows]
    answer = {
        "method": stated.method,
        "estimate": ESTIMATE,
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
