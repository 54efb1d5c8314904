"""Messages of the texts in an answer, with which the answer can be written in another language."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from kinematics.message import SOURCE_LANGUAGE, find_message, from_json, to_json, translate
from synthesis.model.json_object import JsonObject

SEPARATOR = " "
"""A composed text has at least two words. A shorter one may be a name that the client has chosen."""


class TextMessage(BaseModel):
    """The message of a text in an answer: an id that stays the same if the text is reworded, and the values in it."""

    model_config = ConfigDict(title="Text message", extra="forbid", frozen=True)

    path: str = Field(description="JSON pointer to the text in this object.", examples=["/summary"])
    id: str = Field(description="Id of the message.", examples=["planetary_train-none-within-tolerance"])
    values: JsonObject = Field(
        description="Values in the text by name: texts, counts, or messages with an `id` and `values` of their own."
    )


def list_messages(answer: object) -> list[TextMessage]:
    """Return the messages of all composed texts in a model or in JSON-like data."""
    found = []
    for path, text in _walk_texts(answer, ""):
        message = find_message(text) if SEPARATOR in text else None
        if message is not None:
            found.append(TextMessage(path=path, **to_json(message)))
    return found


def translate_answer(answer: JsonObject, language: str) -> None:
    """Write the texts of an answer in another language, in place; ``messages`` of the answer has their messages."""
    if language == SOURCE_LANGUAGE:
        return
    for entry in answer.get("messages", ()):
        *steps, last = (step.replace("~1", "/").replace("~0", "~") for step in entry["path"].split("/")[1:])
        parent: Any = answer
        for step in steps:
            parent = parent[int(step) if isinstance(parent, list) else step]
        parent[int(last) if isinstance(parent, list) else last] = translate(from_json(entry), language)


def _walk_texts(value: object, path: str) -> Iterator[tuple[str, str]]:
    """Yield the JSON pointers and the texts below a value."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, BaseModel):
        for name, field in type(value).model_fields.items():
            shown = field.serialization_alias or field.alias or name
            yield from _walk_texts(getattr(value, name), f"{path}/{_escape(shown)}")
    elif isinstance(value, Mapping):
        for name, item in value.items():
            yield from _walk_texts(item, f"{path}/{_escape(str(name))}")
    # Most lists are long tables of numbers.
    elif isinstance(value, list | tuple) and value and not isinstance(value[0], float):
        for k, item in enumerate(value):
            yield from _walk_texts(item, f"{path}/{k}")


def _escape(name: str) -> str:
    """Return a name as a step of a JSON pointer."""
    return name.replace("~", "~0").replace("/", "~1")
