"""Explicit integration of the same equations, for cross-checks."""
