import io
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from knitcore import InputError, StitchChart
from knitcore.formats.read.chart_files import read_noted_chart

CHART = StitchChart.parse("KKP\nPPK")


def png(mode: str, side: int) -> bytes:
    buffer = io.BytesIO()
    Image.new(mode, (side, side)).save(buffer, "PNG")
    return buffer.getvalue()


def test_png_has_dark_purls_and_the_top_row_first(tmp_path: Path) -> None:
    file = tmp_path / "chart.png"
    Image.fromarray(np.where(CHART.purl[::-1], 20, 240).astype(np.uint8)).save(file)
    assert read_noted_chart(file)[0] == CHART


def test_transparent_pixels_are_knits(tmp_path: Path) -> None:
    file = tmp_path / "chart.png"
    Image.new("RGBA", (3, 2), (0, 0, 0, 0)).save(file)
    assert not read_noted_chart(file)[0].purl.any()


def test_a_program_under_another_name(tmp_path: Path) -> None:
    file = tmp_path / "chart.txt"
    file.write_text("; by hand\nin 1\ntuck - f2 1\ntuck - f1 1\nknit + f1 1\nknit + f2 1\n")
    assert read_noted_chart(file)[0].text == "KK"


def test_design_file(tmp_path: Path) -> None:
    file = tmp_path / "chart.json"
    file.write_text(json.dumps({"format": "knitcore-design", "version": 2, "chart": CHART.text}))
    assert read_noted_chart(file)[0] == CHART


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("chart.doc", b"KP", "not of a kind that holds a chart"),
        ("chart.txt", b"\xff\xfe\x00", "not UTF-8"),
        ("chart.png", b"no picture", "not a readable PNG"),
        ("chart.png", png("L", 40)[:40], "not a readable PNG"),
        ("chart.png", png("1", 5000), "too large"),  # which is seen before it is decoded
        ("chart.json", b"{", "not valid JSON"),
        ("chart.json", b"[1]", "not a design"),
        ("chart.json", b'{"format": "knitcore-design", "version": 99}', "version 99"),
        ("chart.json", b'{"format": "knitcore-design", "version": 2}', "no chart text"),
    ],
)
def test_files_that_are_not_what_they_claim(
    tmp_path: Path, name: str, content: bytes, says: str
) -> None:
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(InputError, match=says):
        read_noted_chart(file)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        read_noted_chart(tmp_path / "none.txt")
