"""Functional mock-up units (FMI 2.0 and 3.0, co-simulation): written in C from the kernels of time steps, and read."""
