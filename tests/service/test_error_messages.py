"""Every fault that pydantic finds in a request is described by a message, which other languages can be written from."""

from typing import get_args

import pytest
from pydantic import BaseModel, ValidationError
from pydantic_core.core_schema import ErrorType

from kinematics.message import find_message, translate
from service.answers.analysis import analyse
from service.api.http.schemas import JobRequest
from service.api.routes.batch_schemas import BatchRequest
from service.api.routes.jobs import JobFilter
from service.error_messages import LIMITS_PAGE, describe_faults
from service.refusals import Refusal, refuse_invalid_body
from service.simulation.query import SimulationQuery
from synthesis.analyses import list_families
from synthesis.mechanisms.cam import GivenBarrelFollower
from synthesis.model.linkage.given_linkage import SkeletonSpec
from synthesis.registry import KINDS, get_first_example
from tests.support.service.variations import variations

MOTION = get_first_example("motion")
CAM = get_first_example("cam")
BATCH = {"problem": MOTION, "vary": [{"field": "/seed", "values": [1, 2]}]}
EXAMPLE = '{"kind": "motion", "positions": [{"x": 0, "y": 0, "angle": 0}]}'
ROD = {"name": "a", "joints": ["A"]}
PYDANTIC_TYPES = {*get_args(ErrorType)} - {"value_error", "assertion_error"}


def find_faults(model: type[BaseModel], body: object) -> list[tuple[str, str]]:
    """The faults of a body: pydantic's type and our description."""
    with pytest.raises(ValidationError) as refused:
        model.model_validate(body)
    described = refuse_invalid_body(refused.value, body, model).errors
    types = [fault["type"] for fault in refused.value.errors()]
    return [(type_, detail) for type_, (_, detail) in zip(types, described, strict=True)]


def build_job(**changes: object) -> dict[str, object]:
    return {"problem": {**MOTION, **changes}}


def limit_angle(angle: object) -> dict[str, object]:
    return build_job(constraints={"min_transmission_angle": angle})


@pytest.mark.parametrize(
    ("model", "body", "type_", "detail", "german"),
    [
        (JobRequest, {}, "missing", f"This field is required, for example {EXAMPLE}.",
         f"Dieses Feld ist erforderlich, etwa {EXAMPLE}."),
        (JobRequest, {"problem": MOTION, "q": 1}, "extra_forbidden",
         "Unknown field; the fields are `problem` and `label`.",
         "Unbekanntes Feld; die Felder sind `problem` und `label`."),
        (JobRequest, {"problem": {"kind": "q"}}, "unknown_kind",
         f"Unknown; the permitted names are: {', '.join(KINDS)}.", f"Unbekannt; möglich sind: {', '.join(KINDS)}."),
        (JobRequest, {"problem": {}}, "unknown_kind",
         f"This field is required; it must be one of: {', '.join(KINDS)}.",
         f"Dieses Feld ist erforderlich; möglich sind: {', '.join(KINDS)}."),
        (JobRequest, {"problem": {"kind": "moton"}}, "unknown_kind",
         f"Unknown; did you mean motion, parallel_motion? The permitted names are: {', '.join(KINDS)}.",
         f"Unbekannt; ist motion, parallel_motion gemeint? Möglich sind: {', '.join(KINDS)}."),
        (JobRequest, {"problem": {"kind": "compliant_gripper"}}, "unknown_kind",
         f"The service does not support this; see {LIMITS_PAGE}. The permitted names are: "
         f"{', '.join(KINDS)}.",
         f"Das leistet der Dienst nicht; siehe {LIMITS_PAGE}. Möglich sind: {', '.join(KINDS)}."),
        (JobRequest, {"problem": 3}, "unknown_kind", "Expected an object.", "Erwartet wird ein Objekt."),
        (JobRequest, build_job(positions=3), "list_type",
         'Expected a list, for example [{"x": 0, "y": 0, "angle": 0}].',
         'Erwartet wird eine Liste, etwa [{"x": 0, "y": 0, "angle": 0}].'),
        (JobRequest, build_job(ground_line={"point": 3, "angle": 0.0}), "tuple_type",
         "Expected a list, for example [0, 0].", "Erwartet wird eine Liste, etwa [0, 0]."),
        (JobRequest, build_job(layout=3), "model_type",
         'Expected an object, for example {"link_width": 0, "pin_diameter": 0, "thickness": 0}.',
         'Erwartet wird ein Objekt, etwa {"link_width": 0, "pin_diameter": 0, "thickness": 0}.'),
        (JobRequest, {"problem": {**CAM, "segments": [3]}}, "model_attributes_type",
         'Expected an object, for example {"motion": "dwell", "angle": 0}.',
         'Erwartet wird ein Objekt, etwa {"motion": "dwell", "angle": 0}.'),
        (BatchRequest, {**BATCH, "problem": 3}, "dict_type", 'Expected an object, for example {"name": 0}.',
         'Erwartet wird ein Objekt, etwa {"name": 0}.'),
        (JobRequest, {"problem": MOTION, "label": 3}, "string_type", "Expected a string.",
         "Erwartet wird ein Text."),
        (JobRequest, build_job(seed=1.5), "int_type", "Expected an integer.",
         "Erwartet wird eine ganze Zahl."),
        (JobFilter, {"limit": "x"}, "int_parsing", "Expected an integer.",
         "Erwartet wird eine ganze Zahl."),
        (JobFilter, {"limit": "9" * 5000}, "int_parsing_size", "Expected an integer.",
         "Erwartet wird eine ganze Zahl."),
        (JobRequest, limit_angle("x"), "float_type", "Expected a number.", "Erwartet wird eine Zahl."),
        (SimulationQuery, {"width": "x"}, "float_parsing", "Expected a number.",
         "Erwartet wird eine Zahl."),
        (BatchRequest, {**BATCH, "vary": [{"field": "/seed", "from": float("nan"), "to": 1}]}, "finite_number",
         "Expected a finite number.", "Erwartet wird eine endliche Zahl."),
        (JobRequest, build_job(include_failed=1), "bool_type", "Expected true or false.",
         "Erwartet wird true oder false."),
        (JobRequest, build_job(layout={"link_width": 0, "pin_diameter": 1, "thickness": 1}), "greater_than",
         "The value must be greater than 0.", "Der Wert muss größer als 0 sein."),
        (JobRequest, limit_angle(-1), "greater_than_equal", "The value must be at least 0.",
         "Der Wert muss mindestens 0 sein."),
        (JobRequest, limit_angle(90.0), "less_than", "The value must be less than 90.",
         "Der Wert muss kleiner als 90 sein."),
        (JobRequest, build_job(constraints={"max_link_ratio": 1e10}), "less_than_equal",
         "The value must be at most 1000000000.", "Der Wert darf höchstens 1000000000 sein."),
        (JobRequest, build_job(length_unit="km"), "literal_error",
         "Did you mean 'm'? Expected 'mm', 'cm', 'm' or 'in'.",
         "Ist 'm' gemeint? Erwartet wird 'mm', 'cm', 'm' oder 'in'."),
        (GivenBarrelFollower, {"type": "q", "roller_radius": 1.0}, "literal_error", "Expected 'barrel_roller'.",
         "Erwartet wird 'barrel_roller'."),
        (SkeletonSpec, {"joints": {"A": [0, 0]}, "links": [ROD, ROD], "input_link": "a"}, "too_short",
         "The object must have at least 2 members, not 1.", "Das Objekt muss mindestens 2 Einträge haben, nicht 1."),
        (BatchRequest, {**BATCH, "vary": [{"field": "", "values": [1]}]}, "string_too_short",
         "The string must have at least 2 characters.", "Der Text muss mindestens 2 Zeichen haben."),
        (JobRequest, {"problem": MOTION, "label": "x" * 201}, "string_too_long",
         "The string must have at most 200 characters.", "Der Text darf höchstens 200 Zeichen haben."),
        (BatchRequest, {**BATCH, "vary": [{"field": "seed", "values": [1]}]}, "string_pattern_mismatch",
         "The string must match the pattern '^(/([^~/]|~[01])*)+$'.",
         "Der Text muss dem Muster '^(/([^~/]|~[01])*)+$' entsprechen."),
        (BatchRequest, {**BATCH, "vary": []}, "too_short", "The list must have at least 1 item, not 0.",
         "Die Liste muss mindestens 1 Eintrag haben, nicht 0."),
        (BatchRequest, {**BATCH, "metrics": ["size"] * 51}, "too_long", "The list must have at most 50 items, not 51.",
         "Die Liste darf höchstens 50 Einträge haben, nicht 51."),
        (JobRequest, build_job(ground_line={"point": [1.0, 2.0, 3.0], "angle": 0.0}), "too_long",
         "The list must have at most 2 items, not 3.", "Die Liste darf höchstens 2 Einträge haben, nicht 3."),
        (JobRequest, build_job(dynamics={"speed_rpm": 1.0, "bodies": {str(n): {"mass": 0.0} for n in range(21)}}),
         "too_long", "The object must have at most 20 members.", "Das Objekt darf höchstens 20 Einträge haben."),
        (JobRequest, {"problem": {**CAM, "segments": [{}]}}, "union_tag_not_found", "The field 'motion' is required.",
         "Das Feld 'motion' ist erforderlich."),
        (JobRequest, {"problem": {**CAM, "segments": [{"motion": "hop"}]}}, "union_tag_invalid",
         "The field 'motion' must be one of: 'dwell', 'rise', 'fall', 'return', 'constant_velocity', 'polynomial'.",
         "Das Feld 'motion' muss eines von diesen nennen: 'dwell', 'rise', 'fall', 'return', 'constant_velocity', "
         "'polynomial'."),
        (JobRequest, {"problem": {**get_first_example("dwell"), "output": {"type": "q"}}}, "unknown_output",
         "The field `type` must be one of: rocker, slider.",
         "Das Feld type muss eines von diesen nennen: rocker, slider."),
        (JobRequest, build_job(dynamics={}), "value_error",
         "Give speed_rpm, or speed for a sliding input; 0 means statics.",
         "Speed_rpm angeben, oder speed für einen gleitenden Antrieb; 0 bedeutet Statik."),
    ],
)  # fmt: skip
def test_a_fault_has_a_message(model, body, type_, detail, german):
    assert (type_, detail, german) in [
        (found, text, translate(find_message(text), "de")) for found, text in find_faults(model, body)
    ]


STATEMENTS = {
    **{kind: (KINDS[kind].problem, get_first_example(kind)) for kind in KINDS},
    **{family.request.__name__: (family.request, family.request.get_example()) for family in list_families()},
}


@pytest.mark.parametrize("name", STATEMENTS)
def test_no_text_of_pydantic_remains(name):
    model, statement = STATEMENTS[name]
    for body in variations(statement):
        try:
            model.model_validate(body)
        except ValidationError as error:
            for fault in error.errors(include_url=False):
                located = {**fault, "loc": ("body", *fault["loc"])}
                ((_, detail),) = describe_faults([located], body, {"body": model})
                assert fault["type"] not in PYDANTIC_TYPES or find_message(detail) is not None, fault


@pytest.mark.parametrize(
    ("mechanisms", "path", "detail"),
    [
        (["forbar"], "/problem/mechanisms/0", "Did you mean 'fourbar'? Expected 'fourbar', 'slider_crank', "),
        (["forbar", "slider_crank"], "/problem/mechanisms/0", "Did you mean 'fourbar'? "),
        (["xyz"], "/problem/mechanisms/0", "Expected 'fourbar', 'slider_crank', "),
        ("fourbar", "/problem/mechanisms", "Expected 'auto', or a list, for example [\"fourbar\"]."),
        ("atuo", "/problem/mechanisms", "Did you mean 'auto'? Expected 'auto', or a list, for example [\"fourbar\"]."),
    ],
)
@pytest.mark.parametrize("kind", ["motion", "path", "function"])
def test_a_misspelt_type_is_reported_once(kind, mechanisms, path, detail):
    """Whatever groups the types form, their names are listed together, with the nearest."""
    ((found, text),) = refuse({"problem": {**get_first_example(kind), "mechanisms": mechanisms}}).errors
    assert found == path
    assert text.startswith(detail)


def test_a_body_without_its_wrapper_says_where_to_put_it():
    refusal = refuse(MOTION)
    assert refusal.errors == [
        ("/problem", 'The request needs the field `problem` around this object: {"problem": {"kind": "...", ...}}.')
    ]
    with pytest.raises(Refusal) as refused:
        analyse({"type": "fourbar", "links": {}})
    assert refused.value.errors == [
        (
            "/mechanism",
            'The request needs the field `mechanism` around this object: {"mechanism": {"type": "...", ...}}.',
        )
    ]


def test_an_unknown_type_of_mechanism_is_the_only_fault():
    with pytest.raises(Refusal) as refused:
        analyse({"mechanism": {"type": "planetary", "links": {}}})
    ((path, detail),) = refused.value.errors
    assert path == "/mechanism/type"
    assert detail.startswith("Unknown; did you mean planetary_train")
    assert all(f" {family}" in detail for family in ("fourbar", "cam", "gear_pair", "rotor"))


def test_the_detail_is_the_first_fault_in_words():
    assert refuse(build_job(seed="x")).detail == "/problem/seed: Expected an integer."
    two = refuse(build_job(seed="x", max_designs="x"))
    assert two.detail == "/problem/max_designs: Expected an integer. 1 other field is invalid."
    assert translate(find_message(two.detail), "de") == (
        "/problem/max_designs: Erwartet wird eine ganze Zahl. 1 weiteres Feld ist ungültig."
    )


def refuse(body: object) -> Refusal:
    with pytest.raises(ValidationError) as refused:
        JobRequest.model_validate(body)
    return refuse_invalid_body(refused.value, body, JobRequest)
