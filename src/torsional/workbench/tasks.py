"""What a process of the workbench can be asked to do, by name; what each needs is imported when it is asked first."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from torsional.workbench.jobs import Progress
from torsional.workbench.workers import Task

Design = dict[str, Any]


def work(task: Task) -> Any:
    """Do a task."""
    name, asked = task
    return TASKS[name](*asked)


def answer(design: Design, ask: list[Any]) -> bytes:
    """The frame that answers a page."""
    from torsional.workbench import answering

    return answering.answer(design, ask)


def opened(text: str, files: dict[str, str]) -> dict[str, Any]:
    """A model file as a design, and the names of files that it wants beside it.

    Raises ModelError for a text that is no model file, once all its files are there.
    """
    from torsional.workbench.designs import design_of, missing, model_of

    design = design_of({"text": text, "files": files, "changes": {}})
    wanted = list(missing(design))
    if not wanted:
        model_of(design)
    return {"design": {"text": text, "files": files, "changes": {}}, "missing": wanted}


def saved(design: Design) -> dict[str, Any]:
    """A design as a model file with its changes, which must be a model."""
    from torsional.workbench import designs

    known = designs.design_of(design)
    designs.model_of(known)
    return {"text": designs.saved(known), "files": dict(known.files)}


def exported(variants: list[tuple[str, Design]], ask: dict[str, Any], kind: str, dark: bool) -> bytes:
    """A picture or a table of one view."""
    from torsional.workbench.exports import exported

    return exported(variants, ask, kind, dark)


def reported(variants: list[tuple[str, Design]]) -> bytes:
    """The page of `torsional report`."""
    from torsional.workbench.exports import reported

    return reported(variants)


def background(design: Design, kind: str, settings: dict[str, Any], progress: Progress) -> Mapping[str, bytes]:
    """What a job gives."""
    from torsional.workbench.background import worked

    return worked(design, kind, settings, progress)


TASKS: Mapping[str, Callable[..., Any]] = {
    "answer": answer,
    "open": opened,
    "save": saved,
    "export": exported,
    "report": reported,
}
