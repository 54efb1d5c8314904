"""Indexes that give the last turn of a tenant: one of queued jobs, one of queued shares of batches."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None


def _create_index(name: str, condition: str, *columns: str) -> None:
    where = sa.text(condition)
    op.create_index(name, "jobs", columns, sqlite_where=where, postgresql_where=where)


def upgrade() -> None:
    op.drop_index("jobs_queued_by_tenant", "jobs")
    _create_index("jobs_queued_by_tenant", "status = 'queued' AND batch IS NULL", "tenant", "cost", "turn")
    _create_index("shares_queued_by_tenant", "status = 'queued' AND batch IS NOT NULL", "tenant", "cost", "turn")


def downgrade() -> None:
    for name in ("shares", "jobs"):
        op.drop_index(f"{name}_queued_by_tenant", "jobs")
    _create_index("jobs_queued_by_tenant", "status = 'queued'", "tenant", "cost", "batch", "turn")
