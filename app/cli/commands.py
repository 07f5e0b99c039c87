"""How an operation becomes a command.

1. Each field of the request becomes an argument or an option (:mod:`app.cli.inputs`).
2. ``Command.fields`` and ``Command.run`` add the options that ``click.option`` declares on them.
3. A call makes the request: of the fields' values, and of what ``Command.fields`` returns.
4. ``Command.run``, or else ``Operation.run``, gets the request, the context and its own options.
5. stdout gets the result, as JSON or as ``Command.lines``; stderr gets its remarks.
"""

import re
from collections.abc import Callable
from functools import partial
from inspect import signature
from typing import Any

import click
from pydantic import BaseModel

from knitcore.base.errors import InputError

from ..context import Context
from ..operations.perform import carried_out
from ..operations.registry import Operation
from ..requests.base import IntervalResult
from .common import UserMaterials, emit, json_option, telling_what_is_compiled, user_data_dir
from .inputs import Inputs
from .options import CHART_HELP


def command_of(operation: Operation[Any, Any], name: str, line: str = "") -> click.Command:
    """Make the command of an operation; its help begins with a line, or the summary."""
    declared = operation.command
    if declared is None:
        raise TypeError(f"{operation.name} is not a command")
    inputs = Inputs(declared.request or operation.request, declared.names)

    def callback(**given: Any) -> None:
        run: Callable[..., Any] = declared.run or operation.run
        run = partial(run, **_options_for(declared.run, given))
        try:
            with telling_what_is_compiled():
                more = declared.fields or dict
                request = inputs.request(given, more(**_options_for(declared.fields, given)))
                context = Context(user_data_dir, own=UserMaterials(), local=True)
                result = carried_out(run, request, context).result
        except InputError as error:
            raise _with_options(error, command) from error
        emit(result, "\n".join(declared.lines(result)), as_json=given["as_json"])
        for remark in () if given["as_json"] else _remarks(result):
            click.echo(remark, err=True)  # the result may be piped on

    help_text = f"{line or operation.summary + '.'} {declared.more}".rstrip()
    epilog = CHART_HELP if "chart" in inputs.names else None
    command = json_option(click.command(name, help=help_text, epilog=epilog)(callback))
    command.params = [
        *inputs.parameters,
        *_declared_on(declared.fields),
        *_declared_on(declared.run),
        *command.params,
    ]
    return command


def _declared_on(function: Callable[..., Any] | None) -> list[click.Parameter]:
    """List the options that ``click.option`` added to a function, in the order of its lines."""
    return list(reversed(getattr(function, "__click_params__", [])))


def _options_for(function: Callable[..., Any] | None, given: dict[str, Any]) -> dict[str, Any]:
    """Choose the options that a function has parameters for."""
    return {n: given[n] for n in signature(function).parameters if n in given} if function else {}


def _with_options(error: InputError, command: click.Command) -> InputError:
    """Name options instead of fields in an error and in those that came with it."""
    options = (option for option in command.params if isinstance(option, click.Option))
    names = {option.name: max(option.opts, key=len).removeprefix("--") for option in options}
    field = names.get(error.field, error.field)
    named = InputError(field, error.problem, error.remedy, most=error.most)
    named.others = tuple(_with_options(other, command) for other in error.others)
    return named


def _remarks(result: BaseModel) -> list[str]:
    """List what a result says besides its figures."""
    heads = (("notes", "note: "), ("messages", ""), ("warnings", "warning: "))
    remarks = [f"{head}{remark}" for field, head in heads for remark in getattr(result, field, ())]
    if isinstance(result, IntervalResult):
        remarks += _interval_lines(result.interval_source)
    return remarks


def _interval_lines(source: str) -> list[str]:
    """Say what intervals rest on, each sentence in a line, with a dash after its subject."""
    if source.startswith("No interval"):
        return [source]
    sentences = re.split(r"(?<=\.) (?=[A-Z])", source)
    return [
        "90 % intervals rest on",
        *("  " + re.sub(r"^(\w+): ", r"\1 – ", sentence) for sentence in sentences),
    ]
