"""``hang``, ``overhang``, ``drape`` and ``border`` on the command line and over REST."""

from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed
from tests.app.rest import post

YARN = {"material": "acrylic", "linear_density_g_per_m": 0.5}
PIECE = {"fabric": "garter", "columns": 5, "rows": 6}


@pytest.mark.parametrize(
    ("address", "body", "lines"),
    [
        ("hang", {"chart": PIECE, **YARN}, (7, 6)),
        ("overhang", {"chart": "K/P", **YARN}, (43, 3)),
        ("drape", {"chart": "K/P", "across": 10, **YARN}, (11, 11)),
    ],
)
def test_simulated_tests_over_rest(
    client: TestClient, address: str, body: dict[str, Any], lines: tuple[int, int]
) -> None:
    result = post(client, address, {**body, "corners": True})
    assert result["converged"]
    assert np.array([[at is None for at in line] for line in result["corners_mm"]]).shape == lines


@pytest.mark.parametrize(
    ("arguments", "words", "note"),
    [
        (["hang", "garter", "--size", "5x6"], "lengthening", ""),
        (["overhang", "seed", "--direction", "wale"], "bending length", ""),
        (["overhang", "stockinette"], "bending length", "curls"),
        (["drape", "garter", "--across", "10"], "drape coefficient", ""),
        pytest.param(
            ["border", "stockinette", "--border", "rib"],
            "top and bottom",
            "Knitters make borders",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_simulated_tests_as_commands(arguments: list[str], words: str, note: str) -> None:
    result = printed(*arguments, "--material", "acrylic", "--linear-density-g-per-m", "0.5")
    assert words in result.stdout
    assert note in result.stderr


@pytest.mark.parametrize(
    ("address", "more"), [("overhang", {"direction": "wale"}), ("drape", {"across": 10})]
)
def test_the_piece_of_a_test_is_shown_in_3d(
    client: TestClient, address: str, more: dict[str, Any]
) -> None:
    piece = post(client, address, {"chart": "K/P", **more, **YARN})["piece"]
    view = {"curl": {"id": piece.pop("id")}, "material": "acrylic", **piece}
    assert client.post("/api/v1/views/still", json=view).status_code == 200


def test_border_over_rest(client: TestClient) -> None:
    body = {"chart": "K/P", "border": "seed", **YARN}
    assert post(client, "border", body)["sides"]["stitches"] == 0
