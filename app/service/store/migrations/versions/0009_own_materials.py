"""Materials of users."""

from alembic import context, op

revision = "0009"
down_revision = "0008"


def upgrade() -> None:
    """Make the table."""
    context.config.attributes["metadata"].tables["own_materials"].create(op.get_bind())
