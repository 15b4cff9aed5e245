"""Measurements: files of measuring systems into Datasets and back, and their channels as nodes and elements."""

from torsional.measurements.mapped import mapped
from torsional.measurements.mapping_file import MappingFile, load_mapping, mapping_schema
from torsional.measurements.reading import read_measurement
from torsional.measurements.writing import write_measurement

__all__ = ["MappingFile", "load_mapping", "mapped", "mapping_schema", "read_measurement", "write_measurement"]
