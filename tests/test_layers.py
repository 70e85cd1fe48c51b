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
    "blocks",
    "branch",
    "obstacle",
    "template",
    "shipped",
    "description",
    "directions",
    "bones",
    "kinematics",
    "projection",
    "branch_grid",
    "laid_contact",
    "tangent_poses",
    "junction_hull",
    "contact_hull",
    "tangent_proof",
    "toe_contacts",
    "quarter_turn",
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
    "fcl_solids",
    "collision",
    "engine",
    "solid_clearance",
    "contact_products",
    "grasp",
    "verdicts",
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
    "wrap",
    "perch_combinations",
    "witnesses",
    "relaid",
    "propagation",
    "foot_poses",
    "survey",
    "worker_process",
    "atlas_parts",
    "atlas",
    "atlas_file",
    "atlas_regions",
    "atlas_row",
    "reason",
    "preference",
    "perch_height",
    "perch_column",
    "perch_tangents",
    "perch_surroundings",
    "perch_candidates",
    "perch_proof",
    "perch",
    "rest",
    "graspable",
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
    "looks",
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
    "paper.entry",
    "paper.finger_model",
    "paper.finger_plane",
    "paper.branch_drawings",
    "paper.branch_section",
    "paper.ellipse_errata",
    "paper.curves",
    "paper.grasp_cases",
    "paper.grasp_drawings",
    "paper.tangency_solver",
    "paper.tangency",
    "paper.tangency_errata",
    "paper.resting_scan",
    "paper.touched_radii",
    "paper.stability",
    "paper.zero_product",
    "paper.grasp_readings",
    "paper.closed_toes",
    "paper.caption_radius",
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

FOLDERS = ("zygopin", "zygopin.paper")
PLAIN = {name.split(".")[0] for name in LAYERS}


def imported(module: str) -> set[str]:
    """Modules of the package that a module imports, anywhere in its text."""
    path = PACKAGE.joinpath(*module.split(".")).with_suffix(".py")
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module in FOLDERS:
            head = f"{node.module}.".removeprefix("zygopin.")
            found.update(f"{head}{alias.name}" for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
        elif isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
    ours = (name.removeprefix("zygopin.") for name in found)
    return {name for name in ours if name.split(".")[0] in PLAIN}


def test_every_module_has_its_layer():
    paths = (path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))
    modules = {
        ".".join(path.with_suffix("").parts)
        for path in paths
        if path.stem != "__init__"
    }
    assert modules == set(LAYERS)


def test_modules_import_only_from_layers_below():
    for place, module in enumerate(LAYERS):
        above = imported(module) - set(LAYERS[:place])
        assert not above, f"{module} imports {sorted(above)}"
