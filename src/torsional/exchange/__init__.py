"""Exchange with other tools: functional mock-up units, tables of inertias and stiffnesses, openTorsion, matrices."""
