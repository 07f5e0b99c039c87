"""The order in which users are served."""

from app.service.limits.turns import Turns


def test_users_take_turns_and_keep_their_own_order() -> None:
    turns = Turns[int]()
    for owner, item in (("ada", 1), ("ada", 2), ("ada", 3), ("bob", 4)):
        turns.add(owner, item)
    assert turns.next(lambda owner: owner == "bob") == ("bob", 4)
    turns.add("bob", 5)
    served = [turns.next() for _ in range(5)]
    assert served == [("ada", 1), ("bob", 5), ("ada", 2), ("ada", 3), None]
