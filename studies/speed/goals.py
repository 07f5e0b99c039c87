"""The library's work with figure, goal and ratio in one table; CPU seconds.

    python -m studies.speed.goals [GROUP…] [--large]

Groups are commands, design, machine, stretch, published, curl and yarn. ``--large`` adds what takes
minutes. Work that uses two threads counts that of the busier one: the time on two free cores. Times
of the page, the service and first uses are those of ``page``, ``start`` and ``first_use``.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from app.service.results.atlases import atlas_of
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat import strip_test
from knitcore.cloth.space.curl import curl
from knitcore.design.fill import fill_field
from knitcore.design.find import Quantity, Target, find_fabric
from knitcore.design.part_targets import PartTarget, target_maps
from knitcore.formats.designs.garment_design import design_of_plan
from knitcore.formats.write.export import ExportKind, ExportOptions, export_chart
from knitcore.garment.glove import Hand, glove
from knitcore.materials import material
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.solve.growth import Start
from knitcore.yarn.solve.splines import ROUGH_FROM
from knitcore.yarn.study.relax import relax
from knitcore.yarn.study.whole_chart import relax_whole
from studies.speed.curl import PIECES
from studies.speed.swatch import four_fabrics, published

ACRYLIC = material("acrylic")
Row = tuple[str, float, float]
"""Work, CPU seconds, goal."""
FENICS_S = {50: 4.97, 100: 23.4, 200: 193.0}
"""CPU seconds of the authors' script with FEniCS 2019.2, 20 load steps to 0.75."""


def cpu_s(work: Callable[[], Any]) -> float:
    begin = time.thread_time()
    work()
    return time.thread_time() - begin


def commands(large: bool) -> Iterator[Row]:
    for words in ("predict garter --size 5x5 --material acrylic", "--help"):
        spent = []
        for _ in range(4):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            program = [sys.executable, "-m", "app.cli.main", *words.split()]
            subprocess.run(program, capture_output=True, check=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        yield f"knitcore {words}", float(np.median(spent[1:])), 0.25


def design(large: bool) -> Iterator[Row]:
    with tempfile.TemporaryDirectory() as folder:
        built = partial(
            atlas_of,
            material("cotton"),
            "small",
            Path(folder),
            progress=lambda *_: None,
            cancelled=bool,
        )
        stretch = Target(Quantity.MODULUS_COURSE, 0.1)
        yield "find, a yarn without an atlas", cpu_s(lambda: find_fabric(built(), stretch)), 1.0
        atlas = atlas_of(ACRYLIC, "small", Path(folder), progress=lambda *_: None, cancelled=bool)
    plan = glove(Hand(), ACRYLIC)
    parts = [
        PartTarget(
            region.name,
            tuple(
                (row, column, 1)
                for row, column in np.argwhere(region.cells & plan.shaped.stitch).tolist()
            ),
            *moduli,
        )
        for region, moduli in zip(plan.regions[1:3], ((0.1, 0.2), (0.3, 0.1)), strict=True)
    ]
    fill = partial(
        fill_field,
        *target_maps(parts, plan.shaped.chart.rows, plan.shaped.chart.columns),
        ACRYLIC,
        atlas,
        parts=parts,
        kept=plan.shaped.chart,
        stitch=plan.shaped.stitch,
    )
    yield "fill of two regions of a glove", cpu_s(fill), 4.0


def machine(large: bool) -> Iterator[Row]:
    wool = material("glove-wool:glove")
    layout = design_of_plan(glove(Hand(), wool), wool.identifier, intarsia=True)
    options = ExportOptions(layout=layout, name=layout.name, note=layout.note)
    export = partial(export_chart, layout.to_chart(), ExportKind.KNITOUT, wool, options)
    yield "knitout of a glove, knitted and checked", cpu_s(export), 2.0


def stretch(large: bool) -> Iterator[Row]:
    strip_test(four_fabrics(6), ACRYLIC, "wale", 0.3, steps=2)
    for side, goal in {100: 0.6, 200: 2.5, 400: 12.0}.items():
        if side < 400 or large:
            pull = partial(strip_test, four_fabrics(side), ACRYLIC, "wale", 0.3, steps=5)
            yield f"stretch {side} x {side}, 5 steps", cpu_s(pull), goal
            memory_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
            print(f"{'':48} {memory_mb:9.0f} MB at most so far")


def fenics(large: bool) -> Iterator[Row]:
    published(8)
    for cells, ratio in {50: 50, 100: 80, 200: 110}.items():
        if cells < 200 or large:
            seconds, _ = published(cells)
            print(f"{'':48} {FENICS_S[cells] / seconds:9.0f} times as fast as FEniCS")
            yield f"published model {cells} x {cells}, 20 steps", seconds, FENICS_S[cells] / ratio


def curling(large: bool) -> Iterator[Row]:
    curl(PIECES["5x5 basket"](20), ACRYLIC)
    for name, piece in PIECES.items():
        yield (
            f"first shape 60 x 60, {name}",
            cpu_s(partial(curl, piece(60), ACRYLIC, time_limit_s=0.1)),
            0.25,
        )
    for side, goal in {30: 1.5, 60: 5.0, 100: 18.0}.items():
        for name, piece in PIECES.items():
            if side < 100 or large:
                yield (
                    f"curl {side} x {side}, {name}",
                    cpu_s(partial(curl, piece(side), ACRYLIC)),
                    goal,
                )


def yarn(large: bool) -> Iterator[Row]:
    relax(StitchChart.parse("KP/KK"), sample("acrylic", "rib").yarn, 11.28, branch="mirrored")
    for side, goal in {1: 0.015, 4: 0.4, 8: 3.0, 16: 15.0}.items():
        spent = []
        for seed in range(1, 11 if side < 8 else 4 if large else 2):
            chart = StitchChart(np.random.default_rng(seed).random((side, side)) < 0.5)
            for name in ("acrylic", "cotton"):
                entry = sample(name, "stockinette")
                starts = [Start("usual")] if chart.stitches < ROUGH_FROM else None
                shape = relax(
                    chart, entry.yarn, entry.loop_length_mm, starts=starts, branch="mirrored"
                )
                spent.append(shape.seconds)
        yield f"random {side} x {side} relaxed, median", float(np.median(spent)), goal
        yield f"… longest of {len(spent)}", max(spent), 2 * float(np.median(spent))
    if large:
        entry = sample("acrylic", "stockinette")
        chart = StitchChart(np.random.default_rng(1).random((60, 60)) < 0.5)
        began = time.process_time()
        relax_whole(chart, entry.yarn, entry.loop_length_mm)
        yield "whole 60 x 60, both cores together", time.process_time() - began, 360.0


GROUPS: dict[str, Callable[[bool], Iterator[Row]]] = {
    "commands": commands,
    "design": design,
    "machine": machine,
    "stretch": stretch,
    "published": fenics,
    "curl": curling,
    "yarn": yarn,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("groups", nargs="*", metavar="GROUP", default=list(GROUPS))
    parser.add_argument("--large", action="store_true")
    options = parser.parse_args()
    for group in options.groups:
        for work, seconds, goal in GROUPS[group](options.large):
            print(
                f"{work:48} {seconds:9.3f} s, goal {goal:<6.4g} ratio {seconds / goal:5.2f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
