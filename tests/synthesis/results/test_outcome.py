"""What becomes of candidates: the account always adds up, and designs come in one order."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import NamedTuple, cast

from hypothesis import given
from hypothesis import strategies as st

from synthesis.model.answer import Check, Verification
from synthesis.model.problem import ProblemBase
from synthesis.results.candidate_log import DEFECT_REASONS, OUTRANKED_REASON, CandidateLog, report_candidates
from synthesis.results.exhaustive import is_within_tolerance, select_pareto, select_within_tolerance
from synthesis.results.pareto import pareto_front
from synthesis.results.ranking import SORT_KEYS, rank_designs


class Metrics(NamedTuple):
    """What designs are ranked by."""

    quality: float
    size: float
    min_transmission_angle: float
    rms_residual: float = 0.0


class Design(NamedTuple):
    """The least that is sifted and ranked."""

    verification: Verification
    metrics: Metrics
    targets: list[SimpleNamespace]


def design(broken: tuple[str, ...] = (), quality: float = 0.5, size: float = 1.0, residual: float = 0.0) -> Design:
    checks = [Check(name="drawn", passed=True), *(Check(name=name, passed=False) for name in broken)]
    verification = Verification(passed=not broken, checks=checks)
    return Design(verification, Metrics(quality, size, 90.0 * quality, residual), [SimpleNamespace(residual=residual)])


designs = st.builds(
    design,
    st.sampled_from([(), (), ("reaches_targets",), ("longest_link", "same_circuit"), ("same_circuit",)]),
    st.floats(0.0, 1.0),
    st.sampled_from([1.0, 2.0, 3.0]),
    st.floats(0.0, 1.0),
)
verdicts = st.lists(st.one_of(designs, st.none(), st.sampled_from(["degenerate", "link_length"])), max_size=40)


def problem(most: int = 10, *, include_failed: bool = False) -> ProblemBase:
    return ProblemBase(kind="any", max_designs=most, include_failed=include_failed, seed=7)


@given(verdicts, st.dictionaries(st.sampled_from(["branch_defect", OUTRANKED_REASON]), st.integers(0, 9)))
def test_the_account_adds_up(met: list[Design | str | None], screened: dict[str, int]) -> None:
    sifting = CandidateLog[Design](problem(), DEFECT_REASONS)
    for reason, count in screened.items():
        sifting.reject(reason, count)
    sifting.verify_candidates(met, lambda verdict: verdict)
    search = sifting.build_search("any")
    assert search.candidates == len(met) + sum(screened.values())
    assert search.candidates == search.accepted + sum(search.rejected.values())
    assert search.accepted == len(sifting.passed)
    assert all(search.rejected.values())
    assert search.seed == 7
    assert len(sifting.passed) + len(sifting.failed) == sum(isinstance(verdict, Design) for verdict in met)


@given(verdicts, st.integers(0, 5))
def test_what_is_withdrawn_counts_as_rejected(met: list[Design | str | None], kept: int) -> None:
    sifting = CandidateLog[Design](problem())
    sifting.verify_candidates(met, lambda verdict: verdict)
    accepted = sifting.accepted
    sifting.withdraw(sifting.passed[:kept], "far")
    search = sifting.build_search("any")
    assert search.candidates == len(met)
    assert search.accepted == min(kept, accepted)
    assert search.rejected.get("far", 0) == accepted - search.accepted


@given(verdicts, st.integers(1, 4))
def test_it_stops_when_enough_have_passed(met: list[Design | str | None], enough: int) -> None:
    sifting = CandidateLog[Design](problem())
    verified = sifting.verify_candidates(met, lambda verdict: verdict, enough)
    assert verified == sifting.candidates
    assert len(sifting.passed) <= enough
    assert verified == len(met) or len(sifting.passed) == enough


def test_reasons_are_those_of_the_first_broken_check() -> None:
    sifting = CandidateLog[Design](problem(), DEFECT_REASONS, undriven="does_not_turn")
    sifting.verify_candidates(
        [design(("same_circuit", "longest_link")), design(("longest_link",)), None], lambda verdict: verdict
    )
    assert sifting.rejected == {"circuit_defect": 1, "longest_link": 1, "does_not_turn": 1}
    assert sifting.format_reasons("does_not_turn") == "circuit defect 1, longest link 1"


def test_a_candidate_driven_both_ways_counts_once() -> None:
    sifting = CandidateLog[Design](problem())
    reasons = [sifting.insert_design(design()), sifting.insert_design(design())]
    sifting.count("" if "" in reasons else reasons[0])
    assert sifting.candidates == sifting.accepted == 1
    assert len(sifting.passed) == 2


@given(st.lists(designs, max_size=30), st.integers(1, 12), st.booleans(), st.sampled_from(sorted(SORT_KEYS)))
def test_designs_are_cut_and_those_that_failed_are_last(
    met: list[Design], most: int, include_failed: bool, rank_by: str
) -> None:
    sifting = CandidateLog[Design](problem(most, include_failed=include_failed))
    sifting.verify_candidates(met, lambda verdict: verdict)
    returned = sifting.select_designs(lambda listed: rank_designs(listed, rank_by))
    everything = rank_designs(met if include_failed else [d for d in met if d.verification.passed], rank_by)
    assert returned == everything[:most]
    passes = [one.verification.passed for one in returned]
    assert passes == sorted(passes, reverse=True)
    values = [SORT_KEYS[rank_by](one) for one in returned if one.verification.passed]
    assert values == sorted(values)


@given(st.lists(designs, max_size=20))
def test_ties_go_by_quality_and_residuals_of_rounding_are_alike(met: list[Design]) -> None:
    exact = [one._replace(targets=[SimpleNamespace(residual=1e-14 * n)]) for n, one in enumerate(met)]
    order = rank_designs(exact, "accuracy")
    for passed in (True, False):
        qualities = [one.metrics.quality for one in order if one.verification.passed == passed]
        assert qualities == sorted(qualities, reverse=True)


def test_a_kind_states_its_own_key_and_group() -> None:
    small, large, best = design(size=1.0), design(size=2.0), design(quality=0.9, size=3.0)
    assert rank_designs([large, small, best], "quality", {"quality": lambda one: one.metrics.size}) == [
        small,
        large,
        best,
    ]
    assert rank_designs([small, large, best], "size", group=lambda one: -one.metrics.quality) == [best, small, large]


def test_progress_runs_over_its_span() -> None:
    told: list[tuple[float, str]] = []
    drawn = report_candidates(
        ["a", "b"],
        lambda share, message: told.append((share, message)),
        (0.5, 1.0),
        "path-driving-linkages",
    )
    assert list(drawn) == ["a", "b"]
    assert told == [(0.5, "driving linkage 1 of 2"), (0.75, "driving linkage 2 of 2")]


def test_nothing_that_is_left_out_as_alike_takes_a_place() -> None:
    sifting = CandidateLog[Design](problem(2))
    first, same, second = design(quality=0.9), design(quality=0.9, size=2.0), design(quality=0.5)
    sifting.verify_candidates([first, same, second], lambda verdict: cast("Design | None", verdict))
    assert sifting.select_designs(
        lambda listed: rank_designs(listed, "quality"), lambda listed: [listed[0], listed[2]]
    ) == [
        first,
        second,
    ]


class Sized(NamedTuple):
    error: Fraction
    size: int


def test_an_error_exactly_at_the_tolerance_is_within_it():
    """0.1 is no float: the float of it is above the decimal, that of 0.3 below."""
    for decimal in ("0.1", "0.3"):
        assert is_within_tolerance(Fraction(decimal), float(decimal))
        assert not is_within_tolerance(Fraction(decimal) + Fraction(1, 10**30), float(decimal))
    assert is_within_tolerance(Fraction(5), None)


def test_the_pareto_set_has_what_is_nearer_than_all_smaller_ones():
    by_size = [Sized(Fraction(error, 100), size) for size, error in enumerate((7, 9, 7, 4, 5, 4, 0))]
    assert [one.size for one in select_pareto(by_size, lambda one: one.error)] == [0, 3, 6]
    assert [one.size for one in select_within_tolerance(by_size, 0.05, 2)] == [3, 4]


@given(st.lists(designs, max_size=12))
def test_the_front_is_what_no_other_sound_design_beats(found: list[Design]) -> None:
    front = pareto_front(found)
    sound = [n for n, one in enumerate(found) if one.verification.passed]
    if front is None:
        assert len(sound) < 2
        return

    def beats(one: Design, other: Design) -> bool:
        pairs = [
            (max(one.metrics.rms_residual, 1e-12), max(other.metrics.rms_residual, 1e-12)),
            (other.metrics.min_transmission_angle, one.metrics.min_transmission_angle),
            (one.metrics.size, other.metrics.size),
        ]
        return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)

    assert front.quantities == ["rms", "min_transmission_angle", "size"]
    assert front.designs == [n for n in sound if not any(beats(found[k], found[n]) for k in sound)]
    assert front.designs
