"""Scheduling by turns: the estimated cost of a queued job, and its turn among the jobs of all tenants."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

QUEUED_CONDITION = sa.text("status = 'queued'")

# Earlier versions also made a trigger that notified worker hosts of queued jobs; see revision 0004.


def upgrade() -> None:
    op.add_column("jobs", sa.Column("cost", sa.String(5), nullable=False, server_default="long"))
    op.add_column("jobs", sa.Column("turn", sa.Integer, nullable=False, server_default="0"))
    for name, columns in (("turn", ["cost", "turn", "id"]), ("tenant", ["tenant", "cost", "turn"])):
        op.create_index(
            f"jobs_queued_by_{name}", "jobs", columns, sqlite_where=QUEUED_CONDITION, postgresql_where=QUEUED_CONDITION
        )


def downgrade() -> None:
    if op.get_bind().dialect.name == "postgresql":
        op.execute("DROP TRIGGER IF EXISTS jobs_tell_of_work ON jobs")
        op.execute("DROP FUNCTION IF EXISTS tell_of_work")
    for name in ("tenant", "turn"):
        op.drop_index(f"jobs_queued_by_{name}", "jobs")
    for name in ("turn", "cost"):
        op.drop_column("jobs", name)
