"""``knitcore characterise``."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import click

from app.cli.common import choice, json_option
from app.cli.materials import resolve_material
from app.operations.characterise import (
    CharacterisedFabric,
    CharacteriseOptions,
    CharacteriseResult,
    FabricRow,
    YarnInput,
    characterise,
    plan_of,
)
from knitcore.batch import BatchProgress
from knitcore.errors import InputError
from knitcore.fabric import Fabric
from knitcore.materials.files import save_material_file
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.relax import Branch
from knitcore.yarnlibrary.lawfit import MAX_STRESS_N_PER_MM

Item = TypeVar("Item")

FINISHED = "finished"
"""Folder of finished stitches within the results, from which a stopped batch goes on."""


@click.command("characterise")
@click.argument("materials", nargs=-1, metavar="[MATERIAL]...")
@click.option("--yarn", metavar="NAME", help="A yarn by the five numbers below instead.")
@click.option("--bending-modulus-n-mm2", type=float, help="B of --yarn, N·mm².")
@click.option("--contact-stiffness-n-per-mm3", type=float, help="k of --yarn, N/mm³.")
@click.option("--contact-exponent", type=float, help="p of --yarn.")
@click.option("--radius-mm", type=float, help="Outer radius of --yarn.")
@click.option("--core-radius-mm", type=float, help="Core radius of --yarn.")
@click.option("--fabrics", metavar="A,B", help="Pure fabrics; all four if left out.")
@click.option("--loop-lengths", metavar="MM,MM", help="Yarn per stitch, for all fabrics.")
@click.option("--tensions", metavar="X,X", help="Loop lengths as parts of the material's own.")
@click.option("--branch", type=choice(Branch), default=Branch.MIRRORED.value, show_default=True)
@click.option("--convention", type=choice(Convention), default=Convention.PUBLISHED.value)
@click.option("--max-stress-n-per-mm", type=float, default=MAX_STRESS_N_PER_MM, show_default=True)
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="A Dask cluster to work on.")
@click.option("--workers", type=click.IntRange(1), help="Processes here; all cores if left out.")
@click.option("--fresh", is_flag=True, help="Forget what an earlier run left in the folder.")
@click.option("--out", required=True, type=click.Path(path_type=Path), help="FOLDER of results.")
@json_option
def command(
    materials: tuple[str, ...],
    yarn: str | None,
    fabrics: str | None,
    loop_lengths: str | None,
    tensions: str | None,
    branch: str,
    convention: str,
    max_stress_n_per_mm: float,
    scheduler: str | None,
    workers: int | None,
    fresh: bool,
    out: Path,
    as_json: bool,
    **parameters: float | None,
) -> None:
    """Characterise yarns at the yarn level: laws, sizes and energies of their pure fabrics.

    Every fabric is relaxed at every loop length and stretched both ways. Stopped, the command goes
    on where it was. FOLDER holds table.csv, curves.csv, and material files that every other command
    takes for --material.
    """
    given = {
        "fabrics": _listed("fabrics", fabrics, Fabric.parse),
        "loop_lengths_mm": _listed("loop-lengths", loop_lengths, float),
        "tensions": _listed("tensions", tensions, float),
    }
    options = CharacteriseOptions(
        **{name: value for name, value in given.items() if value is not None},
        branch=Branch(branch),
        convention=Convention(convention),
        max_stress_n_per_mm=max_stress_n_per_mm,
    )
    plans = [plan_of(resolve_material(name), options) for name in materials]
    if yarn is not None:
        plans.append(plan_of(YarnInput.model_validate({"name": yarn, **parameters}), options))
    names = [plan.identifier for plan in plans]
    if not plans or len(set(names)) < len(names):
        raise InputError(
            "material", "is missing or named twice.", "Name materials, or give a --yarn."
        )
    if fresh:
        shutil.rmtree(out / FINISHED, ignore_errors=True)
    results = characterise(
        plans, scheduler=scheduler, workers=workers, keep=out / FINISHED, on_progress=_show
    )
    for result in results:
        _write_materials(result, out)
    _write_table(results, out / "table.csv")
    _write_curves(results, out / "curves.csv")
    if as_json:
        click.echo("[" + ",\n".join(result.model_dump_json() for result in results) + "]")
    else:
        click.echo("\n\n".join(_text(result) for result in results))


def _listed(field: str, text: str | None, read: Callable[[str], Item]) -> list[Item] | None:
    if text is None:
        return None
    try:
        return [read(part.strip()) for part in text.split(",")]
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(field, f"{text!r} is no list of numbers.", "Write 10.5,11,11.5.") from None


def _show(told: BatchProgress) -> None:
    failed = f", {told.failed} failed" if told.failed else ""
    label = told.key.rpartition(".")[0]  # without the digest
    click.echo(f"{told.done} of {told.total} stitches{failed} {label}".rstrip(), err=True)


def _write_materials(result: CharacteriseResult, folder: Path) -> None:
    for setting, document in result.materials.items():
        suffix = "" if setting == result.reference else f"-{setting}"
        save_material_file(document.to_material(), folder / f"{result.identifier}{suffix}.json")


def _write_table(results: list[CharacteriseResult], file: Path) -> None:
    columns = list(FabricRow.model_fields)
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, ["yarn", *columns])
        writer.writeheader()
        for result in results:
            for row in result.rows:
                told = row.model_dump(mode="json", include=set(columns))
                writer.writerow({"yarn": result.identifier, **told})


def _write_curves(results: list[CharacteriseResult], file: Path) -> None:
    quantities = (
        "strain", "transverse_strain", "stress_n_per_mm", "bending_share", "contact_share",
    )  # fmt: skip
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["yarn", "fabric", "setting", "direction", *quantities])
        for result in results:
            for row in result.rows:
                for direction, curve in row.curves.items():
                    head = [result.identifier, str(row.fabric), row.setting, str(direction)]
                    points = zip(*(getattr(curve, name) for name in quantities), strict=True)
                    writer.writerows([*head, *point] for point in points)


def _text(result: CharacteriseResult) -> str:
    lines = [
        f"{result.identifier}: {result.provenance}",
        f"{result.branch} branch, {result.convention} convention; "
        + (f"material file at {result.reference}" if result.material else "no material file"),
        "fabric      setting   L mm   wide   high  /cm2   E N·mm contact   Y course     Y wale"
        "   v yx  v xy  strains fitted",
    ]
    lines += [_line(row) for row in result.rows]
    return "\n".join(lines)


def _line(row: CharacterisedFabric) -> str:
    head = f"{row.fabric:11} {row.setting:8} {row.loop_length_mm:5.2f}"
    if row.stitch_course_mm is None:
        return f"{head}  {row.remark}"
    line = (
        f"{head} {row.stitch_course_mm:6.3f} {row.stitch_wale_mm:6.3f} {row.stitches_per_cm2:5.1f} "
        f"{row.energy_n_mm:8.4f} {row.contact_share:7.3f}"
    )
    if row.modulus_course_n_per_mm is None:
        return f"{line}  no law: {row.remark}"
    return (
        f"{line} {row.modulus_course_n_per_mm:10.4f} {row.modulus_wale_n_per_mm:10.4f} "
        f"{row.poisson_yx:6.2f} {row.poisson_xy:5.2f}  to {row.largest_strain_course:.2f} and "
        f"{row.largest_strain_wale:.2f}{'' if row.converged else '; NOT converged'}"
    )
