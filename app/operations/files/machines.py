"""Knitting machines that programs are made for, and programs held against them."""

from pathlib import Path
from typing import Any

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.machine.profile import MAX_BYTES, MachineProfile, machine_of, profiles
from knitcore.machine.program_check import check_program

from ...context import Context
from ...requests.base import NoRequest, RequestModel, ResultModel
from ..registry import Command, Operation

MAX_PROGRAM = 4_000_000


class MachineSummary(ResultModel):
    """A machine in short."""

    identifier: str
    name: str
    dialect: str = Field(description="knitout, kniterate, or hand: a plan in place of a program.")
    beds: int
    needles: int
    columns: int = Field(description="The widest chart.")
    gauge_needles_per_inch: float
    carriers: int
    reads_programs: bool
    profile: dict[str, Any] = Field(description="All figures, with their sources.")


class Machines(ResultModel):
    """The machines."""

    machines: list[MachineSummary]


def machines(request: NoRequest, context: Context) -> Machines:
    """Machines that knitout can be made for, and hand machines, with all figures and sources."""
    del request, context
    return Machines(machines=[_summary(machine) for machine in profiles().values()])


class ProgramRequest(RequestModel):
    """A program, and the machine that is to knit it."""

    program: str = Field(max_length=MAX_PROGRAM, description="A knitout program of anybody's.")
    machine: str | None = Field(
        None,
        max_length=MAX_BYTES,
        description="A machine's name, or a profile of one's own as JSON; the default if left out.",
    )


class ProblemResult(ResultModel):
    """Something that a machine cannot do with a program, or does badly."""

    line: int
    subject: str
    problem: str
    remedy: str
    stops: bool = Field(description="True if the machine refuses the program for it.")
    times: int = Field(description="Lines that show it.")


class ProgramCheck(ResultModel):
    """A program held against a machine."""

    machine: str
    problems: list[ProblemResult] = Field(description="Empty if the machine can knit it.")


def check_machine_program(request: ProgramRequest, context: Context) -> ProgramCheck:
    """Hold a knitout program against a machine: headers, carriers, needles, racking, passes.

    Raises
    ------
    InputError
        If there is no such machine, or its profile cannot be used.
    """
    del context
    machine = machine_of(request.machine)
    problems = check_program(request.program, machine)
    return ProgramCheck(
        machine=machine.name, problems=[ProblemResult.of(problem) for problem in problems]
    )


def machine_text(name: str) -> str:
    """A machine's name, or the content of the file of that name.

    Raises
    ------
    InputError
        If it looks like a file that is not there.
    """
    file = Path(name)
    if file.suffix.lower() != ".json":
        return name
    if not file.is_file():
        raise InputError("machine", f"{name} is not a file.", "Give a machine's name or profile.")
    return file.read_text(encoding="utf-8", errors="replace")


def _summary(machine: MachineProfile) -> MachineSummary:
    return MachineSummary.of(
        machine,
        carriers=machine.carriers.count,
        reads_programs=machine.reads_programs,
        profile=machine.to_dict(),
    )


@click.argument("name", metavar="MACHINE", required=False)
@click.option(
    "--program",
    metavar="FILE",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Hold a knitout program against MACHINE.",
)
def _command(
    request: NoRequest, context: Context, name: str | None, program: Path | None
) -> Machines | MachineSummary | ProgramCheck:
    text = None if name is None else machine_text(name)
    if program is not None:
        lines = program.read_text(encoding="utf-8", errors="replace")
        return check_machine_program(ProgramRequest(program=lines, machine=text), context)
    return machines(request, context) if text is None else _summary(machine_of(text))


def _lines(result: Machines | MachineSummary | ProgramCheck) -> list[str]:
    if isinstance(result, Machines):
        return [
            f"{m.identifier:20} {m.name}: {m.beds} {'bed' if m.beds == 1 else 'beds'}, "
            f"{m.needles} needles, {m.carriers} carriers, {m.dialect}"
            for m in result.machines
        ]
    if isinstance(result, MachineSummary):
        sources = result.profile["sources"]
        return [
            f"{result.name} ({result.identifier})",
            *(
                f"  {name:24} {_in_words(value)}  [{sources.get(name) or sources.get('')}]"
                for name, value in result.profile.items()
                if name not in ("identifier", "name", "sources", "format", "version")
            ),
        ]
    if not result.problems:
        return [f"{result.machine} can knit it"]
    return [
        f"line {p.line}: {p.subject}: {p.problem}{f' ({p.times} times)' if p.times > 1 else ''} "
        f"{p.remedy}"
        for p in result.problems
    ]


def _in_words(value: object) -> str:
    if isinstance(value, dict):
        parts = (f"{name} {_in_words(part)}" for name, part in value.items() if part is not None)
        return ", ".join(parts)
    if isinstance(value, tuple):
        return "; ".join(map(_in_words, value)) or "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "–" if value is None else str(value)


MACHINES = Operation(
    machines,
    method="GET",
    tag="files",
    summary="Knitting machines",
    command=Command(
        _lines, more="MACHINE is a name or the file of a profile of your own.", run=_command
    ),
)
PROGRAM = Operation(
    check_machine_program,
    path="/machines/check",
    tag="files",
    summary="A knitting program held against a machine",
    example={
        "program": ";!knitout-2\n;;Carriers: 1 2 3 4 5 6\nin 1\nknit + f1 1\nout 1\n",
        "machine": "kniterate",
    },
)
