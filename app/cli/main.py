"""``knitcore``: the command line."""

from __future__ import annotations

import importlib
from typing import Any

import click
from pydantic import ValidationError

from knitcore.base.errors import KnitcoreError

from ..operations.registry import commands, operation_of_command
from ..requests.base import first_fault
from .options import CHART_HELP

GROUPS = {"measure": "Measure a yarn's bending and its compression."}
"""Groups of commands, which are operations."""
SERVICE = {
    "serve": ".serve:command",
    "doctor": ".machine:doctor",
    "warm-up": ".machine:warm_up",
    "token": ".token:command",
    "backup": ".backups:backup",
    "restore": ".backups:restore",
}
"""Commands that are no operations, and where each is in this package."""
SECTIONS: dict[str, tuple[str, ...]] = {
    "Design": ("find", "fill", "shape", "atlas"),
    "Fabric": (
        *("predict", "curve", "stretch", "bias", "biaxial", "trellis", "piece"),
        *("curl", "border", "hang", "drape", "overhang", "rs"),
    ),
    "Yarn": (
        *("materials", "estimate", "characterise"),
        *("relax", "whole", "tube", "sweep", "hysteresis", "bend"),
    ),
    "Measure": ("fit", "measure", "calibrate", "compare"),
    "Garment": ("garment", "glove", "limb", "pressure"),
    "Files": ("import", "export"),
    "Serve": (*SERVICE, "extensions"),
}
"""Sections of the help; a command that is in none is listed last."""
LAST_SECTION = "More"


class Failure(click.ClickException):
    """An error for the user: a line on stderr for each fault, exit code 2."""

    exit_code = 2

    def show(self, file: Any = None) -> None:
        """Print the message to stderr."""
        click.echo(f"Error: {self.message}", file=file, err=True)


class Operations(click.Group):
    """Commands made of the operations of a group, each loaded when it is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """List the names of all commands."""
        return sorted(commands(self.operations_of))

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load the command of that name."""
        try:
            operation = operation_of_command(cmd_name, self.operations_of)
        except ModuleNotFoundError as error:
            return _not_installed(cmd_name, error)
        if operation is None:
            return None
        from .commands import command_of

        return command_of(operation, cmd_name)

    @property
    def operations_of(self) -> str:
        """The group of its operations."""
        return self.name if self.name in GROUPS else ""


class Commands(Operations):
    """All commands: operations, their groups, and those that run the service."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """List the names of all commands, section by section."""
        return [name for names in self.sections(ctx).values() for name in names]

    def sections(self, ctx: click.Context) -> dict[str, list[str]]:
        """Sort the names of all commands into sections."""
        every = {*super().list_commands(ctx), *SERVICE, *GROUPS}
        sections = {
            title: [name for name in names if name in every] for title, names in SECTIONS.items()
        }
        rest = every.difference(*SECTIONS.values())
        return sections | ({LAST_SECTION: sorted(rest)} if rest else {})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load the command of that name."""
        if cmd_name in GROUPS:
            return Operations(cmd_name, help=GROUPS[cmd_name])
        if cmd_name in SERVICE:
            module, _, name = SERVICE[cmd_name].partition(":")
            try:
                command: click.Command = getattr(importlib.import_module(module, __package__), name)
            except ModuleNotFoundError as error:
                return _not_installed(cmd_name, error)
            return command
        return super().get_command(ctx, cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write each section with one line for each of its commands."""
        sections = self.sections(ctx)
        width = max(len(name) for names in sections.values() for name in names)
        for title, names in sections.items():
            made = [(name, self.get_command(ctx, name)) for name in names]
            rows = [
                (name.ljust(width), command.get_short_help_str(formatter.width - 6 - width))
                for name, command in made
                if command is not None
            ]
            with formatter.section(title):
                formatter.write_dl(rows)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; expected errors are printed in one line each."""
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


def _not_installed(name: str, error: ModuleNotFoundError) -> click.Command:
    """Takes the place of a command whose packages are not installed."""
    remedy = _remedy(error)

    def refuse() -> None:
        raise Failure(remedy)

    anything = {"ignore_unknown_options": True, "allow_extra_args": True}
    return click.Command(name, callback=refuse, help=remedy, context_settings=anything)


def _remedy(error: ModuleNotFoundError) -> str:
    return f"{error.name} is not installed. Run: pip install 'knitcore[service]'"


@click.command(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=f"{CHART_HELP} `knitcore COMMAND --help` lists the options of a command; each of them "
    "has --json.",
)
@click.version_option(package_name="knitcore")
def main() -> None:
    """Design the mechanics of knitted fabric, stitch by stitch."""


if __name__ == "__main__":
    main(prog_name="knitcore")
