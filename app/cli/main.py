"""``knitcore``: the command line."""

import importlib
from collections.abc import Mapping
from typing import Any

import click

from knitcore.base.errors import KnitcoreError
from knitcore.base.loading import loading

from .options import CHART_HELP

Entry = tuple[str, str]
"""Where a command is, and its line in the help.

An operation is named by its module in :mod:`app.operations`. Any other command is named by its
module in this package and a name there; its line is its own. A group has no module.
"""
SECTIONS: dict[str, dict[str, Entry]] = {
    "Design": {
        "find": ("design.find", "Find repeats that meet targets, the surest first."),
        "fill": ("design.fill", "Design a chart with given moduli at each stitch."),
        "shape": ("design.fill", "Design a chart that takes given widths when it is stretched."),
        "atlas": ("design.atlas", "Predict every repeat of a material, for `knitcore find`."),
    },
    "Fabric": {
        "predict": ("chart.predict", "Predict moduli, Poisson's ratios and size at rest of CHART."),
        "curve": ("chart.curve", "Predict the stress-strain curve of CHART."),
        "stretch": ("cloth.stretch", "Pull CHART between two clamps, as in a strip test."),
        "bias": ("cloth.cut_tests", "Pull a strip cut from CHART at an angle to its rows."),
        "biaxial": ("cloth.cut_tests", "Pull all four edges of a rectangle of CHART outwards."),
        "trellis": ("cloth.cut_tests", "Shear a square of CHART in a hinged frame."),
        "piece": ("cloth.piece", "Load a piece of any outline that is cut from CHART."),
        "curl": ("cloth.curl", "Compute how the whole piece CHART curls and folds."),
        "border": ("cloth.weighing", "Compute how wide a border keeps a piece of CHART flat."),
        "hang": ("cloth.hang", "Compute how the whole piece CHART hangs under its weight."),
        "drape": ("cloth.weighing", "Drape a round piece of CHART over a disc."),
        "overhang": ("cloth.weighing", "Bend a strip of CHART over the edge of a table."),
        "rs": ("yarn.rs", "Compute the four pure fabrics by the reduced-symmetry model."),
    },
    "Yarn": {
        "materials": ("yarn.materials", "List the library's materials, or explain one."),
        "estimate": ("yarn.estimate", "Estimate the fabrics of a yarn that is not in the library."),
        "characterise": (
            "yarn.characterise",
            "Simulate the pure fabrics of yarns and fit their laws.",
        ),
        "relax": ("yarn.relax", "Compute the yarn's shape at rest in the repeat CHART."),
        "whole": ("yarn.whole", "Compute the yarn's shape at rest in a whole CHART."),
        "tube": ("yarn.tube", "Compute the yarn's shape at rest in a tube knitted of CHART."),
        "sweep": ("yarn.sweep", "Stretch the yarn of the repeat CHART and fit a law to it."),
        "hysteresis": (
            "yarn.hysteresis",
            "Load and unload the repeat CHART, with friction in its yarn.",
        ),
        "bend": ("yarn.bend", "Compute bending rigidity and curl of the repeat CHART."),
    },
    "Measure": {
        "fit": ("measure.fit", "Fit a law to a course-wise and a wale-wise stretch test."),
        "measure": ("", "Measure a yarn without a tester, its bending, its compression."),
        "calibrate": (
            "measure.fields",
            "Fit shear and couplings to a measured displacement field.",
        ),
        "compare": ("measure.fields", "Compare a law with a measured displacement field."),
    },
    "Garment": {
        "garment": ("garment.garment", "Plan a garment from a TEMPLATE and measurements."),
        "glove": ("garment.glove", "Compute how a glove fits a hand and presses on it."),
        "limb": ("garment.limb", "Compute how a tube of CHART fits a limb and presses on it."),
        "pressure": ("garment.pressure", "Compute the pressure of a knitted tube on a limb."),
    },
    "Files": {
        "import": ("files.imports", "Read the chart in FILE."),
        "machines": ("files.machines", "List knitting machines, explain one, or check a program."),
        "export": ("files.export", "Write CHART for machines, knitters or other programs."),
        "program": (
            "machine.program_report",
            "Report passes, tightest loop, minutes and yarn of a program.",
        ),
        "dial": ("machine.dial", "Give a machine's stitch number for a loop length."),
        "knit-along": ("files.along", "Print CHART row by row, as it is knitted."),
    },
    "Serve": {
        "serve": (".serve:command", ""),
        "doctor": (".service:doctor", ""),
        "warm-up": (".service:warm_up", ""),
        "token": (".service:token", ""),
        "backup": (".service:backup", ""),
        "restore": (".service:restore", ""),
        "extensions": ("files.installed", "List what installed packages add to Knitcore."),
    },
}
"""Commands by section of the help, whose lines are here so that it loads no operation."""
GROUPS: dict[str, dict[str, Entry]] = {
    "measure": {
        "bending": ("measure.bending", "Measure a yarn's bending modulus from IMAGES."),
        "compression": (
            "measure.compression",
            "Fit the contact law of a yarn to compression tests.",
        ),
        "marks": ("measure.photos", "Write the sheet of marks for photos of a hanging swatch."),
        "photos": ("measure.photos", "Read the stretch of a hanging swatch in IMAGES."),
        "pull": ("measure.pull", "Narrow the laws of a yarn by one stretch TEST of a fabric."),
        "swatch": ("measure.swatch", "Estimate a yarn from a swatch, without a tester."),
    }
}
"""Commands of groups."""


class Failure(click.ClickException):
    """An error for the user: a line on stderr for each fault, exit code 2."""

    exit_code = 2

    def show(self, file: Any = None) -> None:
        """Print the message to stderr."""
        click.echo(f"Error: {self.message}", file=file, err=True)


class Commands(click.Group):
    """Commands that are loaded when they are called.

    Parameters
    ----------
    sections : the commands, by section of the help.
    """

    def __init__(self, *, sections: Mapping[str, Mapping[str, Entry]], **more: Any) -> None:
        super().__init__(**more)
        self.sections = sections

    @property
    def entries(self) -> dict[str, Entry]:
        """All commands, section by section."""
        return {name: entry for of in self.sections.values() for name, entry in of.items()}

    def list_commands(self, ctx: click.Context) -> list[str]:
        """List the names of all commands, section by section."""
        return list(self.entries)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load the command of that name."""
        if cmd_name not in self.entries:
            return None
        module, line = self.entries[cmd_name]
        if not module:
            return Commands(name=cmd_name, help=line, sections={"Commands": GROUPS[cmd_name]})
        try:
            with loading():
                return _loaded(cmd_name, module, line)
        except ModuleNotFoundError as error:
            return _not_installed(cmd_name, error)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write each section with one line for each of its commands."""
        width = max(map(len, self.entries))
        for title, entries in self.sections.items():
            with formatter.section(title):
                formatter.write_dl(
                    [
                        (name.ljust(width), line or self._own_line(ctx, name, formatter))
                        for name, (_, line) in entries.items()
                    ]
                )

    def _own_line(self, ctx: click.Context, name: str, formatter: click.HelpFormatter) -> str:
        command = self.get_command(ctx, name)
        room = formatter.width - 6 - max(map(len, self.entries))
        return "" if command is None else command.get_short_help_str(room)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; expected errors are printed in one line each."""
        with loading():
            from pydantic import ValidationError

            from ..requests.base import first_fault

        try:
            return super().invoke(ctx)
        except KnitcoreError as error:
            faults = (error, *getattr(error, "others", ()))
            raise Failure("\n".join(map(str, faults))) from error
        except ModuleNotFoundError as error:
            raise Failure(_remedy(error)) from error
        except ValidationError as error:
            given = error.errors()[0]["input"]
            raise Failure(f"{first_fault(error)} (given: {given!r}).") from error


def _loaded(name: str, module: str, line: str) -> click.Command:
    """Load a command from its module."""
    if not line:
        file, _, attribute = module.partition(":")
        command: click.Command = getattr(importlib.import_module(file, __package__), attribute)
        return command
    from ..operations.registry import operations_in
    from .commands import command_of

    (operation,) = (of for of in operations_in(module) if of.name == name.replace("-", "_"))
    return command_of(operation, name, line)


def _not_installed(name: str, error: ModuleNotFoundError) -> click.Command:
    """A command in place of one whose packages are not installed: it says what to install."""
    remedy = _remedy(error)

    def refuse() -> None:
        raise Failure(remedy)

    anything = {"ignore_unknown_options": True, "allow_extra_args": True}
    return click.Command(name, callback=refuse, help=remedy, context_settings=anything)


def _remedy(error: ModuleNotFoundError) -> str:
    return f"{error.name} is not installed. Run: pip install 'knitcore[service]'"


@click.command(
    cls=Commands,
    sections=SECTIONS,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=f"{CHART_HELP} `knitcore COMMAND --help` lists the options of a command; each of them "
    "has --json.",
)
@click.version_option(package_name="knitcore")
def main() -> None:
    """Design the mechanics of knitted fabric, stitch by stitch."""


if __name__ == "__main__":
    main(prog_name="knitcore")
