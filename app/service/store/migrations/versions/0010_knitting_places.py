"""Places in knitting designs."""

from alembic import context, op

revision = "0010"
down_revision = "0009"


def upgrade() -> None:
    """Make the table."""
    context.config.attributes["metadata"].tables["knitting_places"].create(op.get_bind())
