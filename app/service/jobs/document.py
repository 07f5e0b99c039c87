"""Jobs in the API."""

from enum import StrEnum

from pydantic import AwareDatetime, BaseModel, Field

from ..problems import Problem


class JobState(StrEnum):
    """State of a job."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"
    INTERRUPTED = "interrupted"

    @property
    def is_final(self) -> bool:
        """True if the job has ended."""
        return self not in (JobState.WAITING, JobState.RUNNING)


class JobStatus(BaseModel):
    """A job as its owner sees it."""

    id: str
    kind: str
    state: JobState
    progress: float = Field(
        ge=0, le=1, description="Share that is done, where the computation reports it."
    )
    problem: Problem | None = Field(None, description="Reason why it failed or was interrupted.")
    created_at: AwareDatetime
    started_at: AwareDatetime | None = None
    finished_at: AwareDatetime | None = None


class JobPage(BaseModel):
    """A part of a list of jobs, latest first."""

    jobs: list[JobStatus]
    next_cursor: str | None = Field(description="Send it to get the next page; null at the end.")
