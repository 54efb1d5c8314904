"""Leases of running jobs, the time of the next check of unfinished ones, the worker hosts, and notifications."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

UNFINISHED_STATES = ("queued", "running")

# When any process stores a new state of a job, all listeners are notified of the job's id.
NOTIFY_FUNCTION = """
CREATE FUNCTION tell_of_job() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM pg_notify('mechsynth_jobs', NEW.id);
    RETURN NULL;
END $$
"""
MOVES_TRIGGER = """
CREATE TRIGGER jobs_tell AFTER UPDATE OF status ON jobs FOR EACH ROW
WHEN (OLD.status IS DISTINCT FROM NEW.status) EXECUTE FUNCTION tell_of_job()
"""


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
        op.execute(NOTIFY_FUNCTION)
        op.execute(MOVES_TRIGGER)


def downgrade() -> None:
    if op.get_bind().dialect.name == "postgresql":
        op.execute("DROP TRIGGER jobs_tell ON jobs")
        op.execute("DROP FUNCTION tell_of_job")
        op.drop_index("jobs_by_due_at", "jobs")
    op.drop_table("hosts")
    for name in ("due_at", "queued_at", "claim"):
        op.drop_column("jobs", name)
