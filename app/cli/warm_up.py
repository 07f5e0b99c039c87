"""``knitcore warm-up``."""

from __future__ import annotations

import click


@click.command("warm-up")
def command() -> None:
    """Compile all kernels for this processor now, not when they are first needed."""
    from knitcore.warm_up import TASKS, warm_up

    click.echo(f"Compiling kernels for this processor in {len(TASKS)} parts …", err=True)
    for done, part in enumerate(warm_up(), start=1):
        click.echo(f"{done} of {len(TASKS)}: {part}", err=True)
