"""Charts row by row, over REST and on the command line."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, run
from tests.app.rest import post

CHART = "KPKK\nPPKP\nKKPP"


@pytest.mark.parametrize("machine", [None, "brother", "silver-reed-ribber"])
def test_rows_are_the_same_everywhere(client: TestClient, machine: str | None) -> None:
    given = ["--machine", machine] if machine else []
    result = post(client, "knit-along", {"chart": CHART, "machine": machine})
    assert run("knit-along", "KPKK/PPKP/KKPP", *given) == result
    assert [row["number"] for row in result["rows"]] == [1, 2, 3]
    assert result["marked"] == {None: "purls", "brother": "to be latched up"}.get(
        machine, "on the ribber"
    )


def test_the_command_line_prints_rows_from_any_on() -> None:
    lines = printed("knit-along", "garter", "--size", "4x6", "--from-row", "5").stdout.splitlines()
    assert lines[1:3] == ["Row 5 (right side): knit", "Row 6 (wrong side): knit"]


def test_a_row_that_there_is_not_and_an_unknown_machine_are_refused(client: TestClient) -> None:
    for field, value in (("from_row", 4), ("machine", "loom")):
        response = client.post("/api/v1/knit-along", json={"chart": CHART, field: value})
        assert response.status_code == 422
        assert field in response.text
