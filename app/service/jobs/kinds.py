"""Operations that run in the background because they may take longer than a page should wait."""

import hashlib
from collections.abc import Callable
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Discriminator, Field, create_model

from knitcore.base.extensions import Group, extensions
from knitcore.yarn.library import fingerprint

from ...context import Context, Supplies
from ...operations.registry import Operation, operations
from ...requests.base import RequestModel, ResultModel, read
from ...requests.faults import check_all

KINDS: dict[str, Operation[Any, Any]] = {
    name: operation for name, operation in operations().items() if operation.job
}


class JobOf(RequestModel):
    """An operation and its request."""

    kind: str
    request: RequestModel


def _job_of(operation: Operation[Any, Any]) -> type[JobOf]:
    fields: Any = {"kind": (Literal[operation.name], ...), "request": (operation.request, ...)}
    return create_model(
        f"{operation.name.capitalize()}Job",
        __base__=JobOf,
        __doc__=f"{operation.summary}.",
        **fields,
    )


if TYPE_CHECKING:
    JobRequest = JobOf
    JobResult = ResultModel
else:
    JobRequest = Annotated[reduce(or_, map(_job_of, KINDS.values())), Discriminator("kind")]
    JobResult = Annotated[
        reduce(or_, (operation.result for operation in KINDS.values())), Field(discriminator="kind")
    ]


def job_key(kind: str, request: str) -> str:
    """A key of everything that determines a result: the request, the operation's code and data, and
    the versions of packages that bring yarns.

    The first one takes a third of a second.
    """
    digest = hashlib.sha256(request.encode()).hexdigest()  # a file's megabytes are hashed once
    packages = [extension.package for extension in extensions(Group.MATERIALS)]
    content = {"kind": kind, "request": digest, "packages": packages}
    return fingerprint.content_key(content, (KINDS[kind].run.__module__,))


def read_job(
    content: bytes, supplies: Supplies, *, cancelled: Callable[[], bool]
) -> tuple[str, str]:
    """Kind and request, as JSON, of a job that somebody asks for; a worker reads a large one.

    Raises
    ------
    InvalidRequestError, InputError
    """
    job = read(JobRequest, content)
    return accepted(job, supplies.context(cancelled=cancelled))


def accepted(job: JobOf, context: Context) -> tuple[str, str]:
    """Kind and request, as JSON, of a job that its operation accepts.

    Raises
    ------
    InputError
        With everything that is wrong.
    """
    check_all(job.request, context)
    return job.kind, job.request.model_dump_json()
