"""Conversion of a batch request to its plan, or to the faults of the request with their places."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice

from kinematics.message import compose, join_messages
from service.api.http.problem_details import Refusal, refuse_invalid_problem, refuse_invalid_request
from service.api.routes.batch_schemas import MAX_SAMPLES, BatchRequest, Vary
from service.error_messages import MAX_FAULTS, format_pointer, is_unknown_field
from service.jobs.batches.plan import NoSuchPlace, Plan, split_pointer
from service.jobs.batches.sampling import Span, sample_evenly, sample_latin_hypercube
from service.jobs.batches.values import PickedValues, Values
from service.jobs.store.states import Cost
from service.requests import Faults, check_consistency, check_fields
from synthesis.model.linkage.answer import ERROR_FIELDS
from synthesis.registry import KINDS

MAX_EXAMINED = 100
"""Number of evenly spread samples that are checked; at least one of them must be a valid problem."""

MAX_TRIED_BYTES = 4_000_000
"""Maximum total size of the problems that are tried, bytes of JSON; about a second of work. For a problem of usual size
that covers all values of a plan. For a larger one evenly spread values are tried, at least :data:`MAX_EXAMINED`."""

CHECK_TIMEOUT_S = 1.0
"""Processor time after which no further values or samples are checked, seconds. The size alone does not bound the time,
because problems with very many faults take longer to check."""

MAX_TABLE_BYTES = 16 << 20
"""Maximum total size of the values of all samples, bytes of JSON, since the table repeats them in each row."""

RATIO_ERRORS = ("max_error", "relative_error", "error")
"""Error metrics of gears; the first one that a kind has is used."""

MAXIMIZED_METRICS = ("min_transmission_angle",)

SIZE_METRICS = ("size", "total_teeth", "tooth_sum")
"""Size metrics; the first one that a kind has is used."""


def build_plan(body: BatchRequest) -> tuple[str, Plan, Cost]:
    """Return the kind of the problems, the plan, and the estimated cost of a problem.

    A value that is invalid for its field is a fault of the batch. Contradictory values are a fault of their sample
    only, unless all of :data:`MAX_EXAMINED` checked samples are contradictory.

    Raises
    ------
    Refusal
        422, with the place of each fault.
    """
    kind = body.problem.get("kind")
    if not isinstance(kind, str) or kind not in KINDS:
        # The kind selects the model, so nothing else can be checked without it.
        detail = compose("service-kind-unknown", names=", ".join(KINDS))
        raise refuse_invalid_problem([("/problem/kind", detail)])
    # The plan is stored as JSON, which has no such numbers.
    faults = [*islice(_find_nonfinite_numbers(body), MAX_FAULTS)]
    if faults:
        raise refuse_invalid_request(faults)
    faults = [*_find_field_faults(body), *_find_sampling_faults(body), *_find_metric_faults(body, kind)]
    if faults:
        raise refuse_invalid_request(faults)
    plan = Plan(
        body.problem,
        [varied.field for varied in body.vary],
        _build_values(body),
        body.sampling == "grid",
        select_default_metrics(KINDS[kind].metrics) if body.metrics is None else body.metrics,
        body.reuse,
    )
    _require_places(plan)
    # Processor time of this thread: how busy the machine is must not decide which faults are found.
    until = time.thread_time() + CHECK_TIMEOUT_S
    faults = _find_problem_faults(kind, plan)
    if faults:
        raise refuse_invalid_problem(faults)
    faults = _find_value_faults(body, kind, plan, until)
    if faults:
        raise refuse_invalid_request(faults)
    return kind, plan, _estimate_cost(kind, plan, until)


def select_default_metrics(metrics: Sequence[str]) -> list[str]:
    """Select the default metrics of a front from those of a kind: an error, metrics to maximize, a size."""
    error = [name for name in (*ERROR_FIELDS, *RATIO_ERRORS) if name in metrics][:1]
    size = [name for name in SIZE_METRICS if name in metrics][:1]
    return [*error, *(name for name in MAXIMIZED_METRICS if name in metrics), *size]


def _find_nonfinite_numbers(body: BatchRequest) -> Iterator[tuple[str, str]]:
    """Yield the faults of infinite numbers and NaN anywhere in the problem and the values."""
    pending: list[tuple[tuple[str | int, ...], object]] = [
        (("vary", k, "values"), varied.values) for k, varied in reversed([*enumerate(body.vary)])
    ]
    pending.append((("problem",), body.problem))
    while pending:
        place, value = pending.pop()
        if isinstance(value, float) and not math.isfinite(value):
            yield format_pointer(place), compose("service-number-not-finite")
        elif isinstance(value, dict | list):
            # Reversed, because a stack returns the last entry first: faults come in the order of the request.
            inside = value.items() if isinstance(value, dict) else enumerate(value)
            pending += [((*place, step), member) for step, member in reversed([*inside])]


def _find_problem_faults(kind: str, plan: Plan) -> list[tuple[str, str]]:
    """Return the faults of the problem that do not depend on the varied fields, found in the first and last samples."""
    # Two samples suffice: a fault outside the varied fields that both samples have is attributed to the problem.
    found: Faults = []
    for number in (0, plan.total - 1):
        before = found
        _, faults = check_fields(kind, plan.build_statement(number))
        found = [(path, detail) for path, detail in faults if _is_independent(path, plan.fields)]
        if not found:
            return []
    agreed = set(before)
    return [(f"/problem{path}", detail) for path, detail in found if (path, detail) in agreed]


def _is_independent(path: str, fields: Sequence[str]) -> bool:
    """Return whether a fault at this place is independent of the varied fields.

    It may depend on them if it lies in a varied field, on the path to one, or in an object with a varied field, which
    may decide on the other fields of the object.
    """
    for field in fields:
        object_, _, _ = field.rpartition("/")
        if f"{path}/".startswith(f"{object_ or field}/") or field.startswith(f"{path}/"):
            return False
    return True


def _find_field_faults(body: BatchRequest) -> Iterator[tuple[str, str]]:
    ways = [split_pointer(varied.field) for varied in body.vary]
    for k, way in enumerate(ways):
        if way == ["kind"]:
            yield f"/vary/{k}/field", compose("service-batch-kind-varied")
        for other in ways[:k]:
            # If one field lies inside the other, the result would depend on the order in which they are set.
            if way[: len(other)] == other or other[: len(way)] == way:
                yield f"/vary/{k}/field", compose("service-field-varied-twice")


def _find_sampling_faults(body: BatchRequest) -> Iterator[tuple[str, str]]:
    drawn = body.sampling == "latin_hypercube"
    if drawn and body.samples is None:
        yield "/samples", compose("service-hypercube-needs-samples")
    if not drawn and body.samples is not None:
        yield "/samples", compose("service-sampling-without-samples", sampling=body.sampling)
    if not drawn and body.seed != 0:
        yield "/seed", compose("service-sampling-without-seed", sampling=body.sampling)
    counts = []
    for k, varied in enumerate(body.vary):
        if drawn and varied.count is not None:
            yield f"/vary/{k}/count", compose("service-hypercube-without-count")
        if not drawn and varied.values is None and varied.count is None:
            yield f"/vary/{k}", compose("service-count-missing")
        counts.append(len(varied.values) if varied.values is not None else varied.count or 1)
    if body.sampling == "zip":
        for k, count in enumerate(counts):
            if count != counts[0]:
                yield (
                    f"/vary/{k}",
                    compose("service-zip-counts-differ", count=counts[0]),
                )
    total = math.prod(counts) if body.sampling == "grid" else body.samples or counts[0]
    if total > MAX_SAMPLES:
        yield "/vary", compose("service-batch-too-large", count=total, most=MAX_SAMPLES)
    elif total * sum(map(_measure_value_bytes, body.vary)) > MAX_TABLE_BYTES:
        yield (
            "/vary",
            compose("service-batch-values-too-long", count=total, size=MAX_TABLE_BYTES >> 20),
        )


def _measure_value_bytes(varied: Vary) -> float:
    return 8.0 if varied.values is None else len(json.dumps(varied.values)) / len(varied.values)


def _find_metric_faults(body: BatchRequest, kind: str) -> Iterator[tuple[str, str]]:
    known = KINDS[kind].metrics
    for k, name in enumerate(body.metrics or ()):
        if name not in known:
            yield f"/metrics/{k}", compose("service-metric-unknown", metrics=", ".join(known))
        elif name in (body.metrics or ())[:k]:
            yield f"/metrics/{k}", compose("service-metric-twice")


def _build_values(body: BatchRequest) -> list[Values]:
    if body.sampling == "latin_hypercube":
        assert body.samples is not None
        given = [v.values if v.values is not None else Span(v.from_ or 0, v.to or 0) for v in body.vary]
        return [*sample_latin_hypercube(given, body.samples, body.seed)]
    return [
        v.values if v.values is not None else sample_evenly(v.from_ or 0, v.to or 0, v.count or 1) for v in body.vary
    ]  # fmt: skip


def _require_places(plan: Plan) -> None:
    try:
        plan.build_statement(0)
    except NoSuchPlace:
        pass
    else:
        return
    for k, (field, value) in enumerate(zip(plan.fields, plan.sample(0), strict=True)):
        alone = Plan(plan.problem, [field], [[value]], True, [], True)
        try:
            alone.build_statement(0)
        except NoSuchPlace as nowhere:
            raise refuse_invalid_request([(f"/vary/{k}/field", str(nowhere))]) from None


def _find_value_faults(body: BatchRequest, kind: str, plan: Plan, until: float) -> list[tuple[str, str]]:
    """Return the faults of single values: each value is tried once, within the time limit."""
    found: dict[tuple[str, str], None] = {}
    most = max(MAX_EXAMINED, MAX_TRIED_BYTES // len(json.dumps(plan.build_statement(0))))
    every = sum(map(len, plan.values)) if plan.grid else plan.total
    step = -(-every // most)
    for places, values in islice(_iterate_trials(plan), 0, None, step):
        if time.thread_time() > until:
            break
        _, faults = check_fields(kind, plan.fill_statement(values))
        for path, detail in faults:
            if len(found) > MAX_FAULTS:
                break
            for k, field in enumerate(plan.fields):
                if k in places and (path == field or path.startswith(f"{field}/")):
                    given = body.vary[k].values is not None
                    unknown = is_unknown_field(detail)
                    inside = f"/values/{places[k]}{path[len(field) :]}" if given else ""
                    place = "/field" if unknown and path == field else inside
                    # Values computed from a range have no place in the request, so the message names the value.
                    shown = "" if given or unknown else compose("service-value-is", value=str(values[k]))
                    found[f"/vary/{k}{place}", join_messages([detail, shown])] = None
        if len(found) > MAX_FAULTS:
            break
    return list(found)


def _iterate_trials(plan: Plan) -> Iterable[tuple[dict[int, int], list[object]]]:
    """Yield samples that together contain every value of every field.

    Each sample is given by the indices of the values that it is meant to test, by field, and by all its values.
    """
    if not plan.grid:
        for number in range(plan.total):
            yield {k: _get_place(values, number) for k, values in enumerate(plan.values)}, plan.sample(number)
        return
    first = plan.sample(0)
    for k, values in enumerate(plan.values):
        for place, value in enumerate(values):
            yield {k: place}, [*first[:k], value, *first[k + 1 :]]


def _get_place(values: Values, number: int) -> int:
    """Return the index of a sample's value among the values given for the field."""
    return values.places[number] if isinstance(values, PickedValues) else number


def _estimate_cost(kind: str, plan: Plan, until: float) -> Cost:
    """Estimate the cost of a problem: the maximum over the samples checked within the time limit, at least one."""
    refused: Faults | None = None
    brief: list[bool] = []
    for number in _sample_numbers(plan.total, MAX_EXAMINED):
        if time.thread_time() > until and (brief or refused):
            break
        problem, faults = check_fields(kind, plan.build_statement(number))
        faults = faults or check_consistency(problem)
        if faults:
            refused = refused or faults
        else:
            brief.append(KINDS[kind].brief(problem))
    if not brief and refused is not None:
        raise _refuse_all_samples(plan, refused)
    return Cost.SHORT if all(brief) else Cost.LONG


def _sample_numbers(total: int, most: int) -> Iterator[int]:
    """Yield at most ``most`` evenly spread numbers below ``total``, such that every prefix is evenly spread, too."""
    count = min(total, most)
    # A step near the golden section of the count spreads every prefix evenly. If it is coprime to the count, the order
    # contains each number once.
    step = next(step for step in range(max(1, round(count * 0.618)), count + 1) if math.gcd(step, count) == 1)
    for n in range(count):
        yield n * step % count * total // count


def _refuse_all_samples(plan: Plan, faults: Faults) -> Refusal:
    placed = [(_locate_fault(plan, path), detail) for path, detail in faults]
    return (
        refuse_invalid_problem if all(path.startswith("/problem") for path, _ in placed) else refuse_invalid_request
    )(placed)


def _locate_fault(plan: Plan, path: str) -> str:
    """Return the place of a fault of all samples: a varied field below the faulty object, otherwise the problem."""
    on_the_way = (k for k, field in enumerate(plan.fields) if path and field.startswith(f"{path}/"))
    k = next(on_the_way, None)
    return f"/problem{path}" if k is None else f"/vary/{k}/field"
