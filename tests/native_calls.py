"""Bad calls that end in FCL or Pinocchio, one after another in a process of their own.

A native library that meets NaN or an index out of range may end the process without a
word: the name of each call is printed before it, so that the last one names the crash.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from examples import (
    ball,
    branch,
    contacts,
    flight,
    foot,
    grid,
    model,
    plan,
    urdf,
)

import zygopin as zg
from zygopin.errors import ZygopinError
from zygopin.grasp import finger_pairs

Call = tuple[str, Callable[[], object]]

NAN, INF = math.nan, math.inf
HALF = np.full(4, 0.5)
TURN = np.eye(3)
CUBE = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]


def spoilt(values: np.ndarray, entry: float) -> np.ndarray:
    """An array with one bad entry."""
    bad = np.array(values, dtype=float)
    bad.flat[0] = entry
    return bad


def grasp_calls() -> Iterator[Call]:
    """Poses and branches for FCL's engine."""
    for name, controls in (
        *((f"controls {x}", spoilt(HALF, x)) for x in (NAN, INF, -0.1, 1.1, 1e308)),
        ("too few", HALF[:3]),
        ("too many", np.full(5, 0.5)),
        ("none", np.zeros(())),
    ):
        yield name, lambda v=controls: zg.check_grasp(foot(), v, branch(), engine="fcl")
        yield name, lambda v=controls: model().forward(v)
        yield name, lambda v=controls: zg.make_engine("fcl", foot()).bones(v)
    for change in (
        *({"radius": x} for x in (NAN, INF, -1.0, 0.0, 1e308)),
        *({"centre": (0.0, 0.0, x)} for x in (NAN, INF, 1e308)),
        *({"axis": axis} for axis in ((0, 0, 0), (NAN, 0, 0), (INF, 0, 0))),
        *({"length": x} for x in (NAN, -1.0, 0.0)),
    ):
        name = f"branch {change}"
        yield name, lambda c=change: replace(branch(), **c)
    for change in (
        {"rho": NAN},
        {"scale": INF},
        {"thickness": -1.0},
        {"fingers": (1,)},
    ):
        yield f"foot {change}", lambda c=change: zg.FootModel(replace(foot(), **c))


def distance_calls() -> Iterator[Call]:
    """Bones that are none, given to FCL past the engine's own kinematics."""
    bones = zg.forward_kinematics(foot(), HALF)
    point = bones.copy()
    point[1, 1] = point[1, 0]
    bad = [spoilt(bones, x) for x in (NAN, INF, 1e200)]
    pairs, engine = finger_pairs(foot()), zg.make_engine("fcl", foot())
    solids = (ball(), zg.Box([0.01] * 3, [0.0] * 3), zg.ConvexMesh(CUBE), branch())
    for lines in (*bad, point, bones[:0], bones[..., :2]):
        for solid in solids:
            name = f"bones at {type(solid).__name__}"
            yield (
                name,
                lambda v=lines, s=solid: zg.obstacle_clearance(
                    v, foot().radii, s, engine="fcl"
                ),
            )
    for lines in (*bad, point):
        yield (
            "bones in an engine",
            lambda v=lines: engine.distances(v, foot().radii, branch(), pairs),
        )
    for radii in (-foot().radii, foot().radii * NAN, np.full(4, INF)):
        yield (
            "radii in an engine",
            lambda v=radii: engine.distances(bones, v, branch(), pairs),
        )


def solid_calls() -> Iterator[Call]:
    """Solids that are none, made anew or changed."""
    box, mesh = zg.Box([0.01] * 3, [0.0] * 3), zg.ConvexMesh(CUBE)
    for turn in (TURN * NAN, TURN * 2, TURN * 0, -TURN, np.ones((3, 3))):
        yield "rotation", lambda v=turn: replace(box, rotation=v)
    for size in ([0, 1, 1], [-1, 1, 1], [NAN, 1, 1], [1, 1], [1e308] * 3):
        yield "size", lambda v=size: replace(box, size=v)
    for ends in (np.zeros((2, 3)), np.full((2, 3), NAN), np.zeros((3, 3))):
        yield "ends", lambda v=ends: zg.Capsule(0.01, v)
    for radius in (0.0, -1.0, NAN, INF, 1e308):
        yield "radius", lambda v=radius: replace(ball(), radius=v)
    for corners in (
        np.zeros((8, 3)),
        np.array(CUBE) * [1, 1, 0],
        np.array(CUBE) * NAN,
        np.array(CUBE) * 1e308,
        CUBE[:3],
    ):
        yield "vertices", lambda v=corners: zg.ConvexMesh(v)
    for faces in ([[0, 1, 99]], [[0, 1, -1]], [[0, 1, 0.5]], [[0, 1, 2]], [[NAN] * 3]):
        yield "triangles", lambda v=faces: replace(mesh, triangles=v)


def model_calls() -> Iterator[Call]:
    """URDFs that were changed, and what asks a model for what it does not have."""
    text, joint = urdf(), "ahead_joint1"
    for name, (old, new) in {
        "cycle": ('parent link="foot"', 'parent link="ahead_tip"'),
        "itself": ('parent link="foot"', 'parent link="ahead_phalanx1"'),
        "unknown type": ('type="revolute"', 'type="hinge"'),
        "floating": ('type="revolute"', 'type="floating"'),
        "planar": ('type="revolute"', 'type="planar"'),
        "no limit": ("<limit", "<limits"),
        "no axis": ('axis xyz="0 1 0"', 'axis xyz="0 0 0"'),
        "NaN origin": ('xyz="0 0 0"', 'xyz="nan 0 0"'),
        "huge origin": ('xyz="0 0 0"', 'xyz="1e400 0 0"'),
        "negative mass": ('<mass value="', '<mass value="-'),
        "no mass": ('<mass value="', '<mass weight="'),
        "negative radius": ('radius="', 'radius="-'),
        "no name": (f'joint name="{joint}"', "joint"),
        "twice": ("ahead_phalanx2", "ahead_phalanx1"),
        "cut": (text[len(text) // 2 :], ""),
        "empty": (text, ""),
        "other root": ("robot", "rob"),
    }.items():
        yield f"URDF {name}", partial(zg.FootModel, foot(), text.replace(old, new))
    for names in (["universe"], ["nonsense"], [""], [3], "ahead_joint1"):
        yield f"joints {names}", lambda v=names: model().coordinates(v)
    for azimuths in ([NAN, 0.0], [0.0], [0.0, 0.0], [1e308, math.pi]):
        yield "azimuths", lambda v=azimuths: model().forward(HALF, azimuths=v)


def record_calls() -> Iterator[Call]:
    """Results handed back with other numbers in them."""
    report, strength = plan().report, zg.Strength(1.0, zg.Friction())
    other = zg.plan_perch(
        zg.Foot.preset("parrot"), zg.Branch(0.008, (0, 0, -0.01))
    ).report
    for spoil in (
        {"controls": report.controls * NAN},
        {"controls": report.controls[:2]},
        {"controls": report.controls + 9},
    ):
        bad = replace(report, **spoil)
        yield "drive", lambda v=bad: zg.joint_drive(model(), v, contacts(), 0.1)
        yield "tendon", lambda v=bad: zg.tendon_drive(model(), v, contacts(), 5.0)
    yield "other foot", lambda: zg.joint_drive(model(), other, contacts(), 0.1)
    for spoil in (
        {"point": report.point * NAN},
        {"normal": report.normal * 0},
        {"normal": np.full_like(report.normal, INF)},
    ):
        yield "hold", partial(zg.check_hold, replace(report, **spoil), strength)
    for ranks in ([99] * 9, [-1] * 9, [4] * 9):
        found = zg.Contacts(
            contacts().points,
            contacts().normals,
            phalanges=ranks[: len(contacts().points)],
        )
        yield "phalanges", lambda v=found: zg.torque_matrix(model(), HALF, v)
    law = zg.Law.of(
        lambda time: HALF if time * 512 % 1 == 0 else HALF * NAN, end=1.0, rate=1.0
    )
    late = replace(
        flight(),
        controls=law,
        motion=zg.Motion.through([0, 1], [[0, 0, 0.1], [0, 0, 0]]),
    )
    touch = zg.Contact(engine="fcl")
    yield "law", lambda: zg.simulate_strike(foot(), ball(), late, contact=touch)
    yield "row", lambda: grid().at(9, 0)


GROUPS = {
    "grasp": grasp_calls,
    "distance": distance_calls,
    "solid": solid_calls,
    "model": model_calls,
    "record": record_calls,
}


def say(line: str) -> None:
    """A line that is out before anything else happens."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main() -> int:
    """Make the calls of some groups; 1 where one is not refused as it should."""
    wrong = 0
    for group in sys.argv[1:]:
        for name, call in GROUPS[group]():
            say(f"{group}: {name}")
            try:
                result = call()
            except ZygopinError:
                continue
            except Exception as error:
                result = f"{type(error).__name__}: {error}"
            wrong += 1
            say(f"WRONG {group}: {name}: {result!r}"[:300])
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())
