"""Reading of request bodies: accepted types, size limits, and JSON parsing."""

from __future__ import annotations

import json
from collections import Counter

from fastapi import Request, Response
from pydantic_core import from_json
from starlette.requests import ClientDisconnect

from kinematics.message import compose
from service.api.http.auth import GuardedRoute, Handler
from service.api.http.json_limits import locate_excess
from service.api.http.problem_details import Refusal, refuse_invalid_request, refuse_malformed_json
from service.error_messages import format_pointer

MAX_VALUES = 20_000
"""Maximum number of values (numbers, strings, lists, objects) in a body. The largest real problem has a few thousand;
validating a million tiny faults would take a second."""


MAX_DEPTH = 201
"""Maximum nesting of lists and objects, set by the parser."""


class BoundedRequest(Request):
    """A request whose body is read up to a size limit."""

    async def read_limited(self, limit: int) -> bytes:
        """Read the body, which must be uncompressed and have at most ``limit`` bytes.

        Raises
        ------
        Refusal
            413, 415 or 400, as documented for the endpoints that take a body.
        """
        if self.headers.get("content-encoding", "identity").strip().lower() != "identity":
            raise Refusal(
                415, "unsupported-media-type", "service-title-unsupported-media-type",
                compose("service-body-compressed"),
                headers={"Accept-Encoding": "identity"},
            )  # fmt: skip
        # The header is only a claim, but a body announced as too large need not be read at all. Longer numbers than 18
        # digits are not converted.
        announced = self.headers.get("content-length", "0")
        if announced.isdecimal() and (len(announced) > 18 or int(announced) > limit):
            raise _refuse_large_body(limit)
        body = bytearray()
        try:
            async for chunk in self.stream():
                body += chunk
                if len(body) > limit:
                    raise _refuse_large_body(limit)
        except ClientDisconnect:
            # The client is gone and cannot read this answer, which ends the request without logging a defect.
            raise Refusal(
                400, "incomplete-body", "service-title-incomplete-body", compose("service-body-incomplete")
            ) from None
        return bytes(body)

    @property
    def media_type(self) -> str:
        """Media type in the ``Content-Type`` header, without parameters; empty if there is none."""
        return self.headers.get("content-type", "").partition(";")[0].strip().lower()


def refuse_media_type(detail: str, *accepted: str) -> Refusal:
    """Build the refusal of a body of another type than the ``accepted`` ones."""
    return Refusal(
        415,
        "unsupported-media-type",
        "service-title-unsupported-media-type",
        detail,
        headers={"Accept": ", ".join(accepted)},
    )


class JsonRequest(BoundedRequest):
    """A request whose JSON body is checked and parsed by this module."""

    _checked: object

    async def read(self, limit: int) -> None:
        """Read and parse the body of at most ``limit`` bytes.

        Raises
        ------
        Refusal
            413, 415 or 400, as documented for the endpoints that take a body.
        """
        if self.media_type != "application/json":
            raise refuse_media_type(compose("service-body-not-json"), "application/json")
        self._body = await self.read_limited(limit)
        self._checked = _parse_body(self._body)

    async def json(self) -> object:
        """Return the parsed body; :meth:`read` must be called first."""
        return self._checked


class JsonRoute(GuardedRoute):
    """A route that checks the API key and then reads its body through :class:`JsonRequest`."""

    def build_inner_handler(self) -> Handler:
        """Return the framework's handler for a request whose body has been read and parsed."""
        handle = super().build_inner_handler()
        if self.body_field is None:
            return handle

        async def read_first(request: Request) -> Response:
            ours = JsonRequest(request.scope, request.receive)
            await ours.read(request.app.state.settings.max_body_bytes)
            return await handle(ours)

        return read_first


def _refuse_large_body(limit: int) -> Refusal:
    # The rest of the body stays unread, so the connection cannot serve another request.
    return Refusal(
        413, "body-too-large", "service-title-body-too-large", compose("service-body-too-large", count=limit),
        headers={"Connection": "close"},
    )  # fmt: skip


def _parse_body(body: bytes) -> object:
    if _has_more_values_than(body, MAX_VALUES):
        raise _refuse_many_values(body)
    # This parser limits depth and digits itself. It passes NaN and 1e999 on to the validation, which names the field.
    try:
        parsed = from_json(body)
    except ValueError as error:
        # The message is the parser's own, "expected `:` at line 1 column 8", without parts of the input.
        detail = compose("service-body-malformed", reason=str(error))
        raise refuse_malformed_json(detail, _find_depth_faults(body) if "recursion" in str(error) else ()) from None
    values, keys = _count_values(parsed)
    if values > MAX_VALUES:
        raise _refuse_many_values(body)
    if _count_keys(body) != keys:
        # The parser keeps the last of equal keys silently; only then is the slower search for them necessary.
        detail = compose("service-key-twice")
        twice = [(place, detail) for place in _find_duplicate_keys(body)]
        if twice:
            raise refuse_invalid_request(twice)
    return parsed


def _refuse_many_values(body: bytes) -> Refusal:
    where = locate_excess(body, MAX_VALUES, MAX_DEPTH)
    detail = compose("service-too-many-values-here", count=MAX_VALUES)
    return Refusal(
        422, "invalid-request", "service-title-invalid-request", compose("service-too-many-values", count=MAX_VALUES),
        errors=[(where, detail)],
    )  # fmt: skip


def _find_depth_faults(body: bytes) -> list[tuple[str, str]]:
    """Return the fault of an unparsable body that is nested too deeply, with its place; empty for any other fault."""
    where = locate_excess(body, len(body), MAX_DEPTH)
    return [(where, compose("service-nested-too-deeply", count=MAX_DEPTH))] if where else []


def _has_more_values_than(body: bytes, limit: int) -> bool:
    """Return whether the punctuation alone shows that a body has more than ``limit`` values.

    A comma separates two values, and each list or object is a value. This quick test precedes parsing: building and
    freeing half a million lists takes a third of a second, counting their brackets a millisecond. A body that passes
    has at most twice the limit.
    """
    if len(body) <= limit:
        return False
    body = _strip_strings(body)
    lists = min(body.count(b"["), body.count(b"]"))
    objects = min(body.count(b"{"), body.count(b"}"))
    return body.count(b",") > limit or lists + objects > limit + 1


def _strip_strings(body: bytes) -> bytes:
    """Return the text outside of strings; a quote after a backslash does not end its string."""
    return b"".join(body.replace(rb"\\", b"").replace(rb"\"", b"").split(b'"')[::2])


def _count_keys(body: bytes) -> int:
    """Count the keys of a valid body: each is followed by a colon outside of strings."""
    return _strip_strings(body).count(b":")


def _count_values(parsed: object) -> tuple[int, int]:
    """Count the values in objects and lists, and the keys; the parser has kept only the last of equal keys."""
    values = keys = 0
    pending: list[object] = [parsed]
    while pending:
        value = pending.pop()
        if isinstance(value, dict):
            keys += len(value)
            pending.extend(value.values())
        elif isinstance(value, list):
            values += len(value)
            pending.extend(value)
    return values + keys, keys


class _Members(list[tuple[str, object]]):
    """An object of the body with all its members, equal keys included."""


def _find_duplicate_keys(body: bytes) -> list[str]:
    """Return the places of keys that occur more than once, as JSON pointers."""
    # Numbers stay texts: they are not needed, and the standard library refuses some valid ones.
    written = json.loads(body, object_pairs_hook=_Members, parse_int=str, parse_float=str)
    found: list[str] = []
    pending: list[tuple[tuple[str | int, ...], object]] = [((), written)]
    while pending:
        place, value = pending.pop()
        if isinstance(value, _Members):
            counted = Counter(name for name, _ in value)
            found += [format_pointer((*place, name)) for name, times in counted.items() if times > 1]
            pending += [((*place, name), member) for name, member in value]
        elif isinstance(value, list):
            pending += [((*place, k), member) for k, member in enumerate(value)]
    return list(dict.fromkeys(found))
