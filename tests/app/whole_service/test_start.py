"""Starts load what they need: solvers, drawings and migrations wait until somebody uses them."""

from pathlib import Path

import pytest

from tests.app.running import knitcore, python

SOLVERS = {
    *("numba", "llvmlite", "skfem", "h5py", "pandas", "openpyxl", "reportlab", "trimesh"),
    *("scipy.constants", "scipy.fft", "scipy.integrate", "scipy.interpolate", "scipy.linalg"),
    *("scipy.ndimage", "scipy.optimize", "scipy.signal", "scipy.sparse", "scipy.spatial"),
    *("scipy.special", "scipy.stats", "skimage.filters", "skimage.measure", "skimage.transform"),
}
LATER = SOLVERS | {"alembic", "distributed", "sqlalchemy.dialects.postgresql", "viser"}
SERVED = """
import sys, threading
from fastapi.testclient import TestClient
from app.service import main
ready = threading.Event()
main.READY_AFTER_S, main.load, main._warm_up = None, lambda: None, ready.set
with TestClient(main.create_app(), base_url="http://127.0.0.1") as client:
    assert client.get("/healthz").is_success and not ready.is_set()
    assert client.get("/").is_success and ready.wait(120)
    print(*sys.modules)
"""
CALLED = """
import sys
from app.cli.main import main
try:
    main(sys.argv[1:])
finally:
    print(*sys.modules, file=sys.stderr)
"""
READY = """
import gc
from app.service import main
main._warm_up()
print(len(gc.get_objects()), gc.get_freeze_count())
"""


@pytest.fixture(scope="module")
def env(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Settings with a database that is up to date."""
    variables = {"KNITCORE_DATA_DIR": str(tmp_path_factory.mktemp("data"))}
    assert knitcore("token", "list", env=variables).returncode == 0
    return variables


def test_the_page_is_sent_before_anything_is_loaded_for_computations(env: dict[str, str]) -> None:
    assert not LATER & set(python("-c", SERVED, env=env).stdout.split())


@pytest.mark.parametrize("command", ["token list", "doctor", "materials", "backup {folder}/b"])
def test_a_command_that_computes_nothing_loads_neither_solvers_nor_the_service(
    command: str, env: dict[str, str], tmp_path: Path
) -> None:
    done = python("-c", CALLED, *command.format(folder=tmp_path).split(), env=env)
    assert not (LATER | {"fastapi", "uvicorn"}) & set(done.stderr.split())


def test_what_workers_run_is_declared_without_its_solvers() -> None:
    code = "import sys; from app.operations.registry import operations; operations()"
    assert not SOLVERS & set(python("-c", f"{code}; print(*sys.modules)").stdout.split())


@pytest.mark.slow
def test_no_request_waits_while_python_looks_for_garbage_in_what_is_loaded() -> None:
    looked_through, left_out = map(int, python("-c", READY).stdout.split())
    assert looked_through < left_out / 10
