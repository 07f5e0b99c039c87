"""Workbooks are read as rows of cells, as far as a table of measurements goes."""

import zipfile
from pathlib import Path

import openpyxl
import pytest

from knitcore import InputError
from knitcore.measure import workbooks
from knitcore.measure.workbooks import is_workbook, read_workbook
from studies.speed.readers import number, old_workbook
from tests.knitcore.measure.synthetic import save_workbook


def test_empty_cells_at_the_end_are_left_out(tmp_path: Path) -> None:
    rows = [["force", None, "depth"], [], [1, 2.5, None], [None]]
    path = save_workbook(tmp_path / "a.xlsx", {"Sheet": rows})
    assert is_workbook(path)
    assert read_workbook(path) == {"Sheet": [["force", "", "depth"], [], [1, 2.5]]}


def test_a_cell_in_the_farthest_corner_costs_nothing(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    sheet = book.worksheets[0]
    sheet["A1"], sheet["XFD1048576"] = 1, 2
    book.save(tmp_path / "far.xlsx")
    assert read_workbook(tmp_path / "far.xlsx") == {"Sheet": [[1]]}


def test_an_old_workbook_is_read_sheet_by_sheet_and_bounded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "old.xls"
    path.write_bytes(old_workbook(number(0) + number(1, 2), 2))
    sheet: list[list[str | float]] = [[0.1], ["", "", 0.1]]
    assert read_workbook(path) == {"00000": sheet, "00001": sheet}
    path.write_bytes(old_workbook(number(65_535, 255), 100))  # padded, 100 MB in memory each
    with pytest.raises(InputError, match="is larger than what is read"):
        read_workbook(path)
    monkeypatch.setattr(workbooks, "MAX_XLS_BYTES", path.stat().st_size - 1)
    with pytest.raises(InputError, match="is larger than what is read"):
        read_workbook(path)


def test_a_workbook_with_more_cells_than_are_read_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = save_workbook(tmp_path / "large.xlsx", {"Sheet": [[1, 2, 3]] * 10})
    monkeypatch.setattr(workbooks, "MAX_CELLS", 30)
    with pytest.raises(InputError, match=r"large\.xlsx.*is larger than what is read"):
        read_workbook(path)


def test_a_file_that_unpacks_to_hundreds_of_megabytes_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "bomb.xlsx"
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as packed,
        packed.open("xl/sharedStrings.xml", "w") as part,
    ):
        for _ in range(1 + workbooks.MAX_UNPACKED_BYTES // 2**20):
            part.write(bytes(2**20))
    with pytest.raises(InputError, match="is larger than what is read"):
        read_workbook(path)


def test_a_damaged_workbook_is_refused_by_name(tmp_path: Path) -> None:
    whole = save_workbook(tmp_path / "whole.xlsx", {"Sheet": [[1, 2]]}).read_bytes()
    (tmp_path / "cut.xlsx").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match=r"cut\.xlsx.*cannot be read as a workbook"):
        read_workbook(tmp_path / "cut.xlsx")
