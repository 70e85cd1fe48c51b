"""The package's shape: modules import only from those below them."""

from __future__ import annotations

import ast
from pathlib import Path

import zygopin

PACKAGE = Path(zygopin.__file__).parent

LAYERS = (
    "errors",
    "checks",
    "records",
    "rotations",
    "expansion",
    "illinois",
    "control_system",
    "ifs",
    "word_answer",
    "word_tree",
    "control_boxes",
    "inverse",
    "cells",
    "raster",
    "extent",
    "stadiums",
    "paths",
    "robot_description",
    "files",
    "archive",
    "hausdorff",
    "presets",
    "finger",
    "foot",
    "names",
    "branch",
    "obstacle",
    "description",
    "kinematics",
    "projection",
    "branch_grid",
    "laid_contact",
    "tangent_poses",
    "contact_hull",
    "tangent_proof",
    "toe_contacts",
    "axis_chain",
    "touch_bounds",
    "touch_witness",
    "touch_search",
    "touch",
    "touching",
    "stance",
    "spread",
    "urdf_check",
    "reach",
    "reach_inverse",
    "model",
    "validation",
    "clearance",
    "polytope",
    "collision",
    "engine",
    "solid_clearance",
    "grasp",
    "placement",
    "tangent_lines",
    "crossings",
    "branch_solutions",
    "branch_search",
    "resting_equations",
    "resting",
    "contacts",
    "strength",
    "programme",
    "closure",
    "toe_torque",
    "load",
    "hold",
    "witnesses",
    "survey",
    "atlas",
    "atlas_file",
    "atlas_regions",
    "atlas_row",
    "reason",
    "wrap",
    "preference",
    "perch_combinations",
    "perch_height",
    "perch_column",
    "perch_tangents",
    "perch_candidates",
    "perch_proof",
    "perch",
    "rest",
    "graspable",
    "worker_process",
    "design",
    "sweep_grid",
    "sweep_cell",
    "sweep_parts",
    "sweep_run",
    "sweep_dataset",
    "sweep_files",
    "design_sweep",
    "poses",
    "adjacency",
    "srdf",
    "keyframes",
    "masses",
    "dynamics",
    "simulated",
    "mjcf_bodies",
    "mjcf",
    "mjcf_scene",
    "mesh",
    "bundle",
    "motion",
    "closing",
    "advancement",
    "flight",
    "grip",
    "trajectory",
    "toe_motion",
    "toe_stops",
    "tendon",
    "strike",
    "attack",
    "engagement",
    "phalanx_sweep",
    "remark",
    "camera",
    "solids",
    "viewer",
    "canvas",
    "playback",
    "drawing",
    "hold_drawing",
    "caption",
    "obstacle_drawing",
    "scene",
    "reach_scene",
    "strike_caption",
    "strike_scene",
    "atlas_scene",
    "figures",
    "plots",
    "engagement_plots",
    "touch_plots",
    "remark_plots",
    "strike_plots",
    "design_plots",
    "side_views",
    "atlas_plots",
    "output",
    "perch_output",
    "reach_output",
    "branch_output",
    "strike_output",
    "touch_output",
    "atlas_output",
    "design_output",
    "sweep_output",
    "options",
    "option_types",
    "given_controls",
    "command_group",
    "terminal",
    "cli_branches",
    "cli_reach",
    "cli_strike",
    "cli_touch",
    "cli_atlas",
    "cli_sweep",
    "cli_design",
    "cli",
    "__main__",
)
"""From parameters to the command line; `__init__` re-exports and stands outside."""


def imported(module: str) -> set[str]:
    """Modules of the package that a module imports, anywhere in its text."""
    tree = ast.parse((PACKAGE / f"{module}.py").read_text(encoding="utf-8"))
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "zygopin":
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            head, _, tail = node.module.partition(".")
            found.update({tail.split(".")[0]} if head == "zygopin" else ())
        elif isinstance(node, ast.Import):
            names = (alias.name.split(".") for alias in node.names)
            found.update(name[1] for name in names if name[0] == "zygopin" and name[1:])
    return found


def test_every_module_has_its_layer():
    modules = {path.stem for path in PACKAGE.glob("*.py")} - {"__init__"}
    assert modules == set(LAYERS)


def test_modules_import_only_from_layers_below():
    for place, module in enumerate(LAYERS):
        above = imported(module) - set(LAYERS[:place])
        assert not above, f"{module} imports {sorted(above)}"
