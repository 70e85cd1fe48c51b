"""What all tests share: one profile for every property, and the command line."""

from __future__ import annotations

import subprocess

import pytest
from hypothesis import settings

from zygopin.cli import main

settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=25)
settings.load_profile("fixed")


@pytest.fixture
def run(capsys, monkeypatch):
    """Run the command line in this process, which has loaded the libraries."""
    monkeypatch.setenv("COLUMNS", "80")

    def run_here(*arguments):
        with pytest.raises(SystemExit) as ended:
            main(list(arguments))
        spoken = capsys.readouterr()
        status = int(ended.value.code)
        return subprocess.CompletedProcess(arguments, status, spoken.out, spoken.err)

    return run_here
