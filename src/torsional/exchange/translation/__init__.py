"""Compiled functions as C: what numba compiles is told a second time in another language, not written a second time."""
