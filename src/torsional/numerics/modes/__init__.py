"""Undamped and damped modes, and receptances from them."""
