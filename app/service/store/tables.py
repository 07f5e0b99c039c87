"""The tables, with times and secrets as they hold them.

Every change here comes with a migration; a test compares the two.
"""

import hashlib
import time

from sqlalchemy import (
    Boolean,
    Column,
    Float,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    false,
)

metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s",
        "pk": "pk_%(table_name)s",
    }
)

designs = Table(
    "designs",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("owner", String(80), nullable=False),
    Column("name", String(200), nullable=False),
    Column("material", String(80), nullable=False),
    Column("chart", Text, nullable=False),  # canonical text, the top row first
    Column("note", Text, nullable=False, server_default=""),
    Column("layout", Text, nullable=False, server_default="{}"),  # JSON of a DesignLayout
    Column("rows", Integer, nullable=False),
    Column("columns", Integer, nullable=False),
    Column("revision", Integer, nullable=False),
    Column("created_at", Float, nullable=False),  # seconds since 1970, UTC
    Column("changed_at", Float, nullable=False),
    Column("deleted_at", Float),
    Column("size_bytes", Integer, nullable=False, server_default="0"),  # of chart, note and layout
    Index(None, "owner", "changed_at", "id"),
    Index(None, "owner", "size_bytes"),
)

design_versions = Table(
    "design_versions",
    metadata,
    Column("design_id", ForeignKey("designs.id", ondelete="CASCADE"), primary_key=True),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("name", String(200), nullable=False),
    Column("automatic", Boolean, nullable=False, server_default=false()),
    Column("design_name", String(200), nullable=False),
    Column("material", String(80), nullable=False),
    Column("chart", Text, nullable=False),
    Column("note", Text, nullable=False),
    Column("layout", Text, nullable=False, server_default="{}"),
    Column("revision", Integer, nullable=False),
    Column("created_at", Float, nullable=False),
    Column("size_bytes", Integer, nullable=False, server_default="0"),
    Index(None, "design_id", "size_bytes"),
)

knitting_places = Table(
    "knitting_places",
    metadata,
    Column("design_id", ForeignKey("designs.id", ondelete="CASCADE"), primary_key=True),
    Column("way", String(40), primary_key=True),  # flat, round, or a machine's identifier
    Column("row", Integer, nullable=False),
    Column("count", Integer, nullable=False),
    Column("changed_at", Float, nullable=False),
)

shares = Table(
    "shares",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("design_id", ForeignKey("designs.id", ondelete="CASCADE"), nullable=False, index=True),
    Column("token_hash", String(64), nullable=False, unique=True),  # the link itself is not kept
    Column("mode", String(8), nullable=False),
    Column("created_at", Float, nullable=False),
    Column("revoked_at", Float),
)

idempotency_keys = Table(
    "idempotency_keys",
    metadata,
    Column("owner", String(80), primary_key=True),
    Column("key", String(200), primary_key=True),
    Column("fingerprint", String(64), nullable=False),
    Column("answer", Text, nullable=False),
    Column("created_at", Float, nullable=False, index=True),
)

jobs = Table(
    "jobs",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("owner", String(80), nullable=False),
    Column("process", String(80), nullable=False),  # which service process runs it
    Column("kind", String(40), nullable=False),
    Column("key", String(64), nullable=False),  # of the content, names the result
    Column("state", String(16), nullable=False),
    Column("problem", Text),
    Column("created_at", Float, nullable=False),
    Column("started_at", Float),
    Column("finished_at", Float),
    Column("progress", Float, nullable=False, server_default="0"),
    Column("seen_at", Float, nullable=False, server_default="0"),  # when its process lived
    Column("size_bytes", Integer, nullable=False, server_default="0"),  # of the request
    Index(None, "owner", "created_at", "id"),
    Index(None, "owner", "size_bytes"),
    Index(None, "process", "state"),
)

job_requests = Table(
    "job_requests",
    metadata,
    Column("job_id", ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True),
    Column("request", Text, nullable=False),  # may be megabytes, while rows of jobs change often
)

results = Table(
    "results",
    metadata,
    Column("key", String(64), primary_key=True),
    Column("kind", String(40), nullable=False),
    Column("body", LargeBinary, nullable=False),  # gzipped JSON
    Column("size_bytes", Integer, nullable=False),
    Column("used_at", Float, nullable=False, index=True),
)

access_tokens = Table(
    "access_tokens",
    metadata,
    Column("id", String(16), primary_key=True),
    Column("user", String(80), nullable=False),
    Column("token_hash", String(64), nullable=False, unique=True),  # the token itself is not kept
    Column("label", String(200), nullable=False),
    Column("created_at", Float, nullable=False),
    Column("expires_at", Float),
    Column("revoked_at", Float),
)

service_keys = Table(
    "service_keys",
    metadata,
    Column("name", String(40), primary_key=True),
    Column("value", String(200), nullable=False),
)

sessions = Table(
    "sessions",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("token", String(64), nullable=False),  # with which it was opened
    Column("user", String(80), nullable=False, index=True),
    Column("created_at", Float, nullable=False),
)

own_materials = Table(
    "own_materials",
    metadata,
    Column("owner", String(80), primary_key=True),
    Column("id", String(80), primary_key=True),  # own:IDENTIFIER.MARK, as designs name it
    Column("identifier", String(64), nullable=False),
    Column("document", Text, nullable=False),  # JSON of a MaterialDocument
    Column("added_at", Float, nullable=False),
    Column("replaced_at", Float),
    Index(None, "id"),
    Index(None, "identifier"),
)


def now() -> float:
    """Seconds since 1970, UTC."""
    return time.time()


def hash_of(secret: str) -> str:
    """Hash a secret; secrets here are 256 random bits, which nobody can guess from a plain hash."""
    return hashlib.sha256(secret.encode()).hexdigest()
