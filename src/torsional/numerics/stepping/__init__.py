"""Implicit time steps over the equations of motion."""
