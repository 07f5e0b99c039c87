"""``knitcore``: the command line."""

from __future__ import annotations

import importlib
import pkgutil
from typing import Any

import click
from pydantic import ValidationError
from pydantic_settings import SettingsError

import app.cli as commands
from app.operations.registry import names_of_commands, operation_of_command
from knitcore.errors import KnitcoreError

NO_COMMANDS = {"main", "common", "commands"}
"""Modules of this package that hold none."""


class Failure(click.ClickException):
    """An error for the user: one line on stderr, exit code 2."""

    exit_code = 2

    def show(self, file: Any = None) -> None:
        """Print the message to stderr."""
        click.echo(f"Error: {self.message}", file=file, err=True)


class Commands(click.Group):
    """The operations, and what runs the service (a module here each); loaded when called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands."""
        modules = {m.name for m in pkgutil.iter_modules(commands.__path__)}
        return sorted(modules - NO_COMMANDS | names_of_commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name."""
        operation = operation_of_command(cmd_name)
        if operation is not None:
            from app.cli.commands import command_of

            return command_of(operation, cmd_name)
        if cmd_name not in {m.name for m in pkgutil.iter_modules(commands.__path__)} - NO_COMMANDS:
            return None
        module = importlib.import_module(f"{commands.__name__}.{cmd_name}")
        command = module.command
        assert isinstance(command, click.Command)  # noqa: S101 - a mistake of ours, not the user's
        return command

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; what goes wrong on purpose is told in one line."""
        try:
            return super().invoke(ctx)
        except KnitcoreError as error:
            raise Failure(str(error)) from error
        except SettingsError as error:
            raise Failure(f'{error}. Write a list as JSON, such as ["knit.example"].') from error
        except ValidationError as error:
            first = error.errors()[0]
            field = ".".join(str(part) for part in first["loc"])
            raise Failure(f"{field}: {first['msg']} (given: {first['input']!r}).") from error


@click.command(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="knitcore")
def main() -> None:
    """Design the mechanics of knitted fabric, stitch by stitch."""


if __name__ == "__main__":
    main(prog_name="knitcore")
