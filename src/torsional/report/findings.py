"""What a reader would conclude, in sentences computed from the results."""

from __future__ import annotations

from torsional.report.analysis import Comparison, Variant
from torsional.report.finding import Finding
from torsional.report.levels import irregularities, largest, unsolved
from torsional.report.motions import motion_findings
from torsional.report.ratios import against
from torsional.report.resonances import resonances
from torsional.report.springs import springs_of
from torsional.report.travels import stage_modes, travel

__all__ = ["Finding", "findings"]


def findings(comparison: Comparison) -> list[tuple[str, list[Finding]]]:
    """Findings under a heading for each variant and each comparison."""
    groups = [(variant.label, _about(variant)) for variant in comparison.variants]
    for other in comparison.variants[1:]:
        title = f"{comparison.first.label} against {other.label}"
        groups.append((title, against(comparison, other)))
    return [(title, found) for title, found in groups if found]


def _about(variant: Variant) -> list[Finding]:
    found, springs = resonances(variant), springs_of(variant)
    absorber = [spring for spring in springs if spring.name in variant.model.landmarks.springs]
    for spring in absorber[:1]:
        found += stage_modes(variant, spring)
    if variant.response is None:
        return [*found, Finding("missing", variant.missing)]
    found += [largest(variant.response), *irregularities(variant.response)]
    for spring in springs:
        found += travel(variant.response, spring)
    if variant.motions is not None:
        found += motion_findings(variant.motions)
    if variant.unmoved:
        found.append(Finding("unmoved", variant.unmoved))
    return found + unsolved(variant.response)
