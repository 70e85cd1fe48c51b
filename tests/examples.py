"""Examples of what the package's functions take: small, so that tables are quick."""

from __future__ import annotations

import math
import tempfile
from functools import cache
from pathlib import Path

import zygopin as zg


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
