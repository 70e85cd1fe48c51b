"""Sweeps on a Dask cluster: the same results, also when a worker is killed."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest
from distributed import LocalCluster
from xarray.testing import assert_identical

from zygopin import Foot
from zygopin.design_sweep import Sweep
from zygopin.errors import WorkerError
from zygopin.sweep_grid import SweepGrid
from zygopin.sweep_run import Runner

GRID = {"phalanges": "2-2-2-2", "rho": [1.1, 1.3], "radius": np.arange(3, 43) * 1e-3}


@pytest.fixture(scope="module")
def cluster():
    options = {"threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with LocalCluster(2, **options) as started:
        yield started


class Deadly:
    """A chunk that ends the process that unpacks it."""

    digest = "deadly"

    def __reduce__(self):
        return os._exit, (1,)


def test_local_processes_that_end_early_are_told():
    with pytest.raises(WorkerError, match="a worker process ended early: run the same"):
        Runner("processes", 1).run([Deadly()], lambda *_: None)


def test_a_killed_worker_loses_nothing(cluster, tmp_path):
    planned = Sweep(SweepGrid.of(Foot.preset("parrot"), GRID), 2, tmp_path / "a.nc")
    killed = []

    def begun(_total, _kept):
        def step():
            if not killed:
                killed.append(cluster.workers[0].process.pid)
                os.kill(killed[0], signal.SIGKILL)

        return step

    result = planned.run(Runner(cluster.scheduler_address), begun)
    assert len(killed) == 1
    assert (result.chunks, result.kept) == (10, 0)
    alone = Sweep(planned.grid, 2).run(Runner("sync"))
    assert_identical(result.dataset, alone.dataset)
    assert [path.name for path in tmp_path.iterdir()] == ["a.nc"]
