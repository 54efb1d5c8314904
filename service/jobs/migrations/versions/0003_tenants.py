"""API keys, and the tenant of each job."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "api_keys",
        sa.Column("id", sa.String(26), primary_key=True),
        sa.Column("tenant", sa.String(100), nullable=False),
        sa.Column("hash", sa.String(64), nullable=False),
        sa.Column("created_at", sa.String(27), nullable=False),
        sa.Column("revoked_at", sa.String(27)),
    )
    op.create_index("api_keys_by_hash", "api_keys", ["hash"], unique=True)
    # Earlier jobs belong to no tenant: a service without keys shows them.
    op.add_column("jobs", sa.Column("tenant", sa.String(100), nullable=False, server_default=""))
    op.drop_index("jobs_by_idempotency_key", "jobs")
    op.drop_index("jobs_by_kind", "jobs")
    op.create_index("jobs_by_idempotency_key", "jobs", ["tenant", "idempotency_key"], unique=True)
    op.create_index("jobs_by_tenant", "jobs", ["tenant", "id"])
    op.create_index("jobs_by_tenant_and_status", "jobs", ["tenant", "status", "id"])
    op.create_index("jobs_by_tenant_and_kind", "jobs", ["tenant", "kind", "id"])


def downgrade() -> None:
    for name in ("tenant_and_kind", "tenant_and_status", "tenant", "idempotency_key"):
        op.drop_index(f"jobs_by_{name}", "jobs")
    op.create_index("jobs_by_kind", "jobs", ["kind", "id"])
    op.create_index("jobs_by_idempotency_key", "jobs", ["idempotency_key"], unique=True)
    op.drop_column("jobs", "tenant")
    op.drop_table("api_keys")
