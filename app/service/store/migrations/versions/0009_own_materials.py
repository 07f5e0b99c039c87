"""Materials of users, which were files of the data folder."""

from alembic import context, op

revision = "0009"
down_revision = "0008"


def upgrade() -> None:
    """Make the table; files are taken over afterwards, by whoever knows their folder."""
    context.config.attributes["metadata"].tables["own_materials"].create(op.get_bind())
