"""Settings that all tests share."""

import atexit
import gc
import os
import shutil
import tempfile

from hypothesis import HealthCheck, Phase, settings

settings.register_profile(
    "knitcore",
    deadline=None,  # how long an example takes is no property
    max_examples=50,
    derandomize=True,  # a suite that was green stays green
    phases=set(Phase) - {Phase.explain},  # its trace of what failed may never end on Python 3.11
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
settings.load_profile("knitcore")

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

# Tests keep all cores busy, and must not wait until nobody else wants one, nor get a tenth of it.
os.environ.setdefault("KNITCORE_WORKER_PRIORITY", "low")
os.environ.setdefault("KNITCORE_WORKER_NICENESS", "1")

# No test writes to the user's own data folder, in this process or in one that it starts.
_DATA = tempfile.mkdtemp(prefix="knitcore-tests-")
os.environ["KNITCORE_DATA_DIR"] = _DATA
atexit.register(shutil.rmtree, _DATA, ignore_errors=True)


def pytest_collection_finish() -> None:
    """Spare the collector everything imported so far: it stays to the end."""
    gc.freeze()
