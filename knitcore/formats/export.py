"""One door to all files that a chart can become."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.extensions import Group, offered, running
from knitcore.formats import (
    chart_drawing,
    design,
    knitout_reader,
    knitspeak,
    png,
    report,
    stitch_values,
    written,
    yarn_mesh,
)
from knitcore.formats.chart_key import ChartStyle, RegionMark, RepeatMark
from knitcore.formats.knitout import Finish
from knitcore.formats.layout import (
    DesignLayout,
    DesignRepeat,
    Placement,
    layout_fields,
    motif_chart,
    piece_of,
    region_cells,
)
from knitcore.garment.piece import Piece
from knitcore.garment.regions import yarn_use
from knitcore.geometry.lattice import flat_lattice
from knitcore.materials import Material
from knitcore.worked import Construction, Side


class ExportKind(StrEnum):
    """Formats for export."""

    KNITOUT = "knitout"
    KNITSPEAK = "knitspeak"
    PNG = "png"
    SVG = "svg"
    PDF = "pdf"
    REPORT = "report"
    TEXT = "text"
    WRITTEN = "written"
    DESIGN = "design"
    GLB = "glb"
    STL = "stl"
    VTU = "vtu"
    CSV = "csv"


SUFFIXES = {
    ExportKind.KNITOUT: (".k", "text/plain; charset=utf-8"),
    ExportKind.KNITSPEAK: (".ks", "text/plain; charset=utf-8"),
    ExportKind.PNG: (".png", "image/png"),
    ExportKind.SVG: (".svg", "image/svg+xml"),
    ExportKind.PDF: (".pdf", "application/pdf"),
    ExportKind.REPORT: (".pdf", "application/pdf"),
    ExportKind.TEXT: (".txt", "text/plain; charset=utf-8"),
    ExportKind.WRITTEN: (".txt", "text/plain; charset=utf-8"),
    ExportKind.DESIGN: (".json", "application/json"),
    ExportKind.GLB: (".glb", "model/gltf-binary"),
    ExportKind.STL: (".stl", "model/stl"),
    ExportKind.VTU: (".vtu", "application/xml"),
    ExportKind.CSV: (".csv", "text/csv; charset=utf-8"),
}
"""Usual suffix and media type of each kind."""


RECTANGULAR_KINDS = frozenset({ExportKind.TEXT, ExportKind.KNITSPEAK})
"""Formats that do not know "no stitch"."""
COLOURLESS_KINDS = frozenset(
    {ExportKind.TEXT, ExportKind.KNITSPEAK, ExportKind.GLB, ExportKind.STL}
)
"""Formats that do not know yarns."""


@dataclass(frozen=True)
class ExportOptions:
    """How a chart is worked and finished, where that matters.

    Attributes
    ----------
    construction : flat or round, for charts and written rows.
    first_side : the side of row 1 in flat knitting.
    finish : how a knitout program ends.
    name : of the design.
    note : printed on charts, and kept in the project file.
    layout : outline, regions and their yarns, and what else the project file keeps.
    linear_density_tex : of the yarns, for their mass.
    """

    construction: Construction = Construction.FLAT
    first_side: Side = Side.RS
    finish: Finish = Finish.WASTE
    name: str = "Untitled"
    note: str = ""
    layout: DesignLayout = field(default_factory=DesignLayout)
    linear_density_tex: float | None = None


@dataclass(frozen=True)
class ExportedFile:
    """The content of a file, and the checks made.

    Attributes
    ----------
    kind : which format.
    content : the bytes.
    notes : for the user.
    transfers : loops moved between beds, of a knitout program.
    carriers : yarn carriers, of a knitout program.
    ends : suffix and media type of an extension's format.
    """

    kind: str
    content: bytes
    notes: tuple[str, ...] = field(default=())
    transfers: int | None = None
    carriers: int | None = None
    ends: tuple[str, str] | None = None

    @property
    def suffix(self) -> str:
        """Usual end of the file's name."""
        return (self.ends or SUFFIXES[ExportKind(self.kind)])[0]

    @property
    def media_type(self) -> str:
        """For HTTP."""
        return (self.ends or SUFFIXES[ExportKind(self.kind)])[1]


@dataclass(frozen=True)
class Exporter:
    """A format of an extension (:mod:`knitcore.extensions`).

    Attributes
    ----------
    identifier : the name of the format.
    suffix, media_type : of its files, such as ``.txt`` and ``text/plain; charset=utf-8``.
    write : the content of a file; may raise InputError for a piece that the format cannot hold.
    notes : for the user, about every file.
    """

    identifier: str
    suffix: str
    media_type: str
    write: Callable[[Piece, Material, ExportOptions], bytes]
    notes: tuple[str, ...] = ()


def exporters() -> dict[str, Exporter]:
    """Formats of extensions.

    Warns
    -----
    knitcore.extensions.ExtensionWarning
        Of every extension that cannot be used.
    """
    return offered(Group.EXPORTERS, Exporter, set(ExportKind))


def export_chart(
    chart: StitchChart,
    kind: ExportKind | str,
    material: Material,
    options: ExportOptions | None = None,
) -> ExportedFile:
    """A chart as a file.

    Parameters
    ----------
    chart : the face grid.
    kind : the format, or the name of an extension's.
    material : gives the stitches their size and their values.
    options : see there.

    Raises
    ------
    InputError
        If there is no such format, the chart is too wide for the machine or too large for a mesh,
        or has an outline that this format cannot hold.
    ExtensionError
        If an extension's format fails.
    KnitoutMismatchError
        If a knitout program does not knit its chart on the virtual machine.
    """
    options = options or ExportOptions()
    piece = piece_of(chart, options.layout)
    if kind not in set(ExportKind):
        return _by_extension(piece, kind, material, options)
    kind = ExportKind(kind)
    if kind in RECTANGULAR_KINDS and not piece.is_rectangle:
        known = ", ".join(k for k in ExportKind if k not in RECTANGULAR_KINDS)
        raise InputError(
            "to",
            f"{kind} cannot hold a chart with an outline, and its stitches must not be made up.",
            f"Export {known}, or a rectangular part.",
        )
    file = _WRITERS[kind](piece, material, options)
    if kind in COLOURLESS_KINDS and len(piece.yarns) > 1:
        return replace(file, notes=(*file.notes, f"{kind} has no colours: the yarns are left out."))
    return file


def _by_extension(
    piece: Piece, kind: str, material: Material, options: ExportOptions
) -> ExportedFile:
    found = exporters()
    if kind not in found:
        known = ", ".join([*ExportKind, *found])
        raise InputError("to", f"{kind!r} is no format.", f"Use one of {known}.")
    exporter = found[kind]
    with running(Group.EXPORTERS, kind):
        content = bytes(exporter.write(piece, material, options))
    ends = exporter.suffix, exporter.media_type
    return ExportedFile(kind, content, exporter.notes, ends=ends)


_Writer = Callable[[Piece, Material, ExportOptions], ExportedFile]

_LOCAL = ("Local values come from the quarter-cell composite: the stretched, flat fabric.",)
_DRAWN = ("A drawn loop on the flat lattice, not a relaxed yarn.",)


def _knitout(piece: Piece, _: Material, options: ExportOptions) -> ExportedFile:
    program = knitout_reader.verified(piece, finish=options.finish)
    notes = ["Knitted on a virtual V-bed machine: the face is this chart."]
    if not piece.is_rectangle:
        notes.append(f"{program.shaping_transfers} further transfers shape the edges.")
    if program.carriers > 1:
        notes.append(
            f"Intarsia with {program.carriers} carriers: "
            + "; ".join(f"{y.name} ({y.colour})" for y in piece.yarns)
            + "."
        )
    return ExportedFile(
        ExportKind.KNITOUT,
        program.text.encode(),
        tuple(notes),
        transfers=program.transfers,
        carriers=program.carriers,
    )


def _svg(piece: Piece, material: Material, options: ExportOptions) -> ExportedFile:
    drawing = chart_drawing.chart_svg(piece, _style(piece, material, options))
    return ExportedFile(ExportKind.SVG, drawing.encode())


def _pdf(piece: Piece, material: Material, options: ExportOptions) -> ExportedFile:
    drawing = chart_drawing.chart_pdf(piece, _style(piece, material, options))
    return ExportedFile(ExportKind.PDF, drawing)


def _report(piece: Piece, material: Material, options: ExportOptions) -> ExportedFile:
    style = _style(piece, material, options)
    pages = report.design_report(piece, material, options.name, style, options.layout.regions)
    return ExportedFile(ExportKind.REPORT, pages)


def _written(piece: Piece, _: Material, options: ExportOptions) -> ExportedFile:
    rows = written.write_rows(piece, options.construction, first_side=options.first_side)
    return ExportedFile(ExportKind.WRITTEN, rows.encode())


def _knitspeak(piece: Piece, _: Material, options: ExportOptions) -> ExportedFile:
    rows = knitspeak.write_knitspeak(
        piece.chart, options.construction, first_side=options.first_side
    )
    return ExportedFile(ExportKind.KNITSPEAK, rows.encode())


def _design(piece: Piece, material: Material, options: ExportOptions) -> ExportedFile:
    document = design.DesignFile(
        name=options.name,
        material=material.identifier,
        chart=piece.chart.text,
        note=options.note,
        **layout_fields(options.layout),
    )
    return ExportedFile(ExportKind.DESIGN, design.write_design(document).encode())


def _glb(piece: Piece, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.GLB, yarn_mesh.write_glb(piece, material), _DRAWN)


def _stl(piece: Piece, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.STL, yarn_mesh.write_stl(piece, material), _DRAWN)


def _vtu(piece: Piece, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.VTU, stitch_values.write_vtu(piece, material), _LOCAL)


def _csv(piece: Piece, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.CSV, stitch_values.write_csv(piece, material).encode(), _LOCAL)


def _style(piece: Piece, material: Material, options: ExportOptions) -> ChartStyle:
    sizes = flat_lattice(piece.chart, material).sizes_mm.mean(axis=(0, 1))
    aspect = min(max(float(sizes[1] / sizes[0]), 0.2), 5.0)
    facts = _yarn_facts(piece, material, options) if len(piece.yarns) > 1 else ()
    marks = tuple(
        RepeatMark(_repeat_words(repeat), tuple(_place(place) for place in repeat.placements))
        for repeat in options.layout.repeats
        if repeat.placements
    )
    regions = tuple(
        RegionMark(region.name, region.colour, region_cells(region, *piece.chart.purl.shape))
        for region in options.layout.regions
        if not region.hidden
    )
    return ChartStyle(
        options.construction,
        options.first_side,
        aspect,
        facts,
        marks,
        options.note,
        options.name,
        regions,
    )


def _place(place: Placement) -> tuple[int, int, int, int]:
    return place.row, place.column, place.rows, place.columns


def _repeat_words(repeat: DesignRepeat) -> str:
    motif = motif_chart(repeat.motif)
    stitches = f"multiple of {motif.columns}" + _plus(repeat.edge_columns)
    rows = f"multiple of {motif.rows}" + _plus(repeat.edge_rows)
    return f"{repeat.name}: {stitches} sts, {rows} rows"


def _plus(edge: int) -> str:
    return f" + {edge}" if edge else ""


def _yarn_facts(piece: Piece, material: Material, options: ExportOptions) -> tuple[str, ...]:
    """Stitches, length and mass of each yarn, as far as the material knows its loops."""
    facts = []
    for index in range(len(piece.yarns)):
        cells = piece.cells(index)
        said = f"{int(cells.sum())} sts"
        try:
            use = yarn_use(
                piece.shaped, material, linear_density_tex=options.linear_density_tex, cells=cells
            )
        except InputError:  # the material has no loop length: stitches must do
            facts.append(said)
            continue
        mass = "" if use.mass_g is None else f", {use.mass_g:.1f} g"
        facts.append(f"{said}, {use.length_m:.1f} m{mass}")
    return tuple(facts)


_WRITERS: dict[ExportKind, _Writer] = {
    ExportKind.KNITOUT: _knitout,
    ExportKind.PNG: lambda piece, _, __: ExportedFile(ExportKind.PNG, png.write_png(piece)),
    ExportKind.SVG: _svg,
    ExportKind.PDF: _pdf,
    ExportKind.REPORT: _report,
    ExportKind.TEXT: lambda p, _, __: ExportedFile(ExportKind.TEXT, f"{p.chart.text}\n".encode()),
    ExportKind.WRITTEN: _written,
    ExportKind.KNITSPEAK: _knitspeak,
    ExportKind.DESIGN: _design,
    ExportKind.GLB: _glb,
    ExportKind.STL: _stl,
    ExportKind.VTU: _vtu,
    ExportKind.CSV: _csv,
}
