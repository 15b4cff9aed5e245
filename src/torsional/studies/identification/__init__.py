"""Identification by a plan: parameters of a model file fitted to loops, order curves and histories."""
