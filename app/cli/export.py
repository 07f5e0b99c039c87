"""``knitcore export``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import chart_argument, check_writable, choice, emit, json_option, resolve_chart
from app.cli.materials import resolve_material
from app.operations.export import ExportFacts, export_facts
from knitcore.formats.chart_files import read_piece
from knitcore.formats.design import DesignFile, read_design
from knitcore.formats.export import ExportKind, ExportOptions, export_chart
from knitcore.formats.knitout import Finish
from knitcore.formats.layout import DesignLayout, layout_fields, layout_of
from knitcore.worked import Construction, Side


@click.command("export")
@chart_argument
@click.option("--to", "kind", required=True, type=choice(ExportKind))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path))
@click.option("--material", help="For sizes and values; otherwise the design's, or acrylic.")
@click.option("--construction", type=choice(Construction), default=Construction.FLAT.value)
@click.option("--first-side", type=choice(Side), default=Side.RS.value, help="Side of row 1.")
@click.option("--finish", type=choice(Finish), default=Finish.WASTE.value, help="Of knitout.")
@click.option("--name", help="Of a design; otherwise the design's own or the file's.")
@click.option("--note", help="Printed on charts; otherwise the design's.")
@click.option("--tex", type=float, help="Linear density of the yarns, for their mass.")
@json_option
def command(
    chart: str,
    size: str | None,
    kind: str,
    out: Path,
    material: str | None,
    construction: str,
    first_side: str,
    finish: str,
    name: str | None,
    note: str | None,
    tex: float | None,
    as_json: bool,
) -> None:
    """Write CHART to a file: knitout is checked on a virtual machine before it is written."""
    check_writable(out, "out")
    stitches = resolve_chart(chart, size)
    path = Path(chart)
    document = (
        read_design(path)
        if path.suffix.lower() == ".json"
        else DesignFile(
            name=out.stem or "Untitled", chart=stitches.text, **layout_fields(_layout(path))
        )
    )
    options = ExportOptions(
        construction=Construction(construction),
        first_side=Side(first_side),
        finish=Finish(finish),
        name=name or document.name,
        note=document.note if note is None else note,
        layout=document,
        linear_density_tex=tex,
    )
    yarn = resolve_material(material or document.material or "acrylic")
    file = export_chart(stitches, ExportKind(kind), yarn, options)
    out.write_bytes(file.content)
    facts = export_facts(stitches, file)
    emit(facts, _text(facts, out), as_json=as_json)


def _layout(path: Path) -> DesignLayout:
    """The outline and the yarns of a file; none of a fabric's name."""
    return layout_of(read_piece(path)) if path.suffix else DesignLayout()


def _text(facts: ExportFacts, out: Path) -> str:
    lines = [f"{out}: {facts.columns} columns x {facts.rows} rows, {facts.bytes} bytes"]
    if facts.transfers is not None:
        lines.append(f"{facts.transfers} transfers")
    if facts.carriers is not None:
        lines.append(f"{facts.carriers} carriers")
    return "\n".join([*lines, *facts.notes])
