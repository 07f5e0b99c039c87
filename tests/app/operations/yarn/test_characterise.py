"""``characterise`` on the command line, killed, resumed, on a cluster, and as an operation."""

import csv
import json
import signal
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from pydantic import ValidationError

from app.context import Context
from app.operations.yarn.characterise import CharacteriseRequest, characterise
from knitcore.base.errors import CancelledError
from tests.app.command_line import printed, run
from tests.app.running import python
from tests.knitcore.base.test_batch import cluster  # noqa: F401 - a fixture

if TYPE_CHECKING:
    from distributed import LocalCluster

YARN = [
    "--yarn", "mine", "--bending-modulus-n-mm2", "0.07", "--contact-stiffness-n-per-mm3", "0.0115",
    "--contact-exponent", "2.9", "--radius-mm", "0.66", "--core-radius-mm", "0.31",
]  # fmt: skip


def characterised(*arguments: str) -> Any:
    return json.loads(printed("characterise", *arguments, "--json").stdout)


@pytest.mark.slow
def test_two_yarns_become_a_table_curves_and_materials(tmp_path: Path) -> None:
    yarns = characterised(
        "cotton", *YARN, "--fabrics", "stockinette", "--loop-lengths", "12,12.5", "--workers", "1",
        "--out", str(tmp_path),
    )  # fmt: skip
    assert [yarn["identifier"] for yarn in yarns] == ["cotton-yarn-level", "mine"]
    with (tmp_path / "table.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["yarn"], row["setting"]) for row in rows] == [
        ("cotton-yarn-level", "12mm"),
        ("cotton-yarn-level", "12.5mm"),
        ("mine", "12mm"),
        ("mine", "12.5mm"),
    ]
    # the same yarn, by name and by its numbers
    assert rows[0]["modulus_course_n_per_mm"] == rows[2]["modulus_course_n_per_mm"]
    with (tmp_path / "curves.csv").open() as file:
        assert {row["direction"] for row in csv.DictReader(file)} == {"course", "wale"}
    law = run("materials", tmp_path / "mine.json")["fabrics"]["stockinette"]
    assert law["modulus_wale_n_per_mm"] == pytest.approx(float(rows[3]["modulus_wale_n_per_mm"]))
    assert law["origin"] == "simulated"
    assert (tmp_path / "mine-12mm.json").is_file()


KILLED = """
import os, signal, sys
from app.cli.main import main
from knitcore.base import batch

write, written = batch._Folder.write, []

def write_and_die(*args):
    write(*args)
    written.append(args)
    if len(written) == 2:
        os.kill(os.getpid(), signal.SIGKILL)

batch._Folder.write = write_and_die
main(sys.argv[1:])
"""
"""The command line, killed when two tasks of a batch are finished."""


@pytest.mark.slow
def test_a_killed_batch_resumes(tmp_path: Path) -> None:
    arguments = [
        "characterise", "cotton", "--fabrics", "stockinette,garter", "--tensions", "1,1.04",
        "--workers", "1", "--out", str(tmp_path),
    ]  # fmt: skip
    here = {"PYTHONPATH": str(Path(__file__).parents[4])}
    killed = python("-c", KILLED, *arguments, check=False, env=here)
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    finished = tmp_path / "finished"
    before = {file: file.stat().st_mtime_ns for file in finished.glob("*.json")}
    assert len(before) == 2
    assert not (tmp_path / "table.csv").exists()
    result = printed(*arguments)
    assert {file: file.stat().st_mtime_ns for file in before} == before
    assert len(list(finished.glob("*.json"))) == 4
    assert result.stdout.count("stockinette") == 2


@pytest.mark.slow
def test_a_cluster_of_two_processes_gives_the_same(
    cluster: "LocalCluster",  # noqa: F811 - a fixture
    tmp_path: Path,
) -> None:
    address = cluster.scheduler_address
    words = ("cotton", "--fabrics", "stockinette", "--tensions", "1,1.05")
    there = characterised(*words, "--scheduler", address, "--out", str(tmp_path / "there"))
    here = characterised(*words, "--workers", "1", "--out", str(tmp_path / "here"))
    assert there == here


@pytest.mark.slow
def test_the_operation_reports_progress_and_stops(tmp_path: Path) -> None:
    request = CharacteriseRequest.model_validate(
        {"material": "cotton", "fabrics": ["stockinette"], "tensions": [1.0]}
    )
    seen: list[tuple[float, float]] = []
    context = Context(tmp_path, progress=lambda *share: seen.append(share))
    result = characterise(request, context)
    assert seen == [(0, 1), (1, 1)]
    assert result.material is not None
    assert result.rows[0].curves
    with pytest.raises(CancelledError):
        characterise(request, Context(tmp_path, cancelled=lambda: True))


@pytest.mark.parametrize("body", [{}, {"material": "cotton", "yarn": {"name": "x"}}])
def test_one_yarn_has_to_be_named(body: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        CharacteriseRequest.model_validate(body)
