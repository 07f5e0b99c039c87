"""Machines over REST and on the command line."""

from pathlib import Path

from fastapi.testclient import TestClient

from knitcore.machine.profile import profile, profiles
from tests.app.command_line import printed, refused, run
from tests.app.rest import post

PROGRAM = ";!knitout-2\n;;Carriers: 1 2 3 4 5 6 7 8 9 10\ninhook 1\nknit - f1 1\nouthook 1\n"


def test_all_machines_are_listed_with_their_sources(client: TestClient) -> None:
    listed = client.get("/api/v1/machines").json()
    assert run("machines") == listed
    assert [machine["identifier"] for machine in listed["machines"]] == list(profiles())
    assert all(machine["profile"]["sources"] for machine in listed["machines"])


def test_a_machine_is_explained_in_lines() -> None:
    lines = printed("machines", "kniterate").stdout
    assert "racking" in lines
    assert "public Kniterate back end" in lines


def test_a_profile_of_ones_own_is_checked(tmp_path: Path) -> None:
    file = tmp_path / "mine.json"
    file.write_text(profile("kniterate").to_json())
    assert run("machines", file)["columns"] == 252
    file.write_text(file.read_text().replace('"beds": 2', '"beds": 3'))
    assert "beds: Input should be 1 or 2" in refused("machines", file)
    assert "is not a file" in refused("machines", tmp_path / "none.json")


def test_a_program_is_held_against_a_machine(client: TestClient, tmp_path: Path) -> None:
    file = tmp_path / "program.k"
    file.write_text(PROGRAM)
    checked = post(client, "machines/check", {"program": PROGRAM, "machine": "kniterate"})
    assert run("machines", "kniterate", "--program", file) == checked
    assert {problem["subject"] for problem in checked["problems"]} == {
        "header",
        "carriers",
        "settings",
    }
    assert "can knit it" in printed("machines", "swg091n2", "--program", file).stdout
