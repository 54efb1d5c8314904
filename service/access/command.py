"""``mechsynth keys``: make, list and revoke API keys."""

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
    """The command could not be carried out; the message is a sentence for the operator."""


def create(settings: Settings, tenant: str, *, further: bool) -> None:
    """Make a key and print it, alone on stdout."""
    if not _TENANT_PATTERN.fullmatch(tenant):
        raise KeysFailure(f"a tenant is named by up to {MAX_TENANT_LENGTH} letters, digits and ._@-")
    with _store(settings) as store:
        try:
            key, secret = store.create(tenant, further=further)
        except TenantExists:
            raise KeysFailure(f"the tenant {tenant} exists; --further makes it one more key") from None
    print(secret)
    print(f"key {key.id} of {tenant}; it is shown this once", file=sys.stderr)


def show(settings: Settings) -> None:
    """Print the keys: id, state, when it was made, tenant."""
    with _store(settings) as store:
        for key in store.list_keys():
            state = "in force" if key.revoked_at is None else f"revoked {key.revoked_at[:19]}Z"
            print(f"{key.id}  {state:<28}  made {key.created_at[:19]}Z  {key.tenant}")


def revoke(settings: Settings, key_id: str) -> None:
    """Make a key useless."""
    with _store(settings) as store:
        if not store.revoke(key_id):
            raise KeysFailure("no key with this id is in force; `mechsynth keys list` shows the ids")
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
        # Not the URL itself, which may hold a password.
        raise KeysFailure(f"cannot use the database ({type(error).__name__}); set MECHSYNTH_DATABASE_URL") from None
