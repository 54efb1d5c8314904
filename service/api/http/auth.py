"""Authentication: every operation under ``/v1`` checks the API key first, before it reads a body."""

from __future__ import annotations

from collections.abc import Callable, Collection, Coroutine
from ipaddress import ip_address
from typing import Annotated, Any
from urllib.parse import urlsplit

import structlog
from fastapi import Depends, Request, Response
from fastapi.routing import APIRoute
from pydantic import BaseModel

from kinematics.message import compose
from service.access.gate import ANYBODY, Gate, NoKey, TooOften
from service.api.http.problem_details import Refusal
from service.observability import telemetry
from service.refusals import refuse_faults

SECURITY_SCHEME = "bearer"
"""The name of the security scheme in the OpenAPI document."""

Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class GuardedRoute(APIRoute):
    """A route that requires an API key if the service has keys."""

    def get_route_handler(self) -> Handler:
        """Return the handler, preceded by the check of the key."""
        handle = self.build_inner_handler()
        parameters = self.dependant.query_params
        # A query that is a model refuses unknown parameters itself.
        has_model = any(_is_model(each.field_info.annotation) for each in parameters)
        known = None if has_model else {each.alias for each in parameters}

        async def handle_after_admission(request: Request) -> Response:
            # Before the body is read, so that strangers cannot make the service parse one.
            request.state.tenant = await _check_admission(request)
            if known is not None:
                _require_known_parameters(request, known)
            return await handle(request)

        return handle_after_admission

    def build_inner_handler(self) -> Handler:
        """Return the framework's handler, which subclasses may wrap."""
        return super().get_route_handler()


def _is_model(annotation: object) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _require_known_parameters(request: Request, known: Collection[str]) -> None:
    """Refuse a query parameter that the operation does not have: it is probably misspelt."""
    faults = [
        {"type": "extra_forbidden", "loc": ("query", name), "input": value, "msg": ""}
        for name, value in request.query_params.items()
        if name not in known
    ]
    if faults:
        raise refuse_faults(faults, {}, {})


async def _check_admission(request: Request) -> str:
    gate = request.app.state.gate
    assert isinstance(gate, Gate)
    try:
        tenant, allowance = await gate.admit(_read_key(request))
    except NoKey as refusal:
        # The challenge names an error only if a key was sent (RFC 6750, section 3).
        raise Refusal(
            401, "unauthorized", "service-title-unauthorized",
            compose("service-key-invalid" if refusal.given else "service-key-missing"),
            headers={"WWW-Authenticate": 'Bearer error="invalid_token"' if refusal.given else "Bearer"},
        ) from None  # fmt: skip
    except TooOften as refusal:
        allowance = refusal.allowance
        telemetry.add_headers(allowance.format_headers())
        raise Refusal(
            429, "rate-limited", "service-title-rate-limited",
            compose("service-rate-limit-reached", requests=allowance.limit, seconds=allowance.window_s),
            headers={"Retry-After": str(allowance.reset_s)},
        ) from None  # fmt: skip
    if tenant == ANYBODY and not _is_for_this_machine(request):
        raise Refusal(
            403, "foreign-host", "service-title-foreign-host",
            compose("service-host-foreign"),
        )  # fmt: skip
    if allowance is not None:
        telemetry.add_headers(allowance.format_headers())
        structlog.contextvars.bind_contextvars(tenant=tenant)
    return tenant


UNREGISTRABLE_DOMAINS = ("localhost", "local", "internal", "test", "example", "invalid")
"""Top-level domains in which no names can be registered (RFC 2606, 6761, 6762)."""


def _is_for_this_machine(request: Request) -> bool:
    """Return whether the host name of the request can only mean this machine.

    A foreign web page may resolve its own host to 127.0.0.1, and the browser would then treat this service as part of
    that page (DNS rebinding). Only the host name reveals it: such a name is registered. Addresses, names without a dot
    and names that cannot be registered are safe. Clients that send no name are not browsers.
    """
    given = request.headers.get("host", "localhost")
    try:
        name = urlsplit(f"//{given}").hostname or ""
        if not name.strip("."):
            return False
        # A final dot marks a name as complete and does not change it.
        *registered, last = name.rstrip(".").split(".")
        return not registered or last in UNREGISTRABLE_DOMAINS or _is_address(name)
    except ValueError:
        return False


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def _read_key(request: Request) -> str | None:
    scheme, _, key = request.headers.get("authorization", "").partition(" ")
    # Names of schemes are case-insensitive (RFC 9110, section 11.1).
    return key.strip() if scheme.lower() == "bearer" else None


async def _get_tenant(request: Request) -> str:
    tenant = request.state.tenant
    assert isinstance(tenant, str)
    return tenant


Tenant = Annotated[str, Depends(_get_tenant)]
