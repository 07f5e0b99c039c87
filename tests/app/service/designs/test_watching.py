import asyncio

from app.service.designs.document import DesignDocument, DesignPatch, Run, Strokes
from app.service.designs.store import DesignStore
from app.service.designs.watching import Watched
from app.service.store.database import Database

RIB = DesignDocument(name="Cuff", material="acrylic", chart="KPKP\nKPKP")


async def test_those_who_follow_a_design_hear_of_each_other_and_of_its_changes(
    database: Database,
) -> None:
    watched = Watched()
    store = DesignStore(database, watched.changed)
    design = store.create("ada", RIB).id

    def follow(owner: str) -> tuple[asyncio.Queue[str], asyncio.Task[None]]:
        heard: asyncio.Queue[str] = asyncio.Queue()

        async def read() -> None:
            async for event in watched.events(owner, design, lambda: False):
                if event is not None:
                    await heard.put(event)

        return heard, asyncio.create_task(read())

    first, reads = follow("ada")
    assert await first.get() == "event: others\ndata: 0\n\n"
    second, leaves = follow("ada")
    stranger, strays = follow("bob")
    assert await stranger.get() == "event: others\ndata: 0\n\n"
    for follower in (first, second):
        assert await follower.get() == "event: others\ndata: 1\n\n"
    await asyncio.to_thread(store.patch, "ada", design, DesignPatch(name="Hem"), '"1"')
    runs = [Run(row=0, column=0, stitches="P")]
    await store.paint("ada", design, Strokes(rows=2, columns=4, runs=runs))
    for revision in ("2", "3"):
        for follower in (first, second):
            assert await follower.get() == f"event: changed\ndata: {revision}\n\n"
    leaves.cancel()
    assert await first.get() == "event: others\ndata: 0\n\n"
    assert stranger.empty()
    for task in (reads, strays):
        task.cancel()
