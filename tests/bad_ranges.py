"""Where a bad value is legitimate after all, and which are out of range besides."""

from __future__ import annotations

import math

import numpy as np

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
