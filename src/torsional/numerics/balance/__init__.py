"""Harmonic balance: the harmonics of the laws' forces, and the equations that they close."""
