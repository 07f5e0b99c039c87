"""How large the requests of jobs are, so that they are summed without reading them."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Add the column with its values, and the index to sum it."""
    op.add_column("jobs", sa.Column("size_bytes", sa.Integer, nullable=False, server_default="0"))
    op.execute("UPDATE jobs SET size_bytes = length(request)")
    op.create_index("ix_jobs_owner_size_bytes", "jobs", ["owner", "size_bytes"])


def downgrade() -> None:
    """Drop them."""
    op.drop_index("ix_jobs_owner_size_bytes", "jobs")
    op.drop_column("jobs", "size_bytes")
