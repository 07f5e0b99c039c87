"""``knitcore``: the command line."""

from __future__ import annotations

import importlib
import pkgutil
from typing import Any

import click
from pydantic import ValidationError

import app.cli as package
from app.models.base import first_fault
from app.operations.registry import commands, operation_of_command
from knitcore.errors import KnitcoreError

GROUPS = {"measure": "Measure a yarn: its bending modulus and its compressibility."}
"""Groups of commands, which are operations."""
NO_COMMANDS = {"main", "common", "commands", "options"}
"""Modules of this package that hold no command."""


class Failure(click.ClickException):
    """An error for the user: a line on stderr for each fault, exit code 2."""

    exit_code = 2

    def show(self, file: Any = None) -> None:
        """Print the message to stderr."""
        click.echo(f"Error: {self.message}", file=file, err=True)


class Operations(click.Group):
    """Commands made of the operations of a group, each loaded when it is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands."""
        return sorted(commands(self.operations_of))

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name."""
        try:
            operation = operation_of_command(cmd_name, self.operations_of)
        except ModuleNotFoundError as error:
            return _not_installed(cmd_name, error)
        if operation is None:
            return None
        from app.cli.commands import command_of

        return command_of(operation, cmd_name)

    @property
    def operations_of(self) -> str:
        """The group of its operations."""
        return self.name if self.name in GROUPS else ""


class Commands(Operations):
    """All commands: operations, and those that run the service, each a module of this package."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands."""
        return sorted({*super().list_commands(ctx), *_own_commands(), *GROUPS})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name."""
        if cmd_name in GROUPS:
            return Operations(cmd_name, help=GROUPS[cmd_name])
        if cmd_name in _own_commands():
            try:
                name = cmd_name.replace("-", "_")
                module = importlib.import_module(f"{package.__name__}.{name}")
            except ModuleNotFoundError as error:
                return _not_installed(cmd_name, error)
            found: click.Command = module.command
            return found
        return super().get_command(ctx, cmd_name)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; expected errors are printed in one line each."""
        try:
            return super().invoke(ctx)
        except KnitcoreError as error:
            found = (error, *getattr(error, "others", ()))
            raise Failure("\n".join(map(str, found))) from error
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


def _own_commands() -> set[str]:
    modules = {module.name for module in pkgutil.iter_modules(package.__path__)} - NO_COMMANDS
    return {name.replace("_", "-") for name in modules}


@click.command(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="knitcore")
def main() -> None:
    """Design the mechanics of knitted fabric, stitch by stitch."""


if __name__ == "__main__":
    main(prog_name="knitcore")
