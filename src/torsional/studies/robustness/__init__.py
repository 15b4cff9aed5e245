"""How far the verdicts on claims hang on uncertain parameters: many trucks, each asked the same claims."""

from torsional.studies.robustness.parameters import PARAMETERS, SPREAD, Parameter, parameters_of, varied
from torsional.studies.robustness.samples import SEED, Samples
from torsional.studies.robustness.verdicts import Answer, Robustness, Turn, judged, wilson

__all__ = [
    "PARAMETERS",
    "SEED",
    "SPREAD",
    "Answer",
    "Parameter",
    "Robustness",
    "Samples",
    "Turn",
    "judged",
    "parameters_of",
    "varied",
    "wilson",
]
