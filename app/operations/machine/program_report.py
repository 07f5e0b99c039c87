"""The figures of a piece on a machine: passes, tightest loop, minutes, yarn, cost."""

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.designs.design_file import check_bare
from knitcore.formats.designs.layout import DesignLayout, piece_of
from knitcore.garment.piece import Piece
from knitcore.machine.duration import CarrierYarn, hand_report, program_report
from knitcore.machine.home.hand_plan import hand_plan
from knitcore.machine.home.plan_rows import minutes_in_words
from knitcore.machine.profile import machine_of
from knitcore.machine.program import Finish
from knitcore.machine.setting import setting_of
from knitcore.machine.stitch_program import stitch_program, stitches_from_row
from knitcore.machine.tension import Verdict
from knitcore.materials.yarn_per_stitch import MeasuredYarn

from ...context import Context
from ...requests.base import Ends, IntervalResult, ResultModel
from ...requests.charts import AnyChartInput, MaterialName, to_stitches
from ...requests.fabrics import Gauged, LawsRequest
from ..files.machines import machine_text
from ..registry import Command, Operation

MAX_STITCHES = 20_000

Price = Annotated[float, Field(gt=0, le=1e6)]


class ProgramReportRequest(DesignLayout, Gauged, LawsRequest):
    """A chart, its yarn, and the machine that knits it."""

    chart: AnyChartInput
    material: MaterialName = Field("acrylic", description="Material of the yarn.")
    finish: Finish = Field(Finish.WASTE, description="The end of the program.")
    stitch_number: float | None = Field(
        None, ge=0, le=10_000, description="That of the yarn's loops if left out."
    )
    from_row: int = Field(1, ge=1, description="The first row, after a break or a jam.")
    loop_length_mm: float | None = Field(
        None, gt=0, le=100, description="Yarn of a stitch; the material's if left out."
    )
    linear_density_tex: float | None = Field(
        None, gt=0, lt=1e5, description="Linear density of the yarn; guessed if left out."
    )
    price_per_kg: Price | None = Field(None, description="Price of the yarn, in any currency.")
    price_per_hour: Price | None = Field(
        None, description="Price of an hour of the machine, in the same currency."
    )


class LoopTensionResult(ResultModel):
    """The yarn between two loops that needles pull apart."""

    needles: float = Field(description="Between the two hooks.")
    across: bool = Field(description="Whether they are on opposite beds.")
    tension_n: float
    tension_interval_n: Ends
    needed_mm: float = Field(description="Yarn that the way needs.")
    own_mm: float = Field(description="Yarn that the stitch has.")
    break_chance: float = Field(description="Chance of breaking, with all that is uncertain.")
    verdict: Verdict


class KindOfTransferResult(ResultModel):
    """Passes of transfers whose tightest loops are alike."""

    rack: float = Field(description="Needles, to either side.")
    passes: int
    transfers: int
    line: int = Field(description="The first of them in the program.")
    tightest: LoopTensionResult | None


class CarrierYarnResult(ResultModel, CarrierYarn):
    """Yarn that a carrier lays."""


class ProgramReportResult(IntervalResult):
    """The figures of a program on a machine."""

    machine: str
    stitch_number: float
    passes: int
    knit_passes: int
    transfer_passes: int
    empty_passes: int = Field(description="Passes that only bring the carriage back.")
    transfers: int = Field(description="Loops; by hand also those that are latched up.")
    rackings: int
    minutes: float = Field(description="Without stops.")
    cost: float | None = Field(description="Of yarn and machine, if a price was given.")
    yarns: list[CarrierYarnResult]
    kinds_of_transfer: list[KindOfTransferResult] = Field(description="The tightest first.")
    notes: list[str]


def program(request: ProgramReportRequest, context: Context) -> ProgramReportResult:
    """Passes, minutes, metres and grams of a chart on a machine, and the tension of transfers.

    Raises
    ------
    InputError
        If the machine cannot knit the chart, or its transfers would break the yarn.
    """
    chart = to_stitches(request.chart)
    check_stitches(chart.rows * chart.columns, MAX_STITCHES, instead=" for a program")
    material, machine = context.material(request.material), machine_of(request.machine)
    others = None
    if isinstance(chart, SymbolChart):
        others = chart = stitches_from_row(chart, request.from_row)
    piece = _piece(chart, request)
    mm = request.loop_length_mm
    setting = setting_of(
        piece,
        machine,
        material,
        stitch_number=request.stitch_number,
        linear_density_tex=request.linear_density_tex,
        measured=None if mm is None else MeasuredYarn(mm),
    )
    if setting.yarn is None:
        raise InputError(
            "material",
            f"{material.identifier} has no loop length, or no linear density.",
            "Give yarn per stitch in mm, and tex.",
        )
    prices = request.price_per_kg, request.price_per_hour
    notes = [setting.note]
    if machine.reads_programs:
        knitted = stitch_program(
            piece if others is None else others,
            finish=request.finish,
            machine=machine,
            stitch_number=setting.number,
            yarn=setting.yarn,
            looser=setting.looser,
        )
        report = program_report(knitted.text, machine, setting.yarn, *prices, looser=setting.looser)
        notes += knitted.notes
    elif others is not None:
        raise InputError(
            "chart",
            f"{machine.name} is worked by hand, from plans that hold knits and purls only.",
            "Give a chart of K and P, or choose a machine that reads programs.",
        )
    else:
        report = hand_report(hand_plan(piece, machine), piece, machine, setting.yarn, *prices)
    return ProgramReportResult.of(
        report,
        stitch_number=setting.number,
        interval_source=f"Tension: {report.tension_source}.",
        notes=[*notes, report.time_note],
    )


def _piece(chart: StitchChart | SymbolChart, request: ProgramReportRequest) -> Piece:
    """The piece of a request: that of the purl map of other stitches."""
    if isinstance(chart, SymbolChart):
        check_bare(request)
        return replace(Piece.plain(chart.plain), gauge=request.relaxed_size)
    piece = replace(piece_of(chart, request), gauge=request.relaxed_size)
    return piece.from_row(request.from_row)


def _command(request: ProgramReportRequest, context: Context) -> ProgramReportResult:
    if request.machine is not None:
        request = request.model_copy(update={"machine": machine_text(request.machine)})
    return program(request, context)


def _lines(result: ProgramReportResult) -> list[str]:
    passes = f"{result.passes} passes"
    if result.transfer_passes:
        passes += f": {result.knit_passes} knit, {result.transfer_passes} transfer"
    if result.transfers:
        passes += f"; {result.transfers} loops transferred"
    if result.empty_passes:
        passes += f"; {result.empty_passes} passes bring the carriage back"
    if result.rackings:
        passes += f"; {result.rackings} rackings"
    lines = [f"machine  {result.machine}", f"time     {minutes_in_words(result.minutes)}", passes]
    lines += result.notes
    lines += [f"carrier {y.carrier}  {y.length_m:.1f} m, {y.mass_g:.1f} g" for y in result.yarns]
    if result.cost is not None:
        lines.append(f"cost     {result.cost:.2f}")
    for kind in result.kinds_of_transfer:
        tightest = "no loop is pulled"
        if (of := kind.tightest) is not None:
            low, high = (float(f"{end:.2g}") for end in of.tension_interval_n)
            tightest = (
                f"tightest loop {of.verdict}: {of.tension_n:.2g} N ({low:g} to {high:g}) over "
                f"{of.needles:g} {'needle' if of.needles == 1 else 'needles'}, "
                f"breaks with a chance of {of.break_chance:.0%}"
            )
        passes = "1 pass" if kind.passes == 1 else f"{kind.passes} passes"
        lines.append(f"rack {kind.rack:g}: {passes} from line {kind.line}, {tightest}")
    return lines


OPERATION = Operation(
    program,
    tag="files",
    path="/program-report",
    summary="Passes, tightest loop, minutes and yarn of a chart on a machine",
    most_stitches=MAX_STITCHES,
    example={"chart": {"fabric": "garter", "columns": 6, "rows": 4}, "material": "lace-acrylic"},
    heavy=True,
    command=Command(
        _lines,
        run=_command,
        more="--machine takes a name of `knitcore machines`, or the file of a profile of your own.",
        names={"linear_density_tex": "--tex", "regions": None, "repeats": None, "shelf": None},
    ),
)
