"""Curves F(x, p) = 0: following them, their events and their ends."""
