"""Routes to the bones: the closed form, sums of plain numbers, readers of the URDF."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from functools import partial
from itertools import chain, pairwise

import numpy as np
import pinocchio as pin

from differ.comparison import Comparison, close, same
from differ.corners import BRANCH_CORNERS, CORNER_NAMES
from differ.draw import Draw, Size
from differ.route import Route
from zygopin import Foot, FootModel, forward_kinematics, names, to_urdf
from zygopin.clearance import Floats

ULPS = 32
"""Rounding of a junction, in units of the last place of the foot's size for each turn
of a toe: a dozen sums and products, each of a few units."""

CORNERS = tuple(name for name in CORNER_NAMES if name not in BRANCH_CORNERS)

THREADS = 2


def rounding(foot: Foot) -> float:
    """What rounding may move a junction by [m].

    The pitch is a sum of up to a dozen angles, whose own rounding turns all that
    follows.
    """
    most = max(finger.phalanges for finger in foot.fingers)
    turns = 1 + most * foot.omega / (2 * math.pi)
    return ULPS * float(np.finfo(float).eps) * turns * foot.size


def plain_bones(foot: Foot, controls: Floats, azimuths: Floats) -> Floats:
    """Equation (sys) with Python's own complex numbers, one pose: shape (P, 2, 3)."""
    bones = []
    for finger, part, azimuth in zip(
        foot.fingers, foot.finger_slices.values(), azimuths, strict=True
    ):
        place, pitch = 0j, finger.orientation
        ahead = complex(math.cos(azimuth), math.sin(azimuth))
        junctions = [(0.0, 0.0, 0.0)]
        for rank, control in enumerate(controls[part].tolist(), start=1):
            pitch += foot.omega * control
            length = foot.scale * foot.rho**-rank
            place += length * complex(math.cos(pitch), -math.sin(pitch))
            level = place.real * ahead
            junctions.append((level.real, level.imag, place.imag))
        bones += [*pairwise(junctions)]
    return np.array(bones)


def _turned(drawn: Draw, count: int) -> tuple[Floats, Floats]:
    """How far reversible toes are turned, 0 to 1, and all azimuths, shape (n, F)."""
    fingers = drawn.foot.fingers
    share = drawn.rng.uniform(size=(count, len(fingers)))
    own = np.array([finger.azimuth for finger in fingers])
    reversal = np.array([finger.reversal for finger in fingers])
    return share, own + share * reversal


def against_formula(drawn: Draw) -> Sequence[Comparison]:
    """The batch, on one thread and two, into given memory, at azimuths; and sums."""
    foot, controls = drawn.foot, drawn.controls
    _, azimuths = _turned(drawn, len(controls))
    own = np.array([finger.azimuth for finger in foot.fingers])
    batch = forward_kinematics(foot, controls, threads=1)
    room = np.empty_like(batch)
    forward_kinematics(foot, controls, threads=THREADS, out=room)
    turned = forward_kinematics(foot, controls, azimuths=azimuths, threads=THREADS)
    plain = np.array([plain_bones(foot, row, own) for row in controls])
    pairs = zip(controls, azimuths, strict=True)
    plain_turned = np.array([plain_bones(foot, row, turn) for row, turn in pairs])
    within = rounding(foot)
    return (
        close("bones: formula / batch", plain, batch, within),
        close("turned bones: formula / batch", plain_turned, turned, within),
        same("bones: one thread / two", batch, room),
    )


def urdf_tree(urdf: str) -> pin.Model:
    """Pinocchio's model of a URDF."""
    return pin.buildModelFromXML(urdf)


def against_pinocchio(drawn: Draw) -> Sequence[Comparison]:
    """The URDF in Pinocchio, between the URDF's own limits, and `FootModel`."""
    foot = drawn.foot
    urdf = to_urdf(foot)
    share, azimuths = _turned(drawn, len(drawn.controls))
    read = _by_pinocchio(urdf_tree(urdf), foot, drawn.controls, share)
    model = FootModel(foot, urdf).forward(drawn.controls[:FEW], azimuths=azimuths[:FEW])
    own = forward_kinematics(foot, drawn.controls, azimuths=azimuths)
    within = rounding(foot)
    return (
        close("bones: closed form / Pinocchio", own, read, within),
        close("bones: closed form / FootModel", own[:FEW], model, within),
    )


FEW = 50
"""Poses that go through `FootModel` as well: Pinocchio again."""


def _by_pinocchio(
    model: pin.Model, foot: Foot, controls: Floats, share: Floats
) -> Floats:
    """Bones by Pinocchio, controls and turns as shares of each joint's limits."""
    joints = [*chain.from_iterable(map(names.flexion_joints, foot.fingers))]
    turning = [i for i, f in enumerate(foot.fingers) if names.is_reversible(f)]
    joints += [names.reversal_joint(foot.fingers[i]) for i in turning]
    places = [model.idx_qs[model.getJointId(joint)] for joint in joints]
    low, high = model.lowerPositionLimit[places], model.upperPositionLimit[places]
    turns = share[:, turning]
    back = [foot.fingers[i].reversal < 0 for i in turning]
    turns = np.where(back, 1 - turns, turns)
    q = np.empty((len(controls), model.nq))
    q[:, places] = low + np.concatenate([controls, turns], axis=1) * (high - low)
    frames = [model.getFrameId(link) for link in names.bone_links(foot)]
    data, places_of = model.createData(), np.empty((len(q), len(frames), 3))
    for row, out in zip(q, places_of, strict=True):
        pin.framesForwardKinematics(model, data, row)
        out[:] = [data.oMf[frame].translation for frame in frames]
    return paired(foot, places_of)


def paired(foot: Foot, origins: Floats) -> Floats:
    """Origins of links, tips among them, as bones, shape (n, P, 2, 3)."""
    starts = np.arange(foot.phalanx_count) + foot.finger_of_phalanx
    return origins[:, starts[:, None] + [0, 1]]


def against_yourdfpy(drawn: Draw) -> Sequence[Comparison]:
    """The same URDF read by yourdfpy: joint limits, and the frames of all links."""
    import yourdfpy  # takes a second

    foot = drawn.foot
    load = partial(yourdfpy.URDF.load, load_meshes=False, build_scene_graph=True)
    robot = load(io.BytesIO(to_urdf(foot).encode()))
    joints = [*chain.from_iterable(map(names.flexion_joints, foot.fingers))]
    limits = [robot.joint_map[joint].limit for joint in joints]
    spans = np.array([(each.lower, each.upper) for each in limits])
    links, found = [*names.bone_links(foot)], []
    for row in drawn.controls:
        angles = spans[:, 0] + row * (spans[:, 1] - spans[:, 0])
        for turn in (angles + 1, angles):  # or trimesh keeps what is DROPPED away
            robot.update_cfg(dict(zip(joints, turn.tolist(), strict=True)))
        found.append([robot.get_transform(link, names.BASE)[:3, 3] for link in links])
    own = forward_kinematics(foot, drawn.controls)
    read = paired(foot, np.array(found))
    within = rounding(foot) + _dropped(drawn)[:, None, None, None]
    return (close("bones: closed form / yourdfpy", own, read, within),)


DROPPED = 1e-8
"""Trimesh, which keeps yourdfpy's frames, leaves out transforms so near to none, and
changes so small: an angle [rad] or an offset [m]."""


def _dropped(drawn: Draw) -> Floats:
    """What frames that are left out move a pose's junctions by at most [m], (n,)."""
    foot, angles = drawn.foot, drawn.foot.omega * drawn.controls
    turned = np.where(angles <= DROPPED, angles, 0.0).sum(axis=1) * foot.size
    return np.asarray(turned + foot.lengths[foot.lengths <= DROPPED].sum())


STATED = f"{ULPS} ulp of the foot's size for each turn of a toe: rounding"

ROUTES = (
    Route(
        "bones-formula",
        "batch forward_kinematics (threads, azimuths, memory) / sums of plain numbers",
        STATED,
        against_formula,
        Size(poses=300),
        CORNERS,
    ),
    Route(
        "bones-pinocchio",
        "closed form / Pinocchio on the written URDF, between its limits / FootModel",
        STATED,
        against_pinocchio,
        Size(poses=5000),
        CORNERS,
    ),
    Route(
        "bones-yourdfpy",
        "closed form / yourdfpy on the written URDF, between its limits",
        STATED,
        against_yourdfpy,
        Size(poses=8, fingers=3, phalanges=5),
        CORNERS,
    ),
)
"""Routes to the bones."""
