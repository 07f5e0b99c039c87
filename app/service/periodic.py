"""Chores of the service, done again and again beside its requests."""

import asyncio
import logging
from collections.abc import Awaitable, Callable

from .problems import StoreError

log = logging.getLogger("knitcore.app")


async def repeated(what: str, action: Callable[[], Awaitable[object]], period_s: float) -> None:
    """Act now and after each period; a failure is logged under what it is that failed."""
    while True:
        try:
            await action()
        except StoreError as error:
            log.warning("%s has to wait: %s", what, error)
        except Exception:
            log.exception("unexpected error: %s failed", what)
        await asyncio.sleep(period_s)
