"""Messages for users: an id and values, with the text of each language in catalogues.

A package that writes messages has the catalogues ``messages.en.ftl`` and ``messages.de.ftl`` in the Fluent format
(https://projectfluent.org). The ids of its messages begin with the name of its folder. :func:`compose` writes the text
of a message:

    compose("path-too-few-points", given=3, least=5)

The result is a plain string, which can be stored in any field. This module remembers the id and the values of the texts
that it has composed last, so :func:`find_message` finds the message of a text that has passed through code which knows
strings only, such as validators and exceptions. Messages are values: they can be sent to other processes, stored, and
written in another language by :func:`translate`. A request is answered in the language of :func:`use_language`; what is
stored is composed in English.
"""

from __future__ import annotations

import os
import re
from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from fluent.runtime import FluentBundle
    from fluent.runtime.types import FluentInt

SOURCE_LANGUAGE = "en"
"""Language of the composed texts, which every other language falls back to."""

LANGUAGES = (SOURCE_LANGUAGE, "de")
"""Languages with complete catalogues."""

JOINED = "joined"
"""Id of a list of messages with a separator between them. It has no text of its own."""

SENTENCE = "sentence"
"""Id of a message written as a sentence, with a capital and a full stop. It has no text of its own."""

MAX_REMEMBERED = 20_000
"""Number of composed texts whose messages are remembered: more than an answer and its checks contain."""

MIN_GROUPED = 10_000
"""Smallest integer whose digits are grouped in threes."""

THIN_SPACE = "\u202f"
"""Narrow no-break space between groups of digits (ISO 80000-1, 7.3.1). It prevents a line break, and no language uses
it as a decimal sign."""

_PACKAGES = ("kinematics", "synthesis", "service")
_NUMBER = re.compile(r"[-−±]?\d+\.\d+(e[-−+]?\d+)?")


@dataclass(frozen=True)
class Message:
    """A message: its id, and its values by the names that the catalogues use."""

    id: str
    values: Mapping[str, Value]


Value: TypeAlias = "str | int | Message | tuple[str | Message, ...]"
"""Value in a message: a text, a count, another message, or the parts of a list."""


class UnknownMessage(LookupError):
    """Raised for an id that no catalogue has, or without a value that the text needs: a defect of the calling code."""


_remembered: OrderedDict[str, Message] = OrderedDict()
_language: ContextVar[str] = ContextVar("language", default=SOURCE_LANGUAGE)


@contextmanager
def use_language(language: str) -> Iterator[None]:
    """Compose messages in a language, one of :data:`LANGUAGES`, within the context: this task or thread only."""
    token = _language.set(language)
    try:
        yield
    finally:
        _language.reset(token)


def get_language() -> str:
    """Return the language in which messages are composed here."""
    return _language.get()


def compose(message_id: str, /, **values: str | int) -> str:
    """Return the text of a message in the language of this context, and remember the message.

    Parameters
    ----------
    message_id : str
        Id in the catalogue of the package that its first word names.
    **values : str or int
        Values for the text. Integers are counts: they select singular or plural and are written with grouped digits;
        any other number is passed as the text to be shown. A composed text is translated with the message it is in.
    """
    return remember(Message(message_id, {name: _as_value(message_id, value) for name, value in values.items()}))


def join_messages(parts: Iterable[str], separator: str = " ") -> str:
    """Join texts, some of which may be composed, and remember them as one message. Empty texts are left out."""
    kept = [part for part in parts if part]
    if len(kept) < 2:
        return "".join(kept)
    return remember(
        Message(JOINED, {"separator": separator, "parts": tuple(_remembered.get(part, part) for part in kept)})
    )


def make_sentence(text: str) -> str:
    """Write a text as a sentence, with a capital and a full stop, and remember it as one message.

    >>> make_sentence("equal to position 0")
    'Equal to position 0.'
    """
    known = _remembered.get(text)
    return _write_sentence(text) if known is None else remember(Message(SENTENCE, {"text": known}))


def remember(message: Message) -> str:
    """Return the text of a message, for which :func:`find_message` returns the message from now on."""
    text = translate(message, get_language())
    remember_text(text, message)
    return text


def remember_text(text: str, message: Message) -> None:
    """Remember the message of a text that another process has composed, in whatever language."""
    _remembered[text] = message
    _remembered.move_to_end(text)
    while len(_remembered) > MAX_REMEMBERED:
        _remembered.popitem(last=False)


def find_message(text: str) -> Message | None:
    """Return the message whose text was composed in this process, or None for any other text."""
    return _remembered.get(text)


def translate(message: Message, language: str) -> str:
    """Write a message in a language, one of :data:`LANGUAGES`.

    Raises
    ------
    UnknownMessage
        If no catalogue has the message, or it lacks a value.
    """
    if message.id == JOINED:
        parts = message.values["parts"]
        assert isinstance(parts, tuple)
        return str(message.values["separator"]).join(str(_write_value(part, language)) for part in parts)
    if message.id == SENTENCE:
        return _write_sentence(str(_write_value(message.values["text"], language)))
    bundle = _load_bundle(message.id.partition("-")[0], language)
    pattern = bundle.get_message(message.id).value if bundle.has_message(message.id) else None
    if pattern is None:
        raise UnknownMessage(f"no catalogue has the message {message.id!r} in the language {language!r}")
    text, errors = bundle.format_pattern(
        pattern, {name: _write_value(value, language) for name, value in message.values.items()}
    )
    if errors:
        raise UnknownMessage(f"{message.id}: {errors[0]}")
    # Catalogues break long lines, which Fluent keeps.
    return str(text).replace("\n", " ")


def format_integer(number: int) -> str:
    """Format an integer for a sentence.

    >>> format_integer(9216), format_integer(-14002477).replace(THIN_SPACE, " ")
    ('9216', '−14 002 477')
    """
    digits = f"{number:,}".replace(",", THIN_SPACE) if abs(number) >= MIN_GROUPED else str(number)
    # Use a true minus sign, as in printed tables.
    return digits.replace("-", "−")


def to_json(message: Message) -> dict[str, object]:
    """Return a message as JSON: an object with ``id`` and ``values``; a message among the values has the same form."""
    return {"id": message.id, "values": {name: _dump_value(value) for name, value in message.values.items()}}


def from_json(stored: Mapping[str, object]) -> Message:
    """Return the message that :func:`to_json` has written."""
    values = stored["values"]
    assert isinstance(values, Mapping)
    return Message(str(stored["id"]), {str(name): _load_value(value) for name, value in values.items()})


@cache
def find_catalogues() -> Mapping[str, Path]:
    """Return the folders with catalogues of the product, by their names, with which the ids of messages begin.

    Raises
    ------
    ValueError
        If two folders have the same name.
    """
    found: dict[str, Path] = {}
    for package in _PACKAGES:
        spec = find_spec(package)
        assert spec is not None
        assert spec.origin is not None
        for folder, _, files in os.walk(Path(spec.origin).parent):
            if f"messages.{SOURCE_LANGUAGE}.ftl" in files:
                path = Path(folder)
                if path.name in found:
                    raise ValueError(f"two folders with messages are named {path.name}: {found[path.name]}, {path}")
                found[path.name] = path
    return found


@cache
def _load_bundle(package: str, language: str) -> FluentBundle:
    # Imported when the first message is written: the import takes a tenth of a second, and most processes start without
    # writing one.
    from fluent.runtime import FluentBundle, FluentResource

    folder = find_catalogues().get(package)
    bundle = FluentBundle([language], use_isolating=False)
    if folder is not None:
        bundle.add_resource(FluentResource((folder / f"messages.{language}.ftl").read_text("utf-8")))
    return bundle


def _as_value(message_id: str, value: str | int) -> Value:
    if isinstance(value, int):
        return int(value)
    known = _remembered.get(value)
    # The text of a message may be one of its own values. Without this check it would contain itself, once more with
    # every call.
    return value if known is None or known.id == message_id else known


def _write_value(value: Value, language: str) -> str | int:
    if isinstance(value, Message):
        return translate(value, language)
    if isinstance(value, int):
        return _write_count(value)
    assert isinstance(value, str)
    # In a text that is a number the decimal sign is the only thing to translate.
    return value.replace(".", ",") if language == "de" and _NUMBER.fullmatch(value) else value


def _write_count(count: int) -> str | FluentInt:
    """Return a count in a form that selects the plural and is written as :func:`format_integer` does."""
    from fluent.runtime.types import FluentInt

    # The library groups digits as its locales do. A text selects the default, which is the plural of any large number.
    return FluentInt(count, useGrouping=False) if 0 <= count < MIN_GROUPED else format_integer(count)


def _write_sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:].rstrip('.')}."


def _dump_value(value: Value) -> object:
    if isinstance(value, Message):
        return to_json(value)
    return [_dump_value(part) for part in value] if isinstance(value, tuple) else value


def _load_value(value: object) -> Value:
    if isinstance(value, Mapping):
        return from_json(value)
    if isinstance(value, list):
        parts = [_load_value(part) for part in value]
        return tuple(part for part in parts if isinstance(part, str | Message))
    assert isinstance(value, str | int)
    return value
