"""``knitcore measure bending`` and ``knitcore measure compression``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option
from app.operations.measure import (
    BendingOptions,
    BendingResult,
    CompressionResult,
    bending_of,
    compression_of,
)
from knitcore.measure.compression import PROBE_WIDTH_MM


@click.group("measure")
def command() -> None:
    """Measure a yarn: its bending modulus and its compressibility."""


@command.command("bending")
@click.argument("images", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--linear-density-g-per-m",
    required=True,
    type=float,
    help="Mass per length: weigh some metres; 0.5 g/m is 500 tex.",
)
@click.option(
    "--length-mm",
    "lengths",
    type=float,
    multiple=True,
    help="Hanging length, clamp to free end; once for all images or once per image.",
)
@click.option("--px-per-mm", type=float, help="Scale, if it is known.")
@json_option
def bending(
    images: tuple[Path, ...],
    linear_density_g_per_m: float,
    lengths: tuple[float, ...],
    px_per_mm: float | None,
    as_json: bool,
) -> None:
    """Bending modulus from IMAGES of yarn hanging from a horizontal clamp."""
    options = BendingOptions(
        linear_density_g_per_m=linear_density_g_per_m,
        length_mm=list(lengths) or None,
        px_per_mm=px_per_mm,
    )
    result = bending_of(images, options)
    emit(result, _bending_text(result), as_json=as_json)


def _bending_text(r: BendingResult) -> str:
    lines = [f"{'photo':24} {'B mN·mm²':>9} {'length mm':>10} {'px/mm':>7} {'rms mm':>7}"]
    lines += [
        f"{p.name:24} {1000 * p.bending_modulus_n_mm2:9.2f} {p.length_mm:10.1f} {p.px_per_mm:7.2f}"
        f" {p.rms_mm:7.2f}"
        for p in r.photos
    ]
    spread = "" if r.standard_deviation is None else f" ± {1000 * r.standard_deviation:.3g}"
    error = "" if r.standard_error is None else f" (mean ± {1000 * r.standard_error:.2g})"
    lines.append(f"bending modulus {1000 * r.bending_modulus_n_mm2:.4g}{spread} mN·mm²{error}")
    return "\n".join([*lines, *(f"note: {note}" for note in r.notes)])


@command.command("compression")
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--yarn", help="Only the samples of this yarn (sheets named yarn-number).")
@click.option("--diameter-mm", type=float, help="The yarn's, if the file does not say.")
@click.option("--probe-width-mm", type=float, default=PROBE_WIDTH_MM, show_default=True)
@json_option
def compression(
    files: tuple[Path, ...],
    yarn: str | None,
    diameter_mm: float | None,
    probe_width_mm: float,
    as_json: bool,
) -> None:
    """Constants k and p of the contact law from compression tests (XLS or CSV)."""
    result = compression_of(
        files, yarn=yarn, diameter_mm=diameter_mm, probe_width_mm=probe_width_mm
    )
    emit(result, _compression_text(result), as_json=as_json)


def _compression_text(r: CompressionResult) -> str:
    lines = [f"{'sample':16} {'k mN/mm³':>9} {'p':>7}"]
    lines += [f"{s.name:16} {1000 * s.k_n_per_mm3:9.4g} {s.p:7.3f}" for s in r.samples]
    for m in r.mean.values():
        k_spread, p_spread = m.k_standard_deviation_n_per_mm3, m.p_standard_deviation
        k = "" if k_spread is None else f" ± {1000 * k_spread:.2g}"
        p = "" if p_spread is None else f" ± {p_spread:.2g}"
        lines.append(f"{m.yarn}: k {1000 * m.k_n_per_mm3:.4g}{k} mN/mm³, p {m.p:.3f}{p}")
    return "\n".join([*lines, *(f"note: {note}" for note in r.notes)])
