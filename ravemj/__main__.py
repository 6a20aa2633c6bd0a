"""``python -m ravemj``: the command line."""

import sys

from ravemj.cli import main

sys.exit(main())
