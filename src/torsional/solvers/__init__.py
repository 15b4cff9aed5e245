"""Analyses, from a system or a model to a Dataset: one a module, or a package where it takes several."""
