"""Torques of slow motion, and the loops that they run through."""
