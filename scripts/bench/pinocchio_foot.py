"""The foot in Pinocchio, as peers that measure distances use it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bench.checking import Answer, Checking, decided
from zygopin import Branch, names
from zygopin.clearance import Floats
from zygopin.grasp import least_gap

Check = Callable[[], Answer]
Measure = Callable[[Floats, Floats, Floats], None]

REACH = 4.0
"""Half-length of the capsule that stands for a branch, over the foot's size."""

ALONG = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
"""Turns z, along which capsules lie, to x, along which phalanges do."""


class PinocchioFoot:
    """The foot, with a frame midway along each bone that has z along it.

    Args:
        job: The job.

    Attributes:
        model: The model.
        data: Its data.
        q: Configurations [rad], shape (N, P).
        frames: Which frames are midway, in the order of phalanges.
        middles: Their placements, which each pass renews.
    """

    def __init__(self, job: Checking) -> None:
        import pinocchio as pin

        posing, model = job.posing, pin.buildModelFromXML(job.posing.urdf)
        tips = {names.tip_link(finger) for finger in job.foot.fingers}
        ids = [model.getFrameId(link, pin.FrameType.BODY) for link in posing.links]
        both = zip(posing.links, ids, strict=True)
        phalanges = [frame for link, frame in both if link not in tips]
        self.frames = []
        for phalanx, length in zip(phalanges, job.foot.lengths, strict=True):
            holder = model.frames[phalanx]
            half = pin.SE3(ALONG, np.array([length / 2, 0.0, 0.0]))
            name, place = f"{holder.name}_middle", holder.placement * half
            new = pin.Frame(
                name, holder.parentJoint, phalanx, place, pin.FrameType.OP_FRAME
            )
            self.frames.append(model.addFrame(new))
        self.model, self.data = model, model.createData()
        self.q = posing.angles([*model.names][1:])
        self.middles = [self.data.oMf[i] for i in self.frames]
        self._origins = [self.data.oMf[i].translation for i in ids]
        self._pass = pin.framesForwardKinematics

    def move(self, row: Floats, junctions: Floats) -> None:
        """Take a configuration, and write where its junctions are, (3·(P + F),)."""
        self._pass(self.model, self.data, row)
        self.read(junctions)

    def read(self, junctions: Floats) -> None:
        """Write where the junctions are, (3·(P + F),)."""
        np.concatenate(self._origins, out=junctions)


def stem_pose(branch: Branch) -> tuple[Floats, Floats]:
    """Rotation and place of the capsule that stands for a branch."""
    axis = np.asarray(branch.axis)
    aside = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    aside /= np.linalg.norm(aside)
    turn = np.stack([aside, np.cross(axis, aside), axis], axis=1)
    return turn, branch.centre - (branch.centre @ axis) * axis


def each(job: Checking, q: Floats, measure: Measure, pairs: int = 0) -> Check:
    """A check that takes one configuration after the other.

    Args:
        job: The job.
        q: The tool's configurations, shape (N, P).
        measure: Takes a configuration; writes its 14 clearances, after them the
            distances of further pairs, and its junctions, flat.
        pairs: Number of further pairs, of phalanges of different fingers.

    Returns:
        What measures all and decides.
    """
    count = job.foot.phalanx_count
    room, points = np.empty((len(q), count + pairs)), job.posing.room()
    flat = points.reshape(len(q), -1)

    def check() -> Answer:
        for row, out, junctions in zip(q, room, flat, strict=True):
            measure(row, out, junctions)
        answer = decided(job, points, room[:, :count])
        if not pairs:
            return answer
        apart = room[:, count:].min(axis=1) >= least_gap(job.foot, job.tolerance)
        return answer.with_fingers(apart)

    return check
