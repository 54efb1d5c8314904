"""Reading request bodies: which are taken, how large they may be, and how their JSON is parsed."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

from fastapi import Request, Response
from pydantic_core import from_json
from starlette.requests import ClientDisconnect

from service.api.http.auth import GuardedRoute, Handler
from service.api.http.json_limits import locate_excess
from service.api.http.problem_details import Refusal, invalid_request, malformed_json
from service.error_messages import pointer

MAX_VALUES = 20_000
"""Most values (numbers, strings, lists, objects) in a body. The largest honest problem has a few thousand; a body of a
million tiny faults would keep the validation busy for a second."""


MAX_DEPTH = 201
"""Lists and objects within one another that the parser takes."""


class BoundedRequest(Request):
    """A request whose body is read up to a limit."""

    async def limited(self, limit: int) -> bytes:
        """The body, ``limit`` bytes at most, and not compressed.

        Raises
        ------
        Refusal
            413, 415 or 400, as documented for the endpoints that take a body.
        """
        if self.headers.get("content-encoding", "identity").strip().lower() != "identity":
            raise Refusal(
                415, "unsupported-media-type", "Unsupported media type", "The body must not be compressed.",
                headers={"Accept-Encoding": "identity"},
            )  # fmt: skip
        # The header is only a promise, but a body that announces itself as too large need not be read at all.
        announced = self.headers.get("content-length", "0")
        if announced.isdecimal() and (len(announced) > 18 or int(announced) > limit):
            raise _too_large(limit)
        body = bytearray()
        try:
            async for chunk in self.stream():
                body += chunk
                if len(body) > limit:
                    raise _too_large(limit)
        except ClientDisconnect:
            # Nobody reads the answer; it ends the request without the log of a defect.
            raise Refusal(400, "incomplete-body", "Incomplete body", "The connection ended before the body.") from None
        return bytes(body)

    @property
    def media_type(self) -> str:
        """The type that the body is announced as, without its parameters; empty where it is not."""
        return self.headers.get("content-type", "").partition(";")[0].strip().lower()


def foreign(detail: str, *accepted: str) -> Refusal:
    """The body is of a type that is not taken; these are."""
    return Refusal(
        415, "unsupported-media-type", "Unsupported media type", detail, headers={"Accept": ", ".join(accepted)}
    )


class JsonRequest(BoundedRequest):
    """A request whose body is checked and parsed by the rules of this module."""

    _checked: Any

    async def read(self, limit: int) -> None:
        """Read and parse the body, at most ``limit`` bytes.

        Raises
        ------
        Refusal
            413, 415 or 400, as documented for the endpoints that take a body.
        """
        if self.media_type != "application/json":
            raise foreign("The body must be application/json.", "application/json")
        self._body = await self.limited(limit)
        self._checked = _parsed(self._body)

    async def json(self) -> Any:
        """The parsed body; :meth:`read` comes first."""
        return self._checked


class JsonRoute(GuardedRoute):
    """A route that lets in by API key and then reads its body through :class:`JsonRequest`."""

    def handler_inside(self) -> Handler:
        """The framework's handler, on a request that is read and parsed already."""
        handle = super().handler_inside()
        if self.body_field is None:
            return handle

        async def read_first(request: Request) -> Response:
            ours = JsonRequest(request.scope, request.receive)
            await ours.read(request.app.state.settings.max_body_bytes)
            return await handle(ours)

        return read_first


def _too_large(limit: int) -> Refusal:
    # The rest of the body stays unread, so the connection cannot serve another request.
    return Refusal(
        413, "body-too-large", "Body too large", f"The body may have {limit} bytes at most.",
        headers={"Connection": "close"},
    )  # fmt: skip


def _parsed(body: bytes) -> Any:
    if _surely_has_more_values_than(body, MAX_VALUES):
        raise _too_many(body)
    # This parser bounds depth and digits by itself, and passes NaN and 1e999 on to the validation, which knows the
    # field that they are in.
    try:
        parsed = from_json(body)
    except ValueError as error:
        # The message is the parser's own, "expected `:` at line 1 column 8"; it holds nothing of the input.
        detail = f"The body is not valid JSON: {error}."
        raise malformed_json(detail, _faults_of_depth(body) if "recursion" in str(error) else ()) from None
    values, keys = _counts(parsed)
    if values > MAX_VALUES:
        raise _too_many(body)
    if _keys_written(body) != keys:
        twice = [(place, "This key is given twice; give it once.") for place in _given_twice(body)]
        if twice:
            raise invalid_request(twice)
    return parsed


def _too_many(body: bytes) -> Refusal:
    where = locate_excess(body, MAX_VALUES, MAX_DEPTH)
    detail = f"Here the body comes to hold more than {MAX_VALUES} values; it may have {MAX_VALUES} at most."
    return Refusal(
        422, "invalid-request", "Invalid request", f"The body holds more than {MAX_VALUES} values.",
        errors=[(where, detail)],
    )  # fmt: skip


def _faults_of_depth(body: bytes) -> list[tuple[str, str]]:
    """Where a body that cannot be parsed is nested too deep; nothing where that is not what is wrong."""
    where = locate_excess(body, len(body), MAX_DEPTH)
    return [(where, f"This is nested more than {MAX_DEPTH} deep.")] if where else []


def _surely_has_more_values_than(body: bytes, limit: int) -> bool:
    """Whether the punctuation alone says so: a comma stands between two values, and each list or object is one.

    Half a million lists take a third of a second to make and to collect again; counting their brackets takes a
    millisecond. What passes has at most twice the limit.
    """
    if len(body) <= limit:
        return False
    body = _punctuation(body)
    lists = min(body.count(b"["), body.count(b"]"))
    objects = min(body.count(b"{"), body.count(b"}"))
    return body.count(b",") > limit or lists + objects > limit + 1


def _punctuation(body: bytes) -> bytes:
    """What is outside of strings: behind a backslash a quote does not end its string."""
    return b"".join(body.replace(rb"\\", b"").replace(rb"\"", b"").split(b'"')[::2])


def _keys_written(body: bytes) -> int:
    """How many keys a valid body has: a colon outside of strings stands behind each."""
    return _punctuation(body).count(b":")


def _counts(parsed: Any) -> tuple[int, int]:
    """How many values objects and lists hold, and how many keys; of those given twice the parser keeps the last."""
    values = keys = 0
    pending = [parsed]
    while pending:
        value = pending.pop()
        if isinstance(value, dict):
            keys += len(value)
            pending.extend(value.values())
        elif isinstance(value, list):
            values += len(value)
            pending.extend(value)
    return values + keys, keys


class _Members(list[tuple[str, Any]]):
    """An object of the body as it is written."""


def _given_twice(body: bytes) -> list[str]:
    """The places of keys that are given more than once, as JSON pointers."""
    # Numbers are not looked at, and the standard library refuses some that are valid.
    written = json.loads(body, object_pairs_hook=_Members, parse_int=str, parse_float=str)
    found: list[str] = []
    pending: list[tuple[tuple[str | int, ...], Any]] = [((), written)]
    while pending:
        place, value = pending.pop()
        if isinstance(value, _Members):
            counted = Counter(name for name, _ in value)
            found += [pointer((*place, name)) for name, times in counted.items() if times > 1]
            pending += [((*place, name), member) for name, member in value]
        elif isinstance(value, list):
            pending += [((*place, k), member) for k, member in enumerate(value)]
    return list(dict.fromkeys(found))
