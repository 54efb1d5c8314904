"""Leases of running jobs, the time of the next check of unfinished ones, and the worker hosts."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

UNFINISHED_STATES = ("queued", "running")

# Earlier versions also made a trigger that notified all listeners of each new state of a job. The processes do this
# themselves since. Where the trigger exists it stays until no process relies on it: the next revision may drop it.


def upgrade() -> None:
    op.add_column("jobs", sa.Column("claim", sa.String(26)))
    op.add_column("jobs", sa.Column("queued_at", sa.Float, nullable=False, server_default="0"))
    op.add_column("jobs", sa.Column("due_at", sa.Float, nullable=False, server_default="0"))
    op.create_table(
        "hosts",
        sa.Column("id", sa.String(26), primary_key=True),
        sa.Column("workers", sa.Integer, nullable=False),
        sa.Column("seen_at", sa.Float, nullable=False),
    )
    if op.get_bind().dialect.name == "postgresql":
        op.create_index(
            "jobs_by_due_at", "jobs", ["due_at"], postgresql_where=sa.column("status").in_(UNFINISHED_STATES)
        )


def downgrade() -> None:
    if op.get_bind().dialect.name == "postgresql":
        op.execute("DROP TRIGGER IF EXISTS jobs_tell ON jobs")
        op.execute("DROP FUNCTION IF EXISTS tell_of_job")
        op.drop_index("jobs_by_due_at", "jobs")
    op.drop_table("hosts")
    for name in ("due_at", "queued_at", "claim"):
        op.drop_column("jobs", name)
