"""Jobs remember the key that they were posted under, and what was posted."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("jobs", sa.Column("idempotency_key", sa.String(200)))
    op.add_column("jobs", sa.Column("request_hash", sa.String(64)))
    # Decides between equal posts that arrive at once. Jobs without a key do not count as equal to each other.
    op.create_index("jobs_by_idempotency_key", "jobs", ["idempotency_key"], unique=True)


def downgrade() -> None:
    op.drop_index("jobs_by_idempotency_key", "jobs")
    op.drop_column("jobs", "request_hash")
    op.drop_column("jobs", "idempotency_key")
