"""Good arguments for every public entry: small, so that the table is quick."""

from __future__ import annotations

import math
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

import zygopin as zg

RECORDS = {
    "Atlas",
    "BranchSolutions",
    "ClosureQuality",
    "ContactKept",
    "Counterexample",
    "Design",
    "Drive",
    "Engine",
    "FingerReach",
    "GraspReport",
    "GraspVerdicts",
    "GraspableRadii",
    "Grip",
    "HausdorffDistance",
    "Hold",
    "InverseReach",
    "PaperReport",
    "PerchPlan",
    "PullLimit",
    "ReachValidation",
    "ReachableSet",
    "RestingRadii",
    "SpreadStudy",
    "StrikeEvent",
    "StrikeTrajectory",
    "SystemCounts",
    "TiltLimit",
    "TouchIntervals",
    "TouchingControls",
    "ValidationRow",
    "Law",
    "Motion",
}
"""Results: made by the package and by the class methods of their own; what they hold is
not looked at again. Where they are handed back, what reads them is in the table."""

INTERNAL = {"Branch.entries", "BranchGrid.line", "BranchGrid.centres"}
"""Methods that take what the package makes for itself."""


@cache
def folder():
    return Path(tempfile.mkdtemp(prefix="good-"))


@cache
def foot():
    fingers = (
        zg.Finger("ahead", 2, 0.0, reversed_azimuth=1.0),
        zg.Finger("behind", 2, math.pi),
    )
    return zg.Foot(rho=1.2, omega=1.4, scale=0.02, thickness=0.004, fingers=fingers)


@cache
def branch():
    return zg.Branch(0.005, (0.0, 0.0, -0.009))


@cache
def plan():
    return zg.plan_perch(foot(), branch(), find_height=True)


@cache
def contacts():
    return zg.branch_contacts(plan().report)


@cache
def model():
    return zg.FootModel(foot())


@cache
def strength():
    return zg.Strength(1.0, zg.Friction(0.5))


@cache
def grid():
    return zg.BranchGrid([-0.02, -0.012], [0.004, 0.006])


@cache
def atlas():
    return zg.branch_atlas(foot(), grid())


@cache
def system():
    return zg.ControlSystem(1.5, 1.0, 3)


@cache
def ball():
    return zg.Sphere(0.005, (0.0, 0.0, 0.0))


@cache
def flight():
    return zg.Attack().flight(foot(), radius=0.005)


@cache
def strike():
    return zg.simulate_strike(foot(), ball(), flight(), frames=20)


def tendon_foot():
    return zg.TendonFoot(foot(), ball(), flight())


def locked_foot():
    down = zg.Motion.through([0, 1, 9], [[0, 0, 0.1], [0, 0, 0.007], [0, 0, 0.007]])
    made = zg.TendonFoot(foot(), ball(), zg.Flight(down))
    made.run(2.0)
    return made


@cache
def solutions():
    return zg.stable_branches(foot(), (1, 2))


@cache
def intervals():
    return zg.touch_intervals(foot(), branch(), tolerance=0.01)


@cache
def saved_atlas():
    return zg.save_atlas(atlas(), folder() / "atlas.npz")


def motion():
    return zg.Motion.resting()


def law():
    return zg.Law.constant(0.5)


@cache
def design():
    radii = zg.graspable_radii(foot(), 0.004, 0.006, levels=2, samples=2)
    return zg.Design(radii, radii, {"rho": (1.1, 1.3)}, 16)


@cache
def urdf():
    return zg.to_urdf(foot())


OWNERS = {
    "Atlas": atlas,
    "Attack": zg.Attack,
    "Branch": branch,
    "BranchGrid": grid,
    "BranchSolutions": solutions,
    "Closing": zg.Closing,
    "ContactKept": lambda: zg.contact_kept(foot(), ball()),
    "Contacts": contacts,
    "ControlSystem": system,
    "Criteria": zg.Criteria,
    "FingerReach": lambda: zg.finger_reach(foot(), 1, 3),
    "Foot": foot,
    "FootModel": model,
    "Friction": zg.Friction,
    "GraspReport": lambda: plan().report,
    "Law": law,
    "Motion": motion,
    "Placement": zg.Placement,
    "ReachableSet": lambda: zg.reachable_set(1.5, 1.0, 3, 2),
    "TendonFoot": tendon_foot,
    "TendonFoot.release": locked_foot,
    "TouchIntervals": intervals,
}

GOOD = {
    "foot": foot,
    "branch": branch,
    "contacts": contacts,
    "model": model,
    "strength": strength,
    "grid": grid,
    "atlas": atlas,
    "system": system,
    "obstacle": ball,
    "flight": flight,
    "trajectory": strike,
    "report": lambda: plan().report,
    "intervals": intervals,
    "placement": zg.Placement,
    "criteria": zg.Criteria,
    "closing": zg.Closing,
    "contact": zg.Contact,
    "friction": zg.Friction,
    "motion": motion,
    "controls": lambda: np.full(4, 0.5),
    "path": lambda: folder() / "out.png",
    "folder": lambda: folder() / "out",
    "radius": lambda: 0.005,
    "centre": lambda: (0.0, 0.0, -0.009),
    "centre_of_mass": lambda: (0.0, 0.0, 0.03),
    "axis": lambda: (0.0, 1.0, 0.0),
    "heights": lambda: [-0.02, -0.012],
    "radii": lambda: [0.004, 0.006],
    "rho": lambda: 1.5,
    "omega": lambda: 1.0,
    "levels": lambda: 3,
    "depth": lambda: 2,
    "finger": lambda: 1,
    "pair": lambda: (1, 2),
    "tolerance": lambda: 1e-3,
    "target": lambda: 0.5 + 0.1j,
    "first": lambda: [[0.0, 1.0], [2.0, 3.0]],
    "second": lambda: [[0.0, 1.0]],
    "point": lambda: (0.02, 0.0, -0.01),
    "direction": lambda: (0.0, 0.0, 1.0),
    "low": lambda: 0.004,
    "high": lambda: 0.006,
    "reversal": lambda: [0.0, 0.5],
    "mass": lambda: 0.04,
    "tension": lambda: 5.0,
    "torques": lambda: 0.01,
    "load": lambda: np.array([0.0, 0, -1, 0, 0, 0]),
    "forces": lambda: np.ones(contacts().points.shape),
    "verdict": lambda: "stable",
    "row": lambda: 0,
    "column": lambda: 1,
    "rows": lambda: 0,
    "columns": lambda: 1,
    "times": lambda: [0.0, 1.0],
    "duration": lambda: 0.04,
    "splay": lambda: 0.2,
    "bones": lambda: [[[0.0, 0, -1], [1.0, 0, -1]]],
    "Attack.reversal": lambda: 1.0,
    "Attack.flight.target": lambda: (0.0, 0.0, 0.0),
    "Box.size": lambda: (0.01, 0.01, 0.01),
    "Box.centre": lambda: (0.0, 0.0, 0.0),
    "Box.rotation": lambda: np.eye(3),
    "Branch.frame.reference": lambda: (1.0, 0.0, 0.0),
    "Branch.broadcast.shape": lambda: (3,),
    "Branch.length": lambda: 1.0,
    "Capsule.ends": lambda: [[0.0, 0, 0], [0.0, 0, 0.1]],
    "Closing.when.value": lambda: 0.5,
    "ContactKept.keeps.first": lambda: 0.0,
    "ContactKept.keeps.last": lambda: 1.0,
    "Contacts.points": lambda: [[0.0, 0, 0.1], [0.1, 0.0, 0.0]],
    "Contacts.normals": lambda: [[0.0, 0, 1.0], [1.0, 0.0, 0.0]],
    "Contacts.origin": lambda: (0.0, 0.0, 0.0),
    "Contacts.scale": lambda: 1.0,
    "Contacts.phalanges": lambda: [0, 1],
    "Contacts.wrench_at.force": lambda: (0.0, 0.0, 1.0),
    "ControlSystem.tail.total": lambda: 4,
    "ConvexMesh.vertices": lambda: [[0.0, 0, 0], [1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]],
    "ConvexMesh.triangles": lambda: [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    "Finger.name": lambda: "toe",
    "Finger.phalanges": lambda: 2,
    "Finger.azimuth": lambda: 0.0,
    "FingerReach.in_space.indices": lambda: [0, 1],
    "Flight.controls": lambda: 0.5,
    "Flight.reversal": lambda: 0.5,
    "Foot.rho": lambda: 1.2,
    "Foot.scale": lambda: 0.02,
    "Foot.thickness": lambda: 0.002,
    "Foot.preset.name": lambda: "owl",
    "Foot.load.path": lambda: zg.PRESETS_PATH / "owl.yaml",
    "Foot.from_mapping.mapping": lambda: {"rho": 1.2},
    "FootModel.urdf": urdf,
    "FootModel.coordinates.joints": lambda: ["ahead_joint1"],
    "Friction.forces.normals": lambda: [[0.0, 0.0, 1.0]],
    "GraspReport.difference.other": lambda: plan().report,
    "Law.constant.value": lambda: 0.5,
    "Law.through.values": lambda: [0.0, 1.0],
    "Law.of.function": lambda: abs,
    "Law.of.end": lambda: 1.0,
    "Law.of.rate": lambda: 1.0,
    "Law.rate.start": lambda: 0.0,
    "Law.rate.end": lambda: 1.0,
    "Motion.through.positions": lambda: np.zeros((2, 3)),
    "Motion.through.rotations": lambda: np.array([np.eye(3)] * 2),
    "Motion.of.function": lambda: lambda _time: np.eye(4),
    "Motion.of.end": lambda: 1.0,
    "Motion.of.speed": lambda: 0.0,
    "Motion.resting.pose": lambda: np.eye(4),
    "Motion.bounds.start": lambda: 0.0,
    "Motion.bounds.end": lambda: 1.0,
    "Placement.branch.height": lambda: -0.01,
    "ReachableSet.words.indices": lambda: [0, 1],
    "Strength.normal_force": lambda: 1.0,
    "TendonFoot.run.until": lambda: 0.01,
    "TendonFoot.near.bones": lambda: np.tile([[0.0, 0, -1], [1.0, 0, -1]], (4, 1, 1)),
    "TendonFoot.near.radii": lambda: np.zeros(4),
    "contact_kept.base": lambda: np.eye(4),
    "contact_kept.azimuths": lambda: [0.0, math.pi],
    "forward_kinematics.azimuths": lambda: [0.0, math.pi],
    "FootModel.configuration.azimuths": lambda: [0.0, math.pi],
    "FootModel.forward.azimuths": lambda: [0.0, math.pi],
    "forward_kinematics.out": lambda: np.empty((4, 2, 3)),
    "load_atlas.path": saved_atlas,
    "make_engine.name": lambda: "fcl",
    "obstacle_clearance.radii": lambda: [0.0],
    "plot_engagement.stages": lambda: 3,
    "plot_touch_bands.omegas": lambda: [1.0, 1.2],
    "plot_touch_bands.rhos": lambda: [1.2, 1.4],
    "pull_limit.load": lambda: np.zeros(6),
    "save_strike.path": lambda: folder() / "strike.npz",
    "sweep.grid": lambda: {"radius": [0.005]},
    "to_mjcf_scene.model": lambda: "foot.xml",
    "validate_foot.levels": lambda: 3,
    "validate_foot.samples": lambda: 5,
    "validate_foot.urdf": urdf,
    "nearest_reachable.tolerance": lambda: 1e-3,
    "resting_branch.radius": lambda: 0.005,
    "simulate_strike.frames": lambda: 5,
    "talon_hull_area.reversal": lambda: [0.5],
    "touching_controls.radius": lambda: 0.005,
    "attractor.tolerance": lambda: 0.1,
    "Criteria.tolerance": lambda: 1e-6,
    "inverse_reach.tolerance": lambda: 1e-4,
    "inverse_reach.levels": lambda: 3,
    "counterexample.lost_at": lambda: 0.6,
    "plot_remark.lost_at": lambda: 0.6,
    "design_foot.bounds": lambda: {"rho": (1.1, 1.3)},
    "spread_study.steps": lambda: 3,
    "spread_study.controls": lambda: np.zeros(4),
    "tilt_limit.contacts": contacts,
    "BranchGrid.rows.which": lambda: slice(0, 1),
    "design": design,
}
"""By a parameter's name, or by the entry's and its own: how a good value is made."""

TEXTS = ("empty", "unknown", "capitals", "two lines", "long")
MANY_TIMES = ("1e308", "-1e308")

ACCEPTED = {
    "Finger.name": ("unknown",),
    "Foot.name": ("unknown",),
    "BranchGrid.heights": ("a number",),
    "BranchGrid.radii": ("a number",),
    "Closing.at.times": ("last axis longer", "last axis empty", "a number"),
    "Closing.when.value": MANY_TIMES,
    "Contact.tolerance": ("1e308",),  # each foot has its own limit: see Criteria.metres
    "Criteria.tolerance": ("1e308",),
    "ControlSystem.tail.total": ("inf",),
    "levels": ("a million",),  # all of them 0: one level
    "count_systems.levels": (),
    "Flight.controls": ("mapping",),  # which fingers there are is the foot's to say
    "Law.rate.start": MANY_TIMES,
    "Law.rate.end": MANY_TIMES,
    "Motion.bounds.start": MANY_TIMES,
    "Motion.bounds.end": MANY_TIMES,
    "TendonFoot.run.until": ("-1e308",),  # a time that has passed
    "export_atlas_scene.height": MANY_TIMES,  # the nearest of the grid's
    "forward_kinematics.out": ("nan", "inf", "-inf"),  # all of it is overwritten
    "graspable_radii.tolerance": ("1e308",),
    "strike_area.reversal": ("last axis longer", "last axis empty", "a number"),
    "talon_hull_area.reversal": ("last axis longer", "last axis empty", "a number"),
    "title": TEXTS,
    "to_mjcf_scene.model": (*TEXTS, "surrogate"),
}
"""By a parameter's name, or by the entry's and its own: labels of bad values that are
legitimate there."""

OUT = {
    "rho": [("1", 1.0), ("0", 0.0), ("101", 101.0)],
    "omega": [("0", 0.0), ("π", math.pi), ("2π", 2 * math.pi)],
    "splay": [("negative", -0.1), ("π/2", math.pi / 2)],
    "zygodactyl_fingers.splay": [],
    "scale": [("0", 0.0), ("negative", -1.0)],
    "radius": [("0", 0.0), ("negative", -1.0)],
    "Attack.flight.radius": [("negative", -1.0)],
    "strike_area.radius": [("negative", -1.0)],
    "spread_study.radius": [("negative", -1.0)],
    "controls": [("above 1", np.full(4, 1.5)), ("negative", np.full(4, -0.1))],
    "threads": [("0", 0), ("257", 257)],
    "workers": [("0", 0)],
    "tolerance": [("0", 0.0), ("negative", -1.0)],
    "length": [("0", 0.0), ("negative", -1.0)],
    "axis": [("zero", (0.0, 0.0, 0.0))],
    "direction": [("zero", (0.0, 0.0, 0.0))],
    "mass": [("0", 0.0), ("negative", -1.0)],
    "Box.rotation": [("no rotation", np.ones((3, 3))), ("mirror", -np.eye(3))],
    "depth": [("-1", -1), ("1001", 1001)],
    "frames": [("1", 1)],
    "coefficient": [("negative", -0.1)],
    "edges": [("2", 2), ("65", 65)],
}
"""Values out of range, by a parameter's name, or by the entry's and its own."""
