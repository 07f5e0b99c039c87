"""How large designs and versions are, so that what a user keeps can be summed; sessions."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"

SIZED = {"designs": "owner", "design_versions": "design_id"}
PARTS = ("chart", "note", "layout")


def upgrade() -> None:
    """Add the columns with their values, the indices to sum them, and the table."""
    for table, whose in SIZED.items():
        op.add_column(
            table, sa.Column("size_bytes", sa.Integer, nullable=False, server_default="0")
        )
        sized = sa.table(table, *map(sa.column, ("size_bytes", *PARTS)))
        size = sum(sa.func.length(sized.c[part]) for part in PARTS)
        op.execute(sized.update().values(size_bytes=size))
        op.create_index(f"ix_{table}_{whose}_size_bytes", table, [whose, "size_bytes"])
    op.create_table(
        "sessions",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("token", sa.String(64), nullable=False),
        sa.Column("user", sa.String(80), nullable=False),
        sa.Column("created_at", sa.Float, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_sessions"),
    )
    op.create_index("ix_sessions_user", "sessions", ["user"])


def downgrade() -> None:
    """Drop them."""
    op.drop_table("sessions")
    for table, whose in SIZED.items():
        op.drop_index(f"ix_{table}_{whose}_size_bytes", table)
        op.drop_column(table, "size_bytes")
