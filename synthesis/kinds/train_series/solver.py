"""The best series of trains for a ratio: all trains of every unit, the search over their products, verification."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from kinematics.message import compose, join_messages
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.solver import SEARCH_NOTE
from synthesis.kinds.gear_train.statement.train import DEFAULT_TOLERANCE
from synthesis.kinds.train_series.catalogue import Catalogue, build_catalogue
from synthesis.kinds.train_series.design import (
    ParetoSeries,
    TrainSeriesDesign,
    TrainSeriesMechanism,
    TrainSeriesResult,
    TrainSeriesSearch,
)
from synthesis.kinds.train_series.problem import TrainSeriesProblem
from synthesis.kinds.train_series.search import SearchResult, Series, SeriesSearch
from synthesis.kinds.train_series.units import build_unit_problem
from synthesis.kinds.train_series.verification import verify
from synthesis.model.gears.answer import Ratio
from synthesis.model.gears.ratio_target import format_ratio
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog

MAX_EXTRA_SERIES = 1000
"""Number of series tried beyond the requested ones if some cannot be made."""


def solve_train_series(problem: TrainSeriesProblem, progress: Progress) -> TrainSeriesResult:
    """Find the best series of trains for a ratio, each verified.

    Parameters
    ----------
    problem : TrainSeriesProblem
        A problem without contradictions.
    progress : callable
        Receives the unit whose trains are being listed.

    Returns
    -------
    TrainSeriesResult
        Complete unless a unit's teeth are fitted to distances that are searched in steps, or no idler was found.
    """
    # Equal units share one catalogue.
    listed: dict[int, Catalogue] = {}
    for k, first in enumerate(problem.first_equal_units):
        progress(0.5 * k / len(problem.units), compose("train_series-listing-teeth", unit=k + 1))
        if first not in listed:
            listed[first] = build_catalogue(problem.units[first], problem.length_unit)
    catalogues = [listed[first] for first in problem.first_equal_units]
    search = SeriesSearch(catalogues, problem.first_equal_units, problem.target, problem.sign)
    progress(0.5, compose("train_series-searching", series=f"{search.combinations:.3g}"))
    tolerance = problem.exact_tolerance
    near = DEFAULT_TOLERANCE if tolerance is None else tolerance
    sifting = CandidateLog[TrainSeriesDesign](problem, undriven="gears")
    wanted, met = problem.max_designs, set[tuple[int, ...]]()

    def list_untried(best: list[Series]) -> Iterator[tuple[tuple[int, ...], Series]]:
        for series in best:
            for rows in search.list_rows(series):
                if len(met) >= MAX_EXTRA_SERIES + problem.max_designs:
                    return
                if rows not in met:
                    met.add(rows)
                    yield rows, series

    def verify_series(chosen: tuple[tuple[int, ...], Series]) -> TrainSeriesDesign | str | None:
        mechanism = _build_mechanism(catalogues, *chosen)
        return "idler" if mechanism is None else verify(problem, mechanism)

    while True:
        found = search.find_best(tolerance, near, wanted, problem.rank_by == "size")
        progress(0.9, compose("train_series-verifying"))
        sifting.verify_candidates(list_untried(found.best), verify_series, problem.max_designs)
        # Series that cannot be made leave places for others behind them.
        enough = len(sifting.passed) >= problem.max_designs
        if enough or len(found.best) < wanted or len(met) >= MAX_EXTRA_SERIES:
            break
        wanted *= 4
    progress(1.0, compose("train_series-verified"))
    searched = _is_searched_in_steps(problem)
    least = None if found.nearest is None else abs(problem.target.compute_relative_error(abs(found.nearest.ratio)))
    return TrainSeriesResult(
        designs=sifting.select_designs(list),
        search=TrainSeriesSearch(
            **dict(sifting.build_search("exhaustive", complete=not sifting.rejected and not searched)),
            combinations=search.combinations,
            ties=found.ties,
            least_error=least,
        ),
        summary=join_messages(
            [
                _write_summary(problem, search, found, catalogues, sifting.passed),
                compose(SEARCH_NOTE) if searched else "",
            ]
        ),
        pareto=[entry for one in found.front if (entry := _build_pareto(problem, search, catalogues, one)) is not None],
    )


def _is_searched_in_steps(problem: TrainSeriesProblem) -> bool:
    """Return whether the feasible distances of a unit's gears are searched in steps, so that nothing is proven."""
    units = (build_unit_problem(unit, Fraction(1), problem.length_unit) for unit in problem.units)
    return any(isinstance(unit, GearTrainProblem) and unit.searches_distances for unit in units)


def _build_mechanism(catalogues: list[Catalogue], rows: tuple[int, ...], one: Series) -> TrainSeriesMechanism | None:
    built = [catalogue.build_train(row) for catalogue, row in zip(catalogues, rows, strict=True)]
    units = [unit for unit in built if unit is not None]
    if len(units) < len(built):
        return None
    return TrainSeriesMechanism(units=units, ratio=Ratio.from_fraction(one.ratio))


def _build_pareto(
    problem: TrainSeriesProblem, search: SeriesSearch, catalogues: list[Catalogue], one: Series
) -> ParetoSeries | None:
    """Build a series of the Pareto set from the first of its trains that can be made."""
    for rows in search.list_rows(one):
        mechanism = _build_mechanism(catalogues, rows, one)
        design = None if mechanism is None else verify(problem, mechanism)
        if design is not None and design.verification.passed:
            return ParetoSeries(
                total_teeth=one.total,
                error=design.metrics.error,
                ratio=design.mechanism.ratio,
                units=design.mechanism.units,
            )
    return None


def _write_summary(
    problem: TrainSeriesProblem,
    search: SeriesSearch,
    found: SearchResult,
    catalogues: list[Catalogue],
    accepted: list[TrainSeriesDesign],
) -> str:
    """Write one or two sentences: the result, or the reason why there is none."""
    searched = compose("train_series-searched", count=search.combinations)
    if accepted:
        if found.ties > 1:
            searched = join_messages([searched, compose("train_series-ties", count=found.ties)], "; ")
        return _describe_best(problem, accepted[0], searched)
    for k, catalogue in enumerate(catalogues, 1):
        if not len(catalogue.value):
            return compose("train_series-unit-without-trains", unit=k)
    if found.nearest is None:
        none = "train_series-none-turns-same" if problem.sign > 0 else "train_series-none-turns-opposite"
        return compose(none, searched=searched)
    if found.best:
        return compose("train_series-none-verified", searched=searched)
    error = abs(problem.target.compute_relative_error(abs(found.nearest.ratio)))
    return compose(
        "train_series-nearest-too-far",
        ratio=f"{float(found.nearest.ratio):.6g}",
        error=f"{100.0 * error:.4g}",
        searched=searched,
    )


def _describe_best(problem: TrainSeriesProblem, best: TrainSeriesDesign, searched: str) -> str:
    """Describe the best series in a sentence: the product of the ratios of its units, and its error."""
    factors = [_write_minus(f"{unit.ratio.value:.6g}") for unit in best.mechanism.units]
    product, ratio = join_messages(factors, " × "), _write_minus(format_ratio(problem.ratio))
    if best.metrics.error == 0.0:
        return compose("train_series-best-exact", product=product, ratio=ratio, searched=searched)
    return compose(
        "train_series-best-nearest",
        product=product,
        reached=_write_minus(f"{best.mechanism.ratio.value:.8g}"),
        ratio=ratio,
        error=_write_minus(f"{100.0 * best.metrics.error:.4g}"),
        searched=searched,
    )


def _write_minus(number: str) -> str:
    return number.replace("-", "−")
