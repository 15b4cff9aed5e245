"""The schema of a model file, one module a group of blocks; published as JSON Schema."""

from torsional.files.schema.document import ModelFile, json_schema

__all__ = ["ModelFile", "json_schema"]
