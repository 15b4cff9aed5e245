"""Motion in time: a system and what drives it as arrays, stepped."""
