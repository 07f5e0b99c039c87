"""Requests that no operation can carry out: refused in words, over REST and by commands."""

from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.operations.files.export import MAX_STITCHES
from knitcore.formats.write.export import ExportKind
from tests.app.command_line import refused
from tests.app.rest import refusal

GARTER = {"fabric": "garter", "columns": 9, "rows": 6}
LARGE_RIB = {"fabric": "rib", "columns": 200, "rows": 200}
LARGE_SIDE = int(MAX_STITCHES[ExportKind.GLB] ** 0.5) + 1
PULL = {"chart": GARTER, "material": "acrylic", "direction": "wale", "strain": 0.4, "steps": 4}
YARN = {"chart": "K", "material": "acrylic"}
HELD = {"chart": {"fabric": "stockinette", "columns": 1, "rows": 2}, "material": "cotton"}
CONE = [
    {"at_mm": 0, "girth_mm": 140, "rest_mm": 150},
    {"at_mm": 200, "girth_mm": 220, "rest_mm": 170},
]
NO_LIMB = CONE[0] | {"girth_mm": 0.001}
TUBE = {"chart": "KP", "material": "acrylic", "girths": CONE}
STOCKINETTE_TUBE = YARN | {"chart": None, "fabric": "stockinette", "direction": "course"}
WORN = STOCKINETTE_TUBE | {"rest_mm": 120, "worn_mm": 150}
TOO_LARGE_TO_BEND = "\n".join("K" * row + "P" * (40 - row) for row in range(1, 9))
BEYOND, CROSSED = [[0, 0], [1e9, 0], [0, 1]], [[0, 0], [50, 80], [50, 0], [0, 80]]
GLUED, FREE = [{"kind": "glued", "edge": "hem"}], [{"kind": "pulled", "edge": "hem", "y_n": 1}]
PIECE: dict[str, Any] = {
    "outline": [[0, 0], [50, 0], [50, 80]],
    "edges": {"hem": [1]},
    "conditions": [{"kind": "held", "edge": "hem"}],
}
RIB = {"name": "Cuff", "material": "acrylic", "chart": "KPKP\nKPKP"}
NO_DESIGNS: tuple[dict[str, Any], ...] = (
    {"chart": "KQ"}, {"name": ""}, {"name": "a\u0001b"}, {"name": "x" * 201}, {"version": 3},
    {"format": "other"}, {"owner": "eve"},
)  # fmt: skip
NO_FIELD = {"values": [1.0, 2.0], "low": 0, "high": 1}
ELSEWHERE = {"id": "a", "name": "A", "colour": "#ff0000", "runs": [[7, 0, 1]]}
WITHOUT_FRICTION: tuple[tuple[dict[str, Any], str], ...] = (
    ({"branch": "published"}, "branch"),
    ({"flat": True, "cell_course_mm": 3.0}, "flat cell_course_mm"),
    ({"loop_lengths_mm": [[11.0, 12.0]], "chart": "KP"}, "loop_lengths_mm"),
    ({"chart": "KKKKKKP\nKKKKPKK\nKKPKKKK\nPKKKKKK\nKPKKKKK\nKKKPKKK"}, "chart"),
    ({"friction": 3.0}, "friction"),
)
"""Changes of a relaxation that friction does not allow."""

REQUESTS: list[tuple[str, dict[str, Any], str, str]] = [
    ("charts/parse", {"text": "KQ"}, "chart", ""),
    ("charts/parse", {"text": "KP\nK"}, "chart", ""),
    ("charts/parse", {"text": ""}, "chart", ""),
    ("charts/parse", {"text": 5}, "text", ""),
    ("charts/parse", {"text": "K\u0000"}, "body", "NUL"),
    ("designs", RIB | {"note": "a\\\u0000b"}, "body", "NUL"),
    ("charts/parse", {}, "text", ""),
    ("charts/parse", {"text": "K", "extra": 1}, "extra", ""),
    ("predict", YARN | {"chart": "KX"}, "chart", ""),
    ("predict", YARN | {"material": "steel"}, "material", ""),
    ("predict", YARN | {"chart": GARTER | {"columns": 0}}, "chart.columns", ""),
    ("predict", {"chart": "K"}, "material", ""),
    ("predict", YARN | {"chart": GARTER | {"fabric": "velvet"}}, "chart.fabric", ""),
    ("predict", YARN | {"chart": 5}, "chart", ""),
    ("curve", YARN | {"direction": "wale", "stress_n_per_mm": [0.2, 0.1]}, "stress", ""),
    ("stretch", PULL | {"strain": 5}, "strain", ""),
    ("stretch", PULL | {"strain": -0.1}, "strain", ""),
    ("stretch", PULL | {"strain": "much"}, "strain", ""),
    ("stretch", PULL | {"strain": None}, "strain", "is missing."),
    ("stretch", PULL | {"force_n": 2.0}, "force_n", "strain is given as well."),
    ("stretch", PULL | {"steps": 99, "chart": LARGE_RIB}, "steps", ""),
    ("stretch", PULL | {"material": "steel"}, "material", ""),
    ("stretch", PULL | {"chart": "K?"}, "chart", ""),
    ("stretch", PULL | {"chart": GARTER | {"columns": 900, "rows": 900}}, "chart", ""),
    ("stretch", PULL | {"width_mm": 0}, "width_mm", ""),
    ("stretch", PULL | {"width_mm": 1e-9}, "width_mm", ""),
    ("stretch", PULL | {"length_mm": 1e-300}, "length_mm", ""),
    ("stretch", PULL | {"shear_modulus_n_per_mm": 1e-300}, "shear_modulus_n_per_mm", ""),
    ("stretch", PULL | {"outline": "\n".join(["xxxx.xxxx"] * 6)}, "outline", "2 pieces"),
    ("piece", YARN | {"piece": PIECE | {"outline": BEYOND}}, "piece.outline.1.0", "10000"),
    ("piece", YARN | {"piece": PIECE | {"conditions": GLUED}}, "piece.conditions.0.kind", "sewn"),
    ("piece", YARN | {"piece": PIECE | {"outline": CROSSED}}, "outline", ""),
    ("piece", YARN | {"piece": PIECE | {"edges": {"hem": [99]}}}, "edges.hem", ""),
    ("piece", YARN | {"piece": PIECE | {"edges": {"low": [1]}}}, "edge", ""),
    ("piece", YARN | {"piece": PIECE | {"conditions": FREE}}, "conditions", ""),
    ("curl", YARN | {"chart": "KKK\nKKK", "outline": "x.x\nx.x"}, "outline", "2 parts"),
    ("curl", YARN | {"chart": GARTER | {"columns": 101, "rows": 100}}, "chart", ""),
    ("limb", TUBE | {"girths": CONE[::-1]}, "girths", ""),
    ("limb", TUBE | {"girths": [CONE[0], {"at_mm": 200, "girth_mm": 220}]}, "girths", ""),
    ("limb", TUBE | {"girths": [NO_LIMB, CONE[1]]}, "girths.0.girth_mm", "10"),
    ("views/solid", YARN | {"colour": "pressure"}, "colour", ""),
    ("views/still", YARN | {"curl": {"id": "gone"}}, "curl.id", ""),
    ("views/still", YARN | {"curl": {"id": "gone"}, "stretch": {"id": "x", "step": 0}}, "curl", ""),
    ("views/still", YARN | {"outline": "xx"}, "outline", ""),
    ("views/still", YARN | {"colour": "field"}, "field", ""),
    ("views/still", YARN | {"colour": "field", "field": NO_FIELD}, "field", ""),
    ("views/still", YARN | {"colour": "strain"}, "colour", ""),
    ("views/still", YARN | {"colour": "region", "regions": [ELSEWHERE]}, "regions", ""),
    *(("designs", RIB | change, *change, "") for change in NO_DESIGNS),
    (
        "garment",
        {"garment": {"template": "wrist-brace", "wrist_mm": 170}, "material": "acrylic"},
        "garment.wrist-brace.length_mm",
        "length_mm",
    ),
    ("pressure", WORN | {"material": None}, "material", "is missing."),
    ("pressure", WORN | {"law": {"alpha": 1.0}}, "law", "material is given as well."),
    ("pressure", WORN | {"fabric": None}, "fabric", "is missing."),
    ("pressure", WORN | {"chart": "KP"}, "chart", "fabric is given as well."),
    ("pressure", WORN | {"rest_mm": None}, "rest_mm", "is missing."),
    ("pressure", WORN | {"target_mmhg": 20}, "target_mmhg", "rest_mm is given as well."),
    ("bend", YARN | {"chart": TOO_LARGE_TO_BEND}, "chart", ""),
    ("tube", YARN | {"chart": "KP", "wales": 25}, "wales", ""),
    ("hysteresis", YARN | {"friction": 3.0}, "friction", ""),
    ("hysteresis", YARN | {"cycles": 9}, "cycles", ""),
    ("relax", YARN | {"chart": "KKP", "branch": "published"}, "branch", "four pure fabrics"),
    ("relax", HELD | {"loop_lengths_mm": [[15.0]] * 3}, "loop_lengths_mm", ""),
    ("relax", HELD | {"loop_lengths_mm": [[15.0, 15.0], [15.0]]}, "loop_lengths_mm", ""),
    (
        "relax",
        HELD | {"loop_lengths_mm": [[15.0], [15.0]], "loop_length_mm": 15.0},
        "loop_lengths_mm",
        "",
    ),
    ("relax", HELD | {"loop_lengths_mm": []}, "loop_lengths_mm", ""),
    ("relax", HELD | {"branch": "published", "flat": True}, "branch", ""),
    ("relax", HELD | {"cell_wale_mm": 90.0}, "cell_wale_mm", ""),
    *(
        ("relax", YARN | {"history": "agitated"} | change, fields, "")
        for change, fields in WITHOUT_FRICTION
    ),
    (
        "sweep",
        YARN
        | {"direction": "course", "max_strain": 0.2}
        | {"there_and_back": True, "slide_quenching": True, "flat": True},
        "flat slide_quenching",
        "",
    ),
    (
        "export",
        {"chart": {"fabric": "rib", "rows": LARGE_SIDE, "columns": LARGE_SIDE}, "to": "glb"},
        "chart",
        "has 2601 stitches",
    ),
    ("import", {"file": {"name": "chart.k", "content": "a25pdA=="}}, "knitout", ""),
    ("import", {"file": {"name": "chart.doc", "content": "S1A="}}, "chart", ""),
    ("import", {"file": {"name": "a.txt", "content": "S1g="}}, "chart", ""),
    (
        "fill",
        {
            "material": "acrylic",
            "modulus_course_n_per_mm": [[0.1, 0.1], [0.1]],
            "modulus_wale_n_per_mm": [[0.1, None], [0.1, 0.1]],
        },
        "modulus_course_n_per_mm",
        "",
    ),
]


@pytest.mark.parametrize(("address", "body", "field", "says"), REQUESTS)
def test_the_service_names_field_problem_and_remedy(
    client: TestClient, address: str, body: dict[str, Any], field: str, says: str
) -> None:
    problem = refusal(client, address, body)
    assert problem["field"] == field.partition(" ")[0]
    assert [error["field"] for error in problem["errors"]] == field.split()
    assert says in problem["detail"]
    assert problem["detail"]
    assert problem["remedy"]


PREDICT = ("predict", "garter")
ACRYLIC = ("--material", "acrylic")
ESTIMATE = ("estimate", "--bending-modulus-n-mm2", "0.02")
RELAX = ("relax", "rib", "--material", "cotton")
STOCKINETTE = ("--material", "glove-wool:glove", "--fabric", "stockinette", "--direction", "wale")
PRESSURE = ("pressure", *STOCKINETTE, "--worn-mm", "180")
LIMB = ("limb", "stockinette", "--size", "40x4", *ACRYLIC, "--girth")
STRETCH = (
    *("stretch", "garter", "--size", "9x6", *ACRYLIC, "--direction", "wale", "--strain", "0.2"),
    "--out",
)
CHARACTERISE = ("characterise", "--out", "new")
MINE = (
    *("--yarn", "mine", "--bending-modulus-n-mm2", "0.02", "--contact-stiffness-n-per-mm3", "0.01"),
    *("--contact-exponent", "2.4", "--radius-mm", "0.7", "--core-radius-mm"),
)

COMMANDS: list[tuple[tuple[str, ...], str]] = [
    ((*PREDICT, *ACRYLIC), "size"),
    ((*PREDICT, "--size", "0x5", *ACRYLIC), "no stitches"),
    ((*PREDICT, "--size", "5000x5000", *ACRYLIC), "too large"),
    ((*PREDICT, "--size", "big", *ACRYLIC), "COLUMNSxROWS"),
    (("predict", "velvet", "--size", "5x5", *ACRYLIC), "size"),
    (("predict", "nothing.txt", *ACRYLIC), "does not exist"),
    ((*PREDICT, "--size", "5x5", "--material", "steel"), "not in the library"),
    ((*PREDICT, "--size", "5x5", "--material", "none.yaml"), "material"),
    ((*PREDICT, "--size", "5x5"), "--material"),
    (("estimate",), "Missing option '--bending-modulus-n-mm2'"),
    (ESTIMATE, "loop_length_mm: is missing"),
    ((*ESTIMATE, "--loop-length-mm", "long"), "FABRIC=MM"),
    ((*ESTIMATE, "--loop-length-mm", "rib=9"), "missing"),
    ((*ESTIMATE, "--loop-length-mm", "9", "--swatch", "cotton"), "FABRIC="),
    ((*ESTIMATE, "--loop-length-mm", "9", "--swatch", "rib=none"), "library"),
    ((*PRESSURE, "--rest-mm", "200"), "loose"),
    ((*PRESSURE, "--rest-mm", "100"), "lock-up"),
    (PRESSURE, "rest_mm"),
    ((*PRESSURE, "--rest-mm", "100", "--target-mmhg", "20"), "rest_mm"),
    ((*PRESSURE, "--rest-mm", "120", "--law", "x.json"), "one of the two"),
    ((*RELAX, "--cell-course-mm", "40"), "cell-course-mm: 40 mm cannot be reached"),
    (
        (*RELAX, "--loop-lengths-mm", "14/12"),
        "loop-lengths-mm: they do not fit a chart of 2 columns x 1 row. Give every row one "
        "length, or one for each of its stitches",
    ),
    (
        (*RELAX, "--flat", "--cell-course-mm", "3", "--friction", "0.2"),
        "Leave it out.\ncell-course-mm: a fabric at rest",
    ),
    (("whole", "rib", "--material", "cotton"), "size: rib needs a size. Add --size COLUMNSxROWS."),
    (("rs", "--material", "glove-wool"), "acrylic or cotton"),
    (("find", "--target", "course=0.1"), "nothing to search"),
    *(
        (("find", "--atlas", "none.npz", "--target", target), "")
        for target in ("course", "course=x", "colour=1", "course=0.1~%")
    ),
    *(((*LIMB, girth), "0:170") for girth in ("0", "a:b", "0:1:2:3")),
    ((*CHARACTERISE, "--loop-lengths", "12"), "missing"),
    ((*CHARACTERISE, "cotton", "cotton"), "twice"),
    (
        (*CHARACTERISE, "cotton", "--loop-lengths", "twelve"),
        "'twelve': Input should be a valid number",
    ),
    ((*CHARACTERISE, "cotton", "--fabrics", "tweed"), "tweed"),
    ((*CHARACTERISE, "--yarn", "mine", "--loop-lengths", "12"), "bending-modulus-n-mm2"),
    ((*CHARACTERISE, *MINE, "0.2"), "no length is given"),
    ((*CHARACTERISE, *MINE, "0.7", "--loop-lengths", "12"), "not inside the yarn"),
    ((*CHARACTERISE, "cotton", "--scheduler", "somewhere"), "not an address"),
    (("curl", "garter", "--size", "4x4", *ACRYLIC, "--out", "shape.obj"), "out"),
    *(((*STRETCH, out), "out") for out in ("nowhere/fields.npz", ".", "fields.doc")),
    (("import", "none.png"), "does not exist"),
    (("import", "."), "is a folder"),
    (("export", "rib", "--size", "2x2", "--to", "png", "-o", "none/a.png"), "is not a folder"),
]


@pytest.mark.parametrize(("words", "says"), COMMANDS)
def test_a_command_says_what_is_wrong_and_ends_with_code_2(
    words: tuple[str, ...], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert says in refused(*words)
