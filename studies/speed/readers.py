"""Readers of files: CPU time at n, 2n and 4n, for files that are as awkward as they can be.

    python -m studies.speed.readers [NAME ...]

A reader has a limit on bytes, so its time should grow no faster than they do: four times the file
may take about four times as long, and the largest file that is read at all at most 10 s.
"""

import argparse
import contextlib
import io
import json
import struct
import tempfile
import time
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.fit.measured_field import load_field
from knitcore.formats.read.chart_files import read_noted_chart
from knitcore.formats.read.law_files import load_law
from knitcore.formats.read.stitch_maps import read_target_moduli
from knitcore.materials import load_material_file
from knitcore.measure.centreline import load_grey
from knitcore.measure.compression_files import read_compression
from knitcore.measure.photos.hanging_swatch import Swatch, SwatchPhoto, read_photo
from knitcore.measure.uniaxial_files import read_stretch_test

ENOUGH_S = 0.1
ENOUGH_BYTES = 1_000_000
"""A case of so long, or of so many bytes, tells how time grows."""


@dataclass(frozen=True)
class Case:
    """A kind of awkward file.

    Attributes
    ----------
    read : the reader, which may refuse the file.
    ending : of the file's name.
    content : of a file, by its size n.
    size : n of a small one, which takes some hundredths of a second.
    """

    read: Callable[[Path], object]
    ending: str
    content: Callable[[int], str | bytes]
    size: int


def cpu_s(case: Case, size: int) -> float:
    """CPU seconds to read a file of a size, or to refuse it."""
    content = case.content(size)
    if isinstance(content, str):
        content = content.encode()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"file{case.ending}"
        file.write_bytes(content)
        begun = time.process_time()
        with contextlib.suppress(InputError):  # refusing should be quick, too
            case.read(file)
        return time.process_time() - begun


def workbook(rows: int, row: str, strings: str = "") -> bytes:
    """A workbook of one sheet with the same row again and again."""
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types">'
        '<Default Extension="rels" ContentType='
        '"application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{kind}.sheet.main+xml"/>'
        f'<Override PartName="/xl/sharedStrings.xml" ContentType="{kind}.sharedStrings+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{kind}.worksheet+xml"/>'
        "</Types>",
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships">'
        f'<Relationship Id="r1" Type="{office}/worksheet" Target="worksheets/sheet1.xml"/>'
        f'<Relationship Id="r2" Type="{office}/sharedStrings" Target="sharedStrings.xml"/>'
        "</Relationships>",
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>'
        '<sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/sharedStrings.xml": f'<sst xmlns="{main}">{strings}</sst>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData>{row * rows}'
        "</sheetData></worksheet>",
    }
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, text in parts.items():
            packed.writestr(name, text)
    return stream.getvalue()


def _record(kind: int, content: bytes) -> bytes:
    return struct.pack("<HH", kind, len(content)) + content


def number(row: int, column: int = 0) -> bytes:
    """A cell of an old workbook."""
    return _record(0x203, struct.pack("<HHHd", row % 65536, column, 0, 0.1))


def _packed_numbers(row: int) -> bytes:
    """A row of 200 cells in the fewest bytes."""
    cells = struct.pack("<Hi", 0, 6) * 200
    return _record(0xBD, struct.pack("<HH", row % 65536, 0) + cells + struct.pack("<H", 199))


def old_workbook(cells: bytes, sheets: int = 1) -> bytes:
    """An XLS of some sheets with the same records of cells: BIFF8 in a compound file."""

    def begin(what: int) -> bytes:
        return _record(0x809, struct.pack("<HHIII", 0x600, what, 0, 0, 0))

    end = _record(0x0A, b"")
    sheet = begin(0x10) + cells + end

    def head(length: int) -> bytes:
        places = (struct.pack("<IH", length + n * len(sheet), 0) for n in range(sheets))
        names = (_record(0x85, p + b"\5\0" + f"{n:05}".encode()) for n, p in enumerate(places))
        return begin(5) + _record(0xE0, bytes(20)) + b"".join(names) + end

    stream = (head(len(head(0))) + sheet * sheets).ljust(4096, b"\0")
    sectors = -(-len(stream) // 512)
    tables = next(n for n in range(1, sectors + 2) if 128 * n > n + sectors)
    last, free, table = -2, -1, -3
    chain = [table] * tables + [last, *range(tables + 2, tables + 1 + sectors), last]
    chain += [free] * (128 * tables - len(chain))

    def entry(name: str, kind: int, child: int, start: int, size: int) -> bytes:
        text = name.encode("utf-16le")
        links = struct.pack("<HBBiii", len(text) + 2, kind, 1, free, free, child)
        return text.ljust(64, b"\0") + links + bytes(36) + struct.pack("<iQ", start, size)

    places = [*range(tables), *[free] * (109 - tables)]
    sizes = struct.pack("<HHHHH10x", 0x3E, 3, 0xFFFE, 9, 6)
    starts = struct.pack("<iiIIiiii", tables, tables, 0, 4096, last, 0, last, 0)
    folder = entry("Root Entry", 5, 1, last, 0) + entry(
        "Workbook", 2, free, tables + 1, len(stream)
    )
    return (
        bytes.fromhex("d0cf11e0a1b11ae1")
        + bytes(16)
        + sizes
        + starts
        + struct.pack("<109i", *places)
        + struct.pack(f"<{len(chain)}i", *chain)
        + folder.ljust(512, b"\0")
        + stream.ljust(512 * sectors, b"\0")
    )


def _read_photo(file: Path, coin_mm: float | None = None) -> object:
    swatch = Swatch(Fabric.STOCKINETTE, Direction.WALE, 20, 28, 100)
    return read_photo(SwatchPhoto(file.name, load_grey(file), 100.0), swatch, coin_mm=coin_mm)


def _picture(pixels: int) -> bytes:
    """A picture of noise, which has no grid to be found."""
    side = round(pixels**0.5)
    noise = np.random.default_rng(1).integers(0, 255, (side, side, 3), dtype=np.uint8)
    stream = io.BytesIO()
    Image.fromarray(noise).save(stream, "PNG")
    return stream.getvalue()


def _field(pixels: int) -> bytes:
    """A displacement field of noise."""
    stream, side = io.BytesIO(), round(pixels**0.5)
    displacement = np.random.default_rng(1).normal(size=(4, 2, side, side))
    np.savez(stream, displacement=displacement, frame=np.arange(4))
    return stream.getvalue()


def _design(rows: int) -> str:
    chart = "\n".join(["KP" * 250] * rows)
    head = {"format": "knitcore-design", "version": 2, "name": "x", "material": "acrylic"}
    return json.dumps(head | {"chart": chart})


def _readings(count: int, row: str) -> str:
    """Rows of a pull without noise."""
    return "".join(row.format(number / count) for number in range(count))


OWN = "strain_along,strain_across,force_n,width_mm\n"
NUMBERS = "<row><c><v>0.1</v></c><c><v>0.2</v></c></row>"
LAW = '{"law": {"alpha_xx": 1}, "curves": {%s}}'
CASES = {
    "CSV, a head of commas": Case(read_stretch_test, ".csv", lambda n: "," * n, 5_000),
    "CSV, names in its head": Case(
        read_stretch_test, ".csv", lambda n: "force_n," * n + "\n1" + ",1" * n, 2_000
    ),
    "CSV, rows of names": Case(
        read_stretch_test, ".csv", lambda n: "strain_along,force_n\n" * n, 5_000
    ),
    "CSV, tables below each other": Case(
        read_stretch_test,
        ".csv",
        lambda n: "width_mm,50\nextension_mm;force_n\n1;2\n2;3\n" * n,
        1_000,
    ),
    "CSV, rows": Case(
        read_stretch_test,
        ".csv",
        lambda n: "width;50;mm\nextension_mm;force_n\n" + _readings(n, "{0:.4f};{0:.4f}\n"),
        2_000,
    ),
    "CSV, pulls": Case(
        read_stretch_test,
        ".csv",
        lambda n: "width;50;mm\nextension_mm;force_n\n" + "0;0\n1;1\n2;3\n1;1\n" * n,
        500,
    ),
    "CSV of our own, rows": Case(
        read_stretch_test, ".csv", lambda n: OWN + _readings(n, "{0:.4f},0,{0:.4f},50\n"), 5_000
    ),
    "CSV of our own, pulls": Case(
        read_stretch_test, ".csv", lambda n: OWN + "0,0,0,50\n0.1,0,1,50\n0.3,0,2,50\n" * n, 500
    ),
    "CSV of our own, widths": Case(
        read_stretch_test,
        ".csv",
        lambda n: OWN + "".join(f"0,0,0,{50 + i}\n0.1,0,1,{50 + i}\n" for i in range(n)),
        500,
    ),
    "CSV of our own, a wide head": Case(
        read_stretch_test, ".csv", lambda n: OWN[:-1] + ",a" * n + "\n0,0,0,50" + ",0" * n, 5_000
    ),
    "CSV of our own, quotes": Case(read_stretch_test, ".csv", lambda n: OWN + '"' * n, 100_000),
    "workbook, rows of nothing": Case(
        read_stretch_test, ".xlsx", lambda n: workbook(n, "<row></row>"), 10_000
    ),
    "workbook, rows of numbers": Case(
        read_stretch_test, ".xlsx", lambda n: workbook(n, NUMBERS), 1_000
    ),
    "workbook, a row of cells": Case(
        read_stretch_test,
        ".xlsx",
        lambda n: workbook(1, "<row>" + "<c><v>1</v></c>" * n + "</row>"),
        3_000,
    ),
    "workbook, strings": Case(
        read_stretch_test, ".xlsx", lambda n: workbook(1, NUMBERS, "<si><t>a</t></si>" * n), 4_000
    ),
    "XLS, rows of numbers": Case(
        read_stretch_test, ".xls", lambda n: old_workbook(b"".join(map(number, range(n)))), 5_000
    ),
    "XLS, packed numbers": Case(
        read_stretch_test,
        ".xls",
        lambda n: old_workbook(b"".join(map(_packed_numbers, range(n)))),
        50,
    ),
    "XLS, sheets of a far cell": Case(
        read_stretch_test, ".xls", lambda n: old_workbook(number(65_535, 255), n), 2
    ),
    "photo, marks": Case(_read_photo, ".png", _picture, 80_000),
    "photo, a coin": Case(partial(_read_photo, coin_mm=20.0), ".png", _picture, 80_000),
    "compression, CSV": Case(
        read_compression,
        ".csv",
        lambda n: (
            "sample,depth_mm,force_n\n" + "".join(f"a{i},0.1,0.2\na{i},0.2,0.3\n" for i in range(n))
        ),
        500,
    ),
    "compression, a head of commas": Case(
        read_compression, ".csv", lambda n: "," * n + "\n1", 5_000
    ),
    "compression, workbook": Case(read_compression, ".xlsx", lambda n: workbook(n, NUMBERS), 5_000),
    "knitout, header of carriers": Case(
        read_noted_chart, ".k", lambda n: ";!knitout-2\n;;Carriers: " + "1 " * n, 10_000
    ),
    "knitout, a header without spaces": Case(
        read_noted_chart, ".k", lambda n: ";!knitout-2\n;;" + "a" * n, 20_000
    ),
    "knitout, header of spaces": Case(
        read_noted_chart, ".k", lambda n: ";!knitout-2\n;;Carriers: " + " " * n + "x", 10_000
    ),
    "knitout, comments": Case(
        read_noted_chart,
        ".k",
        lambda n: ";!knitout-2\n" + "; carrier 1 knits #ffffff \n" * n,
        3_000,
    ),
    "knitout, loops on a needle": Case(
        read_noted_chart,
        ".k",
        lambda n: ";!knitout-2\n;;Carriers: 1\ninhook 1\n" + "tuck + f1 1\ntuck - f1 1\n" * n,
        2_000,
    ),
    "knitout, courses": Case(
        read_noted_chart,
        ".k",
        lambda n: (
            ";!knitout-2\n;;Carriers: 1\ninhook 1\n"
            + (
                "".join(f"knit + f{i} 1\n" for i in range(20))
                + "".join(f"knit - f{i} 1\n" for i in range(19, -1, -1))
            )
            * n
        ),
        20,
    ),
    "knitout, many carriers": Case(
        read_noted_chart,
        ".k",
        lambda n: (
            ";!knitout-2\n;;Carriers: "
            + " ".join(str(i) for i in range(n))
            + "\n"
            + "".join(f"in {i}\nknit + f{i % 400} {i}\n" for i in range(n))
        ),
        500,
    ),
    "knitout, transfers": Case(
        read_noted_chart,
        ".k",
        lambda n: (
            ";!knitout-2\n;;Carriers: 1\ninhook 1\nknit + f1 1\n" + "xfer f1 b1\nxfer b1 f1\n" * n
        ),
        1_000,
    ),
    "KnitSpeak, stitches": Case(read_noted_chart, ".ks", lambda n: "row 1: " + "k1, p1, " * n, 500),
    "KnitSpeak, rows": Case(
        read_noted_chart, ".ks", lambda n: "".join(f"row {i + 1}: k2, p2.\n" for i in range(n)), 100
    ),
    "KnitSpeak, brackets": Case(read_noted_chart, ".ks", lambda n: "row 1: " + "[" * n, 2_000),
    "KnitSpeak, stars": Case(read_noted_chart, ".ks", lambda n: "row 1: " + "*k1 " * n, 1_000),
    "KnitSpeak, repeats of rows": Case(
        read_noted_chart, ".ks", lambda n: "row 1: k2.\n" + "repeat row 1 999 times.\n" * n, 500
    ),
    "KnitSpeak, references to rows": Case(
        read_noted_chart,
        ".ks",
        lambda n: "row 1: k2.\n" + "".join(f"row {i}: as row {i - 1}.\n" for i in range(2, n)),
        200,
    ),
    "KnitSpeak, ranges": Case(read_noted_chart, ".ks", lambda n: "rows 1-999 (RS): k2.\n" * n, 100),
    "written, prose": Case(
        read_noted_chart, ".txt", lambda n: "Cast on and knit in pattern.\n" * n, 500
    ),
    "written, a long word": Case(read_noted_chart, ".txt", lambda n: "Row 1: " + "k" * n, 5_000),
    "written, digits": Case(read_noted_chart, ".txt", lambda n: "Row 1: k" + "1" * n, 2_000),
    "written, spaces": Case(read_noted_chart, ".txt", lambda n: "Row 1:" + " " * n + "k", 5_000),
    "written, blank lines": Case(
        read_noted_chart, ".txt", lambda n: "Row 1: k1\n" + "\n" * n, 50_000
    ),
    "written, commas": Case(read_noted_chart, ".txt", lambda n: "Row 1: k1" + "," * n, 5_000),
    "written, numbers and words": Case(
        read_noted_chart, ".txt", lambda n: "Row 1: knit " + "two hundred and " * n, 500
    ),
    "chart of letters": Case(read_noted_chart, ".txt", lambda n: ("KP" * 250 + "\n") * n, 100),
    "chart of signs": Case(read_noted_chart, ".txt", lambda n: ("-." * 250 + "\n") * n, 50),
    "chart of hashes": Case(read_noted_chart, ".txt", lambda n: "#" * n, 50_000),
    "chart, framed": Case(read_noted_chart, ".txt", lambda n: ("|" + " |" * 250 + "\n") * n, 30),
    "chart, a legend": Case(read_noted_chart, ".txt", lambda n: "KP\n" + "x = knit\n" * n, 1_000),
    "picture": Case(read_noted_chart, ".png", _picture, 20_000),
    "design, rows": Case(read_noted_chart, ".json", _design, 100),
    "design, brackets": Case(read_noted_chart, ".json", lambda n: "[" * n, 100_000),
    "design, numbers": Case(read_noted_chart, ".json", lambda n: "[" + "1," * n + "1]", 100_000),
    "design, a long number": Case(read_noted_chart, ".json", lambda n: "1" * n, 20_000),
    "design, names": Case(
        read_noted_chart, ".json", lambda n: json.dumps({f"a{i}": 1 for i in range(n)}), 20_000
    ),
    "material, names": Case(
        load_material_file, ".json", lambda n: json.dumps({f"a{i}": 1 for i in range(n)}), 10_000
    ),
    "material, YAML": Case(
        load_material_file, ".yaml", lambda n: "".join(f"a{i}: 1\n" for i in range(n)), 500
    ),
    "material, YAML of aliases": Case(
        load_material_file,
        ".yaml",
        lambda n: (
            "a0: &a0 [x]\n"
            + "".join(f"a{i}: &a{i} [" + f"*a{i - 1}," * 9 + f"*a{i - 1}]\n" for i in range(1, n))
        ),
        8,
    ),
    "law, curves": Case(
        load_law, ".json", lambda n: LAW % ",".join(f'"a{i}": {{}}' for i in range(n)), 5_000
    ),
    "map of moduli": Case(
        read_target_moduli,
        ".csv",
        lambda n: (
            "row,column,modulus_wale_n_per_mm\n"
            + "".join(f"{1 + i % 999},1,0.1\n" for i in range(n))
        ),
        5_000,
    ),
    "map of moduli, a head of commas": Case(
        read_target_moduli,
        ".csv",
        lambda n: "row,column,modulus_wale_n_per_mm" + "," * n + "\n1,1,1",
        20_000,
    ),
    "displacement field": Case(load_field, ".npz", _field, 1_600),
}


def growth(case: Case, runs: int = 2) -> tuple[int, list[float]]:
    """A size n, and CPU seconds at n, 2n and 4n, the least of some runs: as large as a megabyte or
    a tenth of a second."""
    cpu_s(case, 1)  # what the reader imports
    size = case.size
    while cpu_s(case, 4 * size) < ENOUGH_S and len(case.content(8 * size)) < ENOUGH_BYTES:
        size *= 2
    return size, [min(cpu_s(case, factor * size) for _ in range(runs)) for factor in (1, 2, 4)]


def main() -> None:
    """Print CPU seconds at n, 2n and 4n, and the exponent between the first and the last."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="parts of the names of cases; all by default")
    names = parser.parse_args().names
    chosen = [name for name in CASES if not names or any(part in name for part in names)]
    print(f"{'file':36} {'n':>8} {'n':>8} {'2n':>8} {'4n':>8} s  exponent")
    for name in chosen:
        size, seconds = growth(CASES[name])
        exponent = np.log(seconds[2] / seconds[0]) / np.log(4)
        shown = " ".join(f"{each:8.3f}" for each in seconds)
        print(f"{name:36} {size:8} {shown}    {exponent:.1f}", flush=True)


if __name__ == "__main__":
    main()
