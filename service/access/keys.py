"""The API keys: who holds which, made, listed and revoked.

Words: a *tenant* owns jobs and sees only its own; a *key* is a secret that stands for a tenant, who may hold several. A
key is shown once, when it is made; the store has its hash. It is 256 random bits, which nobody can guess, so a plain
SHA-256 is enough to keep it secret; the slow hashes for passwords are for secrets that people have thought of.

A revoked key stays in the store. So a service that has ever had a key never becomes open again by revoking.
"""

from __future__ import annotations

import hashlib
import secrets
from dataclasses import dataclass, fields

from sqlalchemy import Column, Engine, Index, String, Table, insert, inspect, select, update
from ulid import ULID

from service.jobs.store.schema import MAX_TENANT_LENGTH, format_now, metadata

KEY_PREFIX = "mechsynth_"
"""What every key begins with, so that one that has got somewhere by mistake is recognized."""

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
    """A new tenant was to be made, and there is one of this name."""


@dataclass(frozen=True, slots=True)
class Key:
    """A key as it is known to the store: never the key itself."""

    id: str
    tenant: str
    created_at: str
    revoked_at: str | None


_KEY_COLUMNS = [api_keys.c[field.name] for field in fields(Key)]


def hash_key(key: str) -> str:
    """What the store keeps of a key."""
    return hashlib.sha256(key.encode("utf-8", "surrogateescape")).hexdigest()


class KeyStore:
    """Reads and changes the keys. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def create(self, tenant: str, *, further: bool = False) -> tuple[Key, str]:
        """Make a key for a new tenant, or a further one for a tenant that there is.

        Returns
        -------
        tuple
            The key as stored, and the secret, which can be had now and never again.

        Raises
        ------
        TenantExists
            When the tenant has, or has had, a key, and ``further`` is false.
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
        """All keys, oldest first, revoked ones too."""
        with self._engine.connect() as connection:
            return [Key(*row) for row in connection.execute(select(*_KEY_COLUMNS).order_by(api_keys.c.id))]

    def revoke(self, key_id: str) -> bool:
        """Make a key useless; False when there is none of this id that was of use."""
        change = update(api_keys).where(api_keys.c.id == key_id, api_keys.c.revoked_at.is_(None))
        with self._engine.begin() as connection:
            return bool(connection.execute(change.values(revoked_at=format_now())).rowcount)

    def load_holders(self) -> dict[str, Key] | None:
        """The keys in force by their hashes; None when no key has ever been made."""
        with self._engine.connect() as connection:
            rows = connection.execute(select(api_keys.c.hash, *_KEY_COLUMNS)).all()
        if not rows:
            return None
        return {row[0]: key for row in rows if (key := Key(*row[1:])).revoked_at is None}

    def has_keys(self) -> bool:
        """Whether a key has ever been made; also of a store that has no tables yet."""
        if not inspect(self._engine).has_table(api_keys.name):
            return False
        with self._engine.connect() as connection:
            return connection.execute(select(api_keys.c.id).limit(1)).first() is not None
