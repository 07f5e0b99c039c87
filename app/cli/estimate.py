"""``knitcore estimate``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import check_writable, emit, json_option
from app.cli.materials import FILE_KINDS
from app.operations.estimate import (
    EstimateInterval,
    EstimateResult,
    LeftOutResult,
    ModelReport,
    estimate_result,
    estimated_material,
    make_estimate,
    model_report,
)
from knitcore.errors import InputError
from knitcore.estimate.estimate import MeasuredSwatch
from knitcore.fabric import Direction, Fabric
from knitcore.formats.law_files import load_law
from knitcore.materials import load_material_file, material
from knitcore.materials.files import save_material_file


@click.command("estimate")
@click.option("--bending-modulus-n-mm2", type=float, help="B of the yarn (`measure bending`).")
@click.option(
    "--loop-length-mm",
    "lengths",
    multiple=True,
    metavar="MM | FABRIC=MM",
    help="Yarn per stitch of the product: one for all, or once per fabric.",
)
@click.option(
    "--swatch",
    "swatches",
    multiple=True,
    metavar="FABRIC=LAW",
    help="A measured swatch: LAW.json, a material file or a library id.",
)
@click.option(
    "--swatch-loop-length-mm",
    "swatch_lengths",
    multiple=True,
    metavar="MM | FABRIC=MM",
    help="Of the swatches; otherwise as the product's, or as in the material.",
)
@click.option("--swatch-setting", default="", help="Needle or stitch setting of the swatches.")
@click.option("--product-setting", default="", help="Needle or stitch setting of the product.")
@click.option("--out", type=click.Path(path_type=Path), help="Write a material file.")
@click.option("--report", is_flag=True, help="Refit the model and leave one yarn out at a time.")
@json_option
def command(
    bending_modulus_n_mm2: float | None,
    lengths: tuple[str, ...],
    swatches: tuple[str, ...],
    swatch_lengths: tuple[str, ...],
    swatch_setting: str,
    product_setting: str,
    out: Path | None,
    report: bool,
    as_json: bool,
) -> None:
    """Estimate the four fabrics of a yarn that is not in the library."""
    if report:
        found = model_report()
        emit(found, _report_text(found), as_json=as_json)
        return
    if bending_modulus_n_mm2 is None or not lengths:
        raise InputError(
            "bending_modulus_n_mm2",
            "the bending modulus and a loop length are needed.",
            "Measure them: `knitcore measure bending`, and unravel ten stitches.",
        )
    check_writable(out, "out")
    product = _lengths(lengths, "loop_length_mm")
    own = _lengths(swatch_lengths, "swatch_loop_length_mm") if swatch_lengths else {}
    measured = [_swatch(text, own, product, swatch_setting) for text in swatches]
    estimate = make_estimate(bending_modulus_n_mm2, product, measured, product_setting)
    if out is not None:
        identifier = out.stem.lower().replace(" ", "-")
        save_material_file(
            estimated_material(estimate, identifier, bending_modulus_n_mm2, product_setting), out
        )
    result = estimate_result(estimate)
    emit(result, _text(result), as_json=as_json)


def _lengths(texts: tuple[str, ...], field: str) -> dict[Fabric, float]:
    found: dict[Fabric, float] = {}
    for text in texts:
        name, _, number = text.rpartition("=")
        try:
            value = float(number)
        except ValueError:
            raise InputError(field, f"{text!r} is no length.", "Write MM or FABRIC=MM.") from None
        if name:
            found[Fabric.parse(name)] = value
        else:
            found = {fabric: found.get(fabric, value) for fabric in Fabric}
    return found


def _swatch(
    text: str, own: dict[Fabric, float], product: dict[Fabric, float], setting: str
) -> MeasuredSwatch:
    name, separator, source = text.partition("=")
    if not separator:
        raise InputError("swatch", f"{text!r} names no fabric.", "Write FABRIC=LAW.json.")
    fabric = Fabric.parse(name)
    path = Path(source)
    if path.suffix.lower() == ".json" and path.is_file() and '"fabrics"' not in path.read_text():
        file = load_law(path)
        law, length, known, curves = file.law, None, "", file.curves
    else:
        is_file = path.suffix.lower() in FILE_KINDS
        record = (load_material_file(path) if is_file else material(source)).record(fabric)
        law, length, known = record.law, record.loop_length_mm, record.setting
        curves = record.measured
    length = own.get(fabric) or length or product.get(fabric)
    if length is None:
        raise InputError(
            "swatch_loop_length_mm", f"is missing for {fabric}.", "Unravel ten stitches."
        )
    return MeasuredSwatch(fabric, law, length, setting or known, curves)


def _text(r: EstimateResult) -> str:
    lines = ["extension at 0.1 N/mm (90 % interval), then Young's modulus in N/mm"]
    for fabric, f in r.fabrics.items():
        kind = " (measured)" if f.measured else ""
        for d in Direction:
            strain = _percent(f.strain_at_0_1_n_per_mm[d])
            modulus = f.modulus_n_per_mm[d]
            lines.append(
                f"{fabric + kind:22} {d:6} {strain:24} {modulus.value:.4f}"
                f" ({modulus.low:.4f} to {modulus.high:.4f})"
            )
    if r.left_out is not None:
        lines += ["", _left_out_text(r.left_out)]
    return "\n".join([*lines, *(f"warning: {w}" for w in r.warnings)])


def _percent(e: EstimateInterval) -> str:
    return f"{e.value:.0%} ({e.low:.0%} to {e.high:.0%})"


def _left_out_text(r: LeftOutResult) -> str:
    measured = " and ".join(r.measured) or "nothing"
    return (
        f"yarns left out, {measured} measured: extension within a factor {r.strain_rms_factor:.2f}"
        f" (rms), moduli {r.modulus_rms_factor:.2f} ({r.modulus_within_two:.0%} within two);"
        f" 90 % intervals cover {r.strain_coverage:.0%} and {r.modulus_coverage:.0%}"
        f" of {r.values} values"
    )


def _report_text(r: ModelReport) -> str:
    lines = [f"{r.yarns} yarns; K in Y = K B / L³, alpha, beta (N/mm)"]
    lines += [
        f"{fabric:12} {d:6} {r.modulus_constant[fabric][d]:8.0f}"
        f" {r.alpha[fabric][d]:7.3f} {r.beta_n_per_mm[fabric][d]:8.4f}"
        for fabric in Fabric
        for d in Direction
    ]
    return "\n".join([*lines, "", *(_left_out_text(found) for found in r.left_out)])
