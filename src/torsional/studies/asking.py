"""Claims asked of trucks: verdicts on the trucks as they are, and how far these hang on uncertain parameters."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import scipy
import xarray as xr

from torsional import __version__
from torsional.errors import ModelError, nearest
from torsional.numerics.compiling import WATCH
from torsional.studies.base import MANY, Finding, Outcome, Study
from torsional.studies.concepts import absorbers, built
from torsional.studies.crew import Crew, Lost
from torsional.studies.register import claims
from torsional.studies.robustness import PARAMETERS, SEED, Answer, Robustness, Samples, judged, parameters_of, varied
from torsional.studies.trucks import Trucks

ENOUGH = 100
"""A claim that is asked of fewer trucks is not asked of those with one other parameter, which are as many."""
SHORT = "ask fewer processes at a time, where memory is short"
COMPILING = ("A1", "A2", "A5", "A12", "D1")
"""Quick claims that between them run most compiled functions: asked first, so that no two processes compile one."""


@dataclass(frozen=True)
class Asked:
    """Claims as asked: ``outcomes`` on the trucks as they are and ``robustness`` by id (empty where no others were
    asked).

    ``hashes`` and ``origins``: of the models by concept; ``parameters``: the uncertain ones, by name; ``many`` trucks
    of a Latin hypercube with ``seed``; ``versions`` of what computed it.  ``seconds``: processor time by id, which
    alone differs between runs.
    """

    outcomes: Mapping[str, Outcome]
    robustness: Mapping[str, Robustness]
    hashes: Mapping[str, str]
    origins: Mapping[str, str]
    parameters: tuple[str, ...]
    many: int
    seed: int
    versions: Mapping[str, str]
    seconds: Mapping[str, float] = field(default_factory=dict, compare=False)


class Piece(NamedTuple):
    """Work for one process: claims asked of one truck, by its ``number`` in the samples (None: the truck as it is)."""

    number: int | None
    ids: tuple[str, ...]


class Reply(NamedTuple):
    """What one truck says to one claim: of the truck as it is the ``outcome`` and the concepts that were ``seen``."""

    number: int | None
    id: str
    answer: Answer
    outcome: Outcome | None
    seen: frozenset[str]
    seconds: float


def asked(
    trucks: Trucks,
    ids: Iterable[str] = (),
    *,
    many: int = MANY,
    thorough: bool = False,
    processes: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Asked:
    """The outcomes of claims (all unless ``ids`` names some), and their robustness on ``many`` trucks (0: none).

    ``thorough``: dear claims are asked of all these too, and of those with one other parameter, which takes hours.
    The figures are the same whatever the number of ``processes`` (None: one a processor).  Raises ModelError for an
    unknown id, for models that came from no file, and where a process dies.

    >>> found = asked(Trucks.shipped(), ["A6"], many=0, processes=1)
    >>> found.outcomes["A6"].verdict
    'reproduced'
    """
    studies = {id: study.asked_of(MANY) if thorough else study for id, study in _chosen(ids).items()}
    documents = {concept: model.document for concept, model in trucks.models.items()}
    if not all(documents.values()):
        remedy = "load them from files, or change values of the file with changed"
        raise ModelError("claims are asked of models that came from files", where="trucks", remedy=remedy)
    names = tuple(each.name for each in parameters_of(trucks)) if many else ()
    samples = Samples(names, many)
    replies = _replies(studies, samples, (documents, dict(trucks.origins), samples), processes, progress)
    base = {each.id: each for each in replies if each.outcome}
    return Asked(
        outcomes={id: base[id].outcome for id in studies},  # type: ignore[misc]  # each of base has one
        robustness={id: _robustness(study, base[id].answer, replies, samples) for id, study in studies.items() if many},
        hashes={concept: model.hash for concept, model in trucks.models.items()},
        origins=dict(trucks.origins),
        parameters=names,
        many=many,
        seed=SEED,
        versions={"torsional": __version__} | {each.__name__: each.__version__ for each in (np, scipy, xr)},
        seconds={id: sum(each.seconds for each in replies if each.id == id) for id in studies},
    )


def _chosen(ids: Iterable[str]) -> dict[str, Study]:
    known, wanted = claims(), set(ids)
    for id in wanted - set(known):
        raise ModelError(f"there is no claim '{id}'", where="claims", remedy=nearest(id, known))
    return {id: study for id, study in known.items() if not wanted or id in wanted}


def _replies(
    studies: Mapping[str, Study],
    samples: Samples,
    given: tuple[Any, ...],
    processes: int | None,
    progress: Callable[[int, int], None],
) -> list[Reply]:
    """All answers, by the trucks' numbers."""
    fewest = {id: min(study.trucks, samples.many) for id, study in studies.items()}
    first = tuple(id for id in studies if id in COMPILING)
    single = [Piece(None, (id,)) for id in sorted(set(studies) - set(first), key=lambda id: (fewest[id], id))]
    together = [Piece(n, tuple(id for id in studies if n < fewest[id])) for n in range(max(fewest.values(), default=0))]
    lone = [id for id, study in studies.items() if study.trucks >= ENOUGH and samples.many]
    total = len(studies) + sum(fewest.values()) + len(lone) * (len(samples) - samples.many)
    found: list[Reply] = []
    with Crew(_answered, _prepare, given, processes) as crew:

        def collect(pieces: list[Piece]) -> None:
            for _, replies in crew.results(pieces):
                if isinstance(replies, Lost):
                    raise ModelError(
                        "a working process ended before its work was done", where="processes", remedy=SHORT
                    )
                found.extend(replies)
                progress(len(found), total)

        collect([Piece(None, first)])
        collect([*single, *together])
        collect(_alone(lone, found, samples))
    progress(total, total)
    return sorted(found, key=lambda each: (-1 if each.number is None else each.number, each.id))


def _alone(ids: list[str], found: list[Reply], samples: Samples) -> list[Piece]:
    """Trucks with one other parameter for the claims whose concepts have it; others answer as the truck as it is."""
    seen = {each.id: each.seen for each in found if each.outcome}
    concepts = {each.name: each.concepts for each in PARAMETERS}
    numbers = range(samples.many, len(samples))
    pieces = [Piece(n, tuple(id for id in ids if seen[id] & concepts[samples.alone(n)[0]])) for n in numbers]
    return [piece for piece in pieces if piece.ids]


def _robustness(study: Study, base: Answer, replies: list[Reply], samples: Samples) -> Robustness:
    answers = {each.number: each.answer for each in replies if each.id == study.name and each.number is not None}
    if study.trucks >= ENOUGH:
        answers = dict.fromkeys(range(samples.many, len(samples)), base) | answers
    return judged(study.name, base, answers, samples, study.leading)


class _Watched(Trucks):
    """Trucks that remember which of their concepts were looked at."""

    seen: set[str]

    def __getattribute__(self, name: str) -> Any:
        if name in absorbers():
            object.__getattribute__(self, "seen").add(name)
        return object.__getattribute__(self, name)

    @classmethod
    def over(cls, trucks: Trucks) -> _Watched:
        """The same trucks, not yet looked at."""
        watched = cls(**trucks.models, origins=trucks.origins)
        object.__setattr__(watched, "seen", set())
        return watched


_HERE: dict[str, Any] = {}
"""What this process asks of: trucks and samples."""


def _prepare(documents: Mapping[str, Mapping[str, Any]], origins: Mapping[str, str], samples: Samples) -> None:
    _HERE.update(trucks=Trucks(**built(documents), origins=origins), samples=samples)


def _answered(piece: Piece) -> list[Reply]:
    """One piece of work: the truck is made once, for all claims."""
    with WATCH.silent():
        if piece.number is None:
            return [_reply(id, None, _HERE["trucks"]) for id in piece.ids]
        try:
            trucks = varied(_HERE["trucks"], _HERE["samples"].factors(piece.number))
        except ModelError as error:
            return [Reply(piece.number, id, Answer(None, error=str(error)), None, frozenset(), 0.0) for id in piece.ids]
        return [_reply(id, piece.number, trucks) for id in piece.ids]


def _reply(id: str, number: int | None, trucks: Trucks) -> Reply:
    study, watched, begun = claims()[id], _Watched.over(trucks), time.process_time()
    try:
        outcome = study.tried(watched)
    except Exception as error:  # a defect of one study must not cost the answers to all others
        outcome = Outcome(study.claim, Finding(None, "", {}, f"the study failed ({type(error).__name__}: {error})"))
    spent = time.process_time() - begun
    kept = outcome if number is None else None
    return Reply(number, id, Answer.of(outcome, study.leading), kept, frozenset(watched.seen), spent)
