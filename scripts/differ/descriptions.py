"""Routes to what the description says: limits and named poses, read back."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from xml.etree import ElementTree as ET

import numpy as np
import pinocchio as pin

from differ.bones import CORNERS, paired, rounding, urdf_tree
from differ.comparison import Comparison, at_most, close, same
from differ.draw import Draw, Size
from differ.route import Route
from zygopin import (
    Criteria,
    Foot,
    check_grasp,
    forward_kinematics,
    names,
    to_srdf,
    to_urdf,
)
from zygopin.clearance import Floats
from zygopin.grasp import TOLERANCE
from zygopin.poses import ANGLE_DIGITS, standard_perch

ULPS = 4
"""Rounding of an angle that is written and read, in units of the last place of a
turn."""

ROUNDED = 0.5 * 10.0**-ANGLE_DIGITS
"""What the perch's angles lose as they are written [rad]."""

TURN = ULPS * 2 * np.pi * float(np.finfo(float).eps)


def against_named(drawn: Draw) -> Sequence[Comparison]:
    """The URDF's limits, the SRDF's states in Pinocchio, the perch by FCL."""
    foot = drawn.foot
    model, states = urdf_tree(to_urdf(foot)), _states(to_srdf(foot))
    joints = [*names.moving_joints(foot)]
    spans = _spans(foot)
    wanted = np.array([spans[joint] for joint in joints])
    places = [model.idx_qs[model.getJointId(joint)] for joint in joints]
    limits = np.stack([model.lowerPositionLimit, model.upperPositionLimit], 1)[places]
    angles = np.array([[state[joint] for joint in joints] for state in states.values()])
    shape = angles.shape
    low, high = (np.broadcast_to(limit, shape) for limit in limits.T)
    read = np.stack([_by_pinocchio(model, foot, state) for state in states.values()])
    known = [name for name in states if name != "perch"]
    some = [name != "perch" for name in states]
    own = np.stack([_pose(foot, name) for name in known])
    return (
        close("limits: URDF / foot", limits[None], wanted[None], TURN),
        at_most("states / upper limits", angles, high, TURN),
        at_most("lower limits / states", low, angles, TURN),
        close("bones of states / closed form", read[some], own, rounding(foot)),
        *_perch(foot, states),
    )


def _states(srdf: str) -> dict[str, dict[str, float]]:
    """The named states of the whole foot: {name: {joint: angle}}."""
    root = ET.fromstring(srdf)  # noqa: S314 our own text
    end = root.find("end_effector")
    group = "" if end is None else end.get("group", "")
    return {
        state.get("name", ""): {
            joint.get("name", ""): float(joint.get("value", "nan")) for joint in state
        }
        for state in root.iterfind(f"group_state[@group='{group}']")
    }


def _spans(foot: Foot) -> dict[str, tuple[float, float]]:
    """Limits of each joint [rad]: 0 and omega, 0 and the turn."""
    joints = chain.from_iterable(map(names.flexion_joints, foot.fingers))
    spans = dict.fromkeys(joints, (0.0, foot.omega))
    for finger in filter(names.is_reversible, foot.fingers):
        turn = finger.reversal
        spans[names.reversal_joint(finger)] = min(0.0, turn), max(0.0, turn)
    return spans


def _by_pinocchio(model: pin.Model, foot: Foot, state: dict[str, float]) -> Floats:
    """Bones of a state, shape (P, 2, 3)."""
    q, data = pin.neutral(model), model.createData()
    for joint, angle in state.items():
        q[model.idx_qs[model.getJointId(joint)]] = angle
    pin.framesForwardKinematics(model, data, q)
    frames = [model.getFrameId(link) for link in names.bone_links(foot)]
    origins = np.array([[data.oMf[i].translation for i in frames]])
    return np.asarray(paired(foot, origins)[0])


def _pose(foot: Foot, name: str) -> Floats:
    """Bones that a pose's name promises, shape (P, 2, 3)."""
    controls = np.full(foot.phalanx_count, 1.0 if name == "closed" else 0.0)
    turn = [finger.reversal if name == "spread" else 0.0 for finger in foot.fingers]
    own = [finger.azimuth for finger in foot.fingers]
    return forward_kinematics(foot, controls, azimuths=np.add(own, turn))


def _perch(foot: Foot, states: dict[str, dict[str, float]]) -> Sequence[Comparison]:
    """The perch grasps the branch that it is for, by FCL, as written."""
    plan = standard_perch(foot)
    written = "perch" in states
    found = same("perch is written / planned", [written], [plan.grasping])
    if not written:
        return (found,)
    joints = chain.from_iterable(map(names.flexion_joints, foot.fingers))
    controls = np.array([states["perch"][joint] for joint in joints]) / foot.omega
    most = max(finger.phalanges for finger in foot.fingers)
    slack = Criteria(tolerance=(TOLERANCE + most * ROUNDED) * foot.size)
    engine_says = check_grasp(
        foot, np.minimum(controls, 1.0), plan.branch, engine="fcl", criteria=slack
    )
    verdicts = [[bool(engine_says.grasping), bool(engine_says.feasible)]]
    return (found, same("perch grasps / FCL", [[True, True]], verdicts))


ROUTES = (
    Route(
        "named-poses",
        "URDF limits, SRDF states in Pinocchio / the foot; the perch / FCL",
        f"{ULPS} ulp of a turn; contacts within what {ANGLE_DIGITS} decimals lose",
        against_named,
        Size(poses=1, fingers=4, phalanges=4, opposed=True),
        tuple(name for name in CORNERS if name != "twelve phalanges"),
        posed=False,
    ),
)
"""Routes to the description."""
