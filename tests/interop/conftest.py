"""Every tool is asked once, two at a time; each test waits for its own tool only."""

from __future__ import annotations

import os
from concurrent.futures import Future, ThreadPoolExecutor

import pytest
import record
from cases import all_cases
from reference import Reference
from suite import Outcome, ask, write_questions
from tools import TOOLS, Tool

OUTCOMES = pytest.StashKey[dict[Tool, "Future[Outcome]"]]()


def pytest_addoption(parser):
    parser.addoption(
        "--update", action="store_true", help="renew results.json if all tests pass"
    )


@pytest.fixture(scope="session")
def references():
    """The right answers of every case, by its name."""
    return {case.name: Reference(case) for case in all_cases()}


@pytest.fixture(scope="session")
def outcomes(request, references, tmp_path_factory):
    """What each tool that a selected test needs will have answered."""
    cases = [right.case for right in references.values()]
    questions = write_questions(cases, tmp_path_factory.mktemp("interop"))
    calls = (getattr(item, "callspec", None) for item in request.session.items)
    chosen = {call.params["tool"] for call in calls if call and "tool" in call.params}
    pool = ThreadPoolExecutor(os.cpu_count() or 2)
    futures = {
        tool: pool.submit(ask, tool, questions) for tool in TOOLS if tool in chosen
    }
    request.config.stash[OUTCOMES] = futures
    yield futures
    pool.shutdown()


def pytest_sessionfinish(session, exitstatus):
    futures = session.config.stash.get(OUTCOMES, {})
    if session.config.getoption("--update") and futures and exitstatus == 0:
        references = {case.name: Reference(case) for case in all_cases()}
        found = {tool: future.result() for tool, future in futures.items()}
        record.write(found, references)
