"""A file format: punch cards of 24 stitches for hand-operated machines."""

from knitcore.base.errors import InputError
from knitcore.formats.write.export import Exporter, ExportOptions
from knitcore.garment.piece import Piece
from knitcore.materials import Material

STITCHES = 24


def exporters() -> list[Exporter]:
    """The house's formats."""
    return [
        Exporter(
            identifier="punchcard",
            suffix=".txt",
            media_type="text/plain; charset=utf-8",
            write=punchcard,
            notes=("A hole (o) is a purl; feed the card from its top line.",),
        )
    ]


def punchcard(piece: Piece, material: Material, options: ExportOptions) -> bytes:
    """Lines of holes, the first row of the chart first."""
    del material
    if not piece.is_rectangle or STITCHES % piece.chart.repeat().columns:
        raise InputError(
            "chart",
            f"a punch card repeats every {STITCHES} stitches.",
            f"Give a rectangle whose repeat divides {STITCHES}.",
        )
    card = piece.chart.repeat().resized(piece.chart.rows, STITCHES)
    lines = ["".join("o" if purl else "." for purl in row) for row in card.purl]
    return "\n".join([f"# {options.name}", *lines, ""]).encode()
