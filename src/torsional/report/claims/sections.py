"""The sections of the report on claims, in the order in which they are read."""

from __future__ import annotations

from collections import Counter

from torsional.errors import ModelError
from torsional.report.blocks import Block, Heading, Items, Section, Table, Text, picture
from torsional.report.claims.robustness import robustness_blocks, share_told, turned_by, turning_picture
from torsional.studies.asking import Asked
from torsional.studies.base import Figure, Finding, Outcome, Study, shown
from torsional.studies.register import claims

THEMES = {
    "A": "Resonances with a single and a dual mass flywheel",
    "B": "Stiffness steps and vibration of half orders",
    "C": "Power split absorber and planetary flywheel",
    "D": "Tuned absorber on the flange",
    "E": "Springs and shoes with clearances in time",
    "F": "Detailed flywheel with friction, and its rig",
    "G": "Pendulums, starts, load changes, other engines",
}
"""What the claims of a letter are about; A to F follow the thesis's appended papers."""
TONES = {"reproduced": "good", "reproduced with a condition": "partly", "not reproduced": "bad", "not answered": "none"}
"""The tones of the verdicts."""
MOST_ROWS = 12
"""Longer tables of figures start closed."""


def sections(asked: Asked) -> list[Section]:
    """All sections."""
    themes = [theme(asked, letter) for letter in THEMES if any(id[0] == letter for id in asked.outcomes)]
    made = [summary(asked), trust(asked), subject(asked), *themes, conventions(asked)]
    return [section for section in made if section.blocks]


def summary(asked: Asked) -> Section:
    """Verdicts counted, then all of them in a table."""
    counted = Counter(outcome.verdict for outcome in asked.outcomes.values())
    told = tuple(f"{counted[verdict]} {verdict}" for verdict in TONES if counted[verdict])
    head = ("", "claim", "verdict", *(("holds on", "turned by ±20 % of") if asked.robustness else ()))
    rows = tuple(_row(asked, outcome) for outcome in asked.outcomes.values())
    links = {id: f"claim-{id}" for id in asked.outcomes}
    blocks = (
        Items(f"{len(asked.outcomes)} claims", told),
        Table("Every claim and its verdict", head, rows, wrapped=True, links=links),
    )
    return Section("verdicts", "Verdicts", blocks)


def _row(asked: Asked, outcome: Outcome) -> tuple[str, ...]:
    id = outcome.claim.id
    known = asked.robustness.get(id)
    more = (share_told(known), turned_by(known)) if asked.robustness else ()
    return (id, outcome.claim.statement, outcome.verdict, *more)


def trust(asked: Asked) -> Section:
    """How far the verdicts depend on the parameters that are not known well."""
    if not asked.robustness:
        return Section("trust", "", ())
    text = (
        "The truck's inertias, stiffnesses and damping are judgement, not measurement. Every claim was asked again of "
        f"up to {asked.many} trucks whose {len(asked.parameters)} uncertain parameters all lie anywhere within ±20 % "
        f"(Latin hypercube, seed {asked.seed}), and of trucks with one parameter 20 % lower or higher. A claim that "
        "holds on few of them holds on one tuned truck only, whatever its verdict here."
    )
    return Section("trust", "How far the verdicts can be trusted", (Text(text), *turning_picture(asked)))


def subject(asked: Asked) -> Section:
    """The trucks that were asked."""
    rows = [(name.replace("_", " "), told) for name, told in asked.origins.items()]
    blocks = (
        Table(
            "The truck with each of the concepts", ("concept", "where its figures come from"), tuple(rows), wrapped=True
        ),
    )
    return Section("trucks", "The trucks that were asked", blocks)


def theme(asked: Asked, letter: str) -> Section:
    """The claims of one letter."""
    blocks: list[Block] = []
    for outcome in asked.outcomes.values():
        if outcome.claim.id[0] == letter:
            blocks += claim_blocks(asked, outcome)
    return Section(f"claims-{letter}", f"{letter}. {THEMES[letter]}", tuple(blocks))


def claim_blocks(asked: Asked, outcome: Outcome) -> list[Block]:
    """One claim: statement and verdict, how it was asked, figures, picture, robustness."""
    claim, finding, study = outcome.claim, outcome.finding, claims()[outcome.claim.id]
    head = Heading(f"{claim.id}  {claim.statement}", f"claim-{claim.id}", outcome.verdict, TONES[outcome.verdict])
    asked_how = [
        ("thesis", f"§ {claim.section}"),
        ("judged by", claim.criterion),
        ("varied", study.varies),
        ("asked under", finding.condition),
        ("holds where", finding.proviso),
        ("to be said", finding.reason),
    ]
    rows = tuple((what, _sentence(text)) for what, text in asked_how if text)
    blocks: list[Block] = [head, Table("", ("", ""), rows, wrapped=True)]
    blocks += drawn(study, finding)
    blocks += figures_table(finding)
    return blocks + robustness_blocks(asked.robustness.get(claim.id))


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:].rstrip('.')}."


def figures_table(finding: Finding) -> list[Block]:
    """What was found, figure by figure; what the clock of this machine told is named so."""
    rows = [(name, _readable(value)) for name, value in finding.figures.items()]
    rows += [(f"{name}, on this machine", shown(value)) for name, value in finding.measured.items()]
    if not rows:
        return []
    many = len(rows) > MOST_ROWS
    caption = f"All {len(rows)} figures found" if many else "Figures found"
    return [Table(caption, ("figure", "value"), tuple(rows), folded=many, wrapped=True)]


def _readable(value: Figure) -> str:
    """A figure as text; names of parts as words."""
    return shown(value).replace("_", " ")


def drawn(study: Study, finding: Finding) -> list[Block]:
    """The picture of a finding that has something to draw; where it cannot be drawn, why."""
    from torsional.plots.sweeps import plot_sweep

    if finding.dataset is None:
        return []
    try:
        figure = (study.picture or plot_sweep)(finding.dataset)
    except ModelError as error:
        return [Text(f"No picture: {error}.", "warning")]
    caption = f"{study.claim.id}: {_sentence(study.varies or study.claim.criterion)}"
    return [picture(figure, caption, f"Picture of claim {study.claim.id}: {study.claim.criterion}.")]


def conventions(asked: Asked) -> Section:
    """How figures are to be read and what they come from."""
    texts = [
        "The claims are statements of L. Wramner, Torsional vibration absorbers in heavy-duty truck powertrains: "
        "simulation and analysis of multiple-mass flywheel concepts, PhD thesis, Chalmers University of Technology, "
        "2020, in our words; the criteria are ours.",
        "Amplitudes are half peak-to-peak of an order, or half the swing over one engine cycle where said, of the "
        "angular acceleration, torque or angle at the gearbox input unless said otherwise. The order speed of a mode "
        "is the engine speed at which the firing order meets it.",
        "Reproduced: the criterion is met. Reproduced with a condition: in one reading of the words or one region "
        "alone, which is told. Not reproduced: it is not, and the reason is told. Not answered: the truck refuses the "
        "question, with the reason.",
    ]
    return Section("conventions", "How to read the figures", tuple(Text(text, "note") for text in texts))
