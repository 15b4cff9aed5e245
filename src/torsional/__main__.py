"""`python -m torsional`, the same as `torsional`."""

import sys

from torsional.cli import main

if __name__ == "__main__":
    sys.exit(main())
