"""Toggles, circuits, branches and order against the continuation, which follows the motion and knows no formula."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.linkage.fourbar import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    barker_class,
    can_assemble,
    find_input_limits,
    find_toggle_angles,
    find_transmission_extremes,
    has_full_rotation,
    is_same_circuit,
    positions,
    stays_on_branch,
    transmission_angle,
    traverse,
)
from tests.kinematics.sampling import assembled_angles, plain, random_fourbars, signs, take
from tests.oracles.continuation import configurations, follow, reaches
from tests.oracles.grashof_circuits import count_circuits

GAP = 1e-4
"""Random linkages keep this distance from change points, where neither side can be sure of a circuit."""

TURN = 2.0 * np.pi


def settled(rng: np.random.Generator, n: int, m: int) -> tuple[Fourbar, np.ndarray]:
    """Linkages with m input angles each at which they close, a little away from toggles."""
    linkage = random_fourbars(rng, n, GAP)
    theta = assembled_angles(rng, linkage, m, margin=1e-4)
    use = np.flatnonzero(~np.isnan(theta).any(axis=1))
    assert use.size > 0.9 * n
    return take(linkage, use), theta[use]


# -- circuits ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_count_of_circuits_and_branches() -> None:
    """Four configurations, mirrored in the ground line and of both assemblies, lie on all circuits that there are."""
    rng = np.random.default_rng(21)
    linkage, theta = settled(rng, 400, 1)
    mirrored = 2.0 * linkage.ground_angle[:, None] - theta
    angles = np.hstack([theta, theta, mirrored, mirrored])
    pins = configurations(plain(linkage), angles, np.array([[1, -1, 1, -1]]))
    first = follow(plain(linkage), *pins)
    left = np.where(first.same_circuit.all(axis=1), 0, (~first.same_circuit).argmax(axis=1))
    order = np.argsort(np.arange(4)[None, :] != left[:, None], axis=1, kind="stable")
    second = follow(plain(linkage), *(np.take_along_axis(pin, order, axis=1) for pin in pins))
    reached = first.same_circuit | np.take_along_axis(second.same_circuit, np.argsort(order, axis=1), axis=1)
    assert reached.all()
    seen = set()
    for k in range(linkage.input.size):
        found = count_circuits(take(linkage, k))
        assert found.circuits == (1 if left[k] == 0 else 2)
        assert found.branches == max(1, first.toggles[k])
        seen.add(tuple(found))
    assert seen == {(1, 2), (2, 1), (2, 2)}


@pytest.mark.parametrize("n", [1500, pytest.param(10_000, marks=pytest.mark.campaign)])
def test_same_circuit_and_branch(n: int) -> None:
    rng = np.random.default_rng(22)
    linkage, theta = settled(rng, n, 3)
    sign = signs(rng, *theta.shape)
    circuit = follow(plain(linkage), *configurations(plain(linkage), theta, sign))
    assert not np.isnan(circuit.length).any()
    for k in (1, 2):
        found = is_same_circuit(linkage, theta[:, 0], sign[:, 0], theta[:, k], sign[:, k])
        np.testing.assert_array_equal(found, circuit.same_circuit[:, k])
        onward = [stays_on_branch(linkage, theta[:, 0], theta[:, k] + turn) for turn in (-TURN, 0.0, TURN)]
        one_branch = np.any(onward, axis=0) & (sign[:, 0] == sign[:, k])
        np.testing.assert_array_equal(one_branch, circuit.same_branch[:, k])
    assert 0.3 < circuit.same_circuit[:, 1:].mean() < 0.9
    assert 0.2 < circuit.same_branch[:, 1:].mean() < 0.8


def test_reaches_names_the_three_cases() -> None:
    """Norton's linkage of Table P4-1, row a, a crank-rocker, and row k, a triple rocker with one toggle."""
    linkages = Fourbar.from_lengths([2.0, 6.0, 6.0], [7.0, 10.0, 10.0], [9.0, 7.0, 7.0], [6.0, 4.0, 4.0])
    start = np.radians([30.0, 88.0, 88.0]), np.array([1, 1, 1])
    target = np.radians([30.0, 80.0, 80.0]), np.array([-1, -1, 1])
    assert reaches(plain(linkages), start, target) == ["other circuit", "same circuit", "same branch"]
    np.testing.assert_array_equal(
        is_same_circuit(linkages, start[0], start[1], target[0], target[1]), [False, True, True]
    )


def test_every_toggle_is_met_once_in_a_round() -> None:
    rng = np.random.default_rng(23)
    linkage, theta = settled(rng, 600, 1)
    circuit = follow(plain(linkage), *configurations(plain(linkage), theta, np.ones((1, 1))))
    for k in range(linkage.input.size):
        one = take(linkage, k)
        on_circuit = find_toggle_angles(one).size // count_circuits(one).circuits
        assert circuit.toggles[k] == on_circuit
        assert bool(has_full_rotation(one)) == (on_circuit == 0)


@pytest.mark.slow
def test_stays_on_branch_is_assembled_all_the_way() -> None:
    """Turning from start to end by up to three turns, each way: sampled positions are valid all the way, or not."""
    rng = np.random.default_rng(24)
    linkage, theta = settled(rng, 5_000, 1)
    start = theta[:, 0]
    end = start + rng.uniform(-1.0, 1.0, start.size) * rng.choice([0.1, 1.0, 6.0 * np.pi], start.size)
    on_the_way = start[:, None] + (end - start)[:, None] * np.linspace(0.0, 1.0, 601)
    mu = transmission_angle(linkage, on_the_way)
    sampled = ~np.isnan(mu).any(axis=1)
    limits = find_input_limits(linkage)
    tight = np.nan_to_num(mu).min(axis=1) < 0.2
    found = stays_on_branch(linkage, start, end)
    np.testing.assert_array_equal(found, stays_on_branch(linkage, end, start))
    np.testing.assert_array_equal(found[~tight], sampled[~tight])
    assert not np.any(found & ~sampled)
    cranks = ~limits.folded_toggle & ~limits.extended_toggle
    assert found[cranks].all()
    assert 0.1 < found[~cranks].mean() < 0.9


# -- traverse ----------------------------------------------------------------------------------------------------------


def routes(seed: int, n: int, m: int) -> tuple[Fourbar, np.ndarray, np.ndarray]:
    """Targets of all sorts: any assemblies, one assembly, one side, in order along the input either way, and shuffled.

    A route in order starts anywhere and turns either way; cranks run over the ground line and past half a turn.
    """
    rng = np.random.default_rng(seed)
    linkage, theta = settled(rng, n, m)
    n = len(theta)
    ground = linkage.ground_angle[:, None]
    delta = np.remainder(theta - ground + np.pi, TURN) - np.pi
    sort = rng.integers(0, 5, n)[:, None]
    delta = np.where(sort >= 2, np.abs(delta) * rng.choice([-1, 1], (n, 1)), delta)
    ordered = np.sort(delta, axis=1) * rng.choice([-1, 1], (n, 1))
    crank = has_full_rotation(linkage)[:, None]
    rolled = np.sort(np.remainder(theta, TURN), axis=1)
    rolled = np.take_along_axis(rolled, (np.arange(m) + rng.integers(0, m, (n, 1))) % m, axis=1)
    flip = rng.random((n, 1)) < 0.5
    rolled = np.where(flip, rolled[:, ::-1], rolled)
    delta = np.where(sort == 3, ordered, np.where((sort == 4) & crank, rolled - ground, delta))
    sign = signs(rng, n, m)
    sign = np.where(sort >= 1, sign[:, :1], sign)
    return linkage, ground + delta + TURN * rng.integers(-2, 3, (n, m)), sign


@pytest.mark.slow
@pytest.mark.parametrize("m", [2, 3, 4, 6])
def test_traverse_agrees_with_the_continuation(m: int) -> None:
    compare_traversals(30 + m, 250, m)


@pytest.mark.campaign
@pytest.mark.parametrize("m", [2, 3, 5])
def test_traverse_agrees_with_the_continuation_on_many(m: int) -> None:
    compare_traversals(40 + m, 4000, m)


def compare_traversals(seed: int, n: int, m: int) -> None:
    """A third of the routes is put in the order in which the continuation meets the targets, on one branch or both."""
    linkage, theta, sign = routes(seed, n, m)
    ok = ~np.isnan(configurations(plain(linkage), theta, sign)[1]).any(axis=1)
    linkage, theta, sign = take(linkage, ok), theta[ok], sign[ok]
    circuit = follow(plain(linkage), *configurations(plain(linkage), theta, sign))
    planted = np.argsort(np.nan_to_num(circuit.arc, nan=np.inf), axis=1)
    planted[::2] = planted[::2, ::-1]
    theta[::3] = np.take_along_axis(theta, planted, axis=1)[::3]
    sign[::3] = np.take_along_axis(sign, planted, axis=1)[::3]
    circuit = follow(plain(linkage), *configurations(plain(linkage), theta, sign))
    least = circuit.least_transmission()
    branch, order = circuit.same_branch.all(axis=1), circuit.in_order
    met: dict[tuple[bool, bool], int] = {}
    for k in range(len(theta)):
        one = take(linkage, k)
        found = traverse(one, theta[k], sign[k])
        assert (found.same_branch, found.in_order) == (branch[k], order[k]), (k, one, theta[k], sign[k])
        met[found.same_branch, found.in_order] = met.get((found.same_branch, found.in_order), 0) + 1
        np.testing.assert_allclose(np.exp(1j * found.angles), np.exp(1j * theta[k]), atol=1e-9)
        assert min(found.start, found.end) <= found.angles.min() + 1e-12
        assert max(found.start, found.end) >= found.angles.max() - 1e-12
        if found.same_branch and found.in_order:
            steps = np.diff(found.angles)
            assert np.all(steps > 0) or np.all(steps < 0)
            assert (found.start, found.end) == (found.angles[0], found.angles[-1])
            assert abs(found.end - found.start) < TURN
            assert stays_on_branch(one, found.start, found.end)
            if has_full_rotation(one) and m == 2:
                assert abs(found.end - found.start) <= np.pi
        if found.same_branch and (found.in_order or not has_full_rotation(one)):
            if has_full_rotation(one) and abs(abs(found.end - found.start) - np.pi) < 0.05:
                continue  # both ways are half a turn long
            mu, _ = find_transmission_extremes(one, found.start, found.end)
            assert float(mu) == pytest.approx(least[k], abs=0.03)
    expected = {(True, True), (False, False)} | ({(True, False), (False, True)} if m > 2 else {(False, True)})
    assert expected <= met.keys()
    assert min(met[key] for key in expected) >= 5


def test_traverse_both_ways_over_the_ground_line() -> None:
    """A crank-rocker met in order one way only, through θ = 180° and through 0°; the turn may exceed half a turn."""
    linkage = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0)
    for route in ([170.0, 190.0, 200.0], [10.0, -10.0, -20.0], [0.0, 100.0, 200.0, 300.0], [0.0, 260.0, 160.0, 60.0]):
        found = traverse(linkage, np.radians(route), np.ones(len(route)))
        assert found.same_branch
        assert found.in_order
        turned = np.degrees(found.angles - found.angles[0])
        expected = np.array(route) - route[0]
        if route[1] == 260.0:
            expected = np.array([0.0, -100.0, -200.0, -300.0])
        np.testing.assert_allclose(turned, expected, atol=1e-9)
    shuffled = traverse(linkage, np.radians([0.0, 200.0, 100.0, 300.0]), np.ones(4))
    assert shuffled.same_branch
    assert not shuffled.in_order
    across = traverse(linkage, np.radians([10.0, 110.0, 60.0, 210.0]), np.ones(4))
    np.testing.assert_allclose(np.degrees([across.start, across.end]), [10.0, 210.0])
    np.testing.assert_allclose(np.degrees(across.angles), [10.0, 110.0, 60.0, 210.0])


def test_traverse_follows_a_planted_round_over_a_toggle() -> None:
    """A triple rocker goes up one branch and, over the toggle, down the other: one circuit, in order, two branches."""
    linkage = Fourbar.from_lengths(6.0, 10.0, 7.0, 4.0)
    limits = find_input_limits(linkage)
    up = float(limits.upper) - np.array([0.6, 0.2])
    theta, sign = np.concatenate([up, up[::-1]]), np.array([1, 1, -1, -1])
    for route in (slice(None), slice(None, None, -1)):
        found = traverse(linkage, theta[route], sign[route])
        assert not found.same_branch
        assert found.in_order
    jumbled = traverse(linkage, theta[[0, 2, 1, 3]], sign[[0, 2, 1, 3]])
    assert not jumbled.in_order


def test_targets_on_different_circuits_are_never_in_order() -> None:
    """A double rocker on both sides of the ground line, with one assembly and with two."""
    linkage = Fourbar.from_lengths(5.0, 2.0, 5.0, 4.0)
    limits = find_input_limits(linkage)
    inside = 0.5 * float(limits.lower + limits.upper)
    for sign in ([1, 1], [1, -1]):
        found = traverse(linkage, [inside, -inside], sign)
        assert not is_same_circuit(linkage, inside, sign[0], -inside, sign[1])
        assert not found.same_branch
        assert not found.in_order
    assert not traverse(Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0), [0.1, 0.2], [1, -1]).in_order


def test_one_target_is_in_order() -> None:
    for lengths in ((2.0, 7.0, 9.0, 6.0), (6.0, 10.0, 7.0, 4.0)):
        found = traverse(Fourbar.from_lengths(*lengths), [1.0], [1])
        assert found.same_branch
        assert found.in_order
        assert (found.start, found.end, list(found.angles)) == (1.0, 1.0, [1.0])


def test_equal_targets_are_not_in_order() -> None:
    """Two targets at one angle and on one assembly are one configuration; nothing moves between them."""
    for lengths in ((2.0, 7.0, 9.0, 6.0), (6.0, 10.0, 7.0, 4.0)):
        linkage = Fourbar.from_lengths(*lengths)
        found = traverse(linkage, [1.0, 1.0, 1.2], [1, 1, 1])
        assert found.same_branch
        assert not found.in_order
        again = traverse(linkage, [1.0, 1.0 + TURN, 1.2], [1, 1, 1])
        assert not again.in_order
        np.testing.assert_allclose(found.angles, [1.0, 1.0, 1.2], atol=1e-12)


@pytest.mark.parametrize("lengths", [(6.0, 10.0, 7.0, 4.0), (5.0, 2.0, 5.0, 4.0), (9.0, 7.0, 2.0, 6.0)])
@pytest.mark.parametrize("at", [0, -1])
def test_target_on_a_toggle_is_on_no_branch(lengths: tuple[float, ...], at: int) -> None:
    """It has a transmission angle of 0 and no direction; its angle stays within the range and does not jump a turn."""
    linkage = Fourbar(0.2 - 1j, 0.2 - 1j + lengths[3] * np.exp(2.1j), *lengths[:3])
    limits = find_input_limits(linkage)
    toggle = float(limits.upper if at else limits.lower) if limits.folded_toggle and limits.extended_toggle else None
    toggle = toggle or float(limits.upper if limits.extended_toggle else limits.lower)
    inward = toggle + 0.05 * (1.0 if toggle == limits.lower else -1.0)
    for nudge in (-1e-15, 0.0, 1e-15):
        theta = float(linkage.ground_angle) + np.array([inward, toggle + nudge, 0.5 * (inward + toggle)])
        found = traverse(linkage, theta, [1, 1, 1])
        np.testing.assert_allclose(found.angles - found.angles[0], theta - theta[0], atol=1e-12)
        assert not found.in_order
    sharp = traverse(linkage, float(linkage.ground_angle) + np.array([inward, toggle]), [1, 1])
    assert not sharp.same_branch
    assert find_transmission_extremes(linkage, sharp.start, sharp.end)[0] < 1e-6


def test_crank_over_several_turns() -> None:
    crank, rocker = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0), Fourbar.from_lengths(6.0, 10.0, 7.0, 4.0)
    assert stays_on_branch(crank, -20.0, 50.0)
    assert not stays_on_branch(rocker, 1.0, 1.0 + TURN)
    assert stays_on_branch(rocker, 1.0 + 6.0 * np.pi, 1.2 + 6.0 * np.pi)
    np.testing.assert_allclose(
        find_transmission_extremes(crank, -20.0, 50.0), find_transmission_extremes(crank, 0.0, TURN)
    )
    theta = np.array([0.3, 1.3, 2.3])
    np.testing.assert_allclose(positions(crank, theta + 40.0 * np.pi).b, positions(crank, theta).b, atol=1e-12)
    assert traverse(crank, theta + TURN * np.array([3, -7, 0]), [1, 1, 1]).in_order


# -- change points -----------------------------------------------------------------------------------------------------

CHANGE_POINTS = {
    "parallelogram": (0.3, 0.7, 0.3, 0.7, "S2X"),
    "antiparallelogram proportions": (0.7, 0.3, 0.7, 0.3, "S2X"),
    "kite, input short": (0.3, 0.7, 0.7, 0.3, "S2X"),
    "kite, input long": (0.7, 0.3, 0.3, 0.7, "S2X"),
    "rhombus": (0.1, 0.1, 0.1, 0.1, "S3X"),
    "shortest is ground": (0.6, 0.8, 0.4, 0.2, "SCCC"),
    "shortest is input": (0.2, 0.8, 0.4, 0.6, "SCRR"),
    "shortest is coupler": (0.8, 0.2, 0.4, 0.6, "SRCR"),
    "shortest is output": (0.8, 0.4, 0.2, 0.6, "SRRC"),
}


@pytest.mark.parametrize("name", CHANGE_POINTS)
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_change_point(name: str, scale: float) -> None:
    """All links fall into one line at θ = 0 or 180°; the circuits join there, and nobody can say where it goes on."""
    a, b, c, d, code = CHANGE_POINTS[name]
    linkage = Fourbar.from_lengths(*(scale * x for x in (a, b, c, d)))
    assert barker_class(linkage).code == code
    assert can_assemble(linkage)
    assert not has_full_rotation(linkage)
    assert count_circuits(linkage) == (1, 2)
    limits = find_input_limits(linkage)
    lines = [0.0] * (abs(abs(b - c) - abs(d - a)) < 1e-12) + [np.pi] * (abs(b + c - d - a) < 1e-12)
    assert lines
    for line in lines:
        assert line in (limits.lower, limits.upper)
        assert not stays_on_branch(linkage, line - 0.3, line + 0.3)
        assert find_transmission_extremes(linkage, line - 0.3, line + 0.3)[0] == pytest.approx(0.0, abs=1e-6)
        apart = abs(linkage.ground - linkage.input * np.exp(1j * line)) > 1e-6 * scale
        assert positions(linkage, line).valid == apart
    toggles = find_toggle_angles(linkage)
    assert all(min(abs(np.exp(1j * line) - np.exp(1j * toggles))) < 1e-12 for line in lines)
    assert len(toggles) == len(np.unique(np.round(np.exp(1j * toggles), 9)))
    for turn in (4.5e-16, 0.7, -2.1):
        turned = find_toggle_angles(Fourbar(0.0, scale * d * np.exp(1j * turn), *(scale * x for x in (a, b, c))))
        assert len(turned) == len(toggles)
        assert np.all((turned > -np.pi) & (turned <= np.pi))
    middle = 0.5 * float(limits.lower + limits.upper)
    assert is_same_circuit(linkage, middle, OPEN_ASSEMBLY, -middle, CROSSED_ASSEMBLY)
    assert traverse(linkage, [middle, -middle], [1, 1]).same_branch == (len(lines) == 1 and len(toggles) == 1)
    assert traverse(linkage, [middle, middle + 0.1], [1, 1]).same_branch


def test_parallelogram_swings_in_parallel() -> None:
    theta = np.radians(np.arange(1.0, 180.0))
    at = positions(Fourbar.from_lengths(0.3, 0.7, 0.3, 0.7), theta, CROSSED_ASSEMBLY)
    other = positions(Fourbar.from_lengths(0.3, 0.7, 0.3, 0.7), theta, OPEN_ASSEMBLY)
    parallel = [np.abs(np.exp(1j * x.output_angle) - np.exp(1j * theta)).max() < 1e-9 for x in (at, other)]
    assert sorted(parallel) == [False, True]
    assert positions(Fourbar.from_lengths(0.3, 0.7, 0.3, 0.7), np.radians(np.arange(361.0))).valid.all()


@pytest.mark.parametrize("excess", [-1e-4, -1e-6, -1e-8, 1e-8, 1e-6, 1e-4])
def test_near_a_change_point(excess: float) -> None:
    """The continuation still tells two circuits from one where S + L misses P + Q by one part in 1e6."""
    for order in ((2, 8, 4, 6), (8, 4, 2, 6), (6, 8, 4, 2), (8, 2, 4, 6)):
        lengths = np.array(order, float)
        lengths[lengths.argmax()] += excess * lengths.sum()
        linkage = Fourbar.from_lengths(*lengths)
        found = count_circuits(linkage)
        assert found.circuits == (2 if excess < 0 else 1)
        if abs(excess) < 1e-6:
            continue
        limits = find_input_limits(linkage)
        theta = 0.4 * float(limits.lower) + 0.6 * float(limits.upper)
        angles, sign = np.array([[theta, theta, -theta, -theta]]), np.array([[1, -1, 1, -1]])
        circuit = follow(plain(linkage), *configurations(plain(linkage), angles, sign))
        expected = [is_same_circuit(linkage, theta, 1, x, s) for x, s in zip(angles[0], sign[0], strict=True)]
        np.testing.assert_array_equal(circuit.same_circuit[0], expected)
        assert circuit.same_circuit[0].sum() == (4 if found.circuits == 1 else 2)
        assert max(1, circuit.toggles[0]) == found.branches


def test_can_assemble_up_to_the_straight_line() -> None:
    """One link as long as the other three together is the limit, whichever link it is; positions agree."""
    theta = np.linspace(0.0, 2.0 * np.pi, 721)
    for longest in range(4):
        for share, expected in ((0.9, True), (1.0 - 1e-6, True), (1.0 + 1e-6, False), (1.1, False)):
            lengths = np.array([1.0, 1.5, 2.0, 0.75])
            lengths[longest] = share * np.delete(lengths, longest).sum()
            linkage = Fourbar.from_lengths(*lengths)
            assert can_assemble(linkage) == expected
            assert positions(linkage, theta).valid.any() == expected
            assert (count_circuits(linkage).circuits > 0) == expected


def test_linkage_that_cannot_be_assembled_has_no_circuit() -> None:
    linkage = Fourbar.from_lengths(1.0, 1.0, 1.0, 10.0)
    assert count_circuits(linkage) == (0, 0)
    assert not has_full_rotation(linkage)
    assert not stays_on_branch(linkage, 0.0, 0.1)
    assert not is_same_circuit(linkage, 0.0, 1, 0.0, 1)
    assert not traverse(linkage, [0.0, 0.1], [1, 1]).same_branch
    assert find_toggle_angles(linkage).size == 0
    assert np.isnan(find_input_limits(linkage).lower)
    assert find_transmission_extremes(linkage, 0.0, 6.0) == (0.0, 0.0)
