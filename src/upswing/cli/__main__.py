"""``python -m upswing.cli``: the same as the command ``upswing``."""

import sys

from upswing.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
