"""Files of stretch tests: what is read, left out and refused."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pytest

from knitcore import Direction, InputError
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_tests
from knitcore.measure.uniaxial_files import read_stretch_test
from tests.knitcore.fit.test_pull_fit import close_to
from tests.knitcore.measure.synthetic import LAW, csv_pair, h5_pair, write_csv, write_h5

X = Direction.COURSE
fit_files = partial(fit_tests, reduction=Reduction.UNIFORM)


def test_lost_points_and_unread_forces_are_left_out(tmp_path: Path) -> None:
    files = h5_pair(tmp_path)
    with h5py.File(files[0], "r+") as file:
        file["video2/forces"][50:60] = np.nan
        file["video3/traj"][1, :, 100:130] = np.nan
        file["video4/traj"][6, 1, :] = 0.0  # left the image: sticks to its border
        file["video5/forces"][200] *= 9  # a digit misread
    fit = fit_files(*files)
    assert fit.runs[X] == 3
    assert any("video4 is left out" in note for note in fit.notes)
    close_to(fit.law, LAW, 0.02)
    published = fit_files(*files, reduction=Reduction.PUBLISHED)
    assert published.runs[X] == 4  # which does not use the upper clamp


@pytest.mark.parametrize("videos", [1, 2, 3, 7])
def test_any_number_of_videos(tmp_path: Path, videos: int) -> None:
    assert fit_files(*h5_pair(tmp_path, videos=videos)).runs[X] == max(1, videos - 1)


def test_an_unloading_at_the_end_of_a_video_is_cut_off(tmp_path: Path) -> None:
    files = h5_pair(tmp_path)
    with h5py.File(files[0], "r+") as file:
        forces, points = file["video2/forces"][()], file["video2/traj"][()]
        del file["video2/forces"], file["video2/traj"]
        file["video2/forces"] = np.concatenate([forces, forces[::-1]])
        file["video2/traj"] = np.concatenate([points, points[:, :, ::-1]], axis=2)
    fit = fit_files(*files, reduction=Reduction.PUBLISHED)
    close_to(fit.law, LAW, 1e-3)
    assert any("after the largest force" in note for note in fit.notes)


def test_a_senseless_pull_is_left_out_and_only_senseless_pulls_are_refused(tmp_path: Path) -> None:
    path = write_h5(tmp_path / "course.h5", X)
    with h5py.File(path, "r+") as file:
        file["video3/forces"][:] = 0.0
    test = read_stretch_test(path)
    assert len(test.runs) == 3
    assert any("video3 is left out" in note for note in test.notes)
    with h5py.File(path, "r+") as file:
        for video in (2, 4, 5):
            file[f"video{video}/forces"][:] = 0.0
    with pytest.raises(InputError, match=r"course\.h5, video5.*never rises"):
        read_stretch_test(path)


def test_names_of_columns_may_carry_units_in_brackets(tmp_path: Path) -> None:
    files = csv_pair(tmp_path)
    for file in files:
        lines = file.read_text().splitlines()
        lines[0] = "Run,Strain along,Strain across,Force (N),Width [mm]"
        file.write_text("\n".join(lines))
    close_to(fit_files(*files).law, LAW, 0.02)


def _cell(lines: list[str], row: int, column: int, text: str) -> None:
    cells = lines[row - 1].split(",")
    cells[column] = text
    lines[row - 1] = ",".join(cells)


def _in_rows(change: Callable[..., tuple[object, ...]]) -> Callable[[list[str]], None]:
    """A change of the run, the strains along and across, the force and the width of every row."""

    def edit(lines: list[str]) -> None:
        for index, line in enumerate(lines[1:], start=1):
            run, *numbers = line.split(",")
            lines[index] = ",".join(map(str, change(run, *map(float, numbers))))

    return edit


_in_percent = _in_rows(lambda r, e, t, *fw: (r, 100 * e, 100 * t, *fw))


def _pull_again(lines: list[str]) -> None:
    """Under one label: a pull, its unloading, and a pull to more."""
    farther = lines[1:]
    _in_rows(lambda r, e, t, f, w: (r, e, t, 1.1 * f, w))(farther := ["", *farther])
    lines += lines[:1:-1] + farther[1:]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda lines: _cell(lines, 7, 3, "nan"), ["force_n", "row 7"]),
        (lambda lines: _cell(lines, 9, 1, "x,y"), ["line 9"]),
        (lambda lines: _cell(lines, 12, 2, "0,3"), ["line 12"]),
        (_in_percent, ["percent", "strain_along", "row"]),
        (_in_rows(lambda r, e, t, *fw: (r, t, e, *fw)), ["strain"]),
        (_in_rows(lambda r, e, *tfw: (r, 0.2, *tfw)), ["strain_along", "the same in every row"]),
        (_in_rows(lambda r, e, t, f, w: (r, e, t, 1000 * f, w)), ["newton (not mN"]),
        (_pull_again, ["monotone", "row"]),
        (lambda lines: lines.__delitem__(slice(12, None)), ["11 usable points"]),
        (lambda lines: lines.__delitem__(slice(1, None)), ["no rows"]),
        (lambda lines: lines.__setitem__(0, "run,a,b,c,d"), ["no column", "strain_along"]),
        (lambda lines: _cell(lines, 30, 4, "7.0"), ["width_mm"]),
        (lambda lines: _cell(lines, 30, 4, "71.5"), ["width_mm", "row 30"]),
    ],
)  # fmt: skip
def test_errors_in_csv_name_file_column_and_row(
    tmp_path: Path, change: Callable[[list[str]], None], says: list[str]
) -> None:
    path = write_csv(tmp_path / "course.csv", X, runs=1)
    lines = path.read_text().splitlines()
    change(lines)
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError) as error:
        read_stretch_test(path)
    for word in ["course.csv", *says]:
        assert word in str(error.value)
    assert error.value.remedy


@pytest.mark.parametrize("has_labels", [True, False])
def test_an_unloading_in_a_table_is_left_out(tmp_path: Path, has_labels: bool) -> None:
    path = write_csv(tmp_path / "course.csv", X, runs=1)
    whole = read_stretch_test(path)
    lines = path.read_text().splitlines()
    lines += lines[:1:-1]
    path.write_text("\n".join(lines if has_labels else [li.split(",", 1)[1] for li in lines]))
    test = read_stretch_test(path)
    assert test.runs[0].length == pytest.approx(whole.runs[0].length, abs=2)
    assert any("after the largest force" in note for note in test.notes)


def test_pulls_without_labels_are_parted_and_the_first_conditions(tmp_path: Path) -> None:
    lines = write_csv(tmp_path / "course.csv", X, runs=1).read_text().splitlines()
    head, *rows = [line.split(",", 1)[1] for line in lines]
    path = tmp_path / "cycles.csv"
    path.write_text("\n".join([head, *[*rows, *rows[::-1]] * 3]))
    test = read_stretch_test(path)
    assert [run.name for run in test.runs] == ["cycles.csv, run pull 2", "cycles.csv, run pull 3"]
    assert "of 3 pulls the first conditions" in test.notes[0]


def test_own_columns_in_other_units_are_converted(tmp_path: Path) -> None:
    path = write_csv(tmp_path / "course.csv", X, runs=1)
    whole = read_stretch_test(path)
    rows = [line.split(",") for line in path.read_text().splitlines()[1:]]
    for head, units, force, width in (
        ("force (cN),width (cm)", [], 100.0, 0.1),
        ("force_n,width_mm", ["-,-,N,mm"], 1.0, 1.0),
    ):
        lines = [f"strain_along,strain_across,{head}", *units]
        lines += [f"{r[1]},{r[2]},{float(r[3]) * force},{float(r[4]) * width}" for r in rows]
        path.write_text("\n".join(lines))
        test = read_stretch_test(path)
        assert test.width_mm == pytest.approx(whole.width_mm)
        assert test.runs[0].stress == pytest.approx(whole.runs[0].stress)


def test_files_that_are_not_what_they_claim(tmp_path: Path) -> None:
    good = write_h5(tmp_path / "x.h5", X)
    cut = tmp_path / "cut.h5"
    cut.write_bytes(good.read_bytes()[:5000])
    text = tmp_path / "text.h5"
    text.write_text("strain_along,strain_across,force_n,width_mm\n")
    noise = tmp_path / "noise.csv"
    noise.write_bytes(bytes(range(256)) * 20)
    for bad in (cut, text, noise, tmp_path / "none.csv", tmp_path):
        with pytest.raises(InputError, match=bad.name):
            read_stretch_test(bad)
    with pytest.raises(InputError, match="HDF5 file, not a CSV"):
        read_stretch_test(good, file_format="csv")


def _link_out(file: h5py.File) -> None:
    del file["video2/forces"]
    file["video2/forces"] = h5py.ExternalLink("other.h5", "video2/forces")


def _hold_too_much(file: h5py.File) -> None:
    del file["video2/forces"]
    file.create_dataset("video2/forces", shape=(10**9,), chunks=(10**6,), dtype="f8")


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (lambda f: f.__delitem__("clampSize"), "clampSize: is missing"),
        (lambda f: f.__delitem__("video3/traj"), "video3/traj: is missing"),
        (lambda f: [f.__delitem__(f"video{i}") for i in range(1, 6)], "0 groups"),
        (lambda f: f["clampSize"].__setitem__(0, np.nan), "clampSize"),
        (_link_out, "is a link"),
        (_hold_too_much, "1000000000 numbers"),
        (lambda f: f.create_group(b"vid\xe9o9"), "UTF-8"),
    ],
)
def test_errors_in_hdf5_name_the_dataset(
    tmp_path: Path, damage: Callable[[h5py.File], object], says: str
) -> None:
    path = write_h5(tmp_path / "course.h5", X)
    with h5py.File(path, "r+") as file:
        damage(file)
    with pytest.raises(InputError, match=says):
        read_stretch_test(path)


def test_a_width_below_that_of_the_tracked_points_is_reported(tmp_path: Path) -> None:
    path = write_h5(tmp_path / "course.h5", X)
    with h5py.File(path, "r+") as file:
        file["fabricSize"][:] = 35.5 * 4.0
    assert any("fabricSize may be misread" in note for note in read_stretch_test(path).notes)


def test_distances_of_clamps_and_points_are_read(tmp_path: Path) -> None:
    test = read_stretch_test(write_h5(tmp_path / "x.h5", X))
    assert test.length_mm == pytest.approx(90.0, rel=0.01)  # of the first frames, stretched a bit
    assert test.across_mm == pytest.approx(0.8 * 70.0, rel=0.01)


def with_column(path: Path, name: str, value: str) -> Path:
    """The CSV file with one more column."""
    header, *rows = path.read_text().split()
    path.write_text("\n".join([f"{header},{name}", *(f"{row},{value}" for row in rows)]))
    return path


@pytest.mark.parametrize("name", ["length_mm", "across_mm"])
def test_optional_lengths_of_a_csv_are_read_and_checked(tmp_path: Path, name: str) -> None:
    path = write_csv(tmp_path / "x.csv", X, runs=2)
    assert getattr(read_stretch_test(path), name) is None
    written = with_column(path, name, "60")
    assert getattr(read_stretch_test(written), name) == 60.0
    written.write_text(written.read_text().replace(",60", ",6", 1))
    with pytest.raises(InputError, match=f"column {name}"):
        read_stretch_test(written)


def test_points_outside_the_sample_are_refused(tmp_path: Path) -> None:
    path = with_column(write_csv(tmp_path / "x.csv", X, runs=2), "across_mm", "99")
    with pytest.raises(InputError, match="more than the clamped width"):
        read_stretch_test(path)
