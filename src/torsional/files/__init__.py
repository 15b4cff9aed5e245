"""Model files: read strictly, checked against a schema, built into models, changed by key paths."""

from torsional.files.edit import changed, document_paths
from torsional.files.expand import expanded
from torsional.files.load import load_model, model_from_document
from torsional.files.plausibility import warnings_of
from torsional.files.schema import json_schema
from torsional.files.starter import starter

__all__ = [
    "changed",
    "document_paths",
    "expanded",
    "json_schema",
    "load_model",
    "model_from_document",
    "starter",
    "warnings_of",
]
