"""`python -m zygopin`: the command line."""

from __future__ import annotations

from zygopin.cli import main

main(prog_name="zygopin")
