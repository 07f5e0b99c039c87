"""Workers on a Dask cluster: the same jobs with progress and cancel, on other machines.

The cluster runs the same program. A job's progress goes through the scheduler as events; its
cancellation goes to all its machines, and the one that runs it stops it. If a machine dies in
mid-job, the job is retried on another, as often as the scheduler's ``allowed-failures`` says; then
it fails.
"""

import asyncio
import contextlib
import logging
import secrets
import threading
import time
from collections.abc import Awaitable, Callable
from concurrent.futures import CancelledError, Future
from typing import Any, TypeVar

from distributed import Client, get_worker
from distributed.client import Future as ClusterFuture
from distributed.scheduler import KilledWorker

from .workers import NotBegunError, WorkerDiedError, call

log = logging.getLogger("knitcore.compute")
T = TypeVar("T")

TOPIC = "knitcore"
CONNECT_S = 5.0
WORKERS_S = 10.0
"""Time for which a job waits for the first worker of a cluster."""
REPORT_EVERY_S = 0.2


class ClusterError(NotBegunError):
    """The cluster does not answer."""


class Cluster:
    """The connection to a scheduler, made when it is needed, and again when it was lost.

    Attributes
    ----------
    address : of the scheduler, such as ``tcp://scheduler:8786``.
    """

    def __init__(self, address: str) -> None:
        self.address = address
        self._client: Client | None = None
        self._lock = threading.Lock()
        self.listeners: dict[str, ClusterWorker] = {}

    def begin(self, key: str, job: Callable[..., Any]) -> ClusterFuture[Any]:
        """Submit a job; its progress goes to the listener with its key.

        Raises
        ------
        ClusterError
        """
        client = self._connected()
        try:
            client.wait_for_workers(1, timeout=WORKERS_S)
        except TimeoutError:
            raise _no_workers() from None
        return client.submit(_run, key, job, key=f"knitcore-{key}", pure=False)

    def check(self) -> None:
        """Check that the scheduler answers and has workers.

        Raises
        ------
        ClusterError
        """
        if not self._connected().scheduler_info(n_workers=-1)["workers"]:
            raise _no_workers()

    def later(self, action: Callable[[Client], Awaitable[Any]]) -> None:
        """Run an action in the client's own thread, where its methods can be awaited."""
        client = self._client
        if client is None or client.loop is None or client.status != "running":
            return

        async def act() -> None:
            with contextlib.suppress(OSError, TimeoutError, CancelledError):  # gone with its jobs
                await action(client)

        client.loop.add_callback(act)

    def close(self) -> None:
        """Disconnect from the scheduler, which then drops the jobs of this client."""
        with self._lock:
            client, self._client = self._client, None
        if client is not None:
            client.close(timeout=2)

    def _connected(self) -> Client:
        with self._lock:
            if self._client is not None and self._client.status == "running":
                return self._client
            if self._client is not None:
                self._client.close(timeout=2)
            try:
                self._client = Client(self.address, timeout=CONNECT_S, set_as_default=False)
            except (OSError, TimeoutError) as error:
                self._client = None
                log.warning("no scheduler answers at %s: %s", self.address, error)
                raise ClusterError("The machines that compute cannot be reached.") from None
            self._client.subscribe_topic(TOPIC, self._hear)
            return self._client

    def _hear(self, event: tuple[float, dict[str, Any]]) -> None:
        message = event[1]
        if (worker := self.listeners.get(message["job"])) is not None:
            worker.share, worker.address = message["share"], message["worker"]


def _no_workers() -> ClusterError:
    return ClusterError(
        "No machine of the cluster accepts computations.", remedy="Start its workers."
    )


class ClusterWorker:
    """Room for one job at a time on a cluster.

    Attributes
    ----------
    share : how much of the job is done; None until it starts.
    address : of the machine that runs it.
    cpu_s : not known; the time that the job takes counts instead.
    """

    cpu_s = None

    def __init__(self, cluster: Cluster) -> None:
        self._cluster = cluster
        self._key = ""
        self._future: ClusterFuture[Any] | None = None
        self.share: float | None = None
        self.address: str | None = None

    async def submit(self, job: Callable[..., T]) -> asyncio.Future[T]:
        """Begin a job; connecting to the cluster is part of it."""
        self._cluster.listeners.pop(self._key, None)
        self._key, self.share, self.address = secrets.token_hex(16), None, None
        self._cluster.listeners[self._key] = self
        self._future = await asyncio.to_thread(self._cluster.begin, self._key, job)
        done: Future[T] = Future()
        self._future.add_done_callback(lambda future: self._settle(future, done))
        return asyncio.wrap_future(done)

    def cancel(self) -> None:
        """Ask the job to stop; one that no worker has begun is withdrawn."""
        key = self._key
        self._cluster.later(lambda client: client.run(_cancel, key, on_error="ignore"))
        if self.address is None:
            self._take_back()

    def replace(self) -> None:
        """Withdraw the job and, if it runs, have the nanny of its worker start a new process."""
        self._take_back()
        if (worker := self.address) is not None:
            self._cluster.later(
                lambda client: client.restart_workers([worker], raise_for_error=False)
            )

    def close(self) -> None:
        """Disconnect from the cluster."""
        self._cluster.close()

    def _take_back(self) -> None:
        if (future := self._future) is not None:
            self._cluster.later(lambda client: client.cancel([future]))

    def _settle(self, future: ClusterFuture[Any], done: Future[T]) -> None:
        """Pass on the outcome of a job, and let the cluster forget it."""
        if self._future is future:
            self._future = None
        if not done.set_running_or_notify_cancel():
            return
        try:
            done.set_result(future.result())
        except (KilledWorker, CancelledError, OSError, TimeoutError) as error:
            log.warning("a job was lost on the cluster: %s", error)
            lost: Exception = WorkerDiedError("The machine of this computation was lost.")
            if self.address is None and not isinstance(error, KilledWorker):
                lost = NotBegunError("The cluster lost this computation before it began.")
            done.set_exception(lost)
        except Exception as error:
            done.set_exception(error)


_running: dict[str, bool] = {}
"""Jobs of a worker process, each True once it was cancelled."""


def _run(key: str, job: Callable[..., T]) -> T:
    worker = get_worker()
    last_report = -1.0

    def report(done: float, of: float) -> None:
        nonlocal last_report
        if done and time.monotonic() < last_report + REPORT_EVERY_S:
            return
        last_report = time.monotonic()
        message = {"job": key, "share": float(done / max(of, 1.0)), "worker": worker.address}
        worker.log_event(TOPIC, message)

    _running[key] = False
    report(0.0, 1.0)
    try:
        return call(job, lambda: _running[key], report, "its worker has")
    finally:
        del _running[key]


def _cancel(key: str) -> None:
    if key in _running:
        _running[key] = True
