"""The benchmark: its clockwork, its proofs of equal work, and that it runs."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import numpy as np
import pytest
from bench import aims, calls, fcl_peers, limits, report, scaling, scaling_plot, suites
from bench.checking import Answer, Checking, compare, decided
from bench.peer import Peer, WrongAnswerError, check
from bench.posing import Posing
from bench.suite import Row, Suite
from bench.timing import Spread, interleaved, ratios

from zygopin import Branch, Foot, check_grasp, forward_kinematics, plan_perch

ROOT = Path(__file__).parent.parent
FOOT, BRANCH = Foot.preset("parrot"), Branch(0.008, (0.0, 0.0, -0.0097))

ROW = {
    "part": "forward kinematics",
    "name": "zygopin",
    "computes": "14 bones",
    "threads": 2,
    "configurations": 1000,
    "microseconds": {"median": 0.25, "low": 0.2, "high": 0.5},
    "ratio": {"median": 1.0, "low": 1.0, "high": 1.0},
    "ratio_alike": None,
    "own": True,
    "packages": [],
    "remark": "all alike",
}
OTHER = ROW | {
    "name": "Tool",
    "computes": "all",
    "threads": 1,
    "microseconds": {"median": 1234.5, "low": 1100.0, "high": 2000.0},
    "ratio": {"median": 4938.0, "low": 4400.0, "high": 5000.0},
    "packages": ["pin", "tool"],
}
RESULTS = {
    "machine": {"processor": "Abacus", "cores": 2},
    "sizes": {"runs": 9},
    "versions": {"pin": "4.1", "tool": "1.2"},
    "rows": [
        ROW,
        OTHER,
        ROW | {"part": suites.SINGLE, "name": "not shown"},
        ROW | {"part": suites.RANDOM, "computes": "less work: half"},
    ],
}


class FakeClock:
    """Time that passes only while work is done, and a little when it is read."""

    def __init__(self):
        self.now = 0.0
        self.done = []

    def __call__(self):
        return self.now

    def work(self, name, *durations):
        """Work that takes these times in turn, the last one from then on."""
        left = list(durations)

        def do():
            self.done.append(name)
            self.now += left.pop(0) if len(left) > 1 else left[0]

        return do


@pytest.fixture(scope="module")
def table():
    script = str(ROOT / "scripts" / "benchmark-table")
    loader = SourceFileLoader("benchmark_table", script)
    module = module_from_spec(spec_from_loader("benchmark_table", loader))
    loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def touching():
    controls = plan_perch(FOOT, BRANCH).controls
    return Checking(FOOT, np.stack([controls, np.zeros(14), np.ones(14)]), BRANCH)


def test_works_take_turns_and_their_first_runs_do_not_count():
    clock = FakeClock()
    works = {"a": clock.work("a", 9.0, 9.0, 1.0), "b": clock.work("b", 7.0, 7.0, 2.0)}
    times = interleaved(works, 5, clock=clock)
    assert times == {"a": [1.0] * 5, "b": [2.0] * 5}
    rounds = np.array(clock.done[4:]).reshape(5, 2)
    assert [sorted(turn) for turn in rounds] == [["a", "b"]] * 5
    assert len({tuple(turn) for turn in rounds}) == 2


def test_short_work_is_repeated_in_one_measurement():
    clock = FakeClock()
    works = {"short": clock.work("short", 0.25), "long": clock.work("long", 4.0)}
    times = interleaved(works, 2, clock=clock, shortest=1.0)
    assert times == {"short": [0.25, 0.25], "long": [4.0, 4.0]}
    assert clock.done.count("short") == 2 + 2 * 4
    assert clock.done.count("long") == 2 + 2


def test_a_machine_that_slows_down_leaves_ratios_as_they_are():
    assert ratios([2.0, 8.0, 4.0], [1.0, 4.0, 2.0]) == Spread(2.0, 2.0, 2.0)
    assert Spread.of([3.0, 1.0, 2.5]) == Spread(2.5, 1.0, 3.0)
    assert Spread.of([1.0]).scaled(1e6) == Spread(1e6, 1e6, 1e6)


def test_the_first_run_of_a_call_counts_only_where_there_is_no_other():
    waits = iter([0.1, 0.0, 0.0])
    assert calls.seconds(lambda: [*range(int(next(waits) * 1e6))], 2) < 1e-3
    assert calls.seconds(lambda: None, 0) >= 0


@pytest.mark.parametrize("difference", [2e-9, float("nan")])
def test_an_answer_that_is_off_is_no_row(difference):
    with pytest.raises(WrongAnswerError, match="Tool is off"):
        check("Tool", difference, 1e-9)
    check("Tool", 1e-9, 1e-9)


def test_a_tool_that_does_other_work_stops_the_run_and_one_that_is_not_there_does_not():
    job = Posing(FOOT, np.random.default_rng(3).uniform(size=(40, 14)))
    own = [Peer("own", "", lambda j: lambda: forward_kinematics(FOOT, j.controls))]
    wrong = Peer("wrong", "", lambda j: lambda: np.zeros((j.count, 18, 3)))
    absent = Peer("absent", "", lambda _: None, packages=("no-such-tool",))
    with pytest.raises(WrongAnswerError, match="wrong is off"):
        Suite("FK", job, own, [wrong], suites.same_bones).measure(1)
    suite = Suite("FK", job, own, [absent], suites.same_bones)
    assert suite.missing() == {"absent": "no-such-tool not installed"}
    (row,) = suite.measure(2)
    assert (row.name, row.configurations, row.own) == ("own", 40, True)
    assert row.ratio == row.ratio_alike == Spread(1.0, 1.0, 1.0)


def test_a_slow_peer_gets_a_part_of_the_configurations():
    job = Posing(FOOT, np.random.default_rng(3).uniform(size=(100, 14)))
    own = [Peer("own", "", lambda j: lambda: forward_kinematics(FOOT, j.controls))]
    slow = [replace(own[0], name="slow", share=1 / 4)]
    rows = Suite("FK", job, own, slow, suites.same_bones).measure(1)
    assert [row.configurations for row in rows] == [100, 25]


def test_verdicts_from_clearances_alone_are_those_of_a_check(touching):
    poses = np.random.default_rng(4).uniform(-1e-9, 1e-9, (30, 14))
    controls = np.clip(touching.controls[0] + poses, 0, 1)
    job = replace(touching, controls=np.concatenate([controls, touching.controls]))
    report = check_grasp(FOOT, job.controls, BRANCH)
    answer = decided(job, _junctions(job), report.clearance)
    np.testing.assert_array_equal(answer.stable, report.stable)
    np.testing.assert_array_equal(answer.grasping, report.grasping)
    np.testing.assert_array_equal(answer.clear, ~report.penetrating.any(axis=-1))
    assert report.grasping.sum() == 31


def _junctions(job):
    """What a tool would give: starts of phalanges and, after each finger's, its tip."""
    bones = forward_kinematics(FOOT, job.controls)
    parts = FOOT.finger_slices.values()
    return np.concatenate(
        [np.append(bones[:, p, 0], bones[:, p.stop - 1 : p.stop, 1], 1) for p in parts],
        axis=1,
    )


def test_a_verdict_that_differs_is_refused_outside_the_band_only(touching):
    right = touching.right
    assert compare("Tool", touching, Answer(stable=right.stable), 1e-9) == 0
    with pytest.raises(WrongAnswerError, match="1 verdicts on stable"):
        compare("Tool", touching, Answer(stable=right.stable & False), 1e-9)
    # A band as wide as the tolerance leaves nothing sure about toes that touch.
    assert compare("Tool", touching, Answer(stable=right.stable & False), 1e-5) >= 1
    off = Answer(clearance=right.clearance + 2e-9 * FOOT.size)
    with pytest.raises(WrongAnswerError, match="off by 2e-09"):
        compare("Tool", touching, off, 1e-9)


def test_fcl_as_written_and_at_its_best_give_the_exact_clearances(touching):
    for make in (fcl_peers.as_written, fcl_peers.at_best):
        answer = make(touching)()
        assert compare("fcl", touching, answer, 1e-9) == 0
        np.testing.assert_array_equal(answer.grasping, [True, False, False])


def test_limits_by_hand():
    rates = limits.Rates(threads=1, bandwidth=7.84e9, flops=1e9, functions=1e8)
    posing, checking = limits.of_kinematics(FOOT), limits.of_check(FOOT)
    assert (posing.bytes, posing.flops, posing.functions) == (784, 112, 28)
    assert (checking.bytes, checking.flops, checking.functions) == (115, 364, 28)
    assert posing.by_memory(rates) == pytest.approx(1e-7)
    assert posing.seconds(rates) == pytest.approx((112 + 28 * 17) * 1e-9)
    found = limits.distance("FK", posing, replace(rates, flops=1e12), 0.5)
    assert found["limit"] == pytest.approx(0.1)
    assert found["over_limit"] == pytest.approx(5)
    assert found["by_numpys_sines"] == pytest.approx(0.28)


def test_rates_are_measured():
    rates = limits.measured_rates(1)
    assert min(rates.bandwidth, rates.flops, rates.functions) > 1e6


def test_memory_beyond_the_result():
    def work():
        part = np.ones(500_000)
        return part[:1000] + np.zeros(500_000)[:1000]

    result, beyond = scaling.memory(work)
    assert result == 8000
    assert 8e6 <= beyond < 8.1e6


def test_counts_beyond_the_memory_are_left_out(monkeypatch):
    monkeypatch.setattr(scaling, "spare_memory", lambda: 1e6)
    found = scaling.against_count([10, 10_000_000], 1)
    assert {point.configurations for point in found} == {10}


def test_aims_by_hand():
    times = Spread(0.25, 0.2, 0.3)
    row = Row(suites.RANDOM, "own", "", 2, 1, times, times, None, True, (), "")
    coal = replace(row, name="coal, distances", own=False, ratio=Spread(60, 50, 70))
    fcl = replace(coal, name="python-fcl, as written", ratio=Spread(200, 1, 400))
    found = {aim.measured: aim.met for aim in aims.aims([row, coal, fcl])}
    assert found == {60: True, 200: False, 4.0: True}


def test_the_figure_of_scaling_is_written(tmp_path):
    points = [
        scaling.Point(work, n, 14, threads, Spread.of([cost / threads]), 672 * n, 10**6)
        for work, cost in (("kinematics", 0.3), ("checks", 0.5))
        for threads in (1, 2)
        for n in (100, 1000)
    ]
    file = scaling_plot.draw(points, points, tmp_path / "scaling.png")
    assert file.read_bytes().startswith(b"\x89PNG")


def test_numbers_have_no_exponents():
    assert report.number(12345.6) == "12,300"
    assert report.number(0.012345) == "0.0123"
    assert report.number(99.96) == "100"
    assert report.number(0) == "0"
    assert report.span(ROW["microseconds"]) == "0.25 (0.2 to 0.5)"


def test_the_table_by_hand(table):
    lines = table.table(RESULTS).splitlines()
    assert lines[2:7] == [
        "| **forward kinematics** |  |  |  |",
        "| zygopin | 2 | 0.25 (0.2 to 0.5) | 1 |",
        "| Tool (1.2) | 1 | 1,200 (1,100 to 2,000) | 4,900 (4,400 to 5,000) |",
        "| **grasp checks, random poses** |  |  |  |",
        "| zygopin, less work | 2 | 0.25 (0.2 to 0.5) | 1 |",
    ]
    assert "9 interleaved rounds" in lines[-1]
    assert "2 cores" in lines[-1]
    assert "Abacus" in lines[-1]


def test_the_table_of_the_readme_is_fresh(table):
    assert table.TABLE.start in (ROOT / "README.md").read_text(encoding="utf-8")
    command = [sys.executable, ROOT / "scripts" / "benchmark-table", "--check"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_quick_run_prints_one_document(tmp_path):
    words = [ROOT / "scripts" / "benchmark", "--quick", "--json", "--png"]
    command = [sys.executable, *words, tmp_path / "scaling.png"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    assert found["machine"]["cores"] >= 1
    assert {"python", "numpy", "pin", "coal", "python-fcl"} <= set(found["versions"])
    parts = {row["part"] for row in found["rows"]}
    kinds = suites.KINEMATICS, suites.RANDOM, suites.TOUCHING
    assert parts == {*kinds, suites.BRANCHES, suites.SINGLE}
    for row in found["rows"]:
        times = row["microseconds"]
        assert 0 < times["low"] <= times["median"] <= times["high"]
        assert row["computes"]
        assert row["name"] not in found["missing"]
    assert {row["work"] for row in found["scaling"]["configurations"]} == {
        *("kinematics", "checks")
    }
    assert all(value > 0 for value in found["calls"]["calls"].values())
    assert found["limits"]
    assert found["aims"]
    assert (tmp_path / "scaling.png").stat().st_size > 10_000
    assert report.text(found).count("\n") > 60
