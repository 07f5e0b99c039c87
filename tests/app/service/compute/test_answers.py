from app.service.compute.answers import RecentResults


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
