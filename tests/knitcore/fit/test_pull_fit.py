"""A law comes back from tests made of it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_tests
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.least_squares import fit_direction
from knitcore.measure.uniaxial_files import read_stretch_test
from tests.knitcore.measure.synthetic import LAW, pull, save_as_xlsx, write_csv, write_h5

X, Y = Direction.COURSE, Direction.WALE
fit_files = partial(fit_tests, reduction=Reduction.UNIFORM)
CONSTANTS = (
    "stiffness_xxxx",
    "stiffness_yyyy",
    "stiffness_xxyy",
    "stiffness_yyxx",
    "alpha_xx",
    "alpha_yy",
    "beta_xx",
    "beta_yy",
)
PERCENT_HEADER = "run,strain_along_%,strain_across_%,force_n,width_mm"


def close_to(law: ConstitutiveLaw, expected: ConstitutiveLaw, rel: float) -> None:
    for name in CONSTANTS:
        assert getattr(law, name) == pytest.approx(getattr(expected, name), rel=rel), name


@pytest.mark.parametrize("reduction", [Reduction.PUBLISHED, Reduction.UNIFORM])
def test_a_law_is_recovered_from_csv(tmp_path: Path, reduction: Reduction) -> None:
    files = [write_csv(tmp_path / f"{d}.csv", d) for d in (X, Y)]
    fit = fit_files(files[0], files[1], reduction=reduction)
    # The recommended reduction averages in 40 strain intervals: the curve bends within them.
    close_to(fit.law, LAW, 1e-3 if reduction is Reduction.PUBLISHED else 0.02)
    assert fit.runs == {X: 4, Y: 4}
    assert fit.rms_n_per_mm < 1e-3


def test_a_workbook_gives_what_its_table_gives_as_csv(tmp_path: Path) -> None:
    files = [write_csv(tmp_path / f"{d}.csv", d, runs=2) for d in (X, Y)]
    from_csv = fit_files(files[0], files[1], reduction=Reduction.PUBLISHED)
    books = [save_as_xlsx(file) for file in files]
    from_books = fit_files(books[0], books[1], reduction=Reduction.PUBLISHED)
    assert from_books.law == from_csv.law
    assert from_books.runs == {X: 2, Y: 2}


@pytest.mark.parametrize("reduction", [Reduction.PUBLISHED, Reduction.UNIFORM])
def test_a_law_is_recovered_from_the_authors_layout(tmp_path: Path, reduction: Reduction) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d) for d in (X, Y)]
    fit = fit_files(files[0], files[1], reduction=reduction)
    close_to(fit.law, LAW, 1e-3 if reduction is Reduction.PUBLISHED else 0.02)
    assert fit.runs == {X: 4, Y: 4}
    assert any("video1" in note for note in fit.notes)


def test_standard_errors_reflect_the_scatter_of_pulls(tmp_path: Path) -> None:
    """Pulls whose force differs by 5 % each: C is known to 5 % / sqrt(4)."""
    files = [write_csv(tmp_path / f"{d}.csv", d, noise=0.05, seed=4) for d in (X, Y)]
    fit = fit_files(files[0], files[1])
    for name in CONSTANTS:
        miss = abs(getattr(fit.law, name) - getattr(LAW, name))
        assert miss < 5 * fit.standard_errors[name], name
    relative = fit.standard_errors["modulus_course"] / fit.law.modulus_course
    assert 0.005 < relative < 0.1


def test_one_pull_has_errors_with_a_note_on_what_they_lack(tmp_path: Path) -> None:
    files = [write_csv(tmp_path / f"{d}.csv", d, runs=1, noise=0.01) for d in (X, Y)]
    fit = fit_files(files[0], files[1])
    assert "scatter of pulls unknown" in fit.error_method
    assert all(fit.standard_errors[name] > 0 for name in CONSTANTS)


@settings(max_examples=25, deadline=None)
@given(
    stiffness=st.floats(0.01, 2.0),
    share=st.floats(0.4, 0.9),
    beta=st.floats(0.005, 0.1),
    coupling=st.floats(0.05, 0.8),
)
def test_a_direction_is_recovered_whatever_its_constants(
    stiffness: float, share: float, beta: float, coupling: float
) -> None:
    along = np.linspace(0, 0.8, 300)
    across = -0.3 * along
    alpha = share / 0.8
    stress = stiffness * (along + coupling * across) + beta * (
        1 / (1 - alpha * along) ** 2 - 1 - 2 * alpha * along
    )
    fit = fit_direction(along, across, stress, np.ones(300), coupling)
    assert fit.stiffness == pytest.approx(stiffness, rel=1e-3)
    assert fit.alpha == pytest.approx(alpha, rel=1e-3)
    assert fit.beta == pytest.approx(beta, rel=0.01)


def test_residuals_add_up_to_the_rms(tmp_path: Path) -> None:
    files = [write_csv(tmp_path / f"{d}.csv", d, noise=0.02) for d in (X, Y)]
    fit = fit_files(files[0], files[1], reduction=Reduction.PUBLISHED)
    r = fit.residuals[X]
    assert np.sqrt(np.mean((r.stress - r.fitted) ** 2)) == pytest.approx(fit.rms_course_n_per_mm)


# -- lost frames -------------------------------------------------------------------------------


def test_lost_points_and_unread_forces_are_left_out(tmp_path: Path) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d) for d in (X, Y)]
    with h5py.File(files[0], "r+") as file:
        file["video2/forces"][50:60] = np.nan
        file["video3/traj"][1, :, 100:130] = np.nan
        file["video4/traj"][6, 1, :] = 0.0  # left the image: sticks to its border
        file["video5/forces"][200] *= 9  # a digit misread
    fit = fit_files(files[0], files[1])
    assert fit.runs[X] == 3
    assert any("video4 is left out" in note for note in fit.notes)
    close_to(fit.law, LAW, 0.02)
    published = fit_files(files[0], files[1], reduction=Reduction.PUBLISHED)
    assert published.runs[X] == 4  # which does not use the upper clamp


@pytest.mark.parametrize("videos", [1, 2, 3, 7])
def test_any_number_of_videos(tmp_path: Path, videos: int) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d, videos=videos) for d in (X, Y)]
    assert fit_files(files[0], files[1]).runs[X] == max(1, videos - 1)


def test_an_unloading_at_the_end_of_a_video_is_cut_off(tmp_path: Path) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d) for d in (X, Y)]
    with h5py.File(files[0], "r+") as file:
        forces, points = file["video2/forces"][()], file["video2/traj"][()]
        del file["video2/forces"], file["video2/traj"]
        file["video2/forces"] = np.concatenate([forces, forces[::-1]])
        file["video2/traj"] = np.concatenate([points, points[:, :, ::-1]], axis=2)
    fit = fit_files(files[0], files[1], reduction=Reduction.PUBLISHED)
    close_to(fit.law, LAW, 1e-3)
    assert any("after the unloading" in note for note in fit.notes)


def test_a_senseless_pull_is_left_out_and_only_senseless_pulls_are_refused(tmp_path: Path) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d) for d in (X, Y)]
    with h5py.File(files[0], "r+") as file:
        file["video3/forces"][:] = 0.0
    fit = fit_files(files[0], files[1])
    assert fit.runs[X] == 3
    assert any("video3 is left out" in note for note in fit.notes)
    with h5py.File(files[0], "r+") as file:
        for video in (2, 4, 5):
            file[f"video{video}/forces"][:] = 0.0
    with pytest.raises(InputError, match=r"course\.h5, video5.*never rises"):
        fit_files(files[0], files[1])


def test_names_of_columns_may_carry_units_in_brackets(tmp_path: Path) -> None:
    files = [write_csv(tmp_path / f"{d}.csv", d) for d in (X, Y)]
    for file in files:
        lines = file.read_text().splitlines()
        lines[0] = "Run,Strain along,Strain across,Force (N),Width [mm]"
        file.write_text("\n".join(lines))
    close_to(fit_files(files[0], files[1]).law, LAW, 0.02)


# -- bad input -----------------------------------------------------------------------------------


def _edit(path: Path, change: Callable[[list[str]], None]) -> None:
    lines = path.read_text().splitlines()
    change(lines)
    path.write_text("\n".join(lines) + "\n")


def _cell(lines: list[str], row: int, column: int, text: str) -> None:
    cells = lines[row - 1].split(",")
    cells[column] = text
    lines[row - 1] = ",".join(cells)


def _percent(lines: list[str]) -> None:
    for row in range(2, len(lines) + 1):
        cells = lines[row - 1].split(",")
        cells[1], cells[2] = str(100 * float(cells[1])), str(100 * float(cells[2]))
        lines[row - 1] = ",".join(cells)


def _exchange(lines: list[str]) -> None:
    for row in range(2, len(lines) + 1):
        cells = lines[row - 1].split(",")
        cells[1], cells[2] = cells[2], cells[1]
        lines[row - 1] = ",".join(cells)


def _unload(lines: list[str]) -> None:
    lines += lines[:1:-1]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda lines: _cell(lines, 7, 3, "nan"), ["force_n", "row 7"]),
        (lambda lines: _cell(lines, 9, 1, "x,y"), ["line 9"]),
        (lambda lines: _cell(lines, 12, 2, "0,3"), ["line 12"]),
        (_percent, ["percent", "strain_along", "row"]),
        (lambda lines: lines.__setitem__(0, PERCENT_HEADER), ["percent", "strain_along_%"]),
        (_exchange, ["strain"]),
        (_unload, ["monotone", "row"]),
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
    files = [write_csv(tmp_path / f"{d}.csv", d, runs=1) for d in (X, Y)]
    _edit(files[0], change)
    with pytest.raises(InputError) as error:
        fit_files(files[0], files[1])
    for word in ["course.csv", *says]:
        assert word in str(error.value)
    assert error.value.remedy


def test_force_in_another_unit_is_named(tmp_path: Path) -> None:
    files = [write_csv(tmp_path / f"{d}.csv", d, runs=1) for d in (X, Y)]
    text = files[1].read_text().splitlines()
    rows = [r.split(",") for r in text[1:]]
    for r in rows:
        r[3] = str(1000 * float(r[3]))
    files[1].write_text("\n".join([text[0], *(",".join(r) for r in rows)]))
    with pytest.raises(InputError, match=r"wale\.csv.*newton \(not mN"):
        fit_files(files[0], files[1])


def test_exchanged_and_equal_tests_are_refused(tmp_path: Path) -> None:
    course, wale = (write_h5(tmp_path / f"{d}.h5", d) for d in (X, Y))
    with pytest.raises(InputError, match="pulled wale-wise"):
        fit_files(wale, course)
    misnamed = write_h5(tmp_path / "sample Y.h5", X)  # description and name contradict each other
    assert fit_files(misnamed, wale).law.alpha_xx == pytest.approx(LAW.alpha_xx, rel=0.02)
    csv = write_csv(tmp_path / "same.csv", X)
    with pytest.raises(InputError, match="same points"):
        fit_files(csv, csv)


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
            fit_files(bad, good)
    with pytest.raises(InputError, match="HDF5 file, not a CSV"):
        fit_files(good, good, file_format="csv")


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (lambda f: f.__delitem__("clampSize"), "clampSize: is missing"),
        (lambda f: f.__delitem__("video3/traj"), "video3/traj: is missing"),
        (lambda f: [f.__delitem__(f"video{i}") for i in range(1, 6)], "0 groups"),
        (lambda f: f["clampSize"].__setitem__(0, np.nan), "clampSize"),
    ],
)
def test_errors_in_hdf5_name_the_dataset(
    tmp_path: Path, damage: Callable[[h5py.File], object], says: str
) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d) for d in (X, Y)]
    with h5py.File(files[0], "r+") as file:
        damage(file)
    with pytest.raises(InputError, match=says):
        fit_files(files[0], files[1])


def test_hdf5_may_neither_link_out_nor_hold_too_much(tmp_path: Path) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d) for d in (X, Y)]
    with h5py.File(files[0], "r+") as file:
        del file["video2/forces"]
        file["video2/forces"] = h5py.ExternalLink(str(files[1]), "video2/forces")
    with pytest.raises(InputError, match="is a link"):
        fit_files(files[0], files[1])
    with h5py.File(files[0], "r+") as file:
        del file["video2/forces"]
        file.create_dataset("video2/forces", shape=(10**9,), chunks=(10**6,), dtype="f8")
    with pytest.raises(InputError, match="1000000000 numbers"):
        fit_files(files[0], files[1])


def test_the_curve_of_a_made_test_is_the_laws() -> None:
    along, across, stress = pull(X)
    assert LAW.stress(along, across)[0] == pytest.approx(stress)


def test_readings_that_never_change_are_refused(tmp_path: Path) -> None:
    good = write_csv(tmp_path / "wale.csv", Y)
    rows = [f"0.2,-0.05,{force},70" for force in range(1, 41)]
    header = "strain_along,strain_across,force_n,width_mm"
    still = tmp_path / "course.csv"
    still.write_text("\n".join([header, *rows]))
    with pytest.raises(InputError, match=r"strain_along.*the same in every row"):
        fit_files(still, good)


def test_names_that_are_not_utf_8_are_refused(tmp_path: Path) -> None:
    path = write_h5(tmp_path / "course.h5", X)
    with h5py.File(path, "r+") as file:
        file.create_group(b"vid\xe9o9")
    with pytest.raises(InputError, match="UTF-8"):
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


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"strain_along;strain_across;force_n;width_mm\n0,1;0;1;70\n", "semicolons"),
        (b"strain_along\tforce_n\n0.1\t1\n", "tabs"),
        ("strain_along,größe\n0.1,1\n".encode("latin-1"), "not text in UTF-8"),
    ],
)
def test_other_kinds_of_csv_are_named(tmp_path: Path, content: bytes, problem: str) -> None:
    path = tmp_path / "x.csv"
    path.write_bytes(content)
    with pytest.raises(InputError, match=problem):
        read_stretch_test(path)


def test_points_outside_the_sample_are_refused(tmp_path: Path) -> None:
    path = with_column(write_csv(tmp_path / "x.csv", X, runs=2), "across_mm", "99")
    with pytest.raises(InputError, match="more than the clamped width"):
        read_stretch_test(path)


@pytest.mark.parametrize(
    "names",
    [("course.csv", "wale.csv"), ("rib_COURSE-wise 2.csv", "wale2.csv"), ("course.csv", "b.csv")],
)
def test_files_named_after_the_other_direction_are_refused(
    tmp_path: Path, names: tuple[str, str]
) -> None:
    course, wale = (write_csv(tmp_path / name, d) for name, d in zip(names, (X, Y), strict=True))
    assert fit_files(course, wale).law.alpha_xx == pytest.approx(LAW.alpha_xx, rel=0.02)
    with pytest.raises(InputError, match=r"pulled (course|wale)-wise"):
        fit_files(wale, course)


def test_names_that_hold_both_directions_state_none(tmp_path: Path) -> None:
    names = "course and wale.csv", "concourse.csv"
    course, wale = (write_csv(tmp_path / name, d) for name, d in zip(names, (X, Y), strict=True))
    assert fit_files(course, wale).law.alpha_xx == pytest.approx(LAW.alpha_xx, rel=0.02)
