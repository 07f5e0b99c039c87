"""k and p come back from made tests."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import InputError
from knitcore.base.arrays import Array
from knitcore.measure.compression import average_compression, fit_compression
from knitcore.measure.compression_files import CompressionTest, read_compression
from knitcore.measure.workbooks import read_workbook
from tests.knitcore.measure.synthetic import save_workbook

WORKBOOK = Path(__file__).with_name("made.xls")


def squeeze(k: float, p: float) -> CompressionTest:
    """A test that follows the force law from 1 mN to 1 N and stops at the core at 3 N."""
    diameter, thickness = 2.0, 3.0
    area = 5.0 * diameter
    rho_end = thickness * (1 + p / (area * k * thickness)) ** (-1 / p)
    depth = np.linspace(0, thickness - rho_end, 300)
    force = area * k * thickness / p * ((thickness / (thickness - depth)) ** p - 1)
    before = np.linspace(-0.5, -0.01, 30)
    return CompressionTest(
        name="made-1",
        yarn="made",
        depth_mm=1.0 + np.concatenate([before, depth, [thickness]]),
        force_n=np.concatenate([np.zeros(30), force + 1e-3, [3.0]]),
        diameter_mm=diameter,
    )


MADE = squeeze(1e-3, 2.5)


@settings(max_examples=30)
@given(k=st.floats(2e-4, 2e-2), p=st.floats(1.2, 4.0))
def test_a_made_test_gives_its_constants(k: float, p: float) -> None:
    fit = fit_compression(squeeze(k, p))
    assert fit.k_n_per_mm3 == pytest.approx(k, rel=0.05)
    assert fit.p == pytest.approx(p, rel=0.05)


def test_k_is_inverse_to_the_area() -> None:
    test = squeeze(1e-3, 2.5)
    thin, thick = (fit_compression(test, diameter_mm=d) for d in (1.0, 4.0))
    assert thin.k_n_per_mm3 == pytest.approx(4 * thick.k_n_per_mm3, rel=1e-4)


def write(path: Path, depth: Array, force: Array, header: str = "depth_mm,force_n") -> Path:
    rows = "\n".join(f"{d},{f}" for d, f in zip(depth, force, strict=True))
    path.write_text(f"{header}\n{rows}\n")
    return path


def test_csv_reads_back(tmp_path: Path) -> None:
    path = write(tmp_path / "mine-1.csv", MADE.depth_mm, MADE.force_n)
    (test,) = read_compression(path)
    assert (test.name, test.yarn, test.diameter_mm) == ("mine-1", "mine", None)
    fit = fit_compression(test, diameter_mm=2.0)
    assert fit.k_n_per_mm3 == pytest.approx(1e-3, rel=0.05)


@pytest.mark.parametrize(
    ("head", "separator", "depth", "force"),
    [
        ("Depth (µm),Force (mN)", ",", 1e3, 1e3),
        ("sep=;\nStandardweg;Standardkraft\nmm;mN", ";", 1.0, 1e3),
        ("depth_mm\tforce_n", "\t", 1.0, 1.0),
    ],
)
def test_forms_of_testers_give_the_same_test(
    tmp_path: Path, head: str, separator: str, depth: float, force: float
) -> None:
    rows = [
        f"{depth * d:.7f}{separator}{force * f:.7f}"
        for d, f in zip(MADE.depth_mm, MADE.force_n, strict=True)
    ]
    text = "\n".join([head, *rows])
    (tmp_path / "mine-1.csv").write_text(text.replace(".", ",") if separator == ";" else text)
    (test,) = read_compression(tmp_path / "mine-1.csv")
    assert (test.name, test.yarn) == ("mine-1", "mine")
    fit = fit_compression(test, diameter_mm=2.0)
    assert fit.k_n_per_mm3 == pytest.approx(1e-3, rel=0.05)


def test_means_are_by_yarn() -> None:
    samples = [fit_compression(squeeze(k, 2.5)) for k in (1e-3, 2e-3)]
    (mean,) = average_compression(samples)
    assert mean.samples == 2
    assert mean.k_n_per_mm3 == pytest.approx(1.5e-3, rel=0.05)
    assert mean.p_standard_deviation == pytest.approx(0, abs=0.05)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda d, f: (d[:-10], f[:-10]), "cut off"),
        (lambda d, f: (d[60:], f[60:]), "starts in contact"),
        (lambda d, f: (d[::40], f[::40]), "readings"),
        (lambda d, f: (d, 1000 * f), "mN"),
        (lambda d, f: (-d, f), "depth"),
        (lambda d, f: (1000 * d, f), "not in µm"),
        (lambda d, f: (d / 1000, f), "not in µm or m"),
        (lambda d, f: (d, np.where(np.arange(len(f)) == 7, np.nan, f)), "reading 8"),
    ],
)
def test_unusable_tests_are_refused(change: Any, says: str) -> None:
    depth, force = change(MADE.depth_mm, MADE.force_n)
    test = CompressionTest("made-1", "made", depth, force, 2.0)
    with pytest.raises(InputError, match=says) as error:
        fit_compression(test)
    assert error.value.field.startswith("made-1")


def test_a_missing_diameter_is_reported() -> None:
    test = CompressionTest("made-1", "made", MADE.depth_mm, MADE.force_n, None)
    with pytest.raises(InputError, match="diameter"):
        fit_compression(test)


def test_files_that_are_something_else(tmp_path: Path) -> None:
    (tmp_path / "a.xls").write_text("depth_mm,force_n\n1,2\n")
    (tmp_path / "b.xls").write_bytes(bytes.fromhex("d0cf11e0a1b11ae1") + b"\0" * 3000)
    (tmp_path / "c.xlsx").write_bytes(b"PK\x03\x04" + b"\0" * 100)
    write(tmp_path / "d.csv", MADE.depth_mm, MADE.force_n, header="a,b")
    write(tmp_path / "e.csv", MADE.depth_mm, np.full(len(MADE.depth_mm), np.nan))
    (tmp_path / "f.csv").write_text("")
    for name in ("a.xls", "b.xls", "c.xlsx", "d.csv", "e.csv", "f.csv", "g.csv"):
        with pytest.raises(InputError, match=name):
            read_compression(tmp_path / name)


@pytest.mark.parametrize("kind", ["xls", "xlsx"])
def test_a_workbook_has_a_sheet_for_each_sample(kind: str, tmp_path: Path) -> None:
    """Made with 1 mN/mm³ and 2.5, and with 10 mN/mm³ and 3; diameters in a sheet of their own."""
    remark = [[], [], [*[None] * 8, "end of the test"]]  # a column that is longer
    sheets = {name: rows + remark for name, rows in read_workbook(WORKBOOK).items()}
    today = save_workbook(tmp_path / "made.xlsx", sheets)
    tests = read_compression(WORKBOOK if kind == "xls" else today)
    assert [test.diameter_mm for test in tests] == [2.0, 2.2, 2.4, 1.2, 1.3]
    means = {m.yarn: m for m in average_compression([fit_compression(t) for t in tests])}
    assert {yarn: mean.samples for yarn, mean in means.items()} == {"soft": 3, "firm": 2}
    assert 1000 * means["soft"].k_n_per_mm3 == pytest.approx(1.0, rel=0.03)
    assert means["soft"].p == pytest.approx(2.5, rel=0.01)
    assert 1000 * means["firm"].k_n_per_mm3 == pytest.approx(10.0, rel=0.03)
    assert means["firm"].p == pytest.approx(3.0, rel=0.01)
