"""``mechsynth keys``: create, list and revoke API keys."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy.exc import SQLAlchemyError

from service.access.keys import KeyStore, TenantExists
from service.jobs.store.database import LaterTables, connect, upgrade
from service.jobs.store.schema import MAX_TENANT_LENGTH
from service.settings import Settings

_TENANT_PATTERN = re.compile(f"[A-Za-z0-9._@-]{{1,{MAX_TENANT_LENGTH}}}")


class KeysFailure(Exception):
    """The command failed; the message is for the operator."""


def create(settings: Settings, tenant: str, *, further: bool) -> None:
    """Create a key and print it, alone on stdout."""
    if not _TENANT_PATTERN.fullmatch(tenant):
        raise KeysFailure(f"a tenant is named by up to {MAX_TENANT_LENGTH} letters, digits and ._@-")
    with _store(settings) as store:
        try:
            key, secret = store.create(tenant, further=further)
        except TenantExists:
            raise KeysFailure(f"the tenant {tenant} exists; --further creates another key for it") from None
    print(secret)
    print(f"key {key.id} of {tenant}; it is shown only now", file=sys.stderr)


def show(settings: Settings) -> None:
    """Print all keys: id, state, time of creation, tenant."""
    with _store(settings) as store:
        for key in store.list_keys():
            state = "in force" if key.revoked_at is None else f"revoked {key.revoked_at[:19]}Z"
            print(f"{key.id}  {state:<28}  made {key.created_at[:19]}Z  {key.tenant}")


def revoke(settings: Settings, key_id: str) -> None:
    """Revoke a key."""
    with _store(settings) as store:
        if not store.revoke(key_id):
            raise KeysFailure("no valid key has this id; `mechsynth keys list` shows the ids")
    print(f"key {key_id} is revoked", file=sys.stderr)


@contextmanager
def _store(settings: Settings) -> Iterator[KeyStore]:
    try:
        engine = connect(settings.store_url, durable=True)
        try:
            upgrade(engine)
            yield KeyStore(engine)
        finally:
            engine.dispose()
    except LaterTables as error:
        raise KeysFailure(str(error)) from None
    except (SQLAlchemyError, ImportError, OSError) as error:
        # The message omits the URL, which may contain a password.
        raise KeysFailure(f"cannot use the database ({type(error).__name__}); set MECHSYNTH_DATABASE_URL") from None
