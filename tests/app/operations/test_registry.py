"""Routes, commands and types of the page that are made of operations, and their sources."""

import math
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result
from pydantic import Field, ValidationError

from app.cli.commands import command_of
from app.context import Context
from app.operations.cloth.stretch import StretchResult
from app.operations.registry import Command, Operation, operations
from app.requests.base import Ends, Floats, IntervalResult, Known, RequestModel, ResultModel
from app.requests.charts import ChartInput, MaterialName, OutlineInput, RepeatInput
from app.requests.fabrics import Gauged, GaugeInput
from app.requests.uploads import UploadedFile, stored
from knitcore.chart.fabric import Direction
from knitcore.materials import Interval


def test_every_module_of_a_subject_has_an_operation() -> None:
    folder = Path(sys.modules["app.operations"].__path__[0])
    modules = {file.stem for file in folder.glob("*/*.py")} - {"__init__"}
    made = {operation.run.__module__.rpartition(".")[2] for operation in operations().values()}
    assert made == modules


def test_every_operation_has_a_route_or_is_a_job(schema: dict[str, Any]) -> None:
    paths = schema["paths"]
    for name, operation in operations().items():
        if operation.path is None:
            assert operation.job or operation.command
            continue
        made = paths[f"/api/v1{operation.address}"][operation.method.lower()]
        assert (made["operationId"], made["summary"]) == (name, operation.summary)
        assert made["description"]


def test_every_operation_on_a_chart_of_a_material_takes_its_gauge() -> None:
    """But not what computes its size from the yarn, rows to knit, which have none, and a fill,
    whose parts have one each."""
    without = set()
    for name, operation in operations().items():
        fields = operation.request.model_fields
        if {"chart", "material"} <= fields.keys() and not issubclass(operation.request, Gauged):
            without |= {name} if operation.tag != "yarn level" else set()
    assert without == {"fill", "knit_along"}


Lines = Callable[[Any], list[str]]


class EveryField(RequestModel):
    """A request with a field of every sort."""

    chart: ChartInput
    material: MaterialName
    outline: OutlineInput = None
    direction: Direction
    gauge: GaugeInput | None = None
    file: UploadedFile | None = None
    parts: list[float] | None = Field(None, description="Some.")
    steps: int = Field(3, ge=1)
    check: bool = True
    brief: bool = False


class Echo(ResultModel):
    """The request, and the content of its file."""

    request: str
    content: str = ""


def echo(request: EveryField, context: Context) -> Echo:
    assert context.local
    content = ""
    if request.file is not None:
        with stored([request.file]) as (path,):
            content = path.read_text()
    return Echo(request=request.model_dump_json(exclude={"file"}), content=content)


COMMAND = Command(lambda r: [r.request], names={"parts": "--part"})
ECHOING = Operation(echo, tag="tests", summary="Echo", command=COMMAND)


def echoed(*arguments: str) -> EveryField:
    result = CliRunner().invoke(command_of(ECHOING, "echo"), arguments, standalone_mode=False)
    if result.exception:
        raise result.exception
    return EveryField.model_validate_json(result.output)


def done(run: Callable[[Any, Context], Any], lines: Lines, *options: str) -> Result:
    """Carry out the command of a function for a rib."""
    operation = Operation(run, tag="tests", summary="Do", command=Command(lines))
    return CliRunner().invoke(command_of(operation, "do"), ["rib", *options])


GARTER = ("garter", "--size", "4x2", "--material", "acrylic", "--direction", "wale")


def test_options_are_the_fields_of_the_request(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text("hello")
    plain = echoed(*GARTER)
    assert plain.chart.model_dump() == {"fabric": "garter", "columns": 4, "rows": 2}  # type: ignore[union-attr]
    assert (plain.steps, plain.check, plain.brief) == (3, True, False)
    assert plain.gauge is None
    assert plain.parts is None
    full = echoed(
        *GARTER, "--stitches-per-10-cm", "20", "--rows-per-10-cm", "30",
        "--part", "1", "--part", "2", "--steps", "5", "--no-check", "--brief",
    )  # fmt: skip
    assert full.gauge == GaugeInput(stitches_per_10_cm=20, rows_per_10_cm=30)
    assert (full.parts, full.steps, full.check, full.brief) == ([1.0, 2.0], 5, False, True)
    shown = CliRunner().invoke(
        command_of(ECHOING, "echo"), [*GARTER, "--file", str(file), "--json"]
    )
    assert '"content":"hello"' in shown.output


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--steps", "0"], "steps: Input should be greater than or equal to 1"),
        (["--part", "x"], "not a valid float"),
        (["--rows-per-10-cm", "30"], "stitches-per-10-cm: Field required"),
    ],
)
def test_a_refused_option_is_named(more: list[str], says: str) -> None:
    with pytest.raises((click.ClickException, ValueError), match=says):
        echoed(*GARTER, *more)


def test_a_file_brings_chart_and_outline(tmp_path: Path) -> None:
    file = tmp_path / "c.txt"
    file.write_text("KP\nPK")
    request = echoed(str(file), "--material", "acrylic", "--direction", "wale")
    assert (request.chart, request.outline) == ("KP\nPK", None)


class Repeat(RequestModel):
    """A request about a repeat."""

    chart: RepeatInput


def repeat(request: Repeat, context: Context) -> Echo:
    assert context.local
    return Echo(request=str(request.chart))


def test_a_repeat_needs_no_size() -> None:
    assert done(repeat, lambda r: [r.request]).output == "KP\n"


class Remarked(ResultModel):
    """A result with remarks."""

    notes: list[str]
    warnings: list[str]


def remark(request: Repeat, context: Context) -> Remarked:
    return Remarked(notes=["one"], warnings=["two"])


def test_remarks_do_not_mix_with_the_result() -> None:
    shown = done(remark, lambda _: ["4"])
    assert (shown.stdout, shown.stderr) == ("4\n", "note: one\nwarning: two\n")
    assert done(remark, lambda _: ["4"], "--json").stderr == ""


@pytest.mark.parametrize(
    ("source", "shown"),
    [
        ("Ten swatches.", "90 % intervals rest on\n  Ten swatches.\n"),
        (
            "Stretch: ten tests. Size: one swatch of 1.5 m.",
            "90 % intervals rest on\n  Stretch – ten tests.\n  Size – one swatch of 1.5 m.\n",
        ),
        ("No intervals: nothing is known.", "No intervals: nothing is known.\n"),
    ],
)
def test_a_result_says_what_its_intervals_rest_on(source: str, shown: str) -> None:
    def known(_: Repeat, __: Context) -> IntervalResult:
        return IntervalResult(interval_source=source)

    assert done(known, lambda _: []).stderr == shown


@pytest.mark.parametrize("name", [name for name, of in operations().items() if of.example])
def test_no_part_of_a_request_may_be_infinite(name: str) -> None:
    operation = operations()[name]
    request = operation.request.model_validate(operation.example).model_dump()
    for holder, key in _leaves(request):
        value, holder[key] = holder[key], math.inf
        with pytest.raises(ValidationError):
            operation.request.model_validate(request)
        holder[key] = value


def _leaves(value: Any) -> Iterator[tuple[Any, Any]]:
    """Holders of the parts that have no parts of their own, and the name or number there."""
    inside = list(value.items() if isinstance(value, dict) else enumerate(value))
    for key, part in inside:
        if isinstance(part, dict | list):
            yield from _leaves(part)
        else:
            yield value, key


def test_an_operation_is_described_by_its_function() -> None:
    assert (ECHOING.name, ECHOING.request, ECHOING.result) == ("echo", EveryField, Echo)
    assert operations()["stretch"].result is StretchResult  # which comes with data for the view
    assert operations()["import"].address == "/import"


class LibraryResult:
    """The result of a library function."""

    modulus_course_n_per_mm = 0.5
    interval = Interval(1.0, 2.0)
    values = (1.0, 2.0)
    beyond = float("nan")


class Numbers(ResultModel):
    """Its numbers."""

    modulus_course_n_per_mm: float
    interval: Ends
    values: Floats
    beyond: Known
    count: int


def test_a_result_reads_the_attributes_of_what_was_found() -> None:
    numbers = Numbers.of(LibraryResult(), count=2)
    assert numbers.model_dump() == {
        "modulus_course_n_per_mm": 0.5,
        "interval": (1.0, 2.0),
        "values": [1.0, 2.0],
        "beyond": None,
        "count": 2,
    }
    assert Numbers.model_validate_json(numbers.model_dump_json()) == numbers


class Pull(RequestModel):
    """A request with a unit in a name."""

    strain: float
    shear_modulus_n_per_mm: float
    steps: int = 3


def test_a_request_passes_its_fields_to_the_library() -> None:
    def pull(
        chart: str, strain: float, *, shear_modulus: float, steps: int = 10, mesh: float = 1.0
    ) -> tuple[str, float, float, int, float]:
        return chart, strain, shear_modulus, steps, mesh

    request = Pull(strain=0.2, shear_modulus_n_per_mm=0.03)
    assert request.pass_to(pull, "KP") == ("KP", 0.2, 0.03, 3, 1.0)
    assert request.pass_to(pull, "KP", 0.4, mesh=2.0, steps=5) == ("KP", 0.4, 0.03, 5, 2.0)


YARN_ALONE = {
    "characterise", "dial", "import", "knit_along", "material", "pull", "relax", "rs",
    "sweep", "tube", "uses", "whole",
}  # fmt: skip
"""They compute from the yarn, the size of its stitches or its document, or, as `pull`, change the
laws; the address of `material` names laws."""


@pytest.mark.parametrize("name", operations())
def test_published_laws_can_be_chosen_wherever_laws_are_used(name: str) -> None:
    operation = operations()[name]
    fields = operation.request.model_fields
    assert name in YARN_ALONE or not {"material", "materials"} & set(fields) or "laws" in fields
    if "laws" in fields and operation.command is not None:
        options = {option for made in command_of(operation, name).params for option in made.opts}
        assert "--laws" in options


CONVERSIONS = {
    "array", "broadcast_to", "isfinite", "round",
    "bool_", "float32", "float64", "nan", "degrees", "linspace", "mean",
    "exp", "sort",
}  # fmt: skip
"""Names of NumPy with which an operation turns lists into arrays, units into others, and back."""


@pytest.mark.parametrize("room", ["operations", "requests"])
def test_an_operation_computes_nothing_itself(room: str) -> None:
    files = sorted(Path(sys.modules["app"].__path__[0], room).rglob("*.py"))
    assert files
    for file in files:
        text = file.read_text(encoding="utf-8")
        assert "scipy" not in text, file
        assert set(re.findall(r"\bnp\.(\w+)", text)) <= CONVERSIONS, file
