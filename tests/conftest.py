"""Settings shared by all tests."""

from hypothesis import settings

# no deadline: the first example of a run may have to compile a kernel
settings.register_profile("torsional", deadline=None, print_blob=True)
settings.load_profile("torsional")
