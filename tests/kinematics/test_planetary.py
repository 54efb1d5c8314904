"""Speeds, torques and assembly of planetary trains: printed values, the tabular method, laws, brute force."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics.errors import DimensionError
from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.gear.assembly import compute_pin_distances, has_fit_at, is_coaxial, measure_gaps, place_pins
from kinematics.gear.planetary import EXTERNAL, GROUND, INTERNAL, Mesh, Train, compute_speed_ratio, solve_speeds
from kinematics.gear.power import PowerFlow, solve_power_flow
from tests.cases import Case, cases

ROWS = tuple(ARRANGEMENTS.values())


def train_of(stated: dict[str, Any], planets: list[str] | None = None) -> Train:
    """A train as the case file states it: gears by name, meshes, rows known by their train value."""
    gears, meshes = stated["gears"], []
    for one, other, carrier, *sense in stated["meshes"]:
        internal = gears[one].get("internal") or gears[other].get("internal")
        meshes.append(
            Mesh(
                gears[one]["body"],
                gears[other]["body"],
                carrier,
                gears[one]["N"],
                gears[other]["N"],
                sense[0] if sense else INTERNAL if internal else EXTERNAL,
            )
        )
    for first, second, carrier, value in stated.get("ratios", ()):
        meshes.append(row(first, second, carrier, Fraction(value)))
    return Train(tuple(meshes), frozenset(planets or ()))


def row(first: str, second: str, carrier: str, value: Fraction) -> Mesh:
    """A row known by its train value (ω_second − ω_c)/(ω_first − ω_c) = ``value``."""
    return Mesh(first, second, carrier, abs(value.numerator), value.denominator, INTERNAL if value > 0 else EXTERNAL)


def known_speeds(stated: dict[str, Any]) -> dict[str, Fraction]:
    return {body: Fraction(str(value)) for body, value in stated["speeds"].items()}


@pytest.mark.parametrize("case", cases("epicyclic", "gear"))
def test_speeds_as_printed(case: Case) -> None:
    train = train_of(case.inputs["train"])
    found = solve_speeds(train, known_speeds(case.inputs["train"]))
    assert found.contradiction is None
    values = {body: float(speed) for body, speed in found.values.items() if speed is not None}
    computed = {body: values[body] for body in case.inputs["out"]} | {"dof": found.freedom}
    for body, carrier in case.inputs.get("rel", {}).items():
        computed[f"{body}_rel"] = values[body] - values[carrier]
    for name, (over, under) in case.inputs.get("ratio", {}).items():
        computed[name] = values[over] / values[under]
    case.check(**computed)


@pytest.mark.parametrize("case", cases("fundamental", "gear"))
def test_one_row_by_its_train_value(case: Case) -> None:
    train = Train((row("first", "last", "arm", Fraction(case.inputs["train_value"])),))
    found = solve_speeds(train, {"first": case.inputs["first"], "arm": case.inputs["arm"]})
    case.check(R=float(case.inputs["train_value"]), last=float(found.values["last"] or 0))


@pytest.mark.parametrize("case", cases("basic_ratio", "gear"))
def test_train_value_with_the_carrier_held(case: Case) -> None:
    """The product of the quotients is the speed of the last gear with the carrier held."""
    meshes, sign = [], 1
    pairs = list(zip(case.inputs["num"], case.inputs["den"], strict=True))
    for k, (over, under) in enumerate(pairs):
        sign = EXTERNAL if over * under < 0 else INTERNAL
        meshes.append(Mesh(f"b{k}", f"b{k + 1}", "arm", abs(over), abs(under), sign))
    last = solve_speeds(Train(tuple(meshes)), {"arm": 0, "b0": 1}).values[f"b{len(pairs)}"]
    assert last is not None
    case.check(rho=float(last), fraction=f"{last.numerator}/{last.denominator}")


@pytest.mark.parametrize("case", cases("three_shaft", "gear"))
def test_efficiency_of_a_row_with_three_shafts(case: Case) -> None:
    """Norton's ρ is (ω1 − ω_arm)/(ω2 − ω_arm)."""
    given_ = case.inputs
    train = Train((row("2", "1", "arm", Fraction(given_["rho"])),))
    (out,) = {"1", "2", "arm"} - {given_["fixed"], given_["inp"]}
    turning = solve_speeds(train, {given_["fixed"]: 0, given_["inp"]: 1}).values
    flow = solve_power_flow(train, turning, {"1", "2", "arm"}, {given_["inp"]: 1}, Fraction(given_["E0"]))
    assert flow is not None
    unit = flow.torques[given_.get("T_known", given_["inp"])]
    assert flow.efficiency is not None
    case.check(
        ratio=float(1 / turning[out]),
        efficiency=float(flow.efficiency),
        self_locking=flow.self_locking,
        **{f"T{body}": float(torque / unit) for body, torque in flow.torques.items()},
    )


@pytest.mark.parametrize("case", cases("epicyclic_torque", "gear"))
def test_torques_as_printed(case: Case) -> None:
    train = train_of(case.inputs["train"], case.inputs["free"])
    turning = solve_speeds(train, known_speeds(case.inputs["train"])).values
    known = {body: Fraction(str(torque)) for body, torque in case.inputs["known"].items()}
    flow = solve_power_flow(train, turning, train.members, known, Fraction(str(case.inputs.get("eta", 1))))
    assert flow is not None
    computed: dict[str, Any] = {f"T_{body}": float(torque) for body, torque in flow.torques.items()}
    computed |= {f"w_{body}": float(speed) for body, speed in turning.items() if speed is not None}
    case.check(efficiency=float(flow.efficiency or 0), **computed)


@pytest.mark.parametrize("case", cases("vehicle_axle", "gear"))
def test_axle_of_a_car(case: Case) -> None:
    """Engine, final drive on fixed axes and differential are one train."""
    stated = case.inputs
    wheel = stated["mph"] * 5280.0 * 12.0 / 60.0 / (2.0 * math.pi * stated["roll_radius_in"])
    ratio = stated["engine_rpm"] / wheel
    final = row("engine", "cage", GROUND, Fraction(1 / ratio))
    sides = Mesh("left", "planet", "cage", 16, 10), Mesh("planet", "right", "cage", 10, 16, INTERNAL)
    train = Train((final, *sides), frozenset({"planet"}))
    straight = solve_speeds(train, {"engine": stated["engine_rpm"], "left": Fraction(wheel)}).values
    assert float(straight["right"] or 0) == pytest.approx(wheel, rel=1e-12)
    curve = solve_speeds(train, {"engine": stated["engine_rpm"], "left": stated["wheel2"]}).values
    case.check(wheel=wheel, ratio=ratio, other=float(curve["right"] or 0))


@pytest.mark.parametrize("case", cases("winch", "gear"))
def test_least_ratio_of_a_winch(case: Case) -> None:
    """Torques without loss give the least ratio; the drum's speed at that ratio the time."""
    stated = case.inputs
    torque = stated["load_lb"] * stated["drum_in"] / 2.0 / 12.0
    least = torque / stated["motor_lbft"]
    train = Train((row("drum", "motor", GROUND, Fraction(least)),))
    turning = solve_speeds(train, {"motor": stated["rpm"]}).values
    flow = solve_power_flow(train, turning, ("motor", "drum"), {"motor": Fraction(stated["motor_lbft"])})
    assert flow is not None
    assert float(-flow.torques["drum"]) == pytest.approx(torque)
    rate = float(turning["drum"] or 0) * math.pi * stated["drum_in"] / 12.0
    case.check(ratio_min=least, time_min=stated["lift_ft"] / rate)


@pytest.mark.parametrize("case", cases("planet_check", "gear"))
def test_planets_that_fit(case: Case) -> None:
    simple, stated = ARRANGEMENTS["simple"], case.inputs
    teeth = {"sun": stated["S"], "planet": stated["P"], "ring": stated["R"]}
    turns = [Fraction(k, stated["n"]) for k in range(stated["n"])]
    case.check(
        closure=is_coaxial(simple, teeth),
        assembly=all(has_fit_at(simple, teeth, ("planet",), turn) for turn in turns),
        neighbour=min(gap.room for gap in measure_gaps(simple, teeth, {"planet": turns})) > 0.0,
    )


counts = st.integers(8, 90)


@st.composite
def toothed(draw: st.DrawFn) -> tuple[Arrangement, dict[str, int]]:
    """Any arrangement with any teeth: speeds do not ask whether the gears are coaxial."""
    arrangement = draw(st.sampled_from(ROWS))
    return arrangement, {gear: draw(counts) for gear in arrangement.gear_names}


def tabular(arrangement: Arrangement, teeth: dict[str, int], set_of: str, turns: Fraction) -> dict[str, Fraction]:
    """Turns past its carrier of every body of a planet set, when one of its suns or rings is turned."""
    past = {arrangement.places[set_of].body: turns}
    for _ in arrangement.meshes:
        for pair in arrangement.meshes:
            for one, other in (pair, pair[::-1]):
                known, unknown = arrangement.places[one].body, arrangement.places[other].body
                carriers = {arrangement.carriers[body] for body in (known, unknown) if body in arrangement.carriers}
                own = {arrangement.carriers[planet] for planet in arrangement.carriers if planet in past}
                own |= {
                    arrangement.carriers[b]
                    for g in arrangement.list_mates(set_of)
                    if (b := arrangement.places[g].body) in arrangement.carriers
                }
                if known in past and unknown not in past and carriers <= own:
                    past[unknown] = past[known] * arrangement.sense(one, other) * Fraction(teeth[one], teeth[other])
    return past


@given(toothed(), st.fractions(-5, 5, max_denominator=9), st.fractions(-5, 5, max_denominator=9))
def test_speeds_agree_with_the_tabular_method(
    given_: tuple[Arrangement, dict[str, int]], turns: Fraction, carried: Fraction
) -> None:
    """All bodies turned with the carrier, then all turned with the carrier held, added up: set by set."""
    arrangement, teeth = given_
    for planets in arrangement.planet_sets:
        first = next(
            g
            for g in arrangement.gear_names
            if set(arrangement.list_mates(g)) & {gear.name for gear in arrangement.gears if gear.body in planets}
            and not arrangement.is_planet(g)
        )
        carrier = arrangement.carriers[planets[0]]
        past = tabular(arrangement, teeth, first, turns)
        body = arrangement.places[first].body
        found = solve_speeds(arrangement.build_train(teeth), {carrier: carried, body: carried + turns}).values
        for other, relative in past.items():
            assert found[other] == carried + relative


@given(toothed(), st.data())
def test_speeds_scale_and_add_up(given_: tuple[Arrangement, dict[str, int]], data: st.DataObject) -> None:
    """Linear: a multiple of all speeds, and all speeds raised by the same, are motions too."""
    arrangement, teeth = given_
    train = arrangement.build_train(teeth)
    one, other = data.draw(st.permutations(arrangement.members))[:2]
    known = {one: Fraction(3), other: Fraction(-2)}
    first = solve_speeds(train, known)
    scaled = solve_speeds(train, {body: 7 * speed for body, speed in known.items()})
    raised = solve_speeds(train, {body: speed + 5 for body, speed in known.items()})
    assert first.freedom == 2
    for body, speed in first.values.items():
        if speed is not None:
            assert scaled.values[body] == 7 * speed
            assert raised.values[body] == speed + 5


@given(toothed(), st.data())
def test_willis(given_: tuple[Arrangement, dict[str, int]], data: st.DataObject) -> None:
    """With each of the other two held, the ratios from one member to the third add up to 1; and back is the inverse."""
    arrangement, teeth = given_
    one, two, three = data.draw(st.permutations(arrangement.members))[:3]
    train = arrangement.build_train(teeth)
    around = [compute_speed_ratio(train, a, b, [c]) for a, b, c in ((one, two, three), (two, one, three))]
    if None not in around:
        assert around[0] * around[1] == 1
    value, other = compute_speed_ratio(train, one, two, [three]), compute_speed_ratio(train, one, three, [two])
    if value is not None and other is not None:
        assert value + other == 1 or len(arrangement.members) > 3


def test_contradictions_and_freedoms_are_told() -> None:
    simple = ARRANGEMENTS["simple"].build_train({"sun": 24, "planet": 18, "ring": 60})
    free = solve_speeds(simple, {"sun": 1})
    assert (free.freedom, free.open, free.contradiction) == (2, 1, None)
    assert free.values["ring"] is None
    over = solve_speeds(simple, {"sun": 1, "carrier": 1, "ring": 2})
    assert over.contradiction == "ring"
    assert over.values["ring"] == 1
    locked = solve_speeds(simple, {"sun": 3}, locked=[("sun", "carrier")])
    assert (locked.freedom, locked.open) == (1, 0)
    assert set(locked.values.values()) == {Fraction(3)}
    stuck = Train((Mesh("a", "b", GROUND, 20, 30), Mesh("b", "a", GROUND, 20, 31)))
    assert solve_speeds(stuck, {}).freedom == 0
    assert solve_speeds(stuck, {"a": 1}).contradiction == "a"


def test_wrong_calls() -> None:
    train = ARRANGEMENTS["simple"].build_train({"sun": 24, "planet": 18, "ring": 60})
    with pytest.raises(DimensionError, match="body"):
        solve_speeds(train, {"moon": 1})
    with pytest.raises(DimensionError, match="teeth"):
        Mesh("a", "b", "c", 0, 20)
    with pytest.raises(DimensionError, match="three different"):
        Mesh("a", "a", "c", 20, 20)
    with pytest.raises(DimensionError, match="sense"):
        Mesh("a", "b", "c", 20, 20, 0)
    with pytest.raises(DimensionError, match="teeth"):
        ARRANGEMENTS["simple"].build_train({"sun": 24, "planet": 18})
    turning = solve_speeds(train, {"sun": 1, "ring": 0}).values
    with pytest.raises(DimensionError, match="efficiency"):
        solve_power_flow(train, turning, ("sun", "carrier", "ring"), {"sun": 1}, 0)
    with pytest.raises(DimensionError, match="load"):
        solve_power_flow(train, turning, ("sun", "planet"), {"sun": 1})
    with pytest.raises(DimensionError, match="speeds"):
        solve_power_flow(train, {"sun": Fraction(1)}, ("sun", "carrier", "ring"), {"sun": 1})


@st.composite
def driven(draw: st.DrawFn) -> tuple[Arrangement, dict[str, int], tuple[str, str, str]]:
    arrangement, teeth = draw(toothed())
    roles = draw(st.permutations(arrangement.members))[:3]
    return arrangement, teeth, (roles[0], roles[1], roles[2])


def flow_of(
    arrangement: Arrangement, teeth: dict[str, int], roles: tuple[str, str, str], efficiency: Fraction
) -> PowerFlow | None:
    train = arrangement.build_train(teeth)
    turning = solve_speeds(train, {roles[2]: 0, roles[0]: 1}).values
    if None in turning.values() or not turning[roles[1]]:
        return None
    return solve_power_flow(train, turning, roles, {roles[0]: 1}, efficiency)


@given(driven())
def test_no_power_is_lost_without_friction(given_: tuple[Arrangement, dict[str, int], tuple[str, str, str]]) -> None:
    """Powers and torques from outside add up to 0, and the torque ratio is the speed ratio turned round."""
    arrangement, teeth, roles = given_
    flow = flow_of(arrangement, teeth, roles, Fraction(1))
    if flow is None:
        return
    assert sum(flow.powers.values()) == 0
    if not arrangement.bevel:
        assert sum(flow.torques.values()) == 0
    assert flow.efficiency == 1
    assert not flow.self_locking
    ratio = compute_speed_ratio(arrangement.build_train(teeth), roles[0], roles[1], [roles[2]])
    assert flow.torques[roles[1]] == -ratio * flow.torques[roles[0]]


@given(driven(), st.fractions(Fraction(9, 10), Fraction(999, 1000), max_denominator=1000))
def test_losses_are_what_is_missing(
    given_: tuple[Arrangement, dict[str, int], tuple[str, str, str]], efficiency: Fraction
) -> None:
    """Each mesh loses its share of its rolling power, and that is all that is lost; torques still balance."""
    arrangement, teeth, roles = given_
    flow = flow_of(arrangement, teeth, roles, efficiency)
    if flow is None:
        return
    assert sum(flow.powers.values()) == sum(mesh.loss for mesh in flow.meshes)
    if flow.self_locking:
        assert flow.efficiency == 0
        return
    assert sum(flow.torques.values()) == 0
    assert flow.efficiency is not None
    assert 0 < flow.efficiency <= 1
    for mesh in flow.meshes:
        put_in = mesh.rolling_power if mesh.rolling_power > 0 else -mesh.rolling_power / efficiency
        assert mesh.loss == (1 - efficiency) * put_in


@given(counts, counts, st.fractions(Fraction(8, 10), Fraction(999, 1000), max_denominator=1000))
def test_efficiency_of_a_simple_set_in_closed_form(sun: int, planet: int, efficiency: Fraction) -> None:
    """Ring held: (s + η² r)/(s + r) from sun to carrier (Müller), with η² for both meshes; both ways."""
    teeth = {"sun": sun, "planet": planet, "ring": sun + 2 * planet}
    simple, ring, both = ARRANGEMENTS["simple"], sun + 2 * planet, efficiency**2
    down = flow_of(simple, teeth, ("sun", "carrier", "ring"), efficiency)
    up = flow_of(simple, teeth, ("carrier", "sun", "ring"), efficiency)
    assert down is not None
    assert up is not None
    assert down.efficiency == (sun + both * ring) / (sun + ring)
    assert up.efficiency == (sun + ring) / (sun + ring / both)


def test_circulating_power_is_told() -> None:
    """A Ferguson train rolls more than a hundred times its input; a simple set rolls less than it."""
    suns = ARRANGEMENTS["stepped_suns"]
    wasteful = flow_of(
        suns,
        {"sun_1": 100, "planet_1": 20, "planet_2": 20, "sun_2": 99},
        ("carrier", "sun_2", "sun_1"),
        Fraction(99, 100),
    )
    assert wasteful is not None
    assert wasteful.largest_rolling_power > 90
    simple = flow_of(
        ARRANGEMENTS["simple"], {"sun": 24, "planet": 18, "ring": 60}, ("sun", "carrier", "ring"), Fraction(99, 100)
    )
    assert simple is not None
    assert simple.largest_rolling_power == Fraction(60, 84)
    assert not simple.circulates


def test_branch_power_that_circulates() -> None:
    """Two rows joined by two shafts: what one row takes too much the other gives back (Müller, Sec. 24)."""
    linked = Train((row("in", "link", "out", Fraction(-3)), row("in", "link", GROUND, Fraction(-2))))
    turning = solve_speeds(linked, {"in": 1}).values
    flow = solve_power_flow(linked, turning, ("in", "out"), {"in": 1})
    assert flow is not None
    assert flow.circulates == (flow.largest_branch_power > 1)
    assert flow.circulates


@settings(max_examples=25)
@given(st.integers(6, 20), st.integers(5, 20), st.integers(5, 20), st.integers(1, 6))
def test_phases_against_the_divisibility_rules(sun: int, one: int, two: int, copies: int) -> None:
    """Trying every tooth finds what (S + R)/n and (S P₂ + R P₁)/(n gcd(P₁, P₂)) say."""
    turn = Fraction(1, copies)
    teeth = {"sun": sun, "planet": one, "ring": sun + 2 * one}
    fits = has_fit_at(ARRANGEMENTS["simple"], teeth, ("planet",), turn)
    assert fits == (2 * (sun + one) % copies == 0)
    ring = sun + one + two
    teeth = {"sun": sun, "planet_1": one, "planet_2": two, "ring": ring}
    fits = has_fit_at(ARRANGEMENTS["stepped"], teeth, ("planet",), turn)
    assert fits == ((sun * two + ring * one) % (copies * math.gcd(one, two)) == 0)
    teeth = {"sun": sun, "planet_1": one, "planet_2": two, "ring": ring}
    fits = has_fit_at(ARRANGEMENTS["double_planet"], teeth, ("planet_1", "planet_2"), turn)
    assert fits == ((ring - sun) % copies == 0)


def test_pins_of_a_ravigneaux_set() -> None:
    """The pins of short and long planet are as far apart as their pitch radii say; not coaxial teeth have none."""
    arrangement = ARRANGEMENTS["ravigneaux"]
    teeth = {"sun_small": 30, "planet_short": 18, "planet_long": 20, "sun_large": 38, "ring": 78}
    placed = place_pins(arrangement, teeth)
    assert placed is not None
    assert abs(placed["planet_short"] - placed["planet_long"]) == pytest.approx(19.0)
    assert abs(placed["planet_short"]) == pytest.approx(24.0)
    assert compute_pin_distances(arrangement, teeth)["planet_long"] == [29, 29]
    assert not is_coaxial(arrangement, teeth | {"ring": 79})
    assert not is_coaxial(arrangement, teeth | {"sun_small": 10, "planet_short": 6})
    turns = {planet: [Fraction(k, 3) for k in range(3)] for planet in arrangement.carriers}
    found = {(gap.one, gap.other): gap.room for gap in measure_gaps(arrangement, teeth, turns)}
    # Long planet beside the small sun, in the plane of the short planets: 29 − (15 + 1) − (10 + 1).
    assert found["planet_long", "sun_small"] == pytest.approx(2.0)


def test_bevel_planets_have_room_by_their_cones() -> None:
    """Four miter planets of the side gears' size would overlap; two never touch."""
    arrangement = ARRANGEMENTS["bevel_differential"]
    teeth = {"side_1": 20, "planet": 20, "side_2": 20}
    four = measure_gaps(arrangement, teeth, {"planet": [Fraction(k, 4) for k in range(4)]})
    assert min(gap.room for gap in four) == pytest.approx(-math.sqrt(2.0))
    assert not measure_gaps(arrangement, teeth, {"planet": [Fraction(0), Fraction(1, 2)]})
