"""Idempotency key and hash of the request for each job."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("jobs", sa.Column("idempotency_key", sa.String(200)))
    op.add_column("jobs", sa.Column("request_hash", sa.String(64)))
    # The unique index decides between equal requests that arrive at the same time. NULL keys are not equal to each
    # other, so any number of jobs may have no key.
    op.create_index("jobs_by_idempotency_key", "jobs", ["idempotency_key"], unique=True)


def downgrade() -> None:
    op.drop_index("jobs_by_idempotency_key", "jobs")
    op.drop_column("jobs", "request_hash")
    op.drop_column("jobs", "idempotency_key")
