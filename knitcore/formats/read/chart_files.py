"""Reading a chart from a file of any kind that holds one."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.designs.design_file import read_design
from knitcore.formats.read.knitspeak import looks_knitspeak, read_knitspeak
from knitcore.formats.read.written_reader import looks_written, read_piece_rows
from knitcore.garment.piece import Piece

MAX_FILE_BYTES = 16_000_000


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


def read_chart(path: str | Path) -> StitchChart:
    """The chart in a file; cells outside its outline, if it has one, have no meaning.

    Parameters
    ----------
    path : as for :func:`read_noted_piece`.

    Raises
    ------
    InputError
        As :func:`read_noted_piece`, but for an outline in several parts.
    """
    return read_noted_chart(path)[0]


def read_noted_chart(path: str | Path) -> tuple[StitchChart, tuple[str, ...]]:
    """Read a file as :func:`read_chart` does, with the notes of the reader."""
    file = Path(path)
    if file.suffix.lower() == ".json":
        return read_design(_checked(file)).to_chart(), ()
    content = read_noted_piece(file)
    return content.chart, content.notes


def read_noted_piece(path: str | Path) -> PieceInFile:
    """The chart in a file, with its outline and its yarns, and the notes of the reader.

    Parameters
    ----------
    path : ``.txt`` (K/P lines, written rows or KnitSpeak), ``.ks`` (KnitSpeak), ``.png`` (one
        pixel a stitch), ``.json`` (a design) or ``.k`` / ``.knitout`` (a knitout program).

    Raises
    ------
    InputError
        If the file is missing, too large, of another kind, or its content does not match its name.
    """
    file = _checked(Path(path))
    content = _READERS[file.suffix.lower()](file)
    return content if isinstance(content, PieceInFile) else PieceInFile(content)


def _checked(file: Path) -> Path:
    if not file.is_file():
        what = "is a folder, not a file" if file.is_dir() else "does not exist"
        raise InputError("chart", f"{file} {what}.", "Check the name and the folder.")
    if file.suffix.lower() not in _READERS:
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


def _read_text(file: Path) -> Piece | PieceInFile:
    text = _text(file)
    if text.lstrip("\ufeff").startswith(";!knitout"):
        return _read_knitout(file)
    if looks_knitspeak(text):
        return Piece.plain(read_knitspeak(text))
    return read_piece_rows(text) if looks_written(text) else Piece.plain(StitchChart.parse(text))


def _read_knitout(file: Path) -> PieceInFile:
    from knitcore.formats.read.knitout_reader import knitted_chart

    return knitted_chart(_text(file))


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise InputError(
            "chart", f"{file.name} is not UTF-8 text.", "Save it as plain text."
        ) from None


def _picture(file: Path) -> Piece:
    from knitcore.formats.read.png import read_png_piece  # needs Pillow, which texts do not

    return read_png_piece(file)


_READERS: dict[str, Callable[[Path], Piece | PieceInFile]] = {
    ".txt": _read_text,
    ".ks": lambda file: Piece.plain(read_knitspeak(_text(file))),
    ".png": _picture,
    ".json": lambda file: read_design(file).to_piece(),
    ".k": _read_knitout,
    ".knitout": _read_knitout,
}
