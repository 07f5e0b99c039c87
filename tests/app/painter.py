"""Somebody who paints while things go wrong, and knows what was acknowledged."""

from __future__ import annotations

import random
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

import httpx2 as httpx

from tests.app.running import wait_until

SIDE = 40


@dataclass
class Painter:
    """Paints one stitch after the other and notes every state that was acknowledged."""

    design: str
    rng: random.Random
    headers: Mapping[str, str] = field(default_factory=dict)
    states: dict[int, list[str]] = field(default_factory=lambda: {1: ["K" * SIDE] * SIDE})
    acknowledged: int = 1
    refused: list[str] = field(default_factory=list)

    @classmethod
    def with_a_design(cls, client: httpx.Client, seed: int) -> Painter:
        """One who begins a design of their own."""
        body = {"name": "x", "material": "acrylic", "chart": "\n".join(["K" * SIDE] * SIDE)}
        design = client.post("/api/v1/designs", json=body).json()["id"]
        return cls(design, random.Random(seed), dict(client.headers))  # noqa: S311

    def paint(self, client: httpx.Client) -> httpx.Response:
        """Change one stitch."""
        row, column = self.rng.randrange(SIDE), self.rng.randrange(SIDE)
        kind = self.rng.choice("KP")
        chart = list(self.states[self.acknowledged])
        line = chart[SIDE - 1 - row]
        chart[SIDE - 1 - row] = line[:column] + kind + line[column + 1 :]
        self.states[self.acknowledged + 1] = chart
        run = {"row": row, "column": column, "stitches": kind}
        answer = client.post(
            f"/api/v1/designs/{self.design}/strokes",
            json={"rows": SIDE, "columns": SIDE, "runs": [run]},
        )
        if answer.status_code == 200:
            self.acknowledged += 1
            assert answer.json()["revision"] == self.acknowledged
        return answer

    def paint_until(self, url: str, stop: threading.Event) -> None:
        with httpx.Client(base_url=url, timeout=60.0, headers=self.headers) as client:
            while not stop.is_set() and not self.refused:
                try:
                    answer = self.paint(client)
                except httpx.TransportError:
                    return  # killed: this stroke may be kept or not
                if answer.status_code != 200:
                    self.refused.append(answer.text)

    def check_over_http(self, client: httpx.Client, unanswered: int = 1) -> None:
        """Everything that was acknowledged is served."""
        stored = client.get(f"/api/v1/designs/{self.design}").raise_for_status().json()
        self.check(stored["revision"], stored["document"]["chart"], unanswered)

    def check(self, revision: int, chart: str, unanswered: int = 1) -> None:
        """Everything that was acknowledged is in this state of the design, and at most so many
        strokes that were never answered."""
        assert self.refused == []
        assert self.acknowledged <= revision <= self.acknowledged + unanswered
        assert chart.split("\n") == self.states[revision]
        self.acknowledged = revision


@contextmanager
def painting(url: str, painters: list[Painter]) -> Iterator[None]:
    """All of them paint while the block runs."""
    stop = threading.Event()
    threads = [threading.Thread(target=p.paint_until, args=(url, stop)) for p in painters]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        stop.set()
        for thread in threads:
            thread.join()


def until_painted(painters: list[Painter], revisions: int) -> None:
    """Wait until so many revisions of all painters together are acknowledged."""
    wait_until(lambda: sum(p.acknowledged for p in painters) >= revisions)
