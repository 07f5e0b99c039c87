"""The figures of a program over REST and on the command line."""

import pytest
from fastapi.testclient import TestClient

from knitcore.machine.profile import profiles
from tests.app.command_line import printed, refused, run
from tests.app.rest import post

HOME = [machine.identifier for machine in profiles().values() if not machine.reads_programs]
SEED = {"chart": {"fabric": "seed", "columns": 8, "rows": 6}}


def test_a_report_gives_passes_yarn_and_the_tightest_loop(client: TestClient) -> None:
    request = SEED | {"machine": "kniterate", "loop_length_mm": 11, "linear_density_tex": 250}
    report = post(client, "program-report", request | {"price_per_kg": 40})
    assert report["transfer_passes"] == 11
    assert report["transfers"] == 44
    assert report["passes"] == sum(report[f"{k}_passes"] for k in ("knit", "transfer", "empty"))
    assert report["cost"] > 0
    kind, of_waste = report["kinds_of_transfer"]  # waste yarn is knitted looser here
    assert (kind["passes"], of_waste["passes"]) == (10, 1)
    assert kind["tightest"]["own_mm"] < of_waste["tightest"]["own_mm"]
    assert kind["tightest"]["verdict"] == "free"
    low, high = kind["tightest"]["tension_interval_n"]
    assert low < kind["tightest"]["tension_n"] < high


def test_a_machine_that_is_not_known_is_refused_with_those_that_are(client: TestClient) -> None:
    reply = client.post("/api/v1/program-report", json=SEED | {"machine": "loom"})
    assert reply.status_code == 422
    assert "kniterate" in reply.text


def test_the_command_prints_a_line_for_each_kind_of_transfer() -> None:
    text = printed("program", "seed", "--size", "8x6", "--machine", "kniterate").stdout
    assert "rack 0: 11 passes" in text
    assert "min" in text


@pytest.mark.parametrize("machine", HOME)
def test_a_home_machine_has_minutes_and_yarn_too(client: TestClient, machine: str) -> None:
    report = post(client, "program-report", SEED | {"machine": machine, "price_per_hour": 12})
    assert report["passes"] == report["knit_passes"] == 6
    assert report["transfers"] > 0
    assert report["minutes"] > 1
    assert report["cost"] == pytest.approx(report["minutes"] / 5)
    assert [yarn["loops"] for yarn in report["yarns"]] == [48]
    assert "our guess" in report["notes"][-1]
    assert run(
        "program", "seed", "--size", "8x6", "--machine", machine, "--price-per-hour", 12
    ) == (report)


CABLES = "PKKKKPPKKKKP;P[2/2L]PP[2/2R]P;PKKKKPPKKKKP;PKKKKPPKKKKP"


def test_cables_have_the_table_of_passes_and_what_was_done_for_the_yarn(client: TestClient) -> None:
    request = {"chart": CABLES, "machine": "kniterate", "material": "glove-wool"}
    report = post(client, "program-report", request)
    assert "Stitch number 9 in course 2" in " ".join(report["notes"])
    kinds = report["kinds_of_transfer"]
    assert {kind["rack"] for kind in kinds} == {0, 2}
    assert max(kind["tightest"]["break_chance"] for kind in kinds) < 0.02
    assert run("program", CABLES, "--machine", "kniterate", "--material", "glove-wool") == report
    words = refused("program", CABLES, "--machine", "brother")
    assert "plans that hold knits and purls only" in words
    rest = run(
        "program", CABLES, "--machine", "kniterate", "--material", "glove-wool", "--from-row", 4
    )
    assert {kind["rack"] for kind in rest["kinds_of_transfer"]} == {0}
    assert rest["minutes"] < report["minutes"]


def test_loops_too_short_for_their_transfers_are_refused_with_what_helps() -> None:
    lace = ["rib", "--size", "8x6", "--machine", "kniterate", "--material", "lace-cashmere"]
    words = refused("program", *lace, "--finish", "bind-off")
    assert "would break" in words
    assert "Knit with loops of" in words
    assert run("program", *lace, "--finish", "bind-off", "--stitch-number", 8)["transfers"] > 0
