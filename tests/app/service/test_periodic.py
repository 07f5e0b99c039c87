"""A chore that failed is done again in its turn, whatever the failure was."""

import asyncio
import logging

import pytest

from app.service.periodic import repeated
from app.service.problems import NotFoundError, StoreError


async def test_a_failure_ends_nothing(caplog: pytest.LogCaptureFixture) -> None:
    outcomes = [ZeroDivisionError("of ours"), StoreError("away"), NotFoundError("gone"), None]
    ended = asyncio.Event()

    async def action() -> None:
        outcome = outcomes.pop(0)
        if outcome is not None:
            raise outcome
        ended.set()

    task = asyncio.create_task(repeated("knitting", action, 0.0))
    async with asyncio.timeout(60):
        await ended.wait()
    task.cancel()
    assert [(r.levelno, r.getMessage()) for r in caplog.records] == [
        (logging.ERROR, "unexpected error: knitting failed"),
        (logging.WARNING, "knitting has to wait: away"),
        (logging.ERROR, "unexpected error: knitting failed"),
    ]
