"""Scheduling by turns: the estimated cost of a queued job, and its turn among the jobs of all tenants."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

QUEUED_CONDITION = sa.text("status = 'queued'")

# When any process queues a job, idle worker hosts are notified.
NOTIFY_FUNCTION = """
CREATE FUNCTION tell_of_work() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM pg_notify('mechsynth_work', '');
    RETURN NULL;
END $$
"""
WORK_TRIGGER = """
CREATE TRIGGER jobs_tell_of_work AFTER INSERT OR UPDATE OF status ON jobs FOR EACH ROW
WHEN (NEW.status = 'queued') EXECUTE FUNCTION tell_of_work()
"""


def upgrade() -> None:
    op.add_column("jobs", sa.Column("cost", sa.String(5), nullable=False, server_default="long"))
    op.add_column("jobs", sa.Column("turn", sa.Integer, nullable=False, server_default="0"))
    for name, columns in (("turn", ["cost", "turn", "id"]), ("tenant", ["tenant", "cost", "turn"])):
        op.create_index(
            f"jobs_queued_by_{name}", "jobs", columns, sqlite_where=QUEUED_CONDITION, postgresql_where=QUEUED_CONDITION
        )
    if op.get_bind().dialect.name == "postgresql":
        op.execute(NOTIFY_FUNCTION)
        op.execute(WORK_TRIGGER)


def downgrade() -> None:
    if op.get_bind().dialect.name == "postgresql":
        op.execute("DROP TRIGGER jobs_tell_of_work ON jobs")
        op.execute("DROP FUNCTION tell_of_work")
    for name in ("tenant", "turn"):
        op.drop_index(f"jobs_queued_by_{name}", "jobs")
    for name in ("turn", "cost"):
        op.drop_column("jobs", name)
