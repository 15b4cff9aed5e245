"""Exact motion of piecewise-linear systems under harmonic loads."""
