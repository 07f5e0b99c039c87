"""CHART is a file, standard input, a repeat in one line or a fabric, in every command."""

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from app.cli.commands import command_of
from app.cli.inputs import Inputs
from app.cli.main import main
from app.cli.options import resolve_chart
from app.operations.registry import operations
from app.requests.charts import PureFabricChart, to_chart, to_repeat
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.machine.program import knitout_program
from tests.app.command_line import run

EXAMPLE_OF_EACH = ("chart.txt", "KKP/PPK", "- for standard input", "rib with --size 31x20")


def commands_with_chart() -> dict[str, tuple[click.Command, Inputs]]:
    """Commands that take CHART, and how each reads its request."""
    made = {}
    for name, operation in operations().items():
        if operation.command is not None:
            command = command_of(operation, name)
            if "chart" in {p.name for p in command.params if isinstance(p, click.Argument)}:
                declared = operation.command
                inputs = Inputs(declared.request or operation.request, declared.names)
                made[name] = (command, inputs)
    return made


COMMANDS = commands_with_chart()


def chart_fields(name: str, chart: str, size: str | None = None) -> dict[str, Any]:
    """Fields that a command makes of CHART and --size."""
    _, inputs = COMMANDS[name]
    (made,) = (part for part in inputs.inputs if part.name == "chart")
    return made.fields({"chart": chart, "size": size})


def meant(name: str, chart: str, size: str | None = None) -> StitchChart:
    """The stitches that a command computes with."""
    fields = chart_fields(name, chart, size)
    assert fields.get("outline") is None
    sent = fields["chart"]
    return to_chart(sent if isinstance(sent, str) else PureFabricChart.model_validate(sent))


def rows_of(columns: int) -> st.SearchStrategy[list[str]]:
    """Rows of a small repeat, the top row first."""
    row = st.text("KP", min_size=columns, max_size=columns)
    return st.lists(row, min_size=1, max_size=6)


@pytest.mark.parametrize("name", sorted(COMMANDS))
@given(rows=st.integers(1, 6).flatmap(rows_of))
@settings(max_examples=10, deadline=None)
def test_a_line_a_file_and_standard_input_are_one_chart(
    name: str, rows: list[str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    lines = "\n".join(rows)
    expected = StitchChart.parse(lines)
    file = tmp_path_factory.mktemp("chart") / "chart.txt"
    file.write_text(lines)
    assert meant(name, "/".join(rows)) == expected
    assert meant(name, "/".join(rows).lower()) == expected
    assert meant(name, str(file)) == expected
    with CliRunner().isolation(input=lines):
        assert meant(name, "-") == expected
    assert meant(name, "/".join(rows), "7x5") == expected.resized(rows=5, columns=7)


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_every_command_takes_a_repeat_where_its_chart_stands(name: str) -> None:
    command, _ = COMMANDS[name]
    required = [word for option in command.params for word in example_of(option)]
    for chart in ("KKP/PPK", "-"):
        context = command.make_context(name, [chart, *required])
        assert context.params["chart"] == chart


def example_of(parameter: click.Parameter) -> Iterator[str]:
    """Words that give a required parameter other than CHART."""
    if not parameter.required or parameter.name == "chart":
        return
    if isinstance(parameter, click.Option):
        yield parameter.opts[-1]
    if isinstance(parameter.type, click.Choice):
        yield str(parameter.type.choices[0])
    elif isinstance(parameter.type, click.Path):
        yield "file.json"
    else:
        yield "acrylic" if parameter.type is click.STRING else "1"


def test_standard_input_may_be_a_file_of_any_kind(tmp_path: Path) -> None:
    design = tmp_path / "rib.json"
    run("export", "KKP/KPP", "--to", "design", "-o", design)
    picture = io.BytesIO()
    Image.new("L", (4, 3), 255).save(picture, "PNG")
    for content, shape in ((design.read_bytes(), (2, 3)), (picture.getvalue(), (3, 4))):
        with CliRunner().isolation(input=content):
            chart = resolve_chart("-", None)
        assert (chart.rows, chart.columns) == shape


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_notes_of_the_reader_are_printed_beside_the_result(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "rib.k"
    program.write_text(knitout_program(StitchChart.parse("KP/KP")).text + "x-roller-advance 100\n")
    chart_fields(name, str(program))
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "note: Yarn of carrier 2 counts as waste yarn." in printed.err
    assert "x-roller-advance (1 line from line" in printed.err


@pytest.mark.parametrize("name", ["rib", "KKP"])
@pytest.mark.parametrize("command", ["predict", "relax", "stretch"])
def test_a_file_comes_before_a_fabric_or_a_repeat_of_its_name(
    command: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path(name).write_text("PPPP\nKKKK\n")
    assert meant(command, name) == StitchChart.parse("PPPP/KKKK")
    Path(name).unlink()
    Path(name).mkdir()  # no file
    assert meant(command, name, "4x4").columns == 4


@pytest.mark.parametrize("name", sorted(COMMANDS))
@pytest.mark.parametrize("chart", ["ribb", "KKX/PPK", "none.txt", "", ".", "/"])
def test_anything_else_is_refused_with_an_example_of_each(name: str, chart: str) -> None:
    with pytest.raises(InputError) as refused:
        chart_fields(name, chart)
    assert all(example in refused.value.remedy for example in EXAMPLE_OF_EACH)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["KKP/PP"], "chart: line 2 has 2 stitches, line 1 has 3."),
        (["rib"], "size: rib needs a size."),
        (["KP/PK", "--size", "4by4"], "size: '4by4' is not a size."),
        (["-", "--size", "4x4"], "size: does not go with a file."),
        (["K" * 9000], "chart: "),
    ],
)
def test_a_chart_that_is_wrong_is_refused_in_a_line(words: list[str], says: str) -> None:
    result = CliRunner().invoke(main, ["predict", *words, "--material", "acrylic"], input="KP")
    assert result.exit_code == 2
    assert result.stderr.startswith(f"Error: {says}")
    assert result.stdout == ""


def test_a_fabric_alone_stands_for_its_repeat_at_the_yarn_level() -> None:
    fabric = StitchChart.of_fabric(Fabric.RIB)
    assert to_repeat(chart_fields("relax", "rib")["chart"]) == fabric.repeat()
    assert to_chart(chart_fields("relax", "KKP/KPP")["chart"]) == StitchChart.parse("KKP/KPP")
