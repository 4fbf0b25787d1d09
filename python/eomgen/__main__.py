# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: ``python3 -m eomgen COMMAND MODEL``."""

from .program import main

main()
