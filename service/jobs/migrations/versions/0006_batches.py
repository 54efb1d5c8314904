"""Batches, their samples, their shares in the job table, and the digests by which equal problems reuse answers."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

QUEUED_CONDITION = sa.text("status = 'queued'")


def _turns_of_tenants(*columns: str) -> None:
    op.drop_index("jobs_queued_by_tenant", "jobs")
    op.create_index(
        "jobs_queued_by_tenant", "jobs", columns, sqlite_where=QUEUED_CONDITION, postgresql_where=QUEUED_CONDITION
    )


def _of_those_given(table: str, *columns: str, name: str | None = None) -> None:
    name = name or columns[-1]
    given = sa.text(f"{name} IS NOT NULL")
    op.create_index(f"{table}_by_{name}", table, columns, sqlite_where=given, postgresql_where=given)


def upgrade() -> None:
    op.add_column("jobs", sa.Column("batch", sa.String(26)))
    op.add_column("jobs", sa.Column("digest", sa.String(64)))
    _turns_of_tenants("tenant", "cost", "batch", "turn")
    _of_those_given("jobs", "batch")
    _of_those_given("jobs", "tenant", "digest")
    op.create_table(
        "batches",
        sa.Column("id", sa.String(26), primary_key=True),
        sa.Column("tenant", sa.String(100), nullable=False),
        sa.Column("kind", sa.String(40), nullable=False),
        sa.Column("label", sa.String(200)),
        sa.Column("status", sa.String(10), nullable=False),
        *(sa.Column(f"{moment}_at", sa.String(27), nullable=moment != "created") for moment in MOMENTS),
        *(sa.Column(name, sa.Integer, nullable=False) for name in COUNTS),
        sa.Column("removed", sa.Boolean, nullable=False),
        *(sa.Column(name, sa.Text, nullable=False) for name in ("stated", "plan")),
        sa.Column("idempotency_key", sa.String(200)),
        sa.Column("request_hash", sa.String(64)),
    )
    op.create_index("batches_by_tenant", "batches", ["tenant", "id"])
    op.create_index("batches_by_idempotency_key", "batches", ["tenant", "idempotency_key"], unique=True)
    op.create_table(
        "samples",
        sa.Column("id", sa.String(26), nullable=False),
        sa.Column("batch", sa.String(26), primary_key=True),
        sa.Column("tenant", sa.String(100), nullable=False),
        sa.Column("number", sa.Integer, primary_key=True),
        sa.Column("status", sa.String(10), nullable=False),
        sa.Column("cached", sa.Boolean, nullable=False),
        *(sa.Column(f"{moment}_at", sa.String(27), nullable=False) for moment in MOMENTS[1:]),
        sa.Column("digest", sa.String(64)),
        sa.Column("same_as", sa.Integer),
        *(sa.Column(name, sa.Text) for name in ("figures", "error", "result")),
    )
    op.create_index("samples_by_id", "samples", ["id"], unique=True)
    _of_those_given("samples", "tenant", "digest", "batch", name="digest")


MOMENTS = ("created", "started", "finished")
COUNTS = ("total", "succeeded", "failed", "cached", "revision")


def downgrade() -> None:
    op.drop_table("samples")
    op.drop_table("batches")
    op.execute("DELETE FROM jobs WHERE batch IS NOT NULL")
    for name in ("digest", "batch"):
        op.drop_index(f"jobs_by_{name}", "jobs")
    _turns_of_tenants("tenant", "cost", "turn")
    for name in ("digest", "batch"):
        op.drop_column("jobs", name)
