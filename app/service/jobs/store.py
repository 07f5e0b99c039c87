"""Jobs and results in the database, which survive a restart."""

import contextlib
import secrets
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    Select,
    bindparam,
    func,
    insert,
    select,
    update,
)

from ..designs.conditions import Retry, once
from ..limits.user_limits import USER_LIMITS, OverLimitError
from ..problems import NotFoundError, Problem, StoreError
from ..store.database import Database
from ..store.tables import job_requests, jobs, results
from .document import JobPage, JobState, JobStatus

WAITING, RUNNING = OPEN = (JobState.WAITING.value, JobState.RUNNING.value)
PART_BYTES = 65_536
"""Part of a result that is read from the database at once."""
NOTED_EACH_S = 600.0
"""Time after which a use of a result is noted again."""
KEPT_S = 30 * 86_400.0
ORPHANED_S = 60.0
"""A process not seen for this long, by the clock of the database, counts as gone; the others take
over its jobs."""
INTERRUPTED = Problem(
    type="interrupted",
    title="The service stopped in the middle of this job",
    status=503,
    detail="The service was stopped or failed while this job ran.",
    remedy="Run it again.",
)


@dataclass(frozen=True)
class StoredResult:
    """A result in the database, of which only a part at a time is in memory.

    Attributes
    ----------
    database : where it is.
    key : of its content.
    size_bytes : of its gzipped JSON.
    """

    database: Database
    key: str
    size_bytes: int

    @property
    def unpacked_bytes(self) -> int:
        """Size of its JSON, from the last four bytes of the gzip format (RFC 1952)."""
        return int.from_bytes(self._part(self.size_bytes - 4, 4) or b"", "little")

    def packed(self) -> Iterator[bytes]:
        """Parts of its gzipped JSON; they end early if it is deleted meanwhile."""
        for start in range(0, self.size_bytes, PART_BYTES):
            part = self._part(start, min(PART_BYTES, self.size_bytes - start))
            if part is None:
                return
            yield part

    def unpacked(self) -> Iterator[bytes]:
        """Parts of its JSON."""
        gzip = zlib.decompressobj(wbits=31)
        for part in self.packed():
            yield gzip.decompress(part, PART_BYTES)
            while gzip.unconsumed_tail:
                yield gzip.decompress(gzip.unconsumed_tail, PART_BYTES)
        yield gzip.flush()

    def _part(self, start: int, size: int) -> bytes | None:
        with self.database.read() as connection:
            row = results.c.key == self.key
            return self.database.backend.part_of(connection, results.c.body, row, start, size)


class JobStore:
    """Jobs of all owners, and the results by content.

    Parameters
    ----------
    database : where they are kept.
    process : name of this service process; jobs that carry it are run by it.
    """

    def __init__(self, database: Database, process: str) -> None:
        self._database = database
        self.process = process

    def add(
        self,
        owner: str,
        kind: str,
        request: str,
        key: str,
        state: JobState,
        *,
        job: str | None = None,
        retry: Retry | None = None,
    ) -> JobStatus:
        """Store a new job, with this id if one is given; it is done if its result is known.

        If the request was sent before, its first job is returned, which has another id.

        Raises
        ------
        OverLimitError
            If the requests of this owner's open jobs leave no room for it.
        """
        at = self._database.clock
        values = {
            "id": job or secrets.token_urlsafe(16),
            "owner": owner,
            "process": self.process,
            "kind": kind,
            "size_bytes": len(request),
            "key": key,
            "state": state.value,
            "created_at": at,
            "seen_at": at,
            "finished_at": at if state.is_final else None,
        }

        def action(connection: Connection) -> JobStatus:
            _make_room(connection, owner, len(request))
            connection.execute(insert(jobs).values(values))
            connection.execute(insert(job_requests).values(job_id=values["id"], request=request))
            return _status(_job(connection, owner, str(values["id"])))

        return once(self._database, retry, JobStatus, action)

    def kept_bytes(self, owner: str) -> int:
        """Size of the requests of an owner's jobs."""
        with self._database.read() as connection:
            return _kept_bytes(connection, owner)

    def get(self, owner: str, job: str) -> JobStatus:
        """A job."""
        with self._database.read() as connection:
            return _status(_job(connection, owner, job))

    def request_of(self, owner: str, job: str) -> tuple[str, str]:
        """Kind and request of a job."""
        with self._database.read() as connection:
            kind = _job(connection, owner, job).kind
            request = select(job_requests.c.request).where(job_requests.c.job_id == job)
            return kind, connection.execute(request).scalar_one()

    def page(self, owner: str, *, limit: int, cursor: str | None) -> JobPage:
        """Jobs of an owner, latest first."""
        mine = select(jobs).where(jobs.c.owner == owner)
        rows, following = self._database.page(
            mine, jobs.c.created_at, jobs.c.id, limit=limit, cursor=cursor
        )
        return JobPage(jobs=[_status(row) for row in rows], next_cursor=following)

    def begin(self, job: str) -> bool:
        """Mark a waiting job as running; False if it no longer waits."""
        return self._move(job, (WAITING,), RUNNING, started_at=self._database.clock)

    def wait_again(self, job: str) -> bool:
        """Put a running job back in the queue."""
        return self._move(job, (RUNNING,), WAITING, started_at=None, progress=0.0)

    def end(
        self,
        job: str,
        state: JobState,
        problem: Problem | None = None,
        *,
        progress: float | None = None,
    ) -> bool:
        """Close an open job, with the progress it made; False if it was closed before."""
        packed = None if problem is None else problem.model_dump_json()
        reached = {} if progress is None else {"progress": progress}
        return self._move(
            job, OPEN, state.value, problem=packed, finished_at=self._database.clock, **reached
        )

    def _move(self, job: str, before: tuple[str, ...], after: str, **values: Any) -> bool:
        change = (
            update(jobs)
            .where(jobs.c.id == job, jobs.c.state.in_(before))
            .values(state=after, **values)
        )
        return self._database.write(lambda connection: connection.execute(change).rowcount == 1)

    def adopt(self) -> list[tuple[str, str]]:
        """Mark running jobs as interrupted after a start; return (id, owner) of waiting ones."""
        return self._take(jobs.c.process == self.process)

    def adopt_orphans(self) -> list[tuple[str, str]]:
        """Mark running jobs of processes that are gone as interrupted; return the waiting ones."""
        return self._take(jobs.c.seen_at < self._database.clock - ORPHANED_S)

    def _take(self, which: ColumnElement[bool]) -> list[tuple[str, str]]:
        def action(connection: Connection) -> list[tuple[str, str]]:
            connection.execute(
                update(jobs)
                .where(which, jobs.c.state == RUNNING)
                .values(
                    state=JobState.INTERRUPTED.value,
                    problem=INTERRUPTED.model_dump_json(),
                    finished_at=self._database.clock,
                )
            )
            waiting = connection.execute(
                update(jobs)
                .where(which, jobs.c.state == WAITING)
                .values(process=self.process, seen_at=self._database.clock)
                .returning(jobs.c.id, jobs.c.owner, jobs.c.created_at)
            )
            rows = sorted(waiting, key=lambda row: row.created_at)
            return [(row.id, row.owner) for row in rows]

        return self._database.write(action)

    def beat(self, shares: Mapping[str, float]) -> set[str]:
        """Share the progress of this process's open jobs, and that it is alive.

        Returns those no longer open: they were cancelled through another process, or taken over by
        one that took this one for dead.
        """

        def action(connection: Connection) -> set[str]:
            report = (
                update(jobs)
                .where(
                    jobs.c.id == bindparam("job"),
                    jobs.c.process == self.process,
                    jobs.c.state.in_(OPEN),
                )
                .values(progress=bindparam("share"), seen_at=self._database.clock)
                .returning(jobs.c.id)
            )
            open_ = (
                connection.execute(report, {"job": job, "share": share}).scalar()
                for job, share in shares.items()
            )
            return set(shares) - {job for job in open_ if job is not None}

        return self._database.write(action)

    def result(self, owner: str, job: str) -> StoredResult | None:
        """The result of a job, or None if it is not stored."""
        with self._database.read() as connection:
            key = _job(connection, owner, job).key
            stored = connection.execute(self._stored(key)).one_or_none()
        if stored is None:
            return None
        self._used(key, stored.is_stale)
        return StoredResult(self._database, key, stored.size_bytes)

    def knows(self, key: str) -> bool:
        """Return whether the result of this content is stored; if so, renew its time of use."""
        with self._database.read() as connection:
            stored = connection.execute(self._stored(key)).one_or_none()
        if stored is not None:
            self._used(key, stored.is_stale)
        return stored is not None

    def _stored(self, key: str) -> Select[tuple[int, bool]]:
        """A result's size, and whether its last use was noted long ago."""
        is_stale = results.c.used_at < self._database.clock - NOTED_EACH_S
        return select(results.c.size_bytes, is_stale.label("is_stale")).where(results.c.key == key)

    def _used(self, key: str, is_stale: bool) -> None:
        """Note that a result is used; every time would be a change of the database each."""
        if not is_stale:
            return
        used = update(results).where(results.c.key == key).values(used_at=self._database.clock)
        with contextlib.suppress(StoreError):  # with a full disk it can still be read
            self._database.write(lambda connection: connection.execute(used))

    def finish(self, job: str, kind: str, key: str, body: bytes) -> bool:
        """Store a compressed result and close its job, both or neither."""

        def action(connection: Connection) -> bool:
            done = connection.execute(
                update(jobs)
                .where(jobs.c.id == job, jobs.c.state.in_(OPEN))
                .values(state=JobState.DONE.value, finished_at=self._database.clock)
            )
            # equal jobs of two processes end at once: either result is the right one
            connection.execute(
                self._database.backend.insert_new(results).values(
                    key=key,
                    kind=kind,
                    body=body,
                    size_bytes=len(body),
                    used_at=self._database.clock,
                )
            )
            return done.rowcount == 1

        return self._database.write(action)

    def tidy(self, most_bytes: int) -> None:
        """Delete old jobs, and the longest unused results beyond a size."""

        def action(connection: Connection) -> None:
            old = jobs.c.finished_at < self._database.clock - KEPT_S
            connection.execute(jobs.delete().where(old))
            newest = func.sum(results.c.size_bytes).over(
                order_by=(results.c.used_at.desc(), results.c.key)
            )
            sizes = select(results.c.key, newest.label("so_far")).subquery()
            too_many = select(sizes.c.key).where(sizes.c.so_far > most_bytes)
            connection.execute(results.delete().where(results.c.key.in_(too_many)))

        self._database.write(action)


def _kept_bytes(connection: Connection, owner: str) -> int:
    size = select(func.coalesce(func.sum(jobs.c.size_bytes), 0))
    return int(connection.execute(size.where(jobs.c.owner == owner)).scalar_one())


def _make_room(connection: Connection, owner: str, more: int) -> None:
    """Delete the jobs of an owner that ended the longest ago, as many as a new request needs.

    Raises
    ------
    OverLimitError
        If the open jobs alone leave too little room.
    """
    if _kept_bytes(connection, owner) + more <= USER_LIMITS.job_bytes:
        return
    ended = jobs.c.finished_at.is_not(None)
    so_far = func.sum(jobs.c.size_bytes).over(
        order_by=(ended, jobs.c.finished_at.desc(), jobs.c.id)
    )
    sizes = select(jobs.c.id, so_far.label("so_far")).where(jobs.c.owner == owner).subquery()
    oldest = select(sizes.c.id).where(sizes.c.so_far + more > USER_LIMITS.job_bytes)
    connection.execute(jobs.delete().where(jobs.c.id.in_(oldest), ended))
    if (held := _kept_bytes(connection, owner)) + more > USER_LIMITS.job_bytes:
        raise OverLimitError(
            f"The requests of your jobs that wait or run have {held / 1e6:.1f} of"
            f" {USER_LIMITS.job_bytes / 1e6:g} MB.",
            field="job_bytes",
            remedy="Wait until one has ended, or cancel one.",
        )


def _job(connection: Connection, owner: str, job: str) -> Row[Any]:
    mine = select(jobs).where(jobs.c.id == job, jobs.c.owner == owner)
    row = connection.execute(mine).one_or_none()
    if row is None:
        raise NotFoundError(
            f"You have no job {job}.", field="job", remedy="Look it up in the list of your jobs."
        )
    return row


def _status(row: Row[Any]) -> JobStatus:
    problem = None if row.problem is None else Problem.model_validate_json(row.problem)
    progress = 1.0 if row.state == JobState.DONE else row.progress
    return JobStatus.model_validate({**row._mapping, "problem": problem, "progress": progress})
