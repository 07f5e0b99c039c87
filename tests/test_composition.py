"""The composition of compose.yaml, without containers: what people do with it, from the first
sign-in to an upgrade."""

import contextlib
import gzip
import json
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx2 as httpx
import pytest

from knitcore.materials import material
from knitcore.materials.material_document import MaterialDocument
from scripts.composition import Composition, composition, missing, repointed

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bool(missing()), reason=f"not installed here: {', '.join(missing())}"),
]

PATIENCE_S = 150.0
PULL = {"chart": "KP/PK", "material": "acrylic", "direction": "wale", "strain": 0.1, "steps": 2}


@pytest.fixture
def running() -> Iterator[Composition]:
    """All programs, in a folder that the database's user reaches."""
    with (
        tempfile.TemporaryDirectory(prefix="knit-all-", dir="/tmp") as folder,
        composition(Path(folder)) as running,
    ):
        yield running


@contextlib.contextmanager
def _signed_in(running: Composition, token: str) -> Iterator[httpx.Client]:
    """A browser that opened the page with a token, through the proxy."""
    options: dict[str, Any] = {"headers": {"Origin": running.url}, "follow_redirects": True}
    with httpx.Client(base_url=running.url, timeout=PATIENCE_S, **options) as client:
        assert client.get(f"/?token={token}").status_code == 200
        assert client.get("/api/v1/session").json()["user"] == "ada"
        yield client


def _stretched(client: httpx.Client, yarn: str) -> Any:
    """The result of a stretch test in the background, which a worker of the cluster does."""
    request = {"kind": "stretch", "request": PULL | {"material": yarn}}
    job = client.post("/api/v1/jobs", json=request)
    assert job.status_code == 202, job.text
    address = job.headers["Location"]
    deadline = time.monotonic() + 300
    while (state := client.get(address).json())["state"] != "done":
        assert state["state"] in ("waiting", "running"), state
        assert time.monotonic() < deadline
        time.sleep(0.2)
    return client.get(f"{address}/result").json()


def _painted(client: httpx.Client, design: dict[str, Any]) -> str:
    """The chart of a design after a stroke."""
    stroke = {"rows": 2, "columns": 2, "runs": [{"row": 0, "column": 0, "stitches": "PP"}]}
    answer = client.post(f"/api/v1/designs/{design['id']}/strokes", json=stroke)
    assert answer.status_code == 200, answer.text
    return str(client.get(f"/api/v1/designs/{design['id']}").json()["document"]["chart"])


def test_sign_in_paint_stretch_back_up_restore_upgrade(
    running: Composition, tmp_path: Path
) -> None:
    assert httpx.get(f"{running.url}/readyz", timeout=PATIENCE_S).status_code == 200
    assert (
        httpx.post(f"{running.url}/api/v1/predict", json=PULL, timeout=PATIENCE_S).status_code
        == 401
    )
    token = json.loads(running.knitcore("token", "create", "ada", "--json"))["token"]
    document = {"name": "Cuff", "material": "acrylic", "chart": "KP\nPK"}
    yarn = MaterialDocument.from_material(material("acrylic")).model_dump(mode="json")
    with _signed_in(running, token) as ada:
        design = ada.post("/api/v1/designs", json=document).json()
        chart = _painted(ada, design)
        assert chart != document["chart"]
        own = ada.post("/api/v1/materials", json=yarn | {"identifier": "mine"}).json()["id"]
        assert _stretched(ada, own)["force_n"] == _stretched(ada, "acrylic")["force_n"]
        used = ada.get("/api/v1/session").json()["use"]
        assert used["cpu_s"]["used"] > 0
        assert used["materials"]["used"] == 1

    backup = tmp_path / "backup.gz"
    running.knitcore("backup", backup)
    assert b'"table": "own_materials"' in gzip.decompress(backup.read_bytes())
    for database in "again", "earlier":
        running.sql(f"CREATE DATABASE {database}")
        running.knitcore("restore", backup, database_url=running.database_url(database))
    with _started_on(running, "again", token) as ada:
        kept = ada.get(f"/api/v1/designs/{design['id']}").json()
        assert kept["document"]["chart"] == chart
        assert _stretched(ada, own)["converged"]

    # as the program before the last schema left it
    running.sql(
        "DROP TABLE own_materials; DROP TABLE knitting_places; "
        "UPDATE alembic_version SET version_num='0008'",
        "earlier",
    )
    with _started_on(running, "earlier", token) as ada:
        assert _painted(ada, design) == chart
        again = ada.post("/api/v1/materials", json=yarn | {"identifier": "mine"}).json()["id"]
        assert again == own
    log = running.service.log.read_text()
    assert "Traceback" not in log
    assert token not in log


@contextlib.contextmanager
def _started_on(running: Composition, database: str, token: str) -> Iterator[httpx.Client]:
    """Somebody who is signed in to a service that was started again on another database."""
    assert running.service.stop() == 0
    running.service.environment["KNITCORE_DATABASE_URL"] = running.database_url(database)
    running.service.start().close()
    repointed(running.folder, running.service)
    _until_ready(running)
    with _signed_in(running, token) as client:
        yield client


def _until_ready(running: Composition) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while httpx.get(f"{running.url}/readyz", timeout=PATIENCE_S).status_code != 200:
        assert time.monotonic() < deadline
        time.sleep(0.2)
