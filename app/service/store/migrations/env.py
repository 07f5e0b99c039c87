"""Run Alembic on the connection that :func:`app.service.store.schema.migrate` hands over."""

from alembic import context
from sqlalchemy import text

LOCK = 5_202_404  # any number not used for another advisory lock

connection = context.config.attributes["connection"]
if connection.dialect.name == "postgresql":
    connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK})
context.configure(
    connection=connection,
    target_metadata=context.config.attributes["metadata"],
    render_as_batch=True,
)
context.run_migrations()
