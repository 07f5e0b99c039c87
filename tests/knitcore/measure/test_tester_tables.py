"""Tables as testers write them, made here in each of their forms."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import openpyxl
import pytest

from knitcore import Direction, InputError
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_tests
from knitcore.measure.stretch_test import StretchTest
from knitcore.measure.table_reading import DoubtError, TableReading
from knitcore.measure.tester_tables import table_heads
from knitcore.measure.uniaxial_files import read_stretch_test
from tests.knitcore.measure.synthetic import LAW, csv_pair, write_csv

LENGTH_MM, WIDTH_MM = 100.0, 70.0
STRAIN = np.linspace(0.0, 0.6, 80)
FORCE = 14 * STRAIN + 30 * STRAIN**3


def comma(value: float) -> str:
    return f"{value:.5f}".replace(".", ",")


def german() -> bytes:
    """Semicolons, decimal commas, lines about the test, a line of units, Windows' letters."""
    lines = ["sep=;", "Prüfer;Öz", f"Probenbreite;{comma(WIDTH_MM)} mm", "Einspannlänge;10;cm", ""]
    lines += ["Prüfzeit;Standardweg;Standardkraft;Temperatur", "s;mm;N;°C"]
    lines += [
        f"0,1;{comma(LENGTH_MM * e)};{comma(f)};20" for e, f in zip(STRAIN, FORCE, strict=True)
    ]
    return "\r\n".join(lines).encode("cp1252")


def specimens_below_each_other() -> bytes:
    """Quoted cells, strain in per cent, kN, two specimens, a mark of UTF-8 first."""
    lines = [f'"Width","{WIDTH_MM}","mm"', f'"Gauge length","{LENGTH_MM}","mm"']
    for number in (1, 2):
        lines += ["", f'"Specimen {number}"', '"Time","Load","Tensile strain (Displacement)"']
        lines += ['"(s)","(kN)","(%)"']
        lines += [
            f'"0","{f / 1000:.7f}","{100 * e:.4f}"' for e, f in zip(STRAIN, FORCE, strict=True)
        ]
    return "\n".join(lines).encode("utf-8-sig")


def cycles() -> bytes:
    """Tabs, UTF-16, and three cycles of one specimen, of which the first conditions it."""
    up_and_down = [STRAIN, STRAIN[-2::-1], STRAIN[1:], STRAIN[-2::-1], STRAIN[1:]]
    strain = np.concatenate(up_and_down)
    force = np.interp(strain, STRAIN, FORCE)
    force[: len(STRAIN)] *= 1.5
    lines = [f"Width\t{WIDTH_MM}\tmm", f"Grip separation\t{LENGTH_MM}\tmm", ""]
    lines += ["Crosshead\tForce\tTime", "cm\tcN\tsec"]
    lines += [f"{10 * e:.6f}\t{100 * f:.4f}\t1" for e, f in zip(strain, force, strict=True)]
    return "\r\n".join(lines).encode("utf-16")


def side_by_side() -> bytes:
    """Two specimens beside each other under one line of names."""
    lines = [f"Width;{WIDTH_MM}", "Specimen 1;;Specimen 2;", "Strain;Force;Strain;Force", "%;N;%;N"]
    lines += [
        f"{100 * e:.4f};{f:.4f};{100 * e:.4f};{f:.4f}" for e, f in zip(STRAIN, FORCE, strict=True)
    ]
    return "\n".join(lines).encode()


def read(path: Path, content: bytes, **more: object) -> StretchTest:
    path.write_bytes(content)
    return read_stretch_test(path, reading=TableReading(**more))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("content", "runs"),
    [(german, 1), (specimens_below_each_other, 2), (cycles, 2), (side_by_side, 2)],
)
def test_forms_of_testers_give_the_same_pull(
    tmp_path: Path, content: Callable[[], bytes], runs: int
) -> None:
    test = read(tmp_path / "test.csv", content())
    assert len(test.runs) == runs
    for run in test.runs:
        stress = np.interp([0.1, 0.3, 0.5], run.strain_along, run.stress)
        expected = np.interp([0.1, 0.3, 0.5], STRAIN, FORCE / WIDTH_MM)
        assert stress == pytest.approx(expected, rel=2e-3)
    if content is not side_by_side:
        assert test.length_mm == pytest.approx(LENGTH_MM)
    assert any("no strain across" in note for note in test.notes)
    if content is cycles:
        assert any("of 3 pulls the first conditions" in note for note in test.notes)
    if content is german:
        assert any("not used: Temperatur" in note for note in test.notes)


def test_a_workbook_with_a_sheet_for_each_specimen(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    book.remove(book.active)
    for number in (1, 2, 3):
        sheet = book.create_sheet(f"Specimen {number}")
        sheet.append(["Specimen width", WIDTH_MM])
        sheet.append(["Extension (mm)", "Force (cN)"])
        for strain, force in zip(STRAIN, FORCE, strict=True):
            sheet.append([LENGTH_MM * strain, 100 * force])
        sheet.append([LENGTH_MM * 0.61, 3.0])  # torn
    book.save(tmp_path / "test.xlsx")
    test = read_stretch_test(
        tmp_path / "test.xlsx", reading=TableReading(length_mm=LENGTH_MM)
    )  # fmt: skip
    assert len(test.runs) == 3
    assert test.peak_stress == pytest.approx(FORCE[-1] / WIDTH_MM, rel=0.05)
    with pytest.raises(InputError, match="no length at rest"):
        read_stretch_test(tmp_path / "test.xlsx")


def test_our_own_columns_may_stand_between_semicolons(tmp_path: Path) -> None:
    head = "run;strain_along;strain_across;force_n;width_mm;length_mm;across_mm"
    rows = [
        f"{run};{comma(e)};{comma(-0.3 * e)};{comma(f)};70;100;50"
        for run in ("1", "2")
        for e, f in zip(STRAIN, FORCE, strict=True)
    ]
    test = read(tmp_path / "own.csv", "\n".join([head, *rows]).encode())
    assert [run.length for run in test.runs] == [len(STRAIN)] * 2
    assert (test.width_mm, test.length_mm, test.across_mm) == ((70.0, 70.0), 100.0, 50.0)
    assert test.runs[1].strain_across[-1] == pytest.approx(-0.18)


def stated(name: str, width: str, length: str, *, separator: str = ",") -> bytes:
    """A pull below two lines about its width and its length, decimals with a point."""
    rows = [f"{LENGTH_MM * e:.4f}{separator}{f:.4f}" for e, f in zip(STRAIN, FORCE, strict=True)]
    return "\n".join([width, length, name, *rows]).encode()


def grouped() -> bytes:
    """Thousands in groups, in quotes."""
    rows = [
        f'"{1e3 * LENGTH_MM * e:,.1f}","{1e3 * f:,.2f}"' for e, f in zip(STRAIN, FORCE, strict=True)
    ]
    return "\n".join(["Width,70", "Length,100", "Extension (µm),Load (mN)", *rows]).encode()


def quoted_commas() -> bytes:
    rows = [f'"{comma(LENGTH_MM * e)}","{comma(f)}"' for e, f in zip(STRAIN, FORCE, strict=True)]
    return "\n".join(['"Width","70,0"', '"Length","100"', '"Extension","Load"', *rows]).encode()


def with_results_below() -> bytes:
    above = stated("Extension (mm),Load (N)", "Width,70", "Length,100")
    return above + b"\n\nMaximum load,14.88\nMean,12.1\n"


@pytest.mark.parametrize(
    "content",
    [
        stated("Extension,Load", "Width : 70 mm", "Gauge length : 100 mm"),
        stated("Extension (mm),Load (N)", "Breite;7;cm".replace(";", ","), "Länge,100,mm"),
        stated("Crosshead,Load\nmm,N", '"Width","70","mm"', '"Gage Length","100","mm"'),
        stated("Axial Displacement,Axial Force\nmm,N", "Specimen width b0,70", "Länge L0,100"),
        stated(
            "Machine Extension (mm),Load (N)", "Probenbreite b0,70",
            "Grip to grip separation at the start position,100",
        ),
        stated("Standard travel,Standard force", "Width,70", "Einspannlänge bei Start,100"),
        stated("Allongement,Force", "Largeur,70,mm", "Longueur,100,mm"),
        stated("Extension(mm)   Load(N)", "Width 70 mm", "Length 100 mm", separator="   "),
        stated("Extension Load", "Width 70", "Length 100", separator=" "),
        grouped(), quoted_commas(), with_results_below(),
    ],
)  # fmt: skip
def test_titles_and_numbers_in_other_forms(tmp_path: Path, content: bytes) -> None:
    test = read(tmp_path / "test.csv", content)
    assert (test.width_mm, test.length_mm) == ((70.0,), 100.0)
    stress = np.interp([0.1, 0.3, 0.5], test.runs[0].strain_along, test.runs[0].stress)
    expected = np.interp([0.1, 0.3, 0.5], STRAIN, FORCE / WIDTH_MM)
    assert stress == pytest.approx(expected, rel=2e-3)


def test_several_lengths_at_rest_are_a_question(tmp_path: Path) -> None:
    content = stated("Extension (mm),Load (N)", "Width,70\nGauge length,50", "Grip separation,100")
    with pytest.raises(DoubtError, match="several lengths at rest: 50, 100 mm") as error:
        read(tmp_path / "test.csv", content)
    changes = [dict(reading.changes) for reading in error.value.doubt.readings]
    assert changes == [{"length_mm": 50.0}, {"length_mm": 100.0}]
    assert read(tmp_path / "test.csv", content, length_mm=100.0).largest_strain == pytest.approx(
        0.6
    )


def test_of_two_extensions_the_first_is_read_and_told(tmp_path: Path) -> None:
    rows = [f"{LENGTH_MM * e:.4f},{f:.4f},0" for e, f in zip(STRAIN, FORCE, strict=True)]
    content = "\n".join(["Crosshead (mm),Load (N),Extension (mm)", *rows]).encode()
    test = read(tmp_path / "test.csv", content, width_mm=WIDTH_MM, length_mm=LENGTH_MM)
    assert "Crosshead (mm), Load (N) are read, and Extension (mm) is not" in test.notes[0]


def test_signs_of_a_press_are_turned(tmp_path: Path) -> None:
    rows = [f"{-LENGTH_MM * e:.4f},{-f:.4f}" for e, f in zip(STRAIN, FORCE, strict=True)]
    content = "\n".join(["Extension (mm),Load (N)", *rows]).encode()
    test = read(tmp_path / "test.csv", content, width_mm=WIDTH_MM, length_mm=LENGTH_MM)
    assert test.largest_strain == pytest.approx(0.6)
    assert ["are negative" in note for note in test.notes[:2]] == [True, True]


def test_a_workbook_under_another_name(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    for row in (["Width", 70], ["Extension", "Load"], *zip(100 * STRAIN, FORCE, strict=True)):
        book.active.append(list(row))
    book.save(tmp_path / "test.xlsx")
    file = (tmp_path / "test.xlsx").rename(tmp_path / "test.csv")
    assert read_stretch_test(file, reading=TableReading(length_mm=100.0)).width_mm == (70.0,)


def channels(name: str = "Ch 1 (mm),Ch 2 (N)") -> bytes:
    rows = [f"{LENGTH_MM * e:.4f},{f:.4f}" for e, f in zip(STRAIN, FORCE, strict=True)]
    return "\n".join([name, *rows]).encode()


def test_columns_that_say_too_little_can_be_named(tmp_path: Path) -> None:
    called = {"extension_mm": "Ch 1 (mm)", "force_n": "Ch 2 (N)"}
    size = {"width_mm": WIDTH_MM, "length_mm": LENGTH_MM}
    test = read(tmp_path / "test.csv", channels(), columns=called, **size)
    assert test.largest_strain == pytest.approx(0.6)
    with pytest.raises(InputError, match=r"it has Ch 1 \(mm\), Ch 2 \(N\)"):
        read(tmp_path / "test.csv", channels(), **size)
    with pytest.raises(InputError, match="none of our columns"):
        read(tmp_path / "test.csv", channels(), columns={"kraft": "Ch 2 (N)"})


@pytest.mark.parametrize(
    ("above", "constants"),
    [
        ("", {}),
        ("\n\n", {}),
        ("mm,N\n", {}),
        ("Specimen 1\nWidth,70 mm\n\n", {"width_mm": WIDTH_MM}),
        ("Width,70,mm\nmm,N\n", {"width_mm": WIDTH_MM}),
    ],
)
def test_numbers_without_names_can_be_named(
    tmp_path: Path, above: str, constants: dict[str, float]
) -> None:
    file, content = tmp_path / "test.csv", above.encode() + channels().split(b"\n", 1)[1]
    called = {"extension_mm": "column 1", "force_n": "column 2"}
    test = read(file, content, columns=called, width_mm=WIDTH_MM, length_mm=LENGTH_MM)
    assert test.runs[0].length == len(STRAIN)
    assert test.largest_strain == pytest.approx(0.6)
    heads = table_heads(file, TableReading(columns=called))
    assert heads
    assert heads.titles == ("column 1", "column 2")
    assert heads.quantities == ("extension_mm", "force_n")
    assert heads.units == (("mm", "N") if "mm,N" in above else ("", ""))
    assert heads.rows[0] == ("0.0000", "0.0000")
    assert heads.constants == constants
    with pytest.raises(InputError, match="it has column 1, column 2"):
        read(file, content)
    wrong = content.replace(b"\n7.5949,", b"\n7.5949,x")
    row = 12 + above.count("\n") - 1
    with pytest.raises(InputError, match=f"row {row} holds"):
        read(file, wrong, columns=called, width_mm=WIDTH_MM, length_mm=LENGTH_MM)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (channels("Extension (mm),Load (stone)"), "'stone', which is not known"),
        (channels("Extension (mm),Load (N)"), "does not say how wide"),
        (channels("a,b"), "it has a, b"),
        (channels("Extension (mm),Load (N)").replace(b"\n7.5949,", b"\n7.5949,x"), "row 12 holds"),
        (
            b"Extension,Load\n" + b"0,5,0,25\n" * 30,
            "4 numbers under 2 names: its decimals are commas",
        ),
        (b"\x00\x01" * 50, "is not text"),
        (b"Extension,Load" + b"," * 20_000, "more than 200 columns"),
    ],
)
def test_what_cannot_be_read_is_said(tmp_path: Path, content: bytes, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read(tmp_path / "test.csv", content)


@pytest.mark.slow
def test_a_law_is_fitted_without_a_strain_across_and_says_that_it_is_less_certain(
    tmp_path: Path,
) -> None:
    measured = [*csv_pair(tmp_path)]
    own = write_csv(tmp_path / "own.csv", Direction.COURSE, runs=1).read_text().splitlines()
    rows = [line.split(",") for line in own[1:]]
    lines = ["Strain;Force;Width", "-;N;mm", *(f"{r[1]};{r[3]};{r[4]}" for r in rows)]
    (tmp_path / "tester.csv").write_text("\n".join(lines))
    fit = fit_tests(tmp_path / "tester.csv", measured[1])
    assert fit.law.modulus_course == pytest.approx(LAW.modulus_course, rel=0.1)
    errors = fit_tests(*measured).standard_errors
    assert fit.standard_errors["poisson_yx"] > 2 * errors["poisson_yx"]
    assert set(fit.waist_rms or {}) == {Direction.WALE}
    with pytest.raises(InputError, match="no strain across"):
        fit_tests(tmp_path / "tester.csv", measured[1], reduction=Reduction.UNIFORM)


def test_heads_say_what_each_column_is_and_what_no_column_says(tmp_path: Path) -> None:
    file = tmp_path / "test.csv"
    file.write_bytes(german())
    heads = table_heads(file, TableReading())
    assert heads
    assert heads.titles == ("Prüfzeit", "Standardweg", "Standardkraft", "Temperatur")
    assert heads.quantities == ("time", "extension_mm", "force_n", "")
    assert heads.units == ("s", "mm", "N", "")
    assert heads.constants == {"width_mm": WIDTH_MM, "length_mm": LENGTH_MM}
    assert heads.rows[0] == ("0.1", "0.00000", "0.00000", "20")
    file.write_bytes(channels())
    heads = table_heads(file, TableReading(columns={"force_n": "Ch 2 (N)"}))
    assert heads
    assert heads.quantities == ("", "force_n")
    file.write_bytes(b"1,2\n3,4")
    assert table_heads(file, TableReading()) is None


def test_a_column_that_the_user_names_is_taken_for_no_other(tmp_path: Path) -> None:
    rows = [
        f"{e:.5f},{f:.5f},{2 * f:.5f},{0.3 * e:.5f}" for e, f in zip(STRAIN, FORCE, strict=True)
    ]
    content = "\n".join(["Strain,Load,Force,Lateral strain", *rows]).encode()
    columns = {"force_n": "Force", "strain_across": ""}
    (run,) = read(tmp_path / "a.csv", content, columns=columns, width_mm=WIDTH_MM).runs
    assert run.stress == pytest.approx(2 * FORCE / WIDTH_MM, abs=1e-6)
    assert np.isnan(run.strain_across).all()
    with pytest.raises(DoubtError, match="18% wider"):
        read(tmp_path / "a.csv", content, columns={"force_n": "Load"}, width_mm=WIDTH_MM)
    narrowing = {"narrowing_is_positive": True, "columns": {"force_n": "Load"}}
    (run,) = read(tmp_path / "a.csv", content, width_mm=WIDTH_MM, **narrowing).runs
    assert run.strain_across == pytest.approx(-0.3 * STRAIN, abs=1e-5)


def test_units_of_the_user_come_before_those_of_the_file(tmp_path: Path) -> None:
    size = {"width_mm": WIDTH_MM, "columns": {"strain_along": "L (mm)", "force_n": "Ch 2 (N)"}}
    rows = [f"{1 + e:.5f},{100 * f:.4f}" for e, f in zip(STRAIN, FORCE, strict=True)]
    content = "\n".join(["L (mm),Ch 2 (N)", *rows]).encode()
    units = {"strain_along": "ratio", "force_n": "cN"}
    (run,) = read(tmp_path / "a.csv", content, units=units, **size).runs
    assert run.strain_along == pytest.approx(STRAIN, abs=1e-5)
    assert run.stress == pytest.approx(FORCE / WIDTH_MM, abs=1e-6)


def test_a_length_in_cm_is_doubted_where_the_strain_is_beyond_any_knit(tmp_path: Path) -> None:
    content = channels("Extension (mm),Load (N)").replace(b"Ext", b"Grip separation,10\nExt", 1)
    with pytest.raises(DoubtError, match="distance of the clamps of 10 looks like cm"):
        read(tmp_path / "a.csv", content, width_mm=WIDTH_MM)
    test = read(tmp_path / "a.csv", content, width_mm=WIDTH_MM, length_mm=100.0)
    assert test.largest_strain == pytest.approx(0.6)
