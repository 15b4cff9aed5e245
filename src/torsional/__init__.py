"""torsional."""
