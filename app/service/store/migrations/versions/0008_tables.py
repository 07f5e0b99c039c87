"""All tables. A change of them is a migration after this one, which then lists them itself."""

from alembic import context, op

revision = "0008"
down_revision = None


def upgrade() -> None:
    """Make the tables."""
    context.config.attributes["metadata"].create_all(op.get_bind())
