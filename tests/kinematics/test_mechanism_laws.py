"""Laws that hold for every mechanism of the core: rigidity, derivatives, invariance; and what wrong calls get."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from kinematics.errors import DimensionError, ShapeError
from kinematics.linkage.fourbar import Fourbar, motion
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import decompose, drive
from kinematics.linkage.planar.mechanism import GROUND, GearPair, Mechanism, Slide, TopologyError
from tests.kinematics.mechanism_sampling import CLASS_THREE, DYADIC, EVERY, geared_fivebar, points, take
from tests.oracles.constraints import Constraints
from tests.support.kinematics.mechanism_laws import CLOSURE, DESIGNS, batch, closes, orders, ways

FEW = [pytest.param(name, id=name) for name in EVERY]
INPUTS = 20


@pytest.mark.parametrize("name", FEW)
def test_constraints_hold(name: str) -> None:
    """Rigid lengths and shapes, joints on their lines and gear angles, of designs × inputs wherever valid."""
    closes(name, 1, DESIGNS[name], INPUTS)


@pytest.mark.parametrize("name", list(CLASS_THREE))
def test_constraints_hold_for_many_class_three(name: str) -> None:
    closes(name, 2, 100, 100)


@pytest.mark.parametrize("name", FEW)
def test_reference_is_kept(name: str) -> None:
    """Driven to its own input a mechanism stays where it is; at a limit a position is sure to the root of rounding."""
    _, mechanism = batch(name, 3)
    found = drive(mechanism, mechanism.reference_input[:, None], order=1)
    assert found.valid.all()
    size = np.max([np.abs(z) for z in mechanism.joints.values()], axis=0)
    sines = np.min([np.abs(s[:, 0]) for s in found.sines.values()], axis=0) if found.sines else np.ones(len(size))
    off = np.max([np.abs(found.joints[name][0, :, 0] - z) for name, z in mechanism.joints.items()], axis=0)
    assert (off / size * np.minimum(sines, 1.0) ** 3).max() < 1e-13
    assert np.median(off / size) < 1e-15
    for link in mechanism.links:
        if link != GROUND:
            turned = found.angles[link][0, :, 0] - mechanism.link_angle(link)
            assert np.abs(np.sin(turned / 2.0)).max() < 1e-7


def test_fourbar_agrees_with_the_fourbars_closed_form() -> None:
    rng = np.random.default_rng(4)
    joints = points(rng, "O2 O4 A B P", 500)
    o2, o4, a, b = (joints[name] for name in ("O2", "O4", "A", "B"))
    arm = (joints["P"] - a) * np.conj(b - a) / np.abs(b - a)
    linkage = Fourbar(o2, o4, np.abs(a - o2), np.abs(b - a), np.abs(b - o4), arm)
    sign = np.where(((b - a) * np.conj(o4 - a)).imag > 0.0, 1, -1)
    theta = np.angle(a - o2)
    made = catalogue.make_fourbar(linkage, theta, sign)
    for name in joints:
        np.testing.assert_allclose(made.joints[name], joints[name], atol=1e-9)
    inputs = rng.uniform(-10.0, 10.0, (500, 20))
    rates = {"speed": 1.3, "acceleration": -0.7, "jerk": 2.0}
    here, there = drive(made, inputs, **rates), motion(linkage, inputs, sign, **rates)
    np.testing.assert_array_equal(here.valid, there.position.valid)
    sine = np.abs(np.sin(there.position.output_angle - there.position.coupler_angle))
    soft = here.smooth & (np.nan_to_num(sine) > 0.05)
    assert soft.mean() > 0.5
    np.testing.assert_allclose(np.abs(here.sines["coupler"])[soft], sine[soft], atol=1e-9)
    for order in range(4):
        for name in ("a", "b", "p"):
            one, other = here.joints[name.upper()][order], getattr(there[order], name)
            scale = 1.0 + np.abs(other)
            assert (np.abs(one - other) / scale)[soft].max() < 1e-7, (order, name)
            assert np.median((np.abs(one - other) / scale)[soft]) < 1e-14
    for order in (1, 2, 3):
        for link in ("coupler", "output"):
            one, other = here.angles[link][order], getattr(there[order], link)
            assert (np.abs(one - other) / (1.0 + np.abs(other)))[soft].max() < 1e-7


def test_peaucellier_draws_a_straight_line() -> None:
    """With the crank as long as the ground, P runs at right angles to the ground, (arm² − side²)/2d from O4.

    Where the rhombus lies flat P meets A, and two motions cross: beyond, the assembly on the reference's side of the
    line B C is the one that keeps P on A.
    """
    rng, mechanism = batch("Peaucellier", 5)
    found = drive(mechanism, mechanism.reference_input[:, None] + ways(rng, mechanism, INPUTS))
    o2, o4 = mechanism.joints["O2"], mechanism.joints["O4"]
    arm, side = (np.abs(mechanism.joints["B"] - mechanism.joints[name]) for name in ("O4", "A"))
    ground, flat = np.abs(o2 - o4), np.sqrt((arm - side) * (arm + side))
    reach = np.abs(found.joints["A"][0] - o4[:, None]) - flat[:, None]
    same = np.sign(reach) == np.sign(np.abs(mechanism.joints["A"] - o4) - flat)[:, None]
    away = np.abs(reach) > 1e-3
    on, off = found.valid & same & away, found.valid & ~same & away
    assert on.sum() > 3000
    assert off.sum() > 500
    pole = found.joints["P"][0] - o4[:, None]
    along = (pole * np.conj((o2 - o4) / ground)[:, None]).real
    expected = ((arm - side) * (arm + side) / (2.0 * ground))[:, None]
    assert (np.abs(along - expected) / (np.abs(pole) + (arm + ground)[:, None]))[on].max() <= CLOSURE
    assert np.abs(found.joints["P"][0] - found.joints["A"][0])[off].max() <= CLOSURE * 10.0
    velocity = found.joints["P"][1]
    across = np.abs((velocity * np.conj((o2 - o4) / ground)[:, None]).real) / np.abs(velocity)
    assert across[on & found.smooth].max() < 1e-7
    assert np.median(across[on & found.smooth]) < 1e-13


SETS = 6
"""Designs of each type of which every assembly is looked for."""


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.slow] if "driven" in name else [])
        for name in DYADIC
        if name != "Peaucellier"  # with B on C it has an infinity of them
    ],
)
def test_every_assembly_and_no_other(name: str) -> None:
    """At each input the configurations of all choices are those that Newton's iteration finds from random starts."""
    rng, mechanism = batch(name, 6, SETS)
    constraints = Constraints.of(mechanism)
    unit = constraints.size if mechanism.has_slide_input else np.ones(SETS)
    steps = decompose(mechanism).steps
    closing = [k for k, step in enumerate(steps) if step.has_two_solutions]
    counts = set()
    for way in (0.7, -1.9):
        every, sure = [], []
        for choice in np.ndindex(*(2,) * len(closing)):
            signs = [np.ones(SETS, int)] * len(steps)
            for k, sign in zip(closing, choice, strict=True):
                signs[k] = np.full(SETS, 1 - 2 * sign)
            found = drive(mechanism, (mechanism.reference_input + way * unit)[:, None], signs=tuple(signs), order=0)
            every.append(constraints.pack({j: z[0, :, 0] for j, z in found.joints.items()}, way))
            margins = np.array([margin[0, :, 0] for margin in found.margins.values()])
            sure.append(np.nan_to_num(np.abs(margins), nan=1.0).min(axis=0) > 1e-3)
        for design in range(SETS):
            if not all(s[design] for s in sure):
                continue
            mine = [x[design] for x in every if np.isfinite(x[design]).all()]
            theirs = constraints.all_configurations(design, way, rng)
            counts.add(len(theirs))
            for other in theirs:
                assert any(np.abs(x - other).max() < 1e-6 for x in mine), (name, design, way)
            for x in mine:
                assert any(np.abs(x - other).max() < 1e-6 for other in theirs), (name, design, way)
    assert len(counts) > 1


# -- derivatives -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FEW)
def test_each_order_is_the_rate_of_the_one_below(name: str) -> None:
    orders(name, 7, 60 if name in CLASS_THREE else 500)


def test_speed_scales_the_orders() -> None:
    """Twice the speed: velocities × 2, accelerations × 4, jerks × 8; running back: odd orders change sign."""
    for name in ("geared fivebar", "crank-shaper", "stephenson_2 driven by its input"):
        _, mechanism = batch(name, 8, 30)
        at = mechanism.reference_input[:, None]
        one = drive(mechanism, at)
        for factor in (2.0, -1.0):
            other = drive(mechanism, at, speed=factor)
            for order in (1, 2, 3):
                for joint, jet in one.joints.items():
                    np.testing.assert_allclose(other.joints[joint][order], factor**order * jet[order], rtol=1e-9)


def test_lower_orders_are_the_same_without_the_higher() -> None:
    for name in ("slider-crank", "stephenson_3 driven by its output"):
        rng, mechanism = batch(name, 9, 30)
        at = mechanism.reference_input[:, None] + ways(rng, mechanism, 3)
        full = drive(mechanism, at)
        for order in (0, 1, 2):
            part = drive(mechanism, at, order=order)
            np.testing.assert_array_equal(part.valid, full.valid)
            for joint, jet in part.joints.items():
                np.testing.assert_array_equal(jet[0], full.joints[joint][0])
                np.testing.assert_array_equal(jet, np.where(part.smooth, full.joints[joint][: order + 1], jet))


# -- invariance --------------------------------------------------------------------------------------------------------


def moved_by(mechanism: Mechanism, place: Callable, reflected: bool = False) -> Mechanism:
    """The same designs elsewhere: ``place`` maps points by a similarity."""
    turn = np.angle(place(1.0) - place(0.0))
    slides = tuple(
        s._replace(point=place(s.point), angle=(-s.angle if reflected else s.angle) + turn) for s in mechanism.slides
    )
    joints = {name: place(z) for name, z in mechanism.joints.items()}
    return Mechanism(joints, mechanism.links, mechanism.input, slides, mechanism.gears)


@pytest.mark.parametrize("name", FEW)
@pytest.mark.parametrize(("factor", "reflected"), [(1e-9, False), (0.7, True), (1e9, False)])
def test_similar_mechanisms_move_alike(name: str, factor: float, reflected: bool) -> None:
    """Turned, moved, scaled from 1e-9 to 1e9 and reflected: the same validity, the image of every joint."""
    rng, mechanism = batch(name, 10, 12 if name in CLASS_THREE else 300)
    way = ways(rng, mechanism, 4, 2.0)
    turn, shift = factor * np.exp(0.9j), 3.0 - 2.0j

    def place(z: np.ndarray) -> np.ndarray:
        return turn * (np.conj(z) if reflected else z) + factor * shift

    other = moved_by(mechanism, place, reflected)
    unit = factor if mechanism.has_slide_input else 1.0
    hand = -1.0 if reflected and not mechanism.has_slide_input else 1.0
    here = drive(mechanism, mechanism.reference_input[:, None] + way)
    there = drive(other, other.reference_input[:, None] + hand * unit * way, speed=hand * unit)
    edge = np.min([np.abs(m[0]) for m in here.margins.values()], axis=0) if here.margins else np.ones(way.shape)
    sure = ~(edge < 1e-9)
    assert sure.mean() > 0.99
    np.testing.assert_array_equal(here.valid[sure], there.valid[sure])
    soft = here.smooth & there.smooth
    if here.sines:
        soft &= np.min([np.nan_to_num(np.abs(s)) for s in here.sines.values()], axis=0) > 0.05
    size = Constraints.of(mechanism).size[:, None]
    for order, close in ((0, 1e-9), (1, 1e-7), (2, 1e-5)):
        for joint, jet in here.joints.items():
            image = place(jet[order]) if order == 0 else place(jet[order]) - place(0.0)
            error = np.abs(there.joints[joint][order] - image) / factor / (size + np.abs(jet[order]))
            assert error[soft].max() < close, (joint, order)
            assert np.median(error[soft]) < 1e-13


def test_far_from_the_origin_only_the_coordinates_lose_digits() -> None:
    _, mechanism = batch("watt_1 driven by its input", 11, 100)
    far = moved_by(mechanism, lambda z: z + 1e6)
    at = mechanism.reference_input[:, None] + np.array([0.1, 0.2])
    here, there = drive(mechanism, at), drive(far, at)
    soft = here.smooth & (np.min([np.nan_to_num(np.abs(s)) for s in here.sines.values()], axis=0) > 0.2)
    for joint in here.joints:
        assert np.abs(there.joints[joint][0] - here.joints[joint][0] - 1e6)[soft].max() < 1e-6
        assert np.median(np.abs(there.joints[joint][0] - here.joints[joint][0] - 1e6)[soft]) < 1e-8


def test_batch_is_the_designs_one_by_one() -> None:
    for name in EVERY:
        rng, mechanism = batch(name, 12, 4)
        at = mechanism.reference_input[:, None] + ways(rng, mechanism, 5, 1.0)
        whole = drive(mechanism, at)
        for k in range(4):
            single = drive(take(mechanism, k), at[k])
            assert single.valid.shape == (5,)
            for joint in mechanism.joints:
                np.testing.assert_allclose(single.joints[joint], whole.joints[joint][:, k], rtol=1e-12, atol=1e-13)


def test_gears_follow_inputs_beyond_full_turns() -> None:
    """With ratio 1/2 a fivebar has turned its output by half when the input is back; after two turns all repeats."""
    rng = np.random.default_rng(13)
    mechanism = geared_fivebar(rng, 200, 0.5)
    at = mechanism.reference_input[:, None] + rng.uniform(-1.0, 1.0, (200, 3))
    turn = 2.0 * np.pi
    here, once, twice = (drive(mechanism, at + k * turn, order=0) for k in (0, 1, 2))
    o5 = mechanism.joints["O5"][:, None]
    np.testing.assert_array_equal(here.valid, twice.valid)
    both = here.valid & once.valid
    assert both.any()
    np.testing.assert_allclose((once.joints["B"][0] - o5)[both], (o5 - here.joints["B"][0])[both], atol=1e-9)
    for joint in mechanism.joints:
        np.testing.assert_allclose(here.joints[joint][0], twice.joints[joint][0], atol=1e-6)


# -- degenerate mechanisms and wrong calls -----------------------------------------------------------------------------

LINKS = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B"), "output": ("O4", "B")}
JOINTS: dict[str, complex] = {"O2": 0.0, "O4": 3.0, "A": 1j, "B": 3.0 + 2j}
SLIDER = {"ground": ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B")}
FIVEBAR = {
    "ground": ("O2", "O5"),
    "input": ("O2", "A"),
    "coupler_1": ("A", "C"),
    "coupler_2": ("B", "C"),
    "output": ("O5", "B"),
}
FIVE = {"O2": 0.0, "O5": 3.0, "A": 1j, "B": 3.0 + 1j, "C": 1.5 + 3j}


def slider(point: complex, angle: float) -> Mechanism:
    line = Slide("B", "ground", np.asarray(point), np.asarray(angle))
    return Mechanism({"O2": 0.0, "A": 1j, "B": 2.0}, SLIDER, "crank", (line,))


WRONG: dict[str, tuple[type[Exception], str, Callable]] = {
    "no coupler": (DimensionError, "coupler", lambda: drive(Mechanism({**JOINTS, "B": 1j}, LINKS, "input"), [0.0])),
    "no output": (DimensionError, "output", lambda: drive(Mechanism({**JOINTS, "B": 3.0}, LINKS, "input"), [0.0])),
    "no crank": (DimensionError, "input from O2 to A", lambda: Mechanism({**JOINTS, "A": 0.0}, LINKS, "input")),
    "crank of rounding": (DimensionError, "input", lambda: Mechanism({**JOINTS, "A": 1e-16}, LINKS, "input")),
    "inversion's assembly": (
        DimensionError,
        "assembly",
        lambda: catalogue.make_inverted_slider_crank(0j, 2.0, 1.0, 0.5, 1.0, 0.4, 0),
    ),
    "inversion's pin on O4": (
        DimensionError,
        "O4",
        lambda: catalogue.make_inverted_slider_crank(0j, 1.0, 1.0, 0.0, 1.0, 0.0),
    ),
    "not a number": (DimensionError, "B", lambda: Mechanism({**JOINTS, "B": np.nan}, LINKS, "input")),
    "off its slide": (DimensionError, "slide", lambda: slider(2.0 + 0.1j, 0.0)),
    "slide without a place": (DimensionError, "slide", lambda: slider(np.nan, 0.0)),
    "slide without a direction": (DimensionError, "slide angle", lambda: slider(2.0, np.inf)),
    "gear without a ratio": (
        DimensionError,
        "ratio",
        lambda: Mechanism(FIVE, FIVEBAR, "input", gears=(GearPair("input", "output", np.nan),)),
    ),
    "gear that cannot be driven back": (
        TopologyError,
        "dyads",
        lambda: drive(Mechanism(FIVE, FIVEBAR, "input", gears=(GearPair("output", "input", 0.0),)), [0.0]),
    ),
    "fivebar's ratio": (
        DimensionError,
        "gear_ratio",
        lambda: catalogue.make_geared_fivebar(0j, 3.0, 1.0, 3.0, 3.0, 1.0, np.nan, 0.5, 0.3),
    ),
    "crank pin on O4": (
        DimensionError,
        "O4",
        lambda: catalogue.make_quick_return(0j, -1.0, 1.0, 1.0, 3.0, 1j, 0.0, np.pi),
    ),
    "arms that miss the rhombus": (
        DimensionError,
        "rhombus",
        lambda: catalogue.make_peaucellier(0j, 1.0, 1.0, 3.0, 1.0, 0.0),
    ),
    "assembly": (DimensionError, "assembly", lambda: catalogue.make_slider_crank(0j, 0j, 0.0, 1.0, 3.0, 0.3, 0)),
    "joint missing": (
        TopologyError,
        "mobility",
        lambda: catalogue.make_sixbar(
            "watt_1", {k: complex(n, n * n) for n, k in enumerate(("O2", "O4", "A", "C", "D", "E"))}
        ),
    ),
    "joint on no link": (TopologyError, "Q", lambda: Mechanism({**JOINTS, "Q": 5.0}, LINKS, "input")),
    "link apart": (
        TopologyError,
        "mobility",
        lambda: Mechanism({**JOINTS, "X": 5.0, "Y": 6.0}, {**LINKS, "far": ("X", "Y")}, "input"),
    ),
    "input not at the ground": (TopologyError, "coupler", lambda: Mechanism(JOINTS, LINKS, "coupler")),
    "designs of two shapes": (
        ShapeError,
        "A",
        lambda: Mechanism({**JOINTS, "A": np.ones(2), "B": np.ones(3)}, LINKS, "input"),
    ),
    "inputs of another shape": (
        ShapeError,
        "input",
        lambda: drive(Mechanism({**JOINTS, "B": np.array([1.0 + 1j, 2.0 + 1j])}, LINKS, "input"), np.zeros((3, 4))),
    ),
    "infinite input": (DimensionError, "input", lambda: drive(Mechanism(JOINTS, LINKS, "input"), [np.inf])),
    "sign": (DimensionError, "signs", lambda: drive(Mechanism(JOINTS, LINKS, "input"), [0.0], signs=(np.array(0),))),
    "signs": (DimensionError, "signs", lambda: drive(Mechanism(JOINTS, LINKS, "input"), [0.0], signs=())),
    "order": (DimensionError, "order", lambda: drive(Mechanism(JOINTS, LINKS, "input"), [0.0], order=4)),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_calls_get_a_clear_error(case: str) -> None:
    error, words, call = WRONG[case]
    with pytest.raises(error, match=words):
        call()


TURN = np.linspace(0.0, 2.0 * np.pi, 9)

ODD: dict[str, Callable[[], Mechanism]] = {
    "parallelogram": lambda: catalogue.make_fourbar(Fourbar.from_lengths(1.0, 3.0, 1.0, 3.0), 0.0),
    "rhombus": lambda: catalogue.make_fourbar(Fourbar.from_lengths(1.0, 1.0, 1.0, 1.0), 1.0),
    "collinear coupler point": lambda: catalogue.make_fourbar(Fourbar.from_lengths(1.0, 3.0, 2.5, 3.0, 1.5), 0.3),
    "crank as long as the coupler": lambda: catalogue.make_slider_crank(0j, 0j, 0.0, 1.0, 1.0, 0.3),
    "slide through the pivot": lambda: catalogue.make_inverted_slider_crank(0j, 2.0, 1.0, 0.0, 0.0, 0.4),
    "crank pin that passes O4": lambda: catalogue.make_quick_return(0j, -1.0, 1.0, 1.0, 3.0, 1j, 0.0, 0.5),
    "gear that stands still": lambda: catalogue.make_geared_fivebar(0j, 3.0, 1.0, 3.0, 3.0, 1.0, 0.0, 0.5, 0.3),
    "irrational ratio": lambda: catalogue.make_geared_fivebar(0j, 3.0, 1.0, 3.0, 3.0, 1.0, np.sqrt(2.0), 0.5, 0.3),
    "pivots on each other": lambda: Mechanism({**JOINTS, "O4": 0.0}, LINKS, "input"),
    "three links at one joint": lambda: Mechanism(
        {**JOINTS, "O6": 6.0, "C": 5.0 + 2j},
        {**LINKS, "ground": ("O2", "O4", "O6"), "link_5": ("B", "C"), "output_2": ("O6", "C")},
        "input",
    ),
    "one of two that cannot close": lambda: Mechanism({**JOINTS, "B": np.array([3.0 + 2j, 1.001j])}, LINKS, "input"),
}


@pytest.mark.parametrize("case", ODD)
def test_degenerate_mechanisms_are_right_where_valid(case: str) -> None:
    mechanism = ODD[case]()
    found = drive(mechanism, np.append(TURN, np.nan))
    assert found.valid.any()
    assert not found.valid[..., -1].any()
    for values in (found.joints, found.angles, found.slides):
        for value in values.values():
            np.testing.assert_array_equal(np.isfinite(value[0]), found.valid)
            np.testing.assert_array_equal(np.isfinite(value).all(axis=0), found.smooth)
    for link, listed in mechanism.links.items():
        for one, other in pairwise(listed):
            length = np.abs(mechanism.joints[one] - mechanism.joints[other])[..., None]
            off = np.abs(np.abs(found.joints[one][0] - found.joints[other][0]) - length)
            assert off[found.valid].max() < 1e-12, link
    for slide in mechanism.slides:
        if slide.link != GROUND:
            continue
        offset = (found.joints[slide.joint][0] - slide.point) * np.exp(-1j * slide.angle)
        assert np.abs(offset.imag)[found.valid].max() < 1e-12


def test_parallelogram_at_its_change_points() -> None:
    """There both assemblies are valid and one, without derivatives; between, the output turns as the input does."""
    mechanism = ODD["parallelogram"]()
    at = np.array([0.0, np.pi])
    one, other = (drive(mechanism, at, signs=(np.array(sign),)) for sign in (1, -1))
    assert one.valid.all()
    assert other.valid.all()
    assert not one.smooth.any()
    np.testing.assert_allclose(one.joints["B"][0], other.joints["B"][0], atol=1e-7)
    moved = drive(mechanism, np.array([0.5, 2.5]), signs=(np.array(-1),))
    np.testing.assert_allclose(moved.angles["output"][1], 1.0, rtol=1e-12)


def test_pivots_on_each_other_turn_as_one_body() -> None:
    found = drive(ODD["pivots on each other"](), TURN)
    for link in ("input", "coupler", "output"):
        np.testing.assert_allclose(found.angles[link][1:, :, ...].reshape(3, -1)[0], 1.0, rtol=1e-12)


@pytest.mark.parametrize("output", [0.7, 0.0])
def test_open_inversions_have_the_pin_ahead_on_the_line(output: float) -> None:
    """Ahead of the point of the line that is nearest to O4, by the line's own direction, γ from O4 → B."""
    gamma = 0.8
    for assembly in (1, -1):
        made = catalogue.make_inverted_slider_crank(0j, 2.0, 1.0, output, gamma, 0.4, assembly)
        along = np.exp(1j * gamma) * (made.joints["B"] - 2.0) / np.abs(made.joints["B"] - 2.0)
        point = made.slides[0].point
        nearest = point + along * ((2.0 - point) * np.conj(along)).real
        assert ((made.joints["A"] - point) * np.conj(along)).imag == pytest.approx(0.0, abs=1e-14)
        assert assembly * ((made.joints["A"] - nearest) * np.conj(along)).real > 0.0


def test_links_on_each_other_have_no_rotation() -> None:
    """A rhombus folded with B on C leaves P free on a circle: no position is given, on whichever assembly."""
    cell = catalogue.make_peaucellier(0j, -1.3 + 0j, 1.3, 2.5, 1.1, 0.6)
    signs = tuple(np.array(s) for s in (1, 1, 1))
    assert not drive(cell, np.linspace(-0.5, 0.5, 50), signs=signs).valid.any()


def test_class_three_reference_at_a_toggle_is_refused() -> None:
    """A link on three legs, A B, C D and O4 E, is at a toggle where the three lines meet in one point."""
    joints = {"O2": 0j, "O4": 3.0 + 0j, "A": 0.2 + 1j, "C": 1.0 + 0.7j, "P": 2.0 + 3j}
    meet = 1.7 + 2.1j
    for leg, foot, part in (("B", "A", 0.6), ("D", "C", 1.4), ("E", "O4", 0.5)):
        joints[leg] = joints[foot] + part * (meet - joints[foot])
    folded = catalogue.make_sixbar("stephenson_2", joints)
    with pytest.raises(DimensionError, match="toggle"):
        drive(folded, [folded.reference_input + 0.01])
    beside = catalogue.make_sixbar("stephenson_2", {**joints, "B": joints["B"] + 1e-3})
    way = np.array([-1e-3, 0.0, 1e-3])
    assert drive(beside, beside.reference_input + way).valid.sum() == 2


@pytest.mark.parametrize("share", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("short", ["coupler", "output"])
def test_a_link_that_is_short_beside_the_others_keeps_its_length(share: float, short: str) -> None:
    """Its square is lost in theirs, so that it must be the one that is solved for; whichever link comes first."""
    rng = np.random.default_rng(14)
    n = 200
    pin, turn = np.exp(1j * rng.uniform(-np.pi, np.pi, n)), np.exp(1j * rng.uniform(-np.pi, np.pi, n))
    a, o4 = (pin, 3.0 + 0j) if short == "output" else (3.0 + pin, 3.0 + 0j)
    b = o4 + share * turn if short == "output" else a + share * turn
    joints = {"O2": np.zeros(n), "O4": np.full(n, 3.0), "A": a, "B": b, "P": b + 1j}
    on = ("O4", "B", "P") if short == "output" else ("A", "B", "P")
    other = ("A", "B") if short == "output" else ("O4", "B")
    named = {"coupler": other, "output": on} if short == "output" else {"coupler": on, "output": other}
    mechanism = Mechanism(joints, {"ground": ("O2", "O4"), "input": ("O2", "A"), **named}, "input")
    at = mechanism.reference_input[:, None] + share * np.array([0.0, 0.1, -0.1])
    found = drive(mechanism, at, order=0)
    assert found.valid[:, 0].all()
    assert found.valid.mean() > 0.5
    for one, two in ((on[0], "B"), (other[0], "B"), (on[0], "P"), ("B", "P")):
        length = np.abs(joints[one] - joints[two])[:, None]
        off = np.abs(np.abs(found.joints[one][0] - found.joints[two][0]) - length)
        assert off[found.valid].max() < 5e-15, (one, two)
