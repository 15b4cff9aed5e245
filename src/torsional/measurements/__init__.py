"""Measurements: files of measuring systems into Datasets and back, and their channels as nodes and elements."""

from torsional.measurements.reading import read_measurement
from torsional.measurements.writing import write_measurement

__all__ = ["read_measurement", "write_measurement"]
