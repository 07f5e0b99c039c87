"""Tables of stretch tests as a fit would read them, and the doubts about them."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.fabric import Direction, Fabric
from knitcore.measure.plausibility import order_doubt, unit_doubts
from knitcore.measure.stretch_tables import is_own_table
from knitcore.measure.stretch_test import StretchTest, check_pair
from knitcore.measure.table_reading import Doubt, DoubtError, TableReading
from knitcore.measure.tester_tables import table_heads
from knitcore.measure.uniaxial_files import read_stretch_test

from ...context import Context
from ...requests.base import Floats, RequestModel, ResultModel
from ...requests.tables import TableTemplate, reading_of
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Operation

SHOWN_PULLS, SHOWN_POINTS = 6, 120


class TablesRequest(RequestModel):
    """Stretch tests of one fabric, of which one may still be missing."""

    test_course: UploadedFile | None = Field(None, description="Test pulled along the rows.")
    test_wale: UploadedFile | None = Field(None, description="Test pulled along the columns.")
    template_course: TableTemplate | None = None
    template_wale: TableTemplate | None = None
    fabric: Fabric | None = Field(None, description="The fabric, if it is a pure one.")


class TableColumn(ResultModel):
    """A column of a table."""

    title: str
    unit: str = Field(description="As it is read; empty where none is known.")
    quantity: str = Field(description="By our names; empty where it is not used.")


class AnswerResult(ResultModel):
    """One answer to a doubt."""

    words: str
    changes: dict[str, Any] = Field(description="Fields of the template that say so.")
    exchanges: bool = Field(description="Whether the two files change places.")


class DoubtResult(ResultModel):
    """Something that can be read in more than one way."""

    field: str
    problem: str
    remedy: str
    readings: list[AnswerResult]
    is_open: bool = Field(description="Whether there is no law before it is answered.")


class PullResult(ResultModel):
    """Points of one pull."""

    strain: Floats
    stress_n_per_mm: Floats


class TableResult(ResultModel):
    """The content of a file."""

    name: str
    is_own: bool = Field(description="Whether its columns have our names, or it is HDF5.")
    columns: list[TableColumn] = Field([])
    rows: list[list[str]] = Field([], description="The first readings, as they stand.")
    width_mm: float | None = None
    length_mm: float | None = None
    missing: list[str] = Field([], description="What has to be said, by our names.")
    problem: str | None = Field(None, description="Why it cannot be read.")
    remedy: str | None = None
    pulls: list[PullResult] = Field([])
    notes: list[str] = Field([])
    doubts: list[DoubtResult] = Field([])


class TablesResult(ResultModel):
    """The content of both files."""

    tests: dict[Direction, TableResult]
    doubts: list[DoubtResult] = Field([], description="About both together.")


def tables(request: TablesRequest, context: Context) -> TablesResult:
    """Columns, first rows, sizes and curves of stretch tests as a fit would read them."""
    del context
    given = [
        (direction, file, reading_of(template))
        for direction, file, template in (
            (Direction.COURSE, request.test_course, request.template_course),
            (Direction.WALE, request.test_wale, request.template_wale),
        )
        if file is not None
    ]
    results: dict[Direction, TableResult] = {}
    tests: dict[Direction, StretchTest] = {}
    with stored([file for _, file, _ in given]) as paths:
        for path, (direction, _, reading) in zip(paths, given, strict=True):
            results[direction], test = _read(path, reading)
            if test is not None:
                tests[direction] = test
    if len(tests) < len(Direction):
        return TablesResult(tests=results)
    course, wale = (tests[direction] for direction in Direction)
    for direction, doubts in unit_doubts(course, wale).items():
        results[direction].doubts += map(DoubtResult.of, doubts)
    return TablesResult(tests=results, doubts=list(_of_both(course, wale, request.fabric)))


@in_reading_time
def _read(path: Path, reading: TableReading) -> tuple[TableResult, StretchTest | None]:
    import h5py  # 10 MB, for those who read a file

    is_own = h5py.is_hdf5(path) or is_own_table(path)
    result = TableResult(name=path.name, is_own=is_own)
    test = None
    try:
        heads = None if is_own else table_heads(path, reading)
        if heads is not None:
            columns = zip(heads.titles, heads.units, heads.quantities, strict=True)
            result.columns = [TableColumn(title=t, unit=u, quantity=q) for t, u, q in columns]
            result.rows = [list(row) for row in heads.rows]
            known = {*heads.constants, *heads.quantities, *reading.sure}
            result.missing = _missing(known)
            for name in ("width_mm", "length_mm"):
                size = getattr(reading, name)
                setattr(result, name, heads.constants.get(name) if size is None else size)
        test = read_stretch_test(path, reading=reading)
    except DoubtError as error:
        result.doubts = [DoubtResult.of(error.doubt)]
    except InputError as error:
        result.problem, result.remedy = f"{error.field} {error.problem}", error.remedy
    if test is None:
        return result, None
    result.width_mm, result.length_mm = test.width_mm[0], test.length_mm
    result.doubts = [DoubtResult.of(doubt) for doubt in test.doubts]
    result.notes = list(test.notes)
    result.pulls = [
        PullResult(strain=run.strain_along[::step], stress_n_per_mm=run.stress[::step])
        for run in test.runs[:SHOWN_PULLS]
        for step in [max(1, -(-run.length // SHOWN_POINTS))]
    ]
    return result, test


def _missing(known: set[str]) -> list[str]:
    """List the quantities that a law needs and neither the file nor the request gives."""
    missing = [] if {"strain_along", "extension_mm"} & known else ["strain_along"]
    missing += [name for name in ("force_n", "width_mm") if name not in known]
    from_extension = "extension_mm" in known and "strain_along" not in known
    return [*missing, *(["length_mm"] if from_extension and "length_mm" not in known else [])]


def _of_both(
    course: StretchTest, wale: StretchTest, fabric: Fabric | None
) -> Sequence[DoubtResult]:
    doubt: Doubt | None = None
    try:
        check_pair(course, wale)
        doubt = None if fabric is None else order_doubt(course, wale, fabric)
    except DoubtError as error:
        doubt = error.doubt
    except InputError as error:
        doubt = Doubt(error.field, error.problem, error.remedy)
    return [] if doubt is None else [DoubtResult.of(doubt)]


OPERATION = Operation(
    tables,
    path="/measure/tables",
    tag="measure",
    summary="What tables of stretch tests say",
    example={"test_course": example_file("course.csv"), "fabric": "rib"},
    heavy=True,
)
