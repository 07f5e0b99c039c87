"""What the processes of one service know of each other's jobs: progress, and that they live."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    """Add the columns."""
    op.add_column("jobs", sa.Column("progress", sa.Float, nullable=False, server_default="0"))
    op.add_column("jobs", sa.Column("seen_at", sa.Float, nullable=False, server_default="0"))


def downgrade() -> None:
    """Drop the columns."""
    op.drop_column("jobs", "seen_at")
    op.drop_column("jobs", "progress")
