"""The requests of jobs in a table of their own: a job's row, which changes often, stays small."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Move them."""
    op.create_table(
        "job_requests",
        sa.Column("job_id", sa.String(64), nullable=False),
        sa.Column("request", sa.Text, nullable=False),
        sa.ForeignKeyConstraint(
            ["job_id"], ["jobs.id"], name="fk_job_requests_job_id", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("job_id", name="pk_job_requests"),
    )
    op.execute("INSERT INTO job_requests (job_id, request) SELECT id, request FROM jobs")
    op.drop_column("jobs", "request")


def downgrade() -> None:
    """Move them back."""
    op.add_column("jobs", sa.Column("request", sa.Text, nullable=False, server_default=""))
    op.execute(
        "UPDATE jobs SET request ="
        " (SELECT request FROM job_requests WHERE job_requests.job_id = jobs.id)"
    )
    op.drop_table("job_requests")
