"""Model files: read strictly, checked against a schema, built into models, changed by key paths."""

from torsional.files.load import load_model, model_from_document
from torsional.files.schema import json_schema

__all__ = ["json_schema", "load_model", "model_from_document"]
