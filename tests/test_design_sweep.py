"""Sweeps: what the cells hold, who works, what is kept and what is saved."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
import xarray
from xarray.testing import assert_identical

import zygopin
from zygopin import Foot, check_grasp, plan_perch
from zygopin.design_sweep import Sweep, sweep
from zygopin.errors import FileError, ParameterError, UnknownNameError, WorkerError
from zygopin.rest import resting_branch
from zygopin.sweep_cell import CHUNK, REASONS, chunks
from zygopin.sweep_dataset import reason_counts
from zygopin.sweep_files import load_dataset, save_dataset
from zygopin.sweep_grid import SweepGrid
from zygopin.sweep_parts import Parts
from zygopin.sweep_run import Runner

PARROT = Foot.preset("parrot")

FEW = {
    "rho": [1.1, 1.3],
    "phalanges": ["2-2-3-3", "1-2-2-1"],
    "radius": np.array([0.001, 0.006, 0.012, 0.03, 0.06]),
    "omega": 1.4,
}
"""Twenty cells, in three chunks."""

SYNC = Runner("sync")


def few(output=None, levels=3):
    return Sweep(SweepGrid.of(PARROT, FEW), levels, output)


def foot_of(counts, rho):
    """The parrot with other fingers."""
    fingers = tuple(
        zygopin.Finger(each.name, count, each.azimuth, splay_gain=each.splay_gain)
        for each, count in zip(PARROT.fingers, counts, strict=True)
    )
    return PARROT.replace(rho=rho, omega=1.4, fingers=fingers)


def files(path):
    """A file's bytes, or those of every file in a folder."""
    found = [path] if path.is_file() else sorted(path.rglob("*"))
    return [each.read_bytes() for each in found if each.is_file()]


@pytest.fixture(scope="module")
def dataset():
    return sweep(PARROT, FEW, levels=3, scheduler="sync")


def test_each_cell_is_the_plan_of_its_foot_and_branch(dataset):
    cell = dataset.sel(rho=1.3, phalanges="1-2-2-1", radius=0.012)
    foot = foot_of((1, 2, 2, 1), 1.3)
    plan = plan_perch(foot, resting_branch(foot, 0.012), levels=3)
    controls = cell["controls"].values
    assert np.isfinite(controls).sum() == foot.phalanx_count
    assert controls[np.isfinite(controls)].tolist() == plan.controls.tolist()
    assert bool(cell["grasping"]) == bool(plan.report.grasping)
    assert float(cell["wrap"]) == plan.wrap.max()
    assert float(cell["branch_height"]) == plan.branch.centre[2]


def test_verdicts_are_those_of_the_other_engine_on_the_controls(dataset):
    for radius in FEW["radius"]:
        cell = dataset.sel(rho=1.1, phalanges="2-2-3-3", radius=radius)
        foot = foot_of((2, 2, 3, 3), 1.1)
        controls = cell["controls"].values
        branch = resting_branch(foot, radius)
        given = controls[np.isfinite(controls)]
        report = check_grasp(foot, given, branch, engine="fcl")
        for name in ("grasping", "feasible", "stable"):
            assert int(cell[name]) == int(getattr(report, name))
        tangent = report.tangent.tolist()
        toes = {i for i, t in zip(foot.finger_of_phalanx, tangent, strict=True) if t}
        assert int(cell["toes"]) == len(toes)
        assert float(cell["scalar_product"]) == pytest.approx(report.scalar_product)


def test_reasons_agree_with_the_verdicts(dataset):
    grasped = (dataset["grasping"] == 1) & (dataset["feasible"] == 1)
    assert ((dataset["reason"] == REASONS.index("grasping")) == grasped).all()
    counts = reason_counts(dataset)
    assert sum(counts.values()) == 20
    assert 0 < counts["grasping"] < 20
    assert dataset["reason"].attrs["flag_counts"].tolist() == list(counts.values())


def test_everything_has_a_name_and_a_unit(dataset):
    for name, variable in dataset.variables.items():
        assert variable.attrs["long_name"], name
        assert variable.attrs["units"] in ("1", "m", "rad"), name
    assert dataset["radius"].attrs["units"] == "m"
    assert dataset["wrap"].dims == ("rho", "phalanges", "radius")
    assert dataset["controls"].dims[3:] == ("finger", "phalanx")
    assert dataset["phalanges"].values.tolist() == FEW["phalanges"]


def test_the_attributes_hold_what_is_the_same_in_all_cells(dataset):
    attributes = dataset.attrs
    assert attributes["zygopin_version"] == zygopin.__version__
    assert (attributes["omega"], attributes["height"]) == (1.4, "rest")
    assert not {"rho", "phalanges", "radius"} & set(attributes)
    assert Foot.from_mapping(json.loads(attributes["foot"])) == PARROT


def test_cells_that_cannot_be_are_told_and_stop_nothing():
    grid = {
        "thickness": [0.0018, 0.02, -1.0],
        "pitch": [0.0, np.pi / 2],
        "radius": [0.008, -1.0, 1e-12],
    }
    found = sweep(PARROT, grid, levels=3, scheduler="sync")
    codes = [REASONS[code] for code in found["reason"].values.ravel()]
    broken = ["invalid_branch"] * 5
    assert codes == ["grasping", *broken, *["invalid_foot"] * 12]
    lost = found.isel(thickness=1, pitch=0, radius=0)
    for name in ("grasping", "feasible", "stable", "toes"):
        assert int(lost[name]) == -1
    for name in ("wrap", "scalar_product", "branch_height", "controls"):
        assert np.isnan(lost[name]).all()


def test_a_branch_may_be_given_its_height_or_have_it_found():
    grid = {"radius": 0.008, "height": [-0.02, -0.012, -0.004]}
    found = sweep(PARROT, grid, levels=3, scheduler="sync")
    assert found["branch_height"].values[:2].tolist() == [-0.02, -0.012]
    assert REASONS[int(found["reason"][2])] == "invalid_branch"  # holds the base
    best = sweep(PARROT, grid | {"height": "found"}, levels=3, scheduler="sync")
    assert best["branch_height"].shape == ()
    plan = plan_perch(PARROT, resting_branch(PARROT, 0.008), find_height=True, levels=3)
    assert float(best["branch_height"]) == plan.branch.centre[2]


@pytest.mark.parametrize("scheduler", ["threads", "processes"])
def test_every_scheduler_finds_the_same_to_the_bit(dataset, scheduler):
    found = sweep(PARROT, FEW, levels=3, scheduler=scheduler, workers=2)
    assert_identical(found, dataset)


@pytest.mark.parametrize("suffix", [".nc", ".zarr"])
def test_what_is_saved_is_read_back_and_is_always_the_same(dataset, tmp_path, suffix):
    paths = [tmp_path / f"{name}{suffix}" for name in "ab"]
    for path in paths:
        save_dataset(dataset, path)
        save_dataset(dataset, path)  # in place of an old one
        assert_identical(load_dataset(path), dataset)
    with xarray.open_dataset(paths[0]) as plain:  # as others open it
        assert_identical(plain.load(), dataset)
    assert sorted(tmp_path.iterdir()) == paths
    assert files(paths[0]) == files(paths[1])


def test_a_sweep_goes_on_where_it_was(dataset, tmp_path):
    output = tmp_path / "a.nc"
    parts, planned = Parts.beside(output), few(output)
    sizes = [len(chunk.cells) for chunk in chunks(planned.grid, 3)]
    assert sizes == [CHUNK, CHUNK, 20 - 2 * CHUNK]

    def interrupted(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        planned.run(SYNC, lambda *_: interrupted)
    assert len(list(parts.folder.iterdir())) == 1
    assert not output.exists()
    begun = []

    def begin(total, kept):
        begun.append((total, kept))
        return lambda: begun.append("step")

    again = planned.run(SYNC, begin)
    assert begun == [(3, 1), "step", "step"]
    assert (again.chunks, again.kept) == (3, 1)
    assert_identical(again.dataset, dataset)
    assert not parts.folder.exists()
    assert output.read_bytes() == save_dataset(dataset, tmp_path / "b.nc").read_bytes()


def test_a_finished_sweep_is_not_done_again(dataset, tmp_path):
    output = tmp_path / "a.zarr"
    save_dataset(dataset, output)
    result = few(output).run(SYNC)
    assert (result.chunks, result.kept) == (3, 3)
    assert_identical(result.dataset, dataset)


def test_another_question_finds_no_old_answer(tmp_path):
    output = tmp_path / "a.nc"
    one = list(chunks(SweepGrid.of(PARROT, FEW), 3))
    fine = list(chunks(SweepGrid.of(PARROT, FEW), 4))
    owl = list(chunks(SweepGrid.of(Foot.preset("owl"), FEW), 3))
    turned = list(chunks(SweepGrid.of(PARROT, FEW | {"yaw": 0.1}), 3))
    digests = [chunk.digest for each in (one, fine, owl, turned) for chunk in each]
    assert len(set(digests)) == len(digests)
    wide = list(chunks(SweepGrid.of(PARROT, FEW | {"rho": [1.1, 1.3, 1.5]}), 3))
    assert [each.digest for each in wide[:2]] == [each.digest for each in one[:2]]
    Parts.beside(output).folder.mkdir()
    (Parts.beside(output).folder / f"{one[0].digest}.npz").write_bytes(b"PK broken")
    assert few(output).run(SYNC).kept == 0


def test_files_of_others_stay(dataset, tmp_path):
    folder = Parts.beside(tmp_path / "a.nc").folder
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    few(tmp_path / "a.nc").run(SYNC)
    assert [path.name for path in folder.iterdir()] == ["notes.txt"]
    own = tmp_path / "mine.zarr"
    own.mkdir()
    with pytest.raises(FileError, match="name another file"):
        few(own)
    with pytest.raises(FileError, match="cannot be replaced"):
        save_dataset(dataset, own)
    assert own.is_dir()


CHILD = """
import sys, time
from tests.test_design_sweep import few, SYNC
def begun(total, kept):
    left = iter(range(2))
    def step():
        if next(left) == 1:
            print("two are done", flush=True)
            time.sleep(600)
    return step
few(sys.argv[1]).run(SYNC, begun)
"""


def test_a_killed_sweep_goes_on_where_it_was(dataset, tmp_path):
    output = tmp_path / "a.nc"
    command = [sys.executable, "-c", CHILD, str(output)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "two are done\n"
        child.kill()
    assert child.returncode == -9
    assert len(list(Parts.beside(output).folder.glob("*.npz"))) == 2
    result = few(output).run(SYNC)
    assert (result.chunks, result.kept) == (3, 2)
    assert_identical(result.dataset, dataset)
    assert sorted(tmp_path.iterdir()) == [output]


def test_an_output_that_cannot_be_is_told_before_the_work(tmp_path):
    with pytest.raises(FileError, match=r"end its name with \.nc .* or \.zarr"):
        few(tmp_path / "a.csv")
    with pytest.raises(ParameterError, match="levels = 1"):
        few(levels=1)
    with pytest.raises(FileError, match="is no dataset"):
        load_dataset(tmp_path / "none.nc")
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be written"):
        few(tmp_path / "file" / "a.nc").run(SYNC)


def test_unknown_schedulers_and_clusters_are_named(monkeypatch):
    monkeypatch.setattr("zygopin.sweep_run.PATIENCE", 0.2)
    with pytest.raises(UnknownNameError, match="processes, threads, sync, tcp://"):
        Runner("slurm")
    with pytest.raises(ParameterError, match="workers = 0"):
        Runner(workers=0)
    with pytest.raises(WorkerError, match="no scheduler answers at tcp://127"):
        sweep(PARROT, {"radius": 0.01}, scheduler="tcp://127.0.0.1:9")


@pytest.mark.parametrize(
    ("package", "module"),
    [("xarray", "sweep_dataset"), ("dask", "sweep_run"), ("dask", "design_sweep")],
)
def test_a_missing_package_names_the_extra(package, module):
    code = (
        f"import sys; sys.modules[{package!r}] = None\n"
        "from zygopin.errors import ZygopinError\n"
        "try:\n"
        f"    import zygopin.{module}\n"
        "except ZygopinError as error:\n"
        "    print(error)\n"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    words = f"{package} is not installed: pip install 'zygopin[sweep]' adds it"
    assert done.stdout.strip() == words
