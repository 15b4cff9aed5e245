"""Who works on a sweep, as a plan says it: processes here, a dask scheduler, or jobs that a cluster's queue starts."""

from __future__ import annotations

import re
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from pydantic import AfterValidator, Field

from torsional.errors import ModelError
from torsional.files.schema.fields import Block
from torsional.units import quoted

_ADDRESS = re.compile(r"(tcp|tls|ucx|ws|wss)://[^\s/]+:\d{1,5}$")
_MEMORY = re.compile(r"\d+(\.\d+)? ?[kMGT]i?B$")
_WALLTIME = re.compile(r"(\d+-)?\d{1,3}:\d\d(:\d\d)?$")


def scheduler_address(text: str) -> str:
    """An address of a scheduler; ModelError for a text that is none.

    >>> scheduler_address("tcp://node-1:8786")
    'tcp://node-1:8786'
    """
    if not _ADDRESS.fullmatch(text):
        problem = "this is no address of a scheduler"
        raise ModelError(problem, found=quoted(text), allowed="protocol, host and port, as tcp://host:8786")
    return text


def _like(form: re.Pattern[str], problem: str, allowed: str) -> AfterValidator:
    def read(text: str) -> str:
        if not form.fullmatch(text):
            raise ModelError(problem, found=quoted(text), allowed=allowed)
        return text

    return AfterValidator(read)


Count = Annotated[int, Field(ge=0, le=4096)]
Several = Annotated[int, Field(ge=1, le=100_000)]
Memory = Annotated[str, _like(_MEMORY, "this is no size of memory", "a number with its unit, as 16 GB")]
Walltime = Annotated[str, _like(_WALLTIME, "this is no time of a job", 'text as "02:00:00" or "02:00"')]


class Processes(Block):
    """Processes on this machine that are started for the sweep."""

    kind: Literal["processes"]
    count: Count = Field(0, description="0: one a core")


class Dask(Block):
    """Workers of a dask scheduler that somebody has started."""

    kind: Literal["dask"]
    address: Annotated[str, AfterValidator(scheduler_address)] = Field(
        description="of the scheduler, as tcp://host:8786"
    )


class LocalCluster(Block):
    """A dask scheduler and workers on this machine, started for the sweep: what a cluster does, tried at home."""

    kind: Literal["local_cluster"]
    count: Count = Field(0, description="workers; 0: one a core")


class Jobs(Block):
    """Jobs of a queueing system, each with a worker a core; the scheduler runs here, and all end with the sweep."""

    queueing: ClassVar[str]
    submit: ClassVar[str]
    """The command that must be there."""

    jobs: Several = Field(description="how many are asked for")
    cores: Several = Field(description="of a job; each works at designs of its own")
    memory: Memory = Field(description="of a job, as 16 GB")
    walltime: Walltime | None = Field(None, description="of a job, as the system writes it")
    queue: str | None = Field(None, description="or partition")
    interface: str | None = Field(None, description="network that the jobs reach this machine by, as ib0")
    prologue: list[str] = Field(default_factory=list, description="lines before the worker, as module load python")
    extra: list[str] = Field(default_factory=list, description="more directives of the job, as --constraint=fast")

    @property
    def settings(self) -> dict[str, Any]:
        """The arguments of dask-jobqueue's class ``queueing``: one process a core, of one thread."""
        kept = self.model_dump(exclude={"kind", "jobs", "extra", "prologue"}, exclude_none=True)
        lines = {"job_extra_directives": self.extra, "job_script_prologue": self.prologue}
        return {**kept, "processes": self.cores, **{name: each for name, each in lines.items() if each}}


class Slurm(Jobs):
    """Jobs of SLURM."""

    queueing: ClassVar[str] = "SLURMCluster"
    submit: ClassVar[str] = "sbatch"

    kind: Literal["slurm"]
    account: str | None = None


class Pbs(Jobs):
    """Jobs of PBS or Torque."""

    queueing: ClassVar[str] = "PBSCluster"
    submit: ClassVar[str] = "qsub"

    kind: Literal["pbs"]
    account: str | None = None


class Lsf(Jobs):
    """Jobs of LSF."""

    queueing: ClassVar[str] = "LSFCluster"
    submit: ClassVar[str] = "bsub"

    kind: Literal["lsf"]
    project: str | None = None


Remote: TypeAlias = Dask | LocalCluster | Slurm | Pbs | Lsf
Settings: TypeAlias = Annotated[Processes | Dask | LocalCluster | Slurm | Pbs | Lsf, Field(discriminator="kind")]
Workers: TypeAlias = Any
"""A number of processes (None: one a processor), settings, the address of a scheduler, or a ``distributed.Client``."""
