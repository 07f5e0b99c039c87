"""One door to all files that a chart can become."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.formats import (
    chart_drawing,
    design,
    knitout_reader,
    png,
    report,
    stitch_values,
    written,
    yarn_mesh,
)
from knitcore.formats.knitout import Finish
from knitcore.garment.shaped import ShapedChart
from knitcore.geometry.lattice import flat_lattice
from knitcore.materials import Material
from knitcore.worked import Construction, Side


class ExportKind(StrEnum):
    """What a chart can be exported to."""

    KNITOUT = "knitout"
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


SHAPED_KINDS = (ExportKind.SVG, ExportKind.PDF, ExportKind.DESIGN)
"""Formats that know "no stitch"."""


@dataclass(frozen=True)
class ExportOptions:
    """How a chart is worked and finished, where that matters.

    Attributes
    ----------
    construction : flat or round, for charts and written rows.
    first_side : the side of row 1 in flat knitting.
    finish : how a knitout program ends.
    name : of the design.
    outline : lines of ``x`` and ``.`` (see :class:`knitcore.garment.shaped.ShapedChart`), or None
        for a rectangle.
    """

    construction: Construction = Construction.FLAT
    first_side: Side = Side.RS
    finish: Finish = Finish.WASTE
    name: str = "Untitled"
    outline: str | None = None


@dataclass(frozen=True)
class ExportedFile:
    """A file's content, and what was checked.

    Attributes
    ----------
    kind : which format.
    content : the bytes.
    notes : what a user should know.
    transfers : loops moved between beds, of a knitout program.
    """

    kind: ExportKind
    content: bytes
    notes: tuple[str, ...] = field(default=())
    transfers: int | None = None

    @property
    def suffix(self) -> str:
        """Usual end of the file's name."""
        return SUFFIXES[self.kind][0]

    @property
    def media_type(self) -> str:
        """For HTTP."""
        return SUFFIXES[self.kind][1]


def export_chart(
    chart: StitchChart,
    kind: ExportKind,
    material: Material,
    options: ExportOptions | None = None,
) -> ExportedFile:
    """A chart as a file.

    Parameters
    ----------
    chart : the face grid.
    kind : the format.
    material : gives the stitches their size and their values.
    options : see there.

    Raises
    ------
    InputError
        If the chart is too wide for the machine or too large for a mesh, or has an outline that
        this format cannot hold.
    KnitoutMismatchError
        If a knitout program does not knit its chart on the virtual machine.
    """
    options = options or ExportOptions()
    if options.outline is not None and kind not in SHAPED_KINDS:
        known = ", ".join(SHAPED_KINDS)
        raise InputError(
            "to",
            f"{kind} cannot hold a chart with an outline, and its stitches must not be made up.",
            f"Export {known}, or a rectangular part.",
        )
    return _WRITERS[kind](chart, material, options)


_Writer = Callable[[StitchChart, Material, ExportOptions], ExportedFile]

_LOCAL = ("Local values come from the quarter-cell composite: the stretched, flat fabric.",)
_DRAWN = ("A drawn loop on the flat lattice, not a relaxed yarn.",)


def _knitout(chart: StitchChart, _: Material, options: ExportOptions) -> ExportedFile:
    program = knitout_reader.verified(chart, finish=options.finish)
    note = "Knitted on a virtual V-bed machine: the face is this chart."
    return ExportedFile(
        ExportKind.KNITOUT, program.text.encode(), (note,), transfers=program.transfers
    )


def _svg(chart: StitchChart, material: Material, options: ExportOptions) -> ExportedFile:
    drawing = chart_drawing.chart_svg(_shaped(chart, options), _style(chart, material, options))
    return ExportedFile(ExportKind.SVG, drawing.encode())


def _pdf(chart: StitchChart, material: Material, options: ExportOptions) -> ExportedFile:
    drawing = chart_drawing.chart_pdf(_shaped(chart, options), _style(chart, material, options))
    return ExportedFile(ExportKind.PDF, drawing)


def _report(chart: StitchChart, material: Material, options: ExportOptions) -> ExportedFile:
    pages = report.design_report(chart, material, options.name, _style(chart, material, options))
    return ExportedFile(ExportKind.REPORT, pages)


def _written(chart: StitchChart, _: Material, options: ExportOptions) -> ExportedFile:
    rows = written.write_rows(chart, options.construction, first_side=options.first_side)
    return ExportedFile(ExportKind.WRITTEN, rows.encode())


def _design(chart: StitchChart, material: Material, options: ExportOptions) -> ExportedFile:
    document = design.DesignFile(
        name=options.name,
        material=material.identifier,
        chart=chart.text,
        outline=options.outline,
    )
    return ExportedFile(ExportKind.DESIGN, design.write_design(document).encode())


def _glb(chart: StitchChart, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.GLB, yarn_mesh.write_glb(chart, material), _DRAWN)


def _stl(chart: StitchChart, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.STL, yarn_mesh.write_stl(chart, material), _DRAWN)


def _vtu(chart: StitchChart, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.VTU, stitch_values.write_vtu(chart, material), _LOCAL)


def _csv(chart: StitchChart, material: Material, _: ExportOptions) -> ExportedFile:
    return ExportedFile(ExportKind.CSV, stitch_values.write_csv(chart, material).encode(), _LOCAL)


def _shaped(chart: StitchChart, options: ExportOptions) -> ShapedChart:
    if options.outline is None:
        return ShapedChart.rectangle(chart)
    return ShapedChart.parse(chart.text, options.outline)


def _style(
    chart: StitchChart, material: Material, options: ExportOptions
) -> chart_drawing.ChartStyle:
    sizes = flat_lattice(chart, material).sizes_mm.mean(axis=(0, 1))
    aspect = min(max(float(sizes[1] / sizes[0]), 0.2), 5.0)
    return chart_drawing.ChartStyle(options.construction, options.first_side, aspect)


_WRITERS: dict[ExportKind, _Writer] = {
    ExportKind.KNITOUT: _knitout,
    ExportKind.PNG: lambda chart, _, __: ExportedFile(ExportKind.PNG, png.write_png(chart)),
    ExportKind.SVG: _svg,
    ExportKind.PDF: _pdf,
    ExportKind.REPORT: _report,
    ExportKind.TEXT: lambda c, _, __: ExportedFile(ExportKind.TEXT, f"{c.text}\n".encode()),
    ExportKind.WRITTEN: _written,
    ExportKind.DESIGN: _design,
    ExportKind.GLB: _glb,
    ExportKind.STL: _stl,
    ExportKind.VTU: _vtu,
    ExportKind.CSV: _csv,
}
