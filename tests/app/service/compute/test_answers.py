import threading
from pathlib import Path
from typing import Any
from unittest.mock import Mock

from app.service.compute.answers import Answers, RecentResults
from app.service.jobs.kinds import KINDS


async def test_only_the_event_loop_uses_recent_results() -> None:
    """A thread between looking and noting the use would meet a result that is dropped."""
    threads = list[threading.Thread]()

    class Watched(RecentResults):
        def get(self, key: str) -> Any:
            threads.append(threading.current_thread())
            return super().get(key)

    answers = Answers(Mock(), Watched(), Path(), Mock())
    stretch = KINDS["stretch"]
    request = stretch.request.model_validate(stretch.example).model_dump_json()
    assert not await answers.can_be_viewed(stretch, request)
    assert threads == [threading.current_thread()]


def test_the_longest_unused_results_make_room() -> None:
    recent = RecentResults(most_bytes=10)
    for key in ("a", "b"):
        recent.put(key, key.upper(), 4)
    assert recent.get("a") == "A"
    recent.put("c", "C", 4)
    assert (recent.get("a"), recent.get("b"), recent.get("c")) == ("A", None, "C")


def test_a_single_large_result_is_kept() -> None:
    recent = RecentResults(most_bytes=10)
    recent.put("large", 1, 100)
    assert recent.get("large") == 1
    recent.put("next", 2, 1)
    assert recent.get("large") is None
    assert recent.get("next") == 2
