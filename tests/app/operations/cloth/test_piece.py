"""Cut pieces over REST and on the command line."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.context import Context
from app.operations.cloth.piece import PieceRequest, piece
from tests.app.command_line import refused, run

PIECE: dict[str, Any] = {
    "outline": [[0, 0], [50, 0], [50, 80], [25, 60], [0, 80]],
    "holes": [[[20, 20], [30, 20], [25, 35]]],
    "grain_deg": 30,
    "edges": {"hem": [1], "top": [3, 4], "hole": [6, 7, 8]},
    "conditions": [
        {"kind": "held", "edge": "hem"},
        {"kind": "pulled", "edge": "top", "x_n": 0.1, "y_n": 1.0},
        {"kind": "sewn", "edge": "hole", "stiffness_n": 5.0},
    ],
}
ASKED = {"chart": "K", "material": "acrylic", "steps": 2, "mesh_mm": 10}


def loaded(**more: Any) -> PieceRequest:
    """A request with a piece that is changed so."""
    return PieceRequest.model_validate(ASKED | {"piece": PIECE | more, "fields": True})


def test_a_piece_is_loaded(context: Context) -> None:
    result = piece(loaded(), context)
    assert result.converged
    assert result.share == [0.5, 1.0]
    hem, top, hole = result.edges
    assert (hem.force_x_n[-1], hem.force_y_n[-1]) == pytest.approx((-0.1, -1.0))
    assert (top.force_y_n[-1], top.force_y_interval_n) == (1.0, ([0.5, 1.0], [0.5, 1.0]))
    assert top.moved_y_mm[-1] > 2.5 * hole.moved_y_mm[-1] > 0
    low, high = np.array(top.moved_y_interval_mm)
    assert np.all(low < top.moved_y_mm)
    assert np.all((low > 0) & (top.moved_y_mm < high))
    assert result.shape is not None
    assert len(result.shape.elements) == len(result.shape.strain_wale) == result.elements
    assert len(result.shape.moved_mm) == len(result.shape.corners_mm)


def test_the_command_line_reads_a_piece_and_writes_results(
    tmp_path: Path, context: Context
) -> None:
    file, out = tmp_path / "piece.json", tmp_path / "out.csv"
    file.write_text(json.dumps(PIECE))
    options = "--material", "acrylic", "--steps", "2", "--mesh-mm", "10"
    edges = run("piece", "stockinette", "--piece", file, "--out", out, *options)["edges"]
    assert edges[0]["force_y_n"] == pytest.approx(piece(loaded(), context).edges[0].force_y_n)
    assert np.genfromtxt(out, delimiter=",", names=True)["top_y_n"] == pytest.approx([0.5, 1.0])


@pytest.mark.parametrize(
    ("written", "says"),
    [("{", "JSON"), ('{"outline": [[0, 0], [1, 0]]}', "outline"), (None, "No such file")],
)
def test_a_file_that_is_not_a_piece_is_refused(
    tmp_path: Path, written: str | None, says: str
) -> None:
    file = tmp_path / "piece.json"
    if written is not None:
        file.write_text(written)
    assert says in refused("piece", "garter", "--piece", file, "--material", "acrylic")


def test_cloth_past_its_lock_up_is_reported(context: Context) -> None:
    conditions = [{"kind": "held", "edge": "hem"}, {"kind": "held", "edge": "top", "y_mm": 90}]
    result = piece(loaded(conditions=conditions, grain_deg=0), context)
    assert result.utilisation > 0.98
    assert any("run out of stretch" in message for message in result.messages)
