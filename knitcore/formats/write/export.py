"""All files that a chart can be written to."""

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from enum import StrEnum

from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.base.extensions import Group, offered, running
from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart, as_stitches
from knitcore.draw.laid_out import mean_stitch_mm
from knitcore.formats.designs.design_file import DesignFile, check_bare, write_design
from knitcore.formats.designs.layout import DesignLayout, DesignRepeat, piece_of, region_cells
from knitcore.formats.read.knitout_reader import verified
from knitcore.formats.write.chart_drawing import chart_pdf, chart_svg
from knitcore.formats.write.chart_key import (
    ChartStyle,
    RegionMark,
    RepeatMark,
    Symbols,
    multiple_words,
)
from knitcore.formats.write.drawn_page import Page, letters_lacking, to_long_svg, to_pdf
from knitcore.formats.write.knitspeak import write_knitspeak
from knitcore.formats.write.pattern import pattern_pages
from knitcore.formats.write.png import write_grey, write_png
from knitcore.formats.write.report import design_report
from knitcore.formats.write.sheets.card_sheet import card_pages
from knitcore.formats.write.sheets.plan_sheet import plan_pages
from knitcore.formats.write.stitch_values import write_csv, write_vtu
from knitcore.formats.write.written_pattern import write_rows
from knitcore.formats.write.yarn_mesh import looped_mesh, mesh_file, yarn_mesh
from knitcore.garment.piece import Piece
from knitcore.garment.regions import YarnUse, yarn_use
from knitcore.machine.home.ayab import ayab_picture
from knitcore.machine.home.hand_plan import hand_plan
from knitcore.machine.home.plan_rows import HandPlan
from knitcore.machine.home.punch_card import punch_card
from knitcore.machine.profile import MachineProfile, machine_of
from knitcore.machine.program import Finish
from knitcore.machine.setting import MachineSetting, setting_of
from knitcore.machine.stitch_program import stitches_from_row
from knitcore.materials import Material
from knitcore.materials.yarn_per_stitch import (
    YARN_OF_FLOAT,
    YARN_OF_TUCK,
    MeasuredYarn,
    yarn_of_acts,
)
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Prediction
from knitcore.prediction.size import RelaxedSize


class ExportKind(StrEnum):
    """Formats for export."""

    KNITOUT = "knitout"
    KNITSPEAK = "knitspeak"
    PNG = "png"
    SVG = "svg"
    PDF = "pdf"
    HAND_PLAN = "hand-plan"
    HAND_PLAN_TEXT = "hand-plan-text"
    AYAB = "ayab"
    PUNCH_CARD = "punch-card"
    PUNCH_CARD_TEXT = "punch-card-text"
    PATTERN = "pattern"
    PATTERN_SVG = "pattern-svg"
    REPORT = "report"
    TEXT = "text"
    WRITTEN = "written"
    DESIGN = "design"
    GLB = "glb"
    STL = "stl"
    VTU = "vtu"
    CSV = "csv"


@dataclass(frozen=True)
class ExportOptions:
    """Options of an export: how the chart is worked, finished and drawn.

    Attributes
    ----------
    construction : flat or round, for charts and written rows.
    first_side : the side of row 1 in flat knitting.
    finish : how a knitout program ends.
    stitch_number : of a knitout program; that of the machine's profile if none is given.
    name : of the design.
    note : printed on charts, and kept in the project file.
    layout : outline, regions and their yarns, the machine, and what else the project file keeps.
    linear_density_tex : of the yarns, for their mass.
    symbols : of knits and purls in printed charts.
    from_row : at which a program, or the plan of a home machine, begins after a break or a jam.
    photo : a PNG picture of the cloth, for the first page of a pattern.
    gauge : relaxed size of the mean stitch, if known.
    measured_yarn : yarn in a stitch of this piece, if known.
    """

    construction: Construction = Construction.FLAT
    first_side: Side = Side.RS
    finish: Finish = Finish.WASTE
    stitch_number: float | None = None
    name: str = "Untitled"
    note: str = ""
    layout: DesignLayout = field(default_factory=DesignLayout)
    linear_density_tex: float | None = None
    photo: bytes | None = None
    gauge: RelaxedSize | None = None
    measured_yarn: MeasuredYarn | None = None
    symbols: Symbols = Symbols.DOTS
    from_row: int = 1


@dataclass(frozen=True)
class ExportedFile:
    """The content of a file, and the checks made.

    Attributes
    ----------
    kind : the format's name.
    content : the bytes.
    suffix, media_type : of the file.
    notes : for the user.
    transfers : loops moved between beds, of a knitout program.
    carriers : yarn carriers, of a knitout program.
    """

    kind: str
    content: bytes
    suffix: str
    media_type: str
    notes: tuple[str, ...] = ()
    transfers: int | None = None
    carriers: int | None = None


Content = str | bytes | ExportedFile


@dataclass(frozen=True)
class Exporter:
    """A format: built in, or that of an extension (:mod:`knitcore.base.extensions`).

    Attributes
    ----------
    identifier : the name of the format.
    suffix, media_type : of its files, such as ``.txt`` and ``text/plain; charset=utf-8``.
    write : the content of a file, a text in UTF-8 or bytes, or the file with notes of its own; may
        raise InputError for a piece that the format cannot hold.
    notes : for the user, about every file.
    holds_outlines : whether it can hold "no stitch"; other charts are refused.
    holds_yarns : whether it can hold several yarns; they are left out otherwise, with a note.
    write_stitches : as ``write``, for a chart that has other stitches than knits and purls; None
        if the format cannot hold them.
    """

    identifier: str
    suffix: str
    media_type: str
    write: Callable[[Piece, Material, ExportOptions], Content]
    notes: tuple[str, ...] = ()
    holds_outlines: bool = True
    holds_yarns: bool = True
    write_stitches: Callable[[SymbolChart, Material, ExportOptions], Content] | None = None


def exporters() -> dict[str, Exporter]:
    """Formats of extensions.

    Warns
    -----
    knitcore.base.extensions.ExtensionWarning
        Of every extension that cannot be used.
    """
    return offered(Group.EXPORTERS, Exporter, set(ExportKind))


def export_chart(
    chart: StitchChart | SymbolChart,
    kind: ExportKind | str,
    material: Material,
    options: ExportOptions | None = None,
) -> ExportedFile:
    """A chart as a file.

    Parameters
    ----------
    chart : the face grid, of knits and purls or of any stitches.
    kind : the format, or the name of an extension's.
    material : gives the stitches their size and their values.
    options : see :class:`ExportOptions`.

    Raises
    ------
    InputError
        If there is no such format, the chart is too wide for the machine or too large for a mesh,
        or has an outline or stitches that this format cannot hold.
    ExtensionError
        If an extension's format fails.
    KnitoutMismatchError
        If a knitout program does not knit its chart on the virtual machine.
    """
    options = options or ExportOptions()
    exporter = FORMATS.get(kind) or _of_extension(kind)
    stitches = as_stitches(chart)
    if isinstance(stitches, SymbolChart):
        return _finished(exporter, _written_stitches(exporter, stitches, material, options))
    piece = replace(piece_of(stitches, options.layout), gauge=options.gauge)
    if not exporter.holds_outlines and not piece.is_rectangle:
        known = ", ".join(name for name, built_in in FORMATS.items() if built_in.holds_outlines)
        problem = f"{kind} cannot hold an outline: the cells outside it would become stitches."
        raise InputError("to", problem, f"Export {known}, or a rectangular part.")
    with nullcontext() if kind in FORMATS else running(Group.EXPORTERS, kind):
        content = exporter.write(piece, material, options)
    notes = exporter.notes
    if not exporter.holds_yarns and len(piece.yarns) > 1:
        notes = (*notes, f"{kind} has no colours: the yarns are left out.")
    if exporter.media_type == _PDF[1]:
        names = [
            *(region.name for region in options.layout.regions),
            *(y.name for y in piece.yarns),
        ]
        texts = [options.name, options.note, material.name, *names]
        if lacking := letters_lacking(texts):
            remedy = "write them in Latin, Greek or Cyrillic letters, or export SVG"
            notes = (*notes, f"The PDF cannot show these letters well: {lacking[:40]} ({remedy}).")
    return _finished(exporter, content, notes)


def _written_stitches(
    exporter: Exporter, chart: SymbolChart, material: Material, options: ExportOptions
) -> Content:
    """The content of a file with other stitches than knits and purls."""
    check_bare(options.layout)
    if exporter.write_stitches is None:
        known = ", ".join(name for name, built_in in FORMATS.items() if built_in.write_stitches)
        problem = f"{exporter.identifier} holds knits and purls only."
        raise InputError("to", problem, f"Export {known}, or give a chart of K and P.")
    return exporter.write_stitches(chart, material, options)


def _finished(exporter: Exporter, content: Content, notes: tuple[str, ...] = ()) -> ExportedFile:
    if isinstance(content, ExportedFile):
        return content
    data = content.encode() if isinstance(content, str) else bytes(content)
    return ExportedFile(exporter.identifier, data, exporter.suffix, exporter.media_type, notes)


def _of_extension(kind: str) -> Exporter:
    extra = exporters()
    if kind not in extra:
        known = ", ".join([*FORMATS, *extra])
        raise InputError("to", f"{kind!r} is not a format.", f"Use one of {known}.")
    return extra[kind]


def _knitout_of_stitches(
    chart: SymbolChart, material: Material, options: ExportOptions
) -> ExportedFile:
    return _knitout(stitches_from_row(chart, options.from_row), material, options)


def _knitout(
    chart: Piece | SymbolChart, material: Material, options: ExportOptions
) -> ExportedFile:
    machine = machine_of(options.layout.machine)
    piece = (
        chart.from_row(options.from_row) if isinstance(chart, Piece) else Piece.plain(chart.plain)
    )
    setting = _setting(piece, machine, material, options)
    program = verified(
        piece if isinstance(chart, Piece) else chart,
        finish=options.finish,
        machine=machine,
        stitch_number=setting.number,
        yarn=setting.yarn,
        looser=setting.looser,
    )
    notes = [
        f"Made for {machine.name}. {setting.note}",
        "Knitted on a virtual V-bed machine: the face is this chart.",
        *program.notes,
        *program.steps,
    ]
    if options.from_row > 1:
        notes.append(
            f"It begins with row {options.from_row} on a cast-on of its own: hold row "
            f"{options.from_row - 1} on waste yarn, and graft the two."
        )
    if not piece.is_rectangle:
        notes.append(f"{program.shaping_transfers} further transfers shape the edges.")
    if program.carriers > 1:
        yarns = "; ".join(f"{y.name} ({y.colour})" for y in piece.yarns)
        notes.append(f"Intarsia with {program.carriers} carriers: {yarns}.")
    if program.draws_waste:
        notes.append("All other carriers hold yarns: waste yarn takes the place of a draw thread.")
    figures = program.transfers, program.carriers
    return ExportedFile(
        ExportKind.KNITOUT, program.text.encode(), ".k", _TEXT, tuple(notes), *figures
    )


def _setting(
    piece: Piece, machine: MachineProfile, material: Material, options: ExportOptions
) -> MachineSetting:
    return setting_of(
        piece,
        machine,
        material,
        stitch_number=options.stitch_number,
        linear_density_tex=options.linear_density_tex,
        measured=options.measured_yarn,
    )


def _hand_plan(piece: Piece, material: Material, options: ExportOptions) -> ExportedFile:
    plan, notes = _planned(piece, material, options)
    content = to_pdf(plan_pages(plan, options.name), options.name)
    return ExportedFile(ExportKind.HAND_PLAN, content, *_PDF, notes)


def _hand_plan_text(piece: Piece, material: Material, options: ExportOptions) -> ExportedFile:
    plan, notes = _planned(piece, material, options)
    text = f"{options.name}\n{plan.text}"
    return ExportedFile(ExportKind.HAND_PLAN_TEXT, text.encode(), *_TXT, notes)


def _planned(
    piece: Piece, material: Material, options: ExportOptions
) -> tuple[HandPlan, tuple[str, ...]]:
    machine = _home(options)
    plan = hand_plan(piece, machine)
    setting = _setting(piece, machine, material, options)
    plan = replace(plan, notes=(setting.note, *plan.notes)).resumed(options.from_row)
    if options.construction is Construction.ROUND:
        return plan, (*plan.notes, plan.time, "The plan is worked flat: join the sides.")
    return plan, (*plan.notes, plan.time)


def _home(options: ExportOptions, usual: str = "brother") -> MachineProfile:
    """The design's machine, or the usual one of a format."""
    return machine_of(options.layout.machine or usual)


def _ayab(piece: Piece, _: Material, options: ExportOptions) -> ExportedFile:
    picture = ayab_picture(piece, _home(options, "ayab"))
    content = write_grey(picture.grey)
    return ExportedFile(ExportKind.AYAB, content, ".png", "image/png", picture.notes)


def _punch_card(piece: Piece, _: Material, options: ExportOptions) -> ExportedFile:
    card = punch_card(piece, _home(options))
    content = to_pdf(card_pages(card, options.name), options.name)
    return ExportedFile(ExportKind.PUNCH_CARD, content, *_PDF, card.notes)


def _punch_card_text(piece: Piece, _: Material, options: ExportOptions) -> ExportedFile:
    card = punch_card(piece, _home(options))
    return ExportedFile(ExportKind.PUNCH_CARD_TEXT, card.text.encode(), *_TXT, card.notes)


def _report(chart: Piece | SymbolChart, material: Material, options: ExportOptions) -> bytes:
    piece, style, prediction = _shown(chart, material, options)
    words = _yarn_words(chart, material, options)
    regions = options.layout.regions
    return design_report(piece, material, options.name, style, regions, words, prediction)


def _pattern(
    chart: Piece | SymbolChart, material: Material, options: ExportOptions
) -> tuple[Page, ...]:
    piece, style, prediction = _shown(chart, material, options)
    facts = _yarn_facts(piece, chart, material, options)
    words = _yarn_words(chart, material, options)
    return pattern_pages(piece, material, style, facts, options.photo, words, prediction)


def _shown(
    chart: Piece | SymbolChart, material: Material, options: ExportOptions
) -> tuple[Piece, ChartStyle, Prediction | None]:
    """A piece, how it is drawn, and its prediction if it is no piece of knits and purls.

    A chart of other stitches is the piece of its purl map, as large as it is with all of them.
    """
    if isinstance(chart, Piece):
        return chart, _style(chart, material, options), None
    prediction = predict(chart, material, options.gauge)
    size = RelaxedSize(prediction.relaxed_course_mm, prediction.relaxed_wale_mm)
    piece = replace(Piece.plain(chart.plain), gauge=size)
    return piece, replace(_style(piece, material, options), stitches=chart), prediction


def _solid(chart: Piece | SymbolChart, material: Material, scale: float, kind: str) -> bytes:
    if isinstance(chart, Piece):
        return mesh_file(yarn_mesh(chart, material), scale, kind)
    return mesh_file(looped_mesh(chart, material), scale, kind)


def _knitspeak(chart: Piece | SymbolChart, _: Material, options: ExportOptions) -> str:
    rows = chart.chart if isinstance(chart, Piece) else chart
    return write_knitspeak(rows, options.construction, first_side=options.first_side)


def _written(chart: Piece | SymbolChart, _: Material, options: ExportOptions) -> str:
    return write_rows(chart, options.construction, first_side=options.first_side)


def _text(chart: Piece | SymbolChart, _: Material, __: ExportOptions) -> str:
    return f"{chart.chart.text if isinstance(chart, Piece) else chart.text}\n"


def _design(chart: Piece | SymbolChart, material: Material, options: ExportOptions) -> str:
    document = DesignFile(
        name=options.name,
        material=material.identifier,
        chart=chart.chart.text if isinstance(chart, Piece) else chart.text,
        note=options.note,
        **{name: getattr(options.layout, name) for name in DesignLayout.model_fields},
    )
    return write_design(document)


def _style(piece: Piece, material: Material, options: ExportOptions) -> ChartStyle:
    width, height = mean_stitch_mm(piece.shaped, material, piece.gauge)
    aspect = min(max(float(height / width), 0.2), 5.0)
    facts = _yarn_facts(piece, piece, material, options) if len(piece.yarns) > 1 else ()
    marks = tuple(_repeat_mark(repeat) for repeat in options.layout.repeats if repeat.placements)
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
        options.symbols,
    )


def _repeat_mark(repeat: DesignRepeat) -> RepeatMark:
    motif = StitchChart.parse(repeat.motif)
    words = f"{repeat.name}: {multiple_words(motif, repeat.edge_columns, repeat.edge_rows)}"
    return RepeatMark(words, tuple((p.row, p.column, p.rows, p.columns) for p in repeat.placements))


def _yarn_facts(
    piece: Piece, chart: Piece | SymbolChart, material: Material, options: ExportOptions
) -> tuple[str, ...]:
    """Stitches, length and mass of each yarn, as far as the material knows its loops."""
    facts = []
    for index in range(len(piece.yarns)):
        cells = piece.cells(index)
        said = f"{int(cells.sum())} sts"
        use = _yarn_use(chart, material, options, cells)
        if use is not None:
            mass = "" if use.mass_g is None else f", {use.mass_g:.1f} g"
            said = f"{said}, {use.length_m:.1f} m{mass}"
        facts.append(said)
    return tuple(facts)


def _yarn_words(
    chart: Piece | SymbolChart, material: Material, options: ExportOptions
) -> tuple[str, ...]:
    """Say how much yarn the piece takes, if its loops are known."""
    use = _yarn_use(chart, material, options)
    return () if use is None else (f"In all {use}, by {use.source}.",)


def _yarn_use(
    chart: Piece | SymbolChart,
    material: Material,
    options: ExportOptions,
    cells: Mask | None = None,
) -> YarnUse | None:
    """Yarn of some stitches; None if neither the material nor the options have a loop length.

    Other stitches than knits and purls take their parts of a knit's yarn, on average.
    """
    piece = chart if isinstance(chart, Piece) else Piece.plain(chart.plain)
    try:
        use = yarn_use(
            piece.shaped, material, linear_density_tex=options.linear_density_tex, cells=cells,
            size=piece.gauge, measured=options.measured_yarn,
        )  # fmt: skip
    except InputError:
        return None
    part = 1.0 if isinstance(chart, Piece) else float(yarn_of_acts(chart.graph).mean())
    if part == 1.0:
        return use
    return replace(
        use,
        length_m=part * use.length_m,
        mass_g=None if use.mass_g is None else part * use.mass_g,
        source=f"{use.source}, with {YARN_OF_TUCK:g} of a knit in a tuck and {YARN_OF_FLOAT:g} in "
        "a slip, which are guesses",
    )


_TEXT = "text/plain; charset=utf-8"
_TXT, _PDF = (".txt", _TEXT), (".pdf", "application/pdf")
_SVG = ".svg", "image/svg+xml"
_GLB, _STL = (".glb", "model/gltf-binary"), (".stl", "model/stl")
_CSV = ".csv", "text/csv; charset=utf-8"
_LOCAL = ("Local values come from the quarter-cell composite: the stretched, flat fabric.",)
_DRAWN = ("Loops are drawn schematically; the yarn was not simulated.",)

_BUILT_IN = (
    Exporter(ExportKind.KNITOUT, ".k", _TEXT, _knitout, write_stitches=_knitout_of_stitches),
    Exporter(
        ExportKind.KNITSPEAK,
        ".ks",
        _TEXT,
        _knitspeak,
        holds_outlines=False,
        holds_yarns=False,
        write_stitches=_knitspeak,
    ),
    Exporter(
        ExportKind.PNG,
        ".png",
        "image/png",
        lambda p, _, __: write_png(p),
        write_stitches=lambda c, _, __: write_png(c),
    ),
    Exporter(
        ExportKind.SVG,
        *_SVG,
        lambda p, m, o: chart_svg(p, _style(p, m, o)),
        write_stitches=lambda c, m, o: chart_svg(c, _shown(c, m, o)[1]),
    ),
    Exporter(
        ExportKind.PDF,
        *_PDF,
        lambda p, m, o: chart_pdf(p, _style(p, m, o)),
        write_stitches=lambda c, m, o: chart_pdf(c, _shown(c, m, o)[1]),
    ),
    Exporter(
        ExportKind.PATTERN,
        *_PDF,
        lambda p, m, o: to_pdf(_pattern(p, m, o), o.name),
        write_stitches=lambda c, m, o: to_pdf(_pattern(c, m, o), o.name),
    ),
    Exporter(
        ExportKind.PATTERN_SVG,
        *_SVG,
        lambda p, m, o: to_long_svg(_pattern(p, m, o), o.name),
        write_stitches=lambda c, m, o: to_long_svg(_pattern(c, m, o), o.name),
    ),
    Exporter(ExportKind.REPORT, *_PDF, _report, write_stitches=_report),
    Exporter(ExportKind.HAND_PLAN, *_PDF, _hand_plan),
    Exporter(ExportKind.HAND_PLAN_TEXT, *_TXT, _hand_plan_text),
    Exporter(ExportKind.AYAB, ".png", "image/png", _ayab),
    Exporter(ExportKind.PUNCH_CARD, *_PDF, _punch_card),
    Exporter(ExportKind.PUNCH_CARD_TEXT, *_TXT, _punch_card_text),
    Exporter(
        ExportKind.TEXT, *_TXT, _text, holds_outlines=False, holds_yarns=False, write_stitches=_text
    ),
    Exporter(ExportKind.WRITTEN, *_TXT, _written, write_stitches=_written),
    Exporter(ExportKind.DESIGN, ".json", "application/json", _design, write_stitches=_design),
    Exporter(
        ExportKind.GLB,
        *_GLB,
        lambda p, m, _: _solid(p, m, 0.001, "glb"),
        _DRAWN,
        holds_yarns=False,
        write_stitches=lambda c, m, _: _solid(c, m, 0.001, "glb"),
    ),
    Exporter(
        ExportKind.STL,
        *_STL,
        lambda p, m, _: _solid(p, m, 1.0, "stl"),
        _DRAWN,
        holds_yarns=False,
        write_stitches=lambda c, m, _: _solid(c, m, 1.0, "stl"),
    ),
    Exporter(ExportKind.VTU, ".vtu", "application/xml", lambda p, m, _: write_vtu(p, m), _LOCAL),
    Exporter(ExportKind.CSV, *_CSV, lambda p, m, _: write_csv(p, m), _LOCAL),
)
FORMATS = {exporter.identifier: exporter for exporter in _BUILT_IN}
"""Built-in formats by name."""
