"""Growth of small deviations from a periodic motion."""
