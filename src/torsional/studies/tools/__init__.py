"""Studies that engineers run by name on their own truck; `torsional.studies.register` finds them."""
