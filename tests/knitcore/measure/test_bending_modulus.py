"""The bending modulus comes back from drawn photos."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from knitcore import InputError
from knitcore.base.gravity import STANDARD_GRAVITY_M_PER_S2
from knitcore.measure.bending_modulus import MeasuredBending, measure_bending
from knitcore.measure.centreline import load_grey, trace_centreline
from tests.knitcore.measure.synthetic import hanging_yarn, save_photo
from tests.knitcore.refusals import refuses

DENSITY = 0.5
LENGTH = 120.0


def measured(folder: Path, *images: Any, name: str = "yarn.png", **options: Any) -> MeasuredBending:
    """Measure photos of a yarn of 120 mm and 0.5 g/m."""
    photos = [save_photo(folder / f"{k or ''}{name}", image) for k, image in enumerate(images)]
    given = {"linear_density_g_per_m": DENSITY, "length_mm": LENGTH} | options
    return measure_bending(photos, **given)


def modulus(load: float) -> float:
    """B (N·mm²) of a drawn yarn of 120 mm and 0.5 g/m."""
    return DENSITY * 1e-6 * STANDARD_GRAVITY_M_PER_S2 * LENGTH**3 / load


@pytest.mark.parametrize("load", [5.0, 60.0, 180.0, 1000.0])
def test_a_drawn_yarn_gives_its_modulus(tmp_path: Path, load: float) -> None:
    bending = measured(tmp_path, hanging_yarn(load))
    assert bending.bending_modulus_n_mm2 == pytest.approx(modulus(load), rel=0.04)
    assert bending.standard_deviation is None


@pytest.mark.parametrize(
    "image",
    [
        lambda: hanging_yarn(100.0)[:, ::-1],
        lambda: 255 - hanging_yarn(100.0, fibres=60),
        pytest.param(lambda: hanging_yarn(100.0, width_px=14.0), marks=pytest.mark.slow),
        pytest.param(
            lambda: hanging_yarn(100.0, length_px=2600.0, width_px=60.0), marks=pytest.mark.slow
        ),
    ],
    ids=["mirrored", "dark on light, with fibres", "thin", "large"],
)
def test_how_the_photo_looks_does_not_matter(
    tmp_path: Path, image: Callable[[], np.ndarray]
) -> None:
    bending = measured(tmp_path, image())
    assert bending.bending_modulus_n_mm2 == pytest.approx(modulus(100.0), rel=0.05)


def test_a_given_scale_does_for_the_length(tmp_path: Path) -> None:
    bending = measured(tmp_path, hanging_yarn(100.0), length_mm=None, px_per_mm=10.0)
    assert bending.photos[0].length_mm == pytest.approx(LENGTH, rel=0.02)
    assert bending.bending_modulus_n_mm2 == pytest.approx(modulus(100.0), rel=0.05)


def test_the_modulus_is_proportional_to_the_density(tmp_path: Path) -> None:
    yarn = hanging_yarn(100.0)
    light, heavy = (measured(tmp_path, yarn, linear_density_g_per_m=d) for d in (0.4, 0.8))
    assert heavy.bending_modulus_n_mm2 == pytest.approx(2 * light.bending_modulus_n_mm2)


@pytest.mark.slow
def test_several_photos_have_a_mean_and_a_spread(tmp_path: Path) -> None:
    yarns = (hanging_yarn(load) for load in (80.0, 100.0, 125.0))
    bending = measured(tmp_path, *yarns, length_mm=[LENGTH] * 3)
    values = [p.bending_modulus_n_mm2 for p in bending.photos]
    assert bending.bending_modulus_n_mm2 == pytest.approx(np.mean(values))
    assert bending.standard_deviation == pytest.approx(np.std(values, ddof=1))
    assert bending.standard_error == pytest.approx(np.std(values, ddof=1) / np.sqrt(3))
    assert values == sorted(values, reverse=True)


def test_the_centreline_lies_on_the_drawn_one() -> None:
    line = trace_centreline(hanging_yarn(100.0) / 255.0)
    assert line.length_px == pytest.approx(1200, rel=0.02)
    assert line.width_px == pytest.approx(30, rel=0.15)
    assert line.tip_in_photo


Y, X = np.indices((900, 700))
WITHOUT_YARN = {
    "blank": np.full((400, 300), 40),
    "noise": np.random.default_rng(1).integers(0, 255, (400, 300)),
    "spot": np.where((Y - 200) ** 2 + (X - 150) ** 2 < 60**2, 220, 20)[:400, :300],
    "half": np.where(X < 150, 20, 230)[:400, :300],
    "ruler": np.where((abs(X - Y // 2 - 10) <= 15) & (abs(Y - 450) < 400), 220, 20),
}


@pytest.mark.parametrize("image", WITHOUT_YARN.values(), ids=WITHOUT_YARN)
def test_a_photo_without_hanging_yarn_is_refused(tmp_path: Path, image: np.ndarray) -> None:
    with refuses("nothing.png", "yarn"):
        measured(tmp_path, image.astype(np.uint8), name="nothing.png")


def test_a_missing_scale_is_reported(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"has no scale.*length_mm.*px_per_mm"):
        measured(tmp_path, hanging_yarn(100.0), length_mm=None)


def test_a_cut_off_tip_needs_the_length(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="free end is outside"):
        measured(tmp_path, hanging_yarn(100.0)[:700], length_mm=None, px_per_mm=10.0)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"linear_density_g_per_m": 500.0}, "tex"),
        ({"linear_density_g_per_m": np.nan}, "linear_density"),
        ({"length_mm": 1.2}, "5 to 5000 mm"),
        ({"length_mm": [100.0, 100.0]}, "2 lengths are given for 1"),
        ({"length_mm": None, "px_per_mm": -1.0}, "px_per_mm"),
        ({"length_mm": 120.0, "px_per_mm": 100.0}, "by its scale"),
    ],
)
def test_impossible_numbers_are_refused(tmp_path: Path, given: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        measured(tmp_path, hanging_yarn(100.0), **given)


def test_files_that_are_not_photos_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = tmp_path / "text.jpg"
    text.write_text("not a photo")
    cut = tmp_path / "cut.png"
    cut.write_bytes(save_photo(tmp_path / "whole.png", hanging_yarn(100.0)).read_bytes()[:3000])
    for bad in (text, cut, tmp_path / "none.jpg", tmp_path):
        with pytest.raises(InputError, match=bad.name):
            load_grey(bad)
    big = tmp_path / "big.png"
    Image.new("L", (9000, 9000)).save(big)
    with pytest.raises(InputError, match="9000 x 9000"):
        load_grey(big)
