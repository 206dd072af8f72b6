"""``python -m quasistatic_ref``: the command line, as ``quasistatic-ref``."""

import sys

from quasistatic_ref.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
