"""``knitcore export``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import chart_argument, check_writable, choice, emit, json_option, resolve_chart
from app.cli.materials import resolve_material
from app.operations.export import ExportFacts, export_facts
from knitcore.formats.design import read_design
from knitcore.formats.export import ExportKind, ExportOptions, export_chart
from knitcore.formats.knitout import Finish
from knitcore.worked import Construction, Side


@click.command("export")
@chart_argument
@click.option("--to", "kind", required=True, type=choice(ExportKind))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path))
@click.option("--material", default="acrylic", show_default=True, help="For sizes and values.")
@click.option("--construction", type=choice(Construction), default=Construction.FLAT.value)
@click.option("--first-side", type=choice(Side), default=Side.RS.value, help="Side of row 1.")
@click.option("--finish", type=choice(Finish), default=Finish.WASTE.value, help="Of knitout.")
@click.option("--name", help="Of a design; otherwise the file's.")
@json_option
def command(
    chart: str,
    size: str | None,
    kind: str,
    out: Path,
    material: str,
    construction: str,
    first_side: str,
    finish: str,
    name: str | None,
    as_json: bool,
) -> None:
    """Write CHART to a file: knitout is checked on a virtual machine before it is written."""
    check_writable(out, "out")
    stitches = resolve_chart(chart, size)
    path = Path(chart)
    is_design = path.suffix.lower() == ".json"
    options = ExportOptions(
        Construction(construction),
        Side(first_side),
        Finish(finish),
        name or out.stem or "Untitled",
        read_design(path).outline if is_design else None,
    )
    file = export_chart(stitches, ExportKind(kind), resolve_material(material), options)
    out.write_bytes(file.content)
    facts = export_facts(stitches, file)
    emit(facts, _text(facts, out), as_json=as_json)


def _text(facts: ExportFacts, out: Path) -> str:
    lines = [f"{out}: {facts.columns} columns x {facts.rows} rows, {facts.bytes} bytes"]
    if facts.transfers is not None:
        lines.append(f"{facts.transfers} transfers")
    return "\n".join([*lines, *facts.notes])
