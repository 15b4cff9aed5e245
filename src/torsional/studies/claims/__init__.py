"""The thesis's claims as studies, each judged on a set of trucks; `torsional.studies.register` finds them."""
