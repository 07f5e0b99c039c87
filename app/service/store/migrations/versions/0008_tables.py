"""The tables of the first release. A change of them is a migration after this one; whoever changes
one of these tables writes it out here as it was."""

from alembic import context, op

revision = "0008"
down_revision = None

TABLES = (
    "designs",
    "design_versions",
    "shares",
    "idempotency_keys",
    "jobs",
    "job_requests",
    "results",
    "access_tokens",
    "service_keys",
    "sessions",
)


def upgrade() -> None:
    """Make the tables."""
    metadata = context.config.attributes["metadata"]
    metadata.create_all(op.get_bind(), [metadata.tables[name] for name in TABLES])
