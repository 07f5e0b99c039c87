"""Kill -9 while designs are edited and commands run: what was acknowledged is there afterwards.

KNITCORE_KILLS=50 makes it fifty kills instead of a few (``make test-hard``).
"""

import os
import random
import time
from pathlib import Path

import pytest

from tests.app.databases import is_whole
from tests.app.painter import Painter, painting, until_painted
from tests.app.running import Service, knitcore

KILLS = int(os.environ.get("KNITCORE_KILLS", "2"))
PAINTERS = 4


@pytest.mark.slow
@pytest.mark.timeout(600 + 60 * KILLS)
def test_no_acknowledged_edit_is_lost(tmp_path: Path) -> None:
    service = Service(tmp_path)
    rng = random.Random(2024)  # noqa: S311
    client = service.start()
    painters = [Painter.with_a_design(client, n) for n in range(PAINTERS)]
    strokes = 0
    try:
        for _ in range(KILLS):
            before = sum(p.acknowledged for p in painters)
            with painting(service.url, painters):
                until_painted(painters, before + PAINTERS)
                listed = knitcore("token", "list", env=service.environment)
                assert listed.returncode == 0  # it opens and closes the same file
                time.sleep(rng.uniform(0.0, 0.5))
                service.kill()
            client.close()
            assert is_whole(tmp_path / "data" / "knitcore.sqlite3")
            client = service.start()
            for painter in painters:
                painter.check_over_http(client)
            strokes += sum(p.acknowledged for p in painters) - before
    finally:
        client.close()
        service.kill()
    assert strokes >= PAINTERS * KILLS
    print(f"{KILLS} kills, {strokes} strokes kept, none lost")  # noqa: T201 - for make test-hard
