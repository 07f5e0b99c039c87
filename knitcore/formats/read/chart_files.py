"""Reading a chart from a file of any kind that holds one."""

import codecs
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart, as_stitches, stitches_in_text
from knitcore.formats.designs.design_file import read_design
from knitcore.formats.read.parent_loops import is_parent_loops, read_parent_loops
from knitcore.formats.read.text_chart import read_text_chart
from knitcore.formats.read.written_reader import looks_written, read_noted_rows
from knitcore.garment.piece import Piece
from knitcore.machine.knitout_machine import looks_like_program

MAX_FILE_BYTES = 16_000_000
_PICTURES = (".png", ".jpg", ".jpeg", ".gif", ".bmp", ".tif", ".tiff", ".webp")


@dataclass(frozen=True)
class PieceInFile:
    """The piece in a file, without what is not of it, such as a program's waste.

    Attributes
    ----------
    piece : the face, its outline and its yarns.
    notes : what was left out or taken in one of several ways, and warnings.
    """

    piece: Piece
    notes: tuple[str, ...] = ()

    @property
    def chart(self) -> StitchChart:
        """The face grid."""
        return self.piece.chart


@dataclass(frozen=True)
class StitchesInFile:
    """The content of a file that may have other stitches than knits and purls.

    Attributes
    ----------
    content : a piece of knits and purls, or a chart that has other stitches.
    notes : as those of :class:`PieceInFile`.
    """

    content: Piece | SymbolChart
    notes: tuple[str, ...] = ()

    @property
    def stitches(self) -> StitchChart | SymbolChart:
        """The chart."""
        return self.content.chart if isinstance(self.content, Piece) else self.content


class Aspect(StrEnum):
    """How the height of a scaled picture follows from its width.

    ``keep`` counts stitches as squares, ``as-knitted`` as wide and high as they are knitted;
    ``free`` takes rows and columns as they are given.
    """

    KEEP = "keep"
    AS_KNITTED = "as-knitted"
    FREE = "free"


@dataclass(frozen=True)
class PictureReading:
    """How a picture becomes a chart.

    Attributes
    ----------
    columns, rows : stitches; of the two, one may follow from the other. None: as in the picture.
    aspect : how it follows.
    stitch_ratio : height over width of a knitted stitch, for ``as-knitted``.
    dark_below : grey below which a stitch is dark, 0 to 255. None: what parts the stitches best.
    light_is_purl : whether the light stitches are the purls, not the dark ones.
    """

    columns: int | None = None
    rows: int | None = None
    aspect: Aspect = Aspect.KEEP
    stitch_ratio: float | None = None
    dark_below: float | None = None
    light_is_purl: bool = False


@in_reading_time
def read_noted_chart(path: str | Path) -> tuple[StitchChart, tuple[str, ...]]:
    """The chart in a file, and the notes of the reader; cells outside its outline, if it has one,
    have no meaning.

    Parameters
    ----------
    path : as for :func:`read_noted_piece`.

    Raises
    ------
    InputError
        As :func:`read_noted_piece`, but for an outline in several parts.
    """
    file = Path(path)
    if is_design(file):
        return read_design(_checked(file)).to_chart(), ()
    content = read_noted_piece(file)
    return content.chart, content.notes


@in_reading_time
def read_noted_stitches(path: str | Path) -> tuple[StitchChart | SymbolChart, tuple[str, ...]]:
    """The chart in a file that may have lace, cables, slips and tucks, and the notes of the reader.

    Parameters
    ----------
    path : as for :func:`read_noted_piece`, or ``.stitches.json``, loops with their parents
        (:mod:`knitcore.formats.read.parent_loops`).

    Raises
    ------
    InputError
        As :func:`read_noted_chart`.
    """
    file = Path(path)
    if is_design(file):
        return read_design(_checked(file)).to_stitches(), ()
    read = read_any_stitches(file)
    return read.stitches, read.notes


def is_design(file: Path) -> bool:
    """Tell whether a file is a design by its name, and not loops with their parents."""
    return file.suffix.lower() == ".json" and not is_parent_loops(_text(_checked(file))[0])


@in_reading_time
def read_noted_piece(path: str | Path, reading: PictureReading | None = None) -> PieceInFile:
    """The chart in a file, with its outline and its yarns, and the notes of the reader.

    Parameters
    ----------
    path : ``.txt`` (a chart of letters or signs, written rows or KnitSpeak), ``.ks`` (KnitSpeak), a
        picture such as ``.png`` (one pixel a stitch, or a drawn grid), ``.json`` (a design) or
        ``.k`` / ``.knitout`` (a knitout program).
    reading : how a picture becomes a chart; nothing to other files.

    Raises
    ------
    InputError
        If the file is missing, too large, of another kind, has other stitches than knits and
        purls, or its content does not match its name.
    """
    read = read_any_stitches(path, reading)
    return PieceInFile(Piece.of(read.content), read.notes)


@in_reading_time
def read_any_stitches(path: str | Path, reading: PictureReading | None = None) -> StitchesInFile:
    """Read a piece of knits and purls, or a chart that has other stitches.

    Parameters are those of :func:`read_noted_piece`.

    Raises
    ------
    InputError
        If the file is missing, too large, of another kind, or its content does not match its name.
    """
    file = _checked(Path(path))
    if file.suffix.lower() in _PICTURES:
        from knitcore.formats.read.picture import read_picture  # needs Pillow

        return StitchesInFile(*read_picture(file, reading))
    return _READERS[file.suffix.lower()](file)


def _checked(file: Path) -> Path:
    if not file.is_file():
        what = "is a folder, not a file" if file.is_dir() else "does not exist"
        raise InputError("chart", f"{file} {what}.", "Check the name and the folder.")
    if file.suffix.lower() not in (*_READERS, *_PICTURES):
        raise InputError(
            "chart",
            f"{file.name} is not of a kind that holds a chart.",
            "Use a .txt file of K/P lines or written rows, a .ks file of KnitSpeak, a .png with one"
            " pixel per stitch, a .json design or a .k knitout program.",
        )
    if file.stat().st_size > MAX_FILE_BYTES:
        raise InputError(
            "chart", f"{file.name} is too large.", f"Use at most {MAX_FILE_BYTES // 10**6} MB."
        )
    return file


def _read_text(file: Path) -> StitchesInFile:
    text, notes = _text(file)
    if looks_like_program(text):
        return _read_knitout(file)
    if text.lstrip().startswith("{"):
        return _read_design(file)
    if looks_written(text):
        piece, said = read_noted_rows(text)
        return StitchesInFile(piece, (*notes, *said))
    if (stitches := stitches_in_text(text)) is not None:
        return StitchesInFile(stitches, notes)
    chart, said = read_text_chart(text)
    return StitchesInFile(Piece.plain(chart), (*notes, *said))


def _read_rows(file: Path) -> StitchesInFile:
    text, notes = _text(file)
    piece, said = read_noted_rows(text)
    return StitchesInFile(piece, (*notes, *said))


def _read_design(file: Path) -> StitchesInFile:
    text, notes = _text(file)
    if is_parent_loops(text):
        chart, said = read_parent_loops(text)
        content = as_stitches(chart)
        piece = Piece.plain(content) if isinstance(content, StitchChart) else content
        return StitchesInFile(piece, (*notes, *said))
    design = read_design(file)
    stitches = design.to_stitches()
    return StitchesInFile(stitches if isinstance(stitches, SymbolChart) else design.to_piece())


def _read_knitout(file: Path) -> StitchesInFile:
    from knitcore.formats.read.knitout_reader import knitted_stitches

    text, notes = _text(file)
    knitted = knitted_stitches(text)
    return StitchesInFile(knitted.content, (*notes, *knitted.notes))


def _text(file: Path) -> tuple[str, tuple[str, ...]]:
    """The text of a file without a byte order mark, and a note if it is not in UTF-8."""
    content = file.read_bytes()
    is_utf_16 = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        text = content.decode("utf-16" if is_utf_16 else "utf-8-sig")
    except UnicodeDecodeError:
        try:
            text = content.decode("cp1252")
        except UnicodeDecodeError:
            text = "\0"
        if is_utf_16 or any(sign < " " and not sign.isspace() for sign in text):
            raise InputError(
                "chart", f"{file.name} is not UTF-8 text.", "Save it as plain text."
            ) from None
        return text, ("The text is not in UTF-8: it is read as Windows-1252.",)
    return text, ()


_READERS: dict[str, Callable[[Path], StitchesInFile]] = {
    ".txt": _read_text,
    ".ks": _read_rows,
    ".json": _read_design,
    ".k": _read_knitout,
    ".knitout": _read_knitout,
}
