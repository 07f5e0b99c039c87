"""Users' material files: what is read, and what is refused."""

import json
from dataclasses import replace

import pytest
import yaml

from knitcore import Direction, Fabric, InputError, material
from knitcore.materials import (
    MeasuredCurve,
    load_library,
    load_material_file,
    load_variants,
    material_from_mapping,
    save_material_file,
)
from tests.knitcore.refusals import refuses

STIFFENING = {"alpha_xx": 1.1, "alpha_yy": 2.4, "beta_xx": 0.04, "beta_yy": 0.01}
LAW = STIFFENING | {
    "modulus_course": 0.16,
    "modulus_wale": 0.45,
    "poisson_yx": 0.45,
    "poisson_xy": 0.43,
}


def stiffnesses(xxxx, yyyy, xxyy, yyxx):
    names = ("stiffness_xxxx", "stiffness_yyyy", "stiffness_xxyy", "stiffness_yyxx")
    return dict(zip(names, (xxxx, yyyy, xxyy, yyxx), strict=True))


@pytest.fixture
def document():
    sizes = {"stitch_course_mm": 3.3, "stitch_wale_mm": 2.3, "loop_length_mm": 11.2}
    return {
        "identifier": "my-merino",
        "name": "My merino",
        "yarn": {"bending_modulus_n_mm2": 0.03},
        "fabrics": {"stockinette": {"law": LAW, **sizes}},
    }


@pytest.mark.parametrize("suffix", [".json", ".yaml", ".yml"])
def test_a_file_is_read(tmp_path, document, suffix):
    path = tmp_path / f"merino{suffix}"
    path.write_text(json.dumps(document) if suffix == ".json" else yaml.safe_dump(document))
    merino = load_material_file(path)
    law = merino.law(Fabric.STOCKINETTE)
    assert law.modulus_course == pytest.approx(0.16)
    assert law.poisson_xy == pytest.approx(0.43)
    assert not merino.is_complete
    assert "10 % assumed" in merino.record(Fabric.STOCKINETTE).uncertainty.source


@pytest.mark.parametrize("identifier", [*load_library(), *load_variants()])
@pytest.mark.parametrize("suffix", [".json", ".yaml"])
def test_saving_and_loading_keeps_all_but_the_printed_figures(tmp_path, identifier, suffix):
    original = material(identifier)
    save_material_file(original, tmp_path / f"m{suffix}")
    again = load_material_file(tmp_path / f"m{suffix}")
    assert (again.identifier, again.yarn) == (original.identifier, original.yarn)
    for fabric, record in original.fabrics.items():
        copy = again.record(fabric)
        modulus = dict.fromkeys(("log_modulus_course", "log_modulus_wale"), 0.0)
        assert replace(copy, uncertainty=replace(copy.uncertainty, **modulus)) == replace(
            record, uncertainty=replace(record.uncertainty, **modulus), printed={}
        )
        for direction in Direction:
            assert copy.uncertainty.log_modulus(direction) == pytest.approx(
                record.uncertainty.log_modulus(direction)
            )


@pytest.mark.parametrize("suffix", [".json", ".yaml"])
def test_measured_curves_are_kept_with_a_material(tmp_path, document, suffix):
    curve = {"strain": [0.0, 0.1, 0.3], "stress_n_per_mm": [0.0, 0.02, 0.11], "pulls": 3}
    document["fabrics"]["stockinette"]["measured"] = {"course": curve}
    merino = material_from_mapping(document)
    save_material_file(merino, tmp_path / f"m{suffix}")
    again = load_material_file(tmp_path / f"m{suffix}").record(Fabric.STOCKINETTE).measured
    assert again == merino.record(Fabric.STOCKINETTE).measured
    assert again == {Direction.COURSE: MeasuredCurve((0.0, 0.1, 0.3), (0.0, 0.02, 0.11), 3)}


@pytest.mark.parametrize(
    ("curve", "field"),
    [
        ({"strain": [0.1, 0.2]}, "stress_n_per_mm"),
        ({"strain": [0.2, 0.1], "stress_n_per_mm": [0.1, 0.2]}, "measured"),
        ({"strain": list(range(200)), "stress_n_per_mm": list(range(200))}, "strain"),
    ],
)
def test_measured_curves_that_are_none_are_refused(document, curve, field):
    document["fabrics"]["stockinette"]["measured"] = {"wale": curve}
    with pytest.raises(InputError) as caught:
        material_from_mapping(document)
    assert caught.value.field.startswith("fabrics.stockinette.measured")
    assert field in caught.value.field


@pytest.mark.parametrize(
    ("change", "field", "message"),
    [
        ({"law": LAW | {"poisson_xy": 2.3}}, "poisson_xy", "1 or more"),
        ({"law": LAW | {"modulus_course": -0.1}}, "law.modulus_course", "greater than 0"),
        ({"law": LAW | {"alpha_xx": float("nan")}}, "law.alpha_xx", "finite"),
        ({"law": LAW | {"modulus_wale": None}}, "law", "modulus_course, modulus_wale"),
        ({"law": LAW | {"stifness": 1}}, "law.stifness", "not permitted"),
        ({"law": LAW | {"modulus_course": "soft"}}, "law.modulus_course", "number"),
        ({"law": LAW | stiffnesses(0.3, 0.5, 0.1, 0.2)}, "modulus_course", "the stiffnesses give"),
        (
            {"law": STIFFENING | stiffnesses(0.099, 0.399, 0.870, 0.181)},
            "stiffness_xxyy",
            "not positive definite",
        ),
        ({"loop_length_mm": 2.0}, "loop_length_mm", "cannot make a stitch"),
    ],
)
def test_unsound_fabrics_are_refused_by_name(document, change, field, message):
    document["fabrics"]["stockinette"] |= change
    with refuses(f"fabrics.stockinette.{field}", message):
        material_from_mapping(document)


def test_unknown_fabrics_and_missing_laws_are_refused(document):
    document["fabrics"]["moss"] = document["fabrics"]["stockinette"]
    with pytest.raises(InputError, match="stockinette"):
        material_from_mapping(document)
    document["fabrics"] = {}
    with refuses("fabrics"):
        material_from_mapping(document)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("broken.json", b"{", "cannot be read"),
        ("broken.yaml", b"a: [", "cannot be read"),
        ("binary.yaml", b"\xff\xfe\x00", "cannot be read"),
        ("list.json", b"[1, 2]", "does not hold a material"),
        ("large.yaml", b"#" * 1_000_001, "over 1 MB"),
        ("none.yaml", None, "is not a file"),
    ],
)
def test_files_that_are_not_materials_are_refused(tmp_path, name, content, message):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=message):
        load_material_file(tmp_path / name)


@pytest.mark.parametrize(
    "yarn",
    [
        {"friction_interval": [0.1, 0.2]},
        {"friction": 0.1, "friction_interval": [0.2, 0.3]},
        {"friction": 0.2, "friction_interval": [0.3, 0.1]},
        {"friction": 3.0},
    ],
)
def test_friction_lies_within_its_interval(document, yarn):
    with pytest.raises(InputError) as caught:
        material_from_mapping({**document, "yarn": yarn})
    assert caught.value.field.startswith("yarn")
