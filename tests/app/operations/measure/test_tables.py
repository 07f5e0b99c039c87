"""Tables of stretch tests looked at before a fit: what stands in them, what has to be said."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from knitcore.chart.fabric import Direction
from tests.app.command_line import printed, refused, run
from tests.app.rest import post, refusal, upload
from tests.knitcore.measure.synthetic import LAW, WIDTH_MM, write_csv


@pytest.fixture
def tests(tmp_path: Path) -> list[Path]:
    return [write_csv(tmp_path / f"{d}.csv", d) for d in Direction]


def scaled(path: Path, column: str, factor: float) -> Path:
    """A copy of a table with one column in another unit."""
    head, *rows = path.read_text().splitlines()
    place = head.split(",").index(column)
    lines = [head]
    for row in rows:
        cells = row.split(",")
        cells[place] = f"{float(cells[place]) * factor:.9g}"
        lines.append(",".join(cells))
    copy = path.with_stem(f"{path.stem}-{column}")
    copy.write_text("\n".join(lines))
    return copy


def looked_at(client: TestClient, course: Path, wale: Path, **more: Any) -> Any:
    body = {"test_course": upload(course), "test_wale": upload(wale), **more}
    return post(client, "measure/tables", body)


@pytest.mark.parametrize(
    ("column", "factor", "answer"),
    [
        ("width_mm", 0.1, "cm: 70 mm"),
        ("force_n", 100.0, "cN"),
        ("strain_across", -1.0, "it narrows by"),
        ("strain_along", 100.0, "per cent"),
    ],
)
def test_an_answered_question_gives_the_law_of_the_right_unit(
    client: TestClient, tests: list[Path], column: str, factor: float, answer: str
) -> None:
    course, wale = scaled(tests[0], column, factor), tests[1]
    files = {"test_course": upload(course), "test_wale": upload(wale)}
    assert refusal(client, "fit", files | {"reduction": "uniform"})["remedy"]
    assert refused("fit", course, wale)
    (doubt,) = looked_at(client, course, wale)["tests"]["course"]["doubts"]
    assert doubt["is_open"]
    (change,) = (r["changes"] for r in doubt["readings"] if r["words"].startswith(answer))
    if column == "strain_along":  # the strain across is a fraction
        change = {"units": {"strain_along": "%"}}
    template = {"template_course": change}
    assert looked_at(client, course, wale, **template)["tests"]["course"]["doubts"] == []
    fitted = post(client, "fit", files | template | {"reduction": "uniform"})
    assert fitted["stiffness_xxxx_n_per_mm"] == pytest.approx(LAW.stiffness_xxxx, rel=0.1)


def test_a_template_of_the_page_reads_the_tables_on_the_command_line(
    client: TestClient, tmp_path: Path, tests: list[Path]
) -> None:
    for file in tests:
        file.write_text(file.read_text().replace("force_n", "Channel 2").replace("along", "1"))
    (course, _) = looked_at(client, *tests)["tests"].values()
    assert course["missing"] == ["strain_along", "force_n"]
    quantities = [column["quantity"] for column in course["columns"]]
    assert quantities == ["run", "", "strain_across", "", "width_mm"]
    assert len(course["rows"]) == 4
    template = tmp_path / "template.json"
    columns = {"force_n": "Channel 2", "strain_along": "strain_1"}
    template.write_text(json.dumps({"columns": columns}))
    for templates in ([template], [template, template]):
        options = [word for path in templates for word in ("--template", path)]
        law = run("fit", *tests, "--reduction", "uniform", *options)
        assert law["stiffness_xxxx_n_per_mm"] == pytest.approx(LAW.stiffness_xxxx, rel=0.1)
    read = looked_at(client, *tests, template_course={"columns": columns})["tests"]["course"]
    assert (read["missing"], read["width_mm"]) == ([], WIDTH_MM)
    assert np.max(read["pulls"][0]["strain"]) > 0.1
    template.write_text('{"column": {}}')
    assert "template.json: column" in refused("fit", *tests, "--template", template)


def test_exchanged_files_and_slack_are_asked_about(
    client: TestClient, tmp_path: Path, tests: list[Path]
) -> None:
    (doubt,) = looked_at(client, tests[1], tests[0])["doubts"]
    assert [reading["exchanges"] for reading in doubt["readings"]] == [True]
    names = [file.rename(tmp_path / f"{name}.csv") for file, name in zip(tests, "ab", strict=True)]
    assert looked_at(client, *names[::-1], fabric="rib")["doubts"] == []
    (doubt,) = looked_at(client, *names, fabric="rib")["doubts"]
    assert "stiffer along its rows" in doubt["problem"]
    assert not doubt["is_open"]
    _, *rows = names[0].read_text().splitlines()
    late = [f"{0.002 * n},0,0,{WIDTH_MM}" for n in range(25)]
    pulled = [[float(cell) for cell in row.split(",")[1:]] for row in rows[:400]]
    late += [f"{0.05 + 1.05 * e},{t},{f},{w}" for e, t, f, w in pulled]
    names[0].write_text("\n".join(["strain_along,strain_across,force_n,width_mm", *late]))
    (slack,) = looked_at(client, *names)["tests"]["course"]["doubts"]
    assert not slack["is_open"]
    assert [r["changes"]["keeps_slack"] for r in slack["readings"]] == [False, True]
    assert "slack before is left out" in printed("fit", *names, "--reduction", "uniform").stderr
