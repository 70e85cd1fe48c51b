"""The command `sweep`."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from zygopin import Foot
from zygopin.sweep_files import load_dataset

SMALL = ("--phalanges", "1-2-2-1", "--levels", "2", "--scheduler", "sync")


def test_grids_are_lists_or_steps(run, tmp_path):
    output = tmp_path / "a.nc"
    grids = ("--rho", "1.1,1.3", "--radius-mm", "3:20:18", "--omega-deg", "80")
    result = run("sweep", *SMALL, *grids, "--json", "-o", str(output))
    assert result.returncode == 0
    document = json.loads(result.stdout)
    assert list(document["dimensions"]) == ["rho", "radius"]
    assert document["dimensions"]["rho"] == [1.1, 1.3]
    radii = [x * 1e-3 for x in range(3, 21)]
    assert document["dimensions"]["radius"] == pytest.approx(radii)
    assert document["fixed"]["phalanges"] == "1-2-2-1"
    assert document["cells"] == sum(document["reasons"].values()) == 36
    assert document["chunks"] == {"total": 5, "kept": 0}
    dataset = load_dataset(output)
    assert dataset.attrs["omega"] == pytest.approx(1.3962634)
    assert Foot.from_mapping(json.loads(dataset.attrs["foot"])) == Foot.preset("parrot")


def test_the_table_fits_and_a_second_run_says_what_was_there(run, tmp_path):
    output = tmp_path / "a.zarr"
    grids = ("--radius-mm", "8:60:3", "--thickness-mm", "1.8,20")
    command = ("sweep", *SMALL, *grids, "-o", str(output))
    first, second = run(*command), run(*command)
    lines = first.stdout.splitlines()
    assert lines[0] == "parrot: 2 thickness × 3 radius = 6 cells"
    assert any(line.split() == ["no", "such", "foot", "3", "50.0%"] for line in lines)
    assert all(len(line) <= 80 for line in lines[:-1])
    assert lines[-1] == f"dataset: {output}"
    assert second.stdout.splitlines()[1] == "1 of 1 chunks were there already"
    assert second.stdout.splitlines()[2:] == lines[1:]


def test_a_height_is_given_or_found(run):
    fixed = run("sweep", *SMALL, "--radius-mm", "8", "--height-mm", "-12,-14", "--json")
    assert json.loads(fixed.stdout)["dimensions"] == {"height": [-0.012, -0.014]}
    found = run("sweep", *SMALL, "--radius-mm", "8", "--find-height", "--json")
    document = json.loads(found.stdout)
    assert document["fixed"]["height"] == "found"
    assert document["dimensions"] == {}
    assert document["output"] is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--radius-mm", "3:8"), "is not START:STOP:COUNT"),
        (("--radius-mm", "3:8:1"), "a count of 2 or more"),
        (("--radius-mm", "3,x"), "'x' is not a number of millimetres"),
        (("--radius-mm", "3,3"), "give each value once"),
        (("--radius-mm", "3", "--phalanges", "2-3"), "give such as 2-3-4-5"),
        (("--radius-mm", "3", "--scheduler", "x"), "unknown scheduler 'x'"),
        (("--radius-mm", "3", "-o", "a.csv"), "end its name with .nc"),
        (("--radius-mm", "3", "--height-mm", "-9", "--find-height"), "exclude"),
        (("--rho", "1.2"), "Missing option '--radius-mm'"),
    ],
)
def test_bad_grids_are_one_line_and_status_2(run, arguments, words):
    assert_complaint(run("sweep", *arguments), words)


def assert_complaint(result, words):
    assert result.returncode == 2
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert result.stderr.startswith("zygopin: ")
    assert words in result.stderr


@pytest.mark.parametrize("package", ["xarray", "dask", "h5netcdf"])
def test_a_missing_package_is_told_in_one_line(package, tmp_path):
    arguments = ["sweep", "--radius-mm", "8", "-o", str(tmp_path / "a.nc")]
    code = (
        f"import sys; sys.modules[{package!r}] = None\n"
        "from zygopin.cli import main\n"
        f"main({arguments!r})\n"
    )
    command = [sys.executable, "-c", code]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 2
    words = f"{package} is not installed: pip install 'zygopin[sweep]' adds it"
    assert result.stderr.splitlines() == [f"zygopin: {words}"]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["sweep", "design"])
def test_help_fits(run, command):
    result = run(command, "--help")
    assert all(len(line) <= 80 for line in result.stdout.splitlines())
