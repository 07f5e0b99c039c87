"""Files of charts, which may be made to keep their readers busy."""

import base64
import json
from pathlib import Path
from typing import Any

import pytest

from app.operations.files.imports import design_in
from app.service import main
from app.service.compute.processes import ProcessWorker, processes
from knitcore.base import reading_time
from knitcore.formats.read import chart_files
from tests.app import jobs
from tests.app.clients import served, state_of
from tests.app.command_line import refused


def upload(name: str) -> dict[str, Any]:
    return {"file": {"name": name, "content": base64.b64encode(b"KP\nPK\n").decode()}}


@pytest.mark.slow
def test_the_service_refuses_a_file_that_takes_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its worker goes on to the next file."""

    def spinning(*given: Any, begin: object, **more: Any) -> list[ProcessWorker]:
        del begin
        return processes(*given, begin=jobs.spin_over_knitspeak, **more)

    monkeypatch.setattr(main, "processes", spinning)
    with served() as client:
        (worker,) = state_of(client).compute.workers
        executor = worker._executor
        answer = client.post("/api/v1/import", json=upload("endless.ks"))
        problem = answer.json()
        assert (answer.status_code, problem["type"]) == (422, "/problems/input")
        assert problem["field"] == "endless.ks"
        assert "more than 1 s to read" in problem["detail"]
        assert "smaller" in problem["remedy"]
        answer = client.post("/api/v1/import", json=upload("chart.txt"))
        assert answer.json()["chart"] == "KP\nPK"
        assert worker._executor is executor


def test_a_command_refuses_a_file_that_takes_too_long(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading_time, "READING_S", 0.1)
    monkeypatch.setitem(chart_files._READERS, ".ks", jobs.spin)
    file = tmp_path / "endless.ks"
    file.write_text("row 1: k2.")
    words = "Error: endless.ks: takes more than 0.1 s to read. Give a smaller or simpler file"
    for command in (["import"], ["predict", "--material", "acrylic"]):
        printed = refused(*command, file)
        assert printed.startswith(words)
        assert printed.count("\n") == 1


def test_a_design_with_lace_keeps_it_also_where_rows_do_not_balance(tmp_path: Path) -> None:
    file = tmp_path / "lace.json"
    lace = [{"row": 1, "column": 0, "codes": "O"}]
    content = {"format": "knitcore-design", "version": 2, "chart": "KK\nKP", "other_stitches": lace}
    file.write_text(json.dumps(content))
    design, _ = design_in(file)
    assert design.chart == "KK\nKP"
    assert [run.model_dump() for run in design.other_stitches] == lace
