"""Pictures of every kind become charts."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageOps

from knitcore import InputError, StitchChart
from knitcore.formats.read.chart_files import Aspect, PictureReading
from knitcore.formats.read.picture import read_picture
from knitcore.formats.write.png import write_png
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart

PURL = np.random.default_rng(1).random((12, 16)) < 0.4


def toned(purl: object, knit: object, kind: object = np.uint8) -> Image.Image:
    """The chart in two tones or colours."""
    tones = np.where(PURL[..., None], purl, knit).astype(kind)  # type: ignore[call-overload]
    return Image.fromarray(tones[..., 0] if tones.shape[-1] == 1 else tones)


def drawn() -> Image.Image:
    """The chart with cells of 20 pixels and lines between them."""
    tones = np.kron(np.where(PURL, 60, 220), np.ones((20, 20))).astype(np.uint8)
    tones[::20] = tones[:, ::20] = 0
    return Image.fromarray(np.pad(tones, (0, 1)))


def sheet(sign: str, line: int, grey: int = 0) -> Image.Image:
    """The chart with cells of 24 pixels and lines between them, numbers beside it, a title."""
    rows, columns = PURL.shape
    image = Image.new("L", (24 * columns + 90, 24 * rows + 100), 255)
    pen = ImageDraw.Draw(image)
    for row, column in np.argwhere(PURL):
        x, y = 30 + 24 * int(column), 40 + 24 * int(row)
        if sign == "cell":
            pen.rectangle([x, y, x + 24, y + 24], fill=60)
        elif sign == "dot":
            pen.ellipse([x + 6, y + 6, x + 18, y + 18], fill=0)
        else:
            pen.line([x + 6, y + 12, x + 18, y + 12], fill=0, width=3)
    for row in range(rows + 1):
        pen.line([30, 40 + 24 * row, 30 + 24 * columns, 40 + 24 * row], fill=grey, width=line)
        pen.text((30 + 24 * columns + 8, 46 + 24 * row), str(rows - row), fill=0)
    for column in range(columns + 1):
        x = 30 + 24 * column
        pen.line([x, 40, x, 40 + 24 * rows], fill=grey, width=line)
    pen.text((30, 10), "Chart A", fill=0)
    return image


def read(image: Image.Image, file: Path, scale: PictureReading | None = None) -> tuple[Piece, str]:
    """The piece of a picture after it was saved, and its notes."""
    image.save(file)
    piece, notes = read_picture(file, scale)
    return piece, " ".join(notes)


@pytest.mark.parametrize(
    ("image", "suffix", "note"),
    [
        (toned(0, 255), "png", ""),
        (toned(0, 255).convert("1"), "png", ""),
        (toned(0, 255).convert("RGB").quantize(4), "png", ""),
        (toned(0, 255), "bmp", ""),
        (toned(20, 230), "webp", ""),
        (toned(1000, 1200, np.uint16), "png", "#050505 is read as knit, the darker #040404"),
        (toned(0, 2_000_000, np.int32), "tif", ""),
        (toned(0.1, 0.9, np.float32), "tif", ""),
        (toned((255, 182, 193), (255, 255, 255)), "png", "#ffffff is read as knit"),
        (toned(5, 40), "png", "the darker #050505 as purl"),
        (toned((200, 30, 30), (30, 130, 40)), "png", "the darker #c81e1e as purl"),
        (toned((0, 0, 0, 255), (0, 0, 0, 0)), "png", "Transparent pixels are read as knits"),
        (drawn(), "png", "A grid of 16 x 12 cells is seen"),
        (drawn(), "jpg", "A grid of 16 x 12 cells is seen"),
        (ImageOps.expand(drawn(), 40, 255), "png", "A grid of 16 x 12 cells is seen"),
        (ImageOps.expand(drawn(), 13, 200), "png", "A grid of 16 x 12 cells is seen"),
        (ImageOps.expand(toned(0, 255).resize((256, 192), 0), 21, 255), "png", "plain border"),
        (sheet("cell", 1), "png", "around the frame of the grid"),
        (sheet("cell", 3), "jpg", "around the frame of the grid"),
        (sheet("cell", 1, grey=150), "png", "around the frame of the grid"),
        (sheet("dot", 1), "png", "around the frame of the grid"),
        (sheet("dash", 2), "jpg", "around the frame of the grid"),
    ],
)
def test_two_tones_or_colours_part_knits_from_purls(
    image: Image.Image, suffix: str, note: str, tmp_path: Path
) -> None:
    piece, notes = read(image, tmp_path / f"chart.{suffix}")
    assert np.array_equal(piece.chart.purl[::-1], PURL)
    assert notes == "" if not note else note in notes


def test_a_turned_photo_is_turned_back(tmp_path: Path) -> None:
    image = toned(0, 255)
    exif = image.getexif()
    exif[274] = 6
    image.save(tmp_path / "chart.png", exif=exif)
    piece, _ = read_picture(tmp_path / "chart.png")
    assert np.array_equal(piece.chart.purl[::-1], np.rot90(PURL, -1))


@pytest.mark.parametrize(("tone", "kind"), [(240, "knits"), (20, "purls")])
def test_one_colour_is_told_even_with_noise(tone: int, kind: str, tmp_path: Path) -> None:
    noise = np.random.default_rng(0).normal(tone, 4, (30, 30))
    piece, notes = read(Image.fromarray(noise.clip(0, 255).astype(np.uint8)), tmp_path / "a.png")
    assert f"one colour, so all stitches are {kind}" in notes
    assert piece.chart.purl.all() == (kind == "purls")


@pytest.mark.parametrize(
    ("scale", "size", "note"),
    [
        (PictureReading(columns=32), (32, 24), "24 rows keep"),
        (PictureReading(rows=6), (8, 6), "8 columns keep"),
        (PictureReading(16, None, Aspect.AS_KNITTED, 0.75), (16, 16), "0.75 times as high as wide"),
        (PictureReading(None, None, Aspect.AS_KNITTED, 0.75), (16, 16), "A grid"),
        (PictureReading(16, 24), (16, 24), "stretch the picture 2.00 times"),
        (PictureReading(16, 24, Aspect.FREE), (16, 24), ""),
    ],
)
def test_proportions_are_kept(
    scale: PictureReading, size: tuple[int, int], note: str, tmp_path: Path
) -> None:
    piece, notes = read(drawn(), tmp_path / "chart.png", scale)
    assert (piece.chart.columns, piece.chart.rows) == size
    assert note in notes


@pytest.mark.parametrize(
    ("scale", "says"),
    [
        (PictureReading(columns=16, aspect=Aspect.FREE), "needed for a free aspect"),
        (PictureReading(columns=16, aspect=Aspect.AS_KNITTED), "not known"),
    ],
)
def test_a_size_that_does_not_follow_is_refused(
    scale: PictureReading, says: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=says):
        read(drawn(), tmp_path / "chart.png", scale)


@pytest.mark.parametrize(
    ("reading", "dark"),
    [
        (PictureReading(light_is_purl=True), ~PURL),
        (PictureReading(dark_below=1), np.zeros_like(PURL)),
        (PictureReading(dark_below=1, light_is_purl=True), np.ones_like(PURL)),
    ],
)
def test_tones_are_parted_as_it_is_said(
    reading: PictureReading, dark: np.ndarray, tmp_path: Path
) -> None:
    piece, _ = read(toned(20, 230), tmp_path / "chart.png", reading)
    assert np.array_equal(piece.chart.purl[::-1], dark)


def test_notes_follow_light_purls(tmp_path: Path) -> None:
    light = PictureReading(light_is_purl=True)
    assert read(toned(5, 40), tmp_path / "a.png", light)[1].endswith("the lighter #282828 as purl.")
    plain = toned(240, 240)
    assert "all stitches are purls: it is light" in read(plain, tmp_path / "b.png", light)[1]


def test_rows_of_blocks_without_lines_are_all_counted(tmp_path: Path) -> None:
    """Welts, of which only every second border goes across, and a motif in between."""
    purl = np.arange(16)[:, None] // 2 % 2 + np.zeros((1, 12)) > 0
    purl[5, 3:6] = purl[10, 7:9] = True
    tones = np.kron(np.where(purl, 20, 230), np.ones((12, 12))).astype(np.uint8)
    assert (read(Image.fromarray(tones), tmp_path / "c.png")[0].chart.purl[::-1] == purl).all()


def test_pixels_that_are_stitches_are_told_and_a_photo_has_none(tmp_path: Path) -> None:
    tones = np.random.default_rng(2).integers(0, 2, (90, 120)).astype(np.uint8) * 255
    piece, notes = read(Image.fromarray(tones), tmp_path / "chart.png")
    assert (piece.chart.rows, piece.chart.columns) == (90, 120)
    assert "Each of 120 x 90 pixels is a stitch" in notes
    with pytest.raises(InputError, match="a photo has no pixel for a stitch"):
        read(Image.fromarray(tones), tmp_path / "chart.jpg")


def test_a_large_picture_without_a_grid_needs_a_width(tmp_path: Path) -> None:
    noise = np.random.default_rng(0).integers(0, 255, (1200, 1100)).astype(np.uint8)
    with pytest.raises(InputError, match="no grid is seen"):
        read(Image.fromarray(noise), tmp_path / "chart.png")


def test_a_picture_of_this_library_keeps_outline_and_yarns(tmp_path: Path) -> None:
    shaped = ShapedChart.parse("KPKK\nPPKP", ".xx.\nxxxx")
    yarns = PieceYarn("cream", "#efe9dd"), PieceYarn("navy", "#1f3b70")
    piece = Piece(shaped, yarns, np.array([[0, 0, 1, 1], [0, 0, 1, 0]]))
    file = tmp_path / "own.png"
    file.write_bytes(write_png(piece))
    assert read_picture(file) == (piece, ())
    assert "yarns are lost: it is scaled" in read_picture(file, PictureReading(columns=8))[1][0]
    with Image.open(file) as image:
        saved = image.convert("RGBA")
    saved.save(file)
    _, notes = read_picture(file)
    assert "an outline is not taken" in " ".join(notes)


def test_blocks_of_a_small_chart_of_this_library_are_not_taken_for_a_grid(tmp_path: Path) -> None:
    basket = StitchChart.parse("KP\nPK")
    big = StitchChart(np.kron(basket.purl, np.ones((10, 10))).astype(bool))
    file = tmp_path / "own.png"
    file.write_bytes(write_png(big))
    assert read_picture(file)[0].chart == big
