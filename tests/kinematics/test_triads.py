"""Class III mechanisms: certified continuation against small steps along the constraints' own curves."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import decompose, drive, has_given_up
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import Mechanism, Slide, TopologyError
from tests.kinematics.mechanism_sampling import CLASS_THREE, take
from tests.oracles.constraints import Constraints, Trace

TURN = 2.0 * np.pi
NAMES = list(CLASS_THREE)


def reach(mechanism: Mechanism, limit: float) -> tuple[Constraints, list[list[Trace]], np.ndarray]:
    """Both ways from the reference by small steps, to the first toggle: traces, and the input's way there (n, 2)."""
    constraints = Constraints.of(mechanism)
    both = [constraints.follow(constraints.start(), side, limit, to_toggle=True) for side in (1.0, -1.0)]
    ends = [[t.toggles[0][1] if t.ended == "toggle" else t.points[-1, -1] for t in traces] for traces in both]
    return constraints, both, np.array(ends).T


def agrees(mechanism: Mechanism, limit: float = TURN, m: int = 40) -> tuple[int, int]:
    """Drive to the traced points and beyond their end: how many positions were compared, and how many refused."""
    constraints, both, ends = reach(mechanism, limit)
    every = constraints.take(np.repeat(np.arange(constraints.n), m))
    compared = refused = 0
    for side, (traces, sign) in enumerate(zip(both, (1.0, -1.0), strict=True)):
        end = ends[:, side][:, None]
        toggled = np.array([trace.ended == "toggle" for trace in traces])
        before = [np.linspace(0, len(t.points) - 1 - t.turned_back, m).astype(int) for t in traces]
        points = np.stack([trace.points[index] for trace, index in zip(traces, before, strict=True)])
        edge = end + sign * np.array([-1e-4, -1e-7, 1e-7, 1e-4, 1e-2, 0.3])
        way = np.concatenate([points[:, :, -1], np.where(toggled[:, None], edge, 0.0)], axis=1)
        found = drive(mechanism, mechanism.reference_input[:, None] + way, order=0)
        # An input beyond a toggle may be reached the other way round.
        places = way[..., None] + TURN * np.array([-1.0, 0.0, 1.0])
        within = (places > ends[:, 1, None, None]) & (places < ends[:, 0, None, None])
        inside = ~toggled[:, None] | within.any(axis=-1)
        sure = ~toggled[:, None] | (np.abs(places[..., None] - ends[:, None, None, :]).min(axis=(-1, -2)) > 1e-9)
        np.testing.assert_array_equal(found.valid[sure], inside[sure])
        refused += int((~inside).sum())
        joints = {name: z[0][:, :m].ravel() for name, z in found.joints.items()}
        off = np.abs(every.pack(joints, way[:, :m].ravel()) - points.reshape(-1, constraints.width)).max(axis=1)
        slope = every.evaluate(points.reshape(-1, constraints.width))[1][:, :, :-1]
        least = np.linalg.svd(slope, compute_uv=False)[:, -1]
        assert np.all((off < 1e-12 / least + 1e-11) | ~sure[:, :m].ravel())
        compared += len(off)
    return compared, refused


def batch(name: str, seed: int, n: int) -> Mechanism:
    return CLASS_THREE[name](np.random.default_rng([seed, NAMES.index(name)]), n)


@pytest.mark.campaign
@pytest.mark.parametrize("name", NAMES)
def test_continuation_agrees_with_small_steps(name: str) -> None:
    compared, refused = agrees(batch(name, 31, 4))
    assert compared > 200
    assert refused > 10


@pytest.mark.campaign
@pytest.mark.parametrize("name", NAMES)
def test_continuation_agrees_with_small_steps_for_many(name: str) -> None:
    compared, refused = agrees(batch(name, 32, 20))
    assert compared > 500
    assert refused > 60


def blended(one: Mechanism, other: Mechanism, share: np.ndarray) -> Mechanism:
    """Designs between two single designs of one topology."""
    joints = {name: one.joints[name] + share * (other.joints[name] - one.joints[name]) for name in one.joints}
    return Mechanism(joints, one.links, one.input)


def far(mechanism: Mechanism, way: float) -> np.ndarray:
    """Whether each design can be driven a given way from its reference."""
    return drive(mechanism, mechanism.reference_input[:, None] + way, order=0).valid[:, -1]


def near_gaps(name: str, n: int) -> tuple[Mechanism, float]:
    """Pairs of designs on both sides of one at which two assemblies touch, at several distances from it.

    Between a design that can be driven a third of a turn and one that cannot, the border is halved: there a toggle
    appears out of nothing or goes beyond the range. Also the way that all are to be driven.
    """
    pool = batch(name, 33, 60)
    way = 2.0
    good, bad = (np.flatnonzero(far(pool, way) == wanted) for wanted in (True, False))
    made: list[Mechanism] = []
    for one, other in zip(good[:n], bad[:n], strict=False):
        first, last = take(pool, one), take(pool, other)
        low, high = 0.0, 1.0
        for _ in range(4):  # nine inner designs each time
            share = np.linspace(low, high, 11)
            driven = far(blended(first, last, share), way)
            k = int(np.argmin(driven))
            low, high = share[k - 1], share[k]
        gap = np.array([1e-2, 1e-3, 1e-4])
        share = np.concatenate([low - gap, high + gap])
        made.append(blended(first, last, np.clip(share, 0.0, 1.0)))
    joints = {joint: np.concatenate([m.joints[joint] for m in made]) for joint in pool.joints}
    every = Constraints.of(Mechanism(joints, pool.links, pool.input))
    slope = every.evaluate(every.start())[1][:, :, :-1]
    use = np.linalg.svd(slope, compute_uv=False)[:, -1] > 1e-4  # else the reference itself is at the toggle
    return Mechanism({joint: z[use] for joint, z in joints.items()}, pool.links, pool.input), way


@pytest.mark.campaign
@pytest.mark.parametrize("name", NAMES)
def test_near_gaps_no_leap_to_another_assembly(name: str) -> None:
    mechanism, way = near_gaps(name, 2)
    compared, refused = agrees(mechanism, way)
    assert compared > 300
    assert refused > 10


def test_inputs_in_any_order_and_repeated() -> None:
    mechanism = batch("stephenson_2 driven by its input", 34, 5)
    way = np.array([0.3, -0.2, 0.0, 0.3, 0.1, -0.5, 0.0])
    at = mechanism.reference_input[:, None]
    whole = drive(mechanism, at + way)
    for k, one in enumerate(way):
        single = drive(mechanism, at + one)
        np.testing.assert_array_equal(single.valid[:, 0], whole.valid[:, k])
        for joint in mechanism.joints:
            np.testing.assert_allclose(single.joints[joint][..., 0], whole.joints[joint][..., k], rtol=1e-9, atol=1e-9)


def test_a_class_three_mechanism_that_also_closes_by_dyads_moves_alike() -> None:
    """A Stephenson III driven at the dyad's end, then at the fourbar's end with the angles found: the same places."""
    mechanism = batch("stephenson_3 driven by its output", 35, 40)
    way = np.linspace(-0.4, 0.4, 9)
    found = drive(mechanism, mechanism.reference_input[:, None] + way)
    by_dyads = Mechanism(mechanism.joints, mechanism.links, "input")
    assert not decompose(by_dyads).left
    back = drive(by_dyads, found.angles["input"][0])
    sines = [np.nan_to_num(np.abs(s)) for s in back.sines.values()]
    both = found.smooth & back.smooth & (np.min(sines, axis=0) > 0.1)
    same = np.max([np.abs(found.joints[j][0] - back.joints[j][0]) for j in mechanism.joints], axis=0) < 1e-8
    assert both.sum() > 100
    middle = slice(3, 6)  # near the reference no dyad has changed its assembly
    assert same[:, middle][both[:, middle]].mean() > 0.97
    for order, close in ((1, 1e-7), (2, 1e-6)):
        scale = 1.0 + np.abs(found.joints["P"][order])
        chained = {
            1: back.joints["P"][1] * found.angles["input"][1],
            2: back.joints["P"][2] * found.angles["input"][1] ** 2 + back.joints["P"][1] * found.angles["input"][2],
        }[order]
        error = np.abs(chained - found.joints["P"][order]) / scale
        assert np.median(error[both & same]) < 1e-11
        assert np.quantile(error[both & same], 0.9) < close


# -- degenerate --------------------------------------------------------------------------------------------------------


def test_reference_at_a_toggle_stays_there() -> None:
    """With links 5 and 6 of a Stephenson III in line under its output the input cannot be told from it; no NaN."""
    joints = {"O2": 0, "O4": 3, "O6": 5 + 1j, "A": 1j, "B": 3 + 2j, "C": 1.5 + 3j, "D": 0.0}
    joints["D"] = (joints["O6"] + joints["C"]) / 2
    mechanism = Mechanism(
        joints,
        {
            "ground": ("O2", "O4", "O6"),
            "input": ("O2", "A"),
            "coupler": ("A", "B", "C"),
            "rocker": ("O4", "B"),
            "link_5": ("C", "D"),
            "output": ("O6", "D"),
        },
        "output",
    )
    found = drive(mechanism, mechanism.reference_input + np.array([-1e-3, 0.0, 1e-3]))
    for point in found.joints.values():
        np.testing.assert_array_equal(np.isfinite(point[0]), found.valid)
    assert found.valid[1]


def test_inputs_of_more_axes_than_the_designs() -> None:
    mechanism = take(batch("stephenson_2 driven by its input", 36, 1), 0)
    at = mechanism.reference_input + np.array([[0.0, 0.1], [0.2, -0.1], [-0.2, 0.0]])
    found = drive(mechanism, at)
    assert found.valid.shape == (3, 2)
    for k in range(3):
        np.testing.assert_allclose(found.joints["P"][:, k], drive(mechanism, at[k]).joints["P"])


def test_slides_in_a_class_three_mechanism_are_refused() -> None:
    mechanism = take(batch("stephenson_2 driven by its input", 37, 1), 0)
    links = {name: listed for name, listed in mechanism.links.items() if name != "output"}
    links["ground"] = ("O2",)
    slide = Slide("E", "ground", np.asarray(mechanism.joints["E"]), np.asarray(0.3))
    joints = {name: z for name, z in mechanism.joints.items() if name != "O4"}
    with pytest.raises(TopologyError, match="dyads"):
        drive(Mechanism(joints, links, "input", (slide,)), [0.0])


@pytest.mark.parametrize("name", NAMES)
def test_an_input_is_reached_from_whichever_side_of_the_reference(name: str) -> None:
    """Inputs in the first turn, wherever in its branch the reference stands: just those of the branch exist."""
    mechanisms, bounded = batch(name, 33, 12), 0
    for k in range(12):
        mechanism = take(mechanisms, k)
        here = find_reference_branch(mechanism, find_branches(mechanism))
        assert here is not None
        at = np.linspace(0.0, TURN, 91) + 1e-3
        first = drive(mechanism, at, order=1)
        if here.full:
            assert first.valid.all()
            continue
        offset, way = np.mod(at - here.low, TURN), here.high - here.low
        sure = np.abs(offset - way) > 1e-6
        if way > TURN - 0.01:
            continue
        bounded += 1
        np.testing.assert_array_equal(first.valid[sure], (offset < way)[sure])
        for turns in (-2.0, 1.0):
            again = drive(mechanism, at + turns * TURN, order=1)
            np.testing.assert_array_equal(again.valid[sure], first.valid[sure])
            both = first.smooth & again.smooth
            for joint, jet in first.joints.items():
                np.testing.assert_allclose(again.joints[joint][0][both], jet[0][both], atol=1e-9)
    assert bounded > 6


def test_all_but_singular_equations_give_no_wrong_position() -> None:
    """Two fixed pivots a millionth apart and E beside C: a linkage that can nearly turn about O2 as one body."""
    joints = {
        "O2": -4.46697e-07 + 6.1903e-07j,
        "O4": 1.190498e-06 + 2.37395556e-07j,
        "A": -1.0j,
        "C": 1.0j,
        "B": -2.000000566957 - 1.000000260164407j,
        "D": -1.0j,
        "E": 8.3e-10 + 0.999999999626716j,
    }
    mechanism = catalogue.make_sixbar("stephenson_2", joints)
    found = drive(mechanism, np.linspace(0.0, TURN, 361), order=0)
    assert found.valid.sum() > 50
    for listed in mechanism.links.values():
        for one, other in pairwise(listed):
            length = np.abs(found.joints[one][0] - found.joints[other][0])[found.valid]
            assert np.abs(length - abs(joints[one] - joints[other])).max() < 1e-12
    assert found.valid.all() or has_given_up(mechanism)
