"""API keys and their tenants.

A *tenant* owns jobs and sees only its own. A *key* is a secret that identifies a tenant, who may have several keys. A
key is shown once, when it is created, and the store keeps only its hash. A key has 256 random bits and cannot be
guessed, so a plain SHA-256 is sufficient protection; slow password hashes are for secrets chosen by people.

A revoked key stays in the store, so a service that has ever had a key does not become open again by revoking it.
"""

from __future__ import annotations

import hashlib
import secrets
from dataclasses import dataclass, fields

from sqlalchemy import Column, Engine, Index, String, Table, insert, inspect, select, update
from ulid import ULID

from service.jobs.store.schema import MAX_TENANT_LENGTH, format_now, metadata

KEY_PREFIX = "mechsynth_"
"""First characters of every key, by which a leaked key can be recognized."""

api_keys = Table(
    "api_keys",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("tenant", String(MAX_TENANT_LENGTH), nullable=False),
    Column("hash", String(64), nullable=False),
    Column("created_at", String(27), nullable=False),
    Column("revoked_at", String(27)),
    Index("api_keys_by_hash", "hash", unique=True),
)


class TenantExists(Exception):
    """A tenant with this name already exists."""


@dataclass(frozen=True, slots=True)
class Key:
    """A stored key, without the secret."""

    id: str
    tenant: str
    created_at: str
    revoked_at: str | None


_KEY_COLUMNS = [api_keys.c[field.name] for field in fields(Key)]


def hash_key(key: str) -> str:
    """Return the hash of a key that the store keeps."""
    return hashlib.sha256(key.encode("utf-8", "surrogateescape")).hexdigest()


class KeyStore:
    """Reads and changes the keys. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def create(self, tenant: str, *, further: bool = False) -> tuple[Key, str]:
        """Create a key for a new tenant, or with ``further`` another key for an existing tenant.

        Returns
        -------
        tuple
            The key as stored, and the secret, which cannot be retrieved later.

        Raises
        ------
        TenantExists
            If the tenant has, or has had, a key and ``further`` is false.
        """
        secret = KEY_PREFIX + secrets.token_urlsafe(32)
        key = Key(id=str(ULID()), tenant=tenant, created_at=format_now(), revoked_at=None)
        with self._engine.begin() as connection:
            known = connection.execute(select(api_keys.c.id).where(api_keys.c.tenant == tenant).limit(1)).first()
            if known is not None and not further:
                raise TenantExists(tenant)
            row = {field.name: getattr(key, field.name) for field in fields(Key)}
            connection.execute(insert(api_keys).values(**row, hash=hash_key(secret)))
        return key, secret

    def list_keys(self) -> list[Key]:
        """Return all keys, revoked ones included, oldest first."""
        with self._engine.connect() as connection:
            return [Key(*row) for row in connection.execute(select(*_KEY_COLUMNS).order_by(api_keys.c.id))]

    def revoke(self, key_id: str) -> bool:
        """Revoke a key; return False if no valid key has this id."""
        change = update(api_keys).where(api_keys.c.id == key_id, api_keys.c.revoked_at.is_(None))
        with self._engine.begin() as connection:
            return bool(connection.execute(change.values(revoked_at=format_now())).rowcount)

    def load_holders(self) -> dict[str, Key] | None:
        """Return the valid keys by their hashes; None if no key has ever been created."""
        with self._engine.connect() as connection:
            rows = connection.execute(select(api_keys.c.hash, *_KEY_COLUMNS)).all()
        if not rows:
            return None
        return {row[0]: key for row in rows if (key := Key(*row[1:])).revoked_at is None}

    def has_keys(self) -> bool:
        """Return whether a key has ever been created; False for a store without tables."""
        if not inspect(self._engine).has_table(api_keys.name):
            return False
        with self._engine.connect() as connection:
            return connection.execute(select(api_keys.c.id).limit(1)).first() is not None
