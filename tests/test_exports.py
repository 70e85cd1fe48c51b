"""The public names: complete, typed, lazy, documented."""

from __future__ import annotations

import ast
import inspect
from importlib import import_module
from pathlib import Path

import pytest

import zygopin

ROOT = Path(__file__).parent.parent
STUB = Path(zygopin.__file__).with_suffix(".pyi")

CONTRACT = {
    "Branch",
    "Finger",
    "Foot",
    "FootModel",
    "GraspReport",
    "PACKAGE_PATH",
    "PerchPlan",
    "SRDF_PATH",
    "URDF_PATH",
    "XACRO_PATH",
    "ZygopinError",
    "check_grasp",
    "export_scene",
    "forward_kinematics",
    "plan_perch",
    "to_srdf",
    "to_urdf",
}


def test_the_names_that_scripts_rely_on_are_exported():
    assert set(zygopin.__all__) >= CONTRACT


@pytest.mark.parametrize("name", zygopin.__all__)
def test_every_exported_name_loads(name):
    assert getattr(zygopin, name) is not None


def test_dir_lists_what_is_exported():
    assert dir(zygopin) == sorted(zygopin.__all__)
    assert len(set(zygopin.__all__)) == len(zygopin.__all__)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'Wing'"):
        _ = zygopin.Wing  # type: ignore[attr-defined]


def test_the_stub_exports_the_same_names_from_the_same_modules():
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    homes = {
        alias.asname: node.module
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert {*homes, "__version__"} == set(zygopin.__all__)
    for name, home in homes.items():
        assert getattr(import_module(home), name) is getattr(zygopin, name)


def test_the_version_is_that_of_the_project_and_the_citation():
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f'version = "{zygopin.__version__}"' in project
    assert f"version: {zygopin.__version__}\n" in citation


def test_public_functions_document_their_arguments_and_results():
    for name in zygopin.__all__:
        value = getattr(zygopin, name)
        if inspect.isfunction(value):
            text = inspect.getdoc(value) or ""
            assert "Returns:" in text, name
            assert not inspect.signature(value).parameters or "Args:" in text, name
