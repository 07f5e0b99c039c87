"""Outline, regions, repeats and shelf of designs."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    """Add the columns."""
    for table in ("designs", "design_versions"):
        op.add_column(table, sa.Column("layout", sa.Text, nullable=False, server_default="{}"))


def downgrade() -> None:
    """Drop the columns."""
    for table in ("designs", "design_versions"):
        op.drop_column(table, "layout")
