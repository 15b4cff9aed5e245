"""Sweeps: one analysis of very many designs, in durable pieces, on one core or many machines."""
