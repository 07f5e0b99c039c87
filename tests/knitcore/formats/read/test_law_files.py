"""Law files read back what was written, and refuse what is no law."""

from dataclasses import asdict, replace
from pathlib import Path

import pytest

from knitcore import Direction, InputError
from knitcore.formats.read.law_files import LawFile, law_from_mapping, load_law, save_law
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import MeasuredCurve

LAW = ConstitutiveLaw(0.24, 0.06, 0.036, 0.029, 1.17, 0.8, 0.022, 0.02, shear_modulus=0.02)
COUPLED = replace(LAW, kappa_xx=0.3, kappa_yy=0.45)


def test_a_written_file_is_read_back(tmp_path: Path) -> None:
    curve = MeasuredCurve((0.1, 0.2), (0.01, 0.03), pulls=4)
    file = LawFile(
        COUPLED, "made", {"alpha_xx": 0.01}, {Direction.WALE: 0.8}, {Direction.WALE: curve}
    )
    save_law(file, tmp_path / "law.json")
    assert load_law(tmp_path / "law.json") == file


@pytest.mark.parametrize(
    ("curves", "field"),
    [
        ({"wale": {"strain": [0.1, 0.2], "stress_n_per_mm": [0.1, "x"]}}, "curves.wale"),
        ({"bias": {"strain": [0.1, 0.2], "stress_n_per_mm": [0.1, 0.2]}}, "curves.bias"),
        ({"wale": {"strain": [0.2, 0.1], "stress_n_per_mm": [0.1, 0.2]}}, "measured"),
        ([1], "curves"),
    ],
)
def test_curves_that_are_none_are_refused_by_name(curves: object, field: str) -> None:
    with pytest.raises(InputError) as caught:
        law_from_mapping({"law": asdict(LAW), "curves": curves})
    assert caught.value.field.startswith(field)


def test_constants_may_carry_their_unit() -> None:
    constants = {
        name if name.startswith("alpha") else f"{name}_n_per_mm": value
        for name, value in asdict(LAW).items()
        if not name.startswith(("kappa", "shear_stiffening"))
    }
    assert law_from_mapping(constants | {"rms_n_per_mm": 0.1}).law == LAW


@pytest.mark.parametrize(
    "text", ["", "not json", "[]", "{}", '{"law": 3}', '{"law": {"alpha_xx": "a"}}', "[" * 100_000]
)
def test_files_that_are_not_laws_are_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "law.json"
    path.write_text(text)
    with pytest.raises(InputError, match="law"):
        load_law(path)


def test_a_missing_file_and_an_unstable_law_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="positive definite"):
        law_from_mapping({"law": asdict(LAW) | {"stiffness_xxyy": 5.0}})
    with pytest.raises(InputError, match="not a file"):
        load_law(tmp_path / "none.json")
