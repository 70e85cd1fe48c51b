"""Torques at the toes' joints: what contact forces ask of muscles and tendons."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from zygopin import checks, names
from zygopin.contacts import Contacts, Floats
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.grasp import GraspReport
from zygopin.model import FootModel
from zygopin.strength import Tendon

STOP = 1e-9
"""Control this near to 0 or 1 is at the joint's stop."""


def torque_matrix(model: FootModel, controls: Floats, contacts: Contacts) -> Floats:
    """Torques that contact forces put on the joints: Jacobians transposed.

    Args:
        model: The foot in Pinocchio.
        controls: Controls of the stance, shape (P,).
        contacts: Its contacts, each with its phalanx.

    Returns:
        Closing torque at each joint per unit of each force [m], shape (P, N, 3); what
        muscles must add to balance forces f is −Σ matrix·f.

    Raises:
        ParameterError: A contact that belongs to no phalanx of the foot.
    """
    foot, ranks = model.foot, np.asarray(contacts.phalanges)
    known = (ranks >= 0) & (ranks < foot.phalanx_count)
    allowed = f"an index from 0 to {foot.phalanx_count - 1}"
    remedy = "give each contact's phalanx"
    checks.require("contacts.phalanges", ranks, known, allowed, remedy)
    links = [link for finger in foot.fingers for link in names.phalanx_links(finger)]
    joints = [name for finger in foot.fingers for name in names.flexion_joints(finger)]
    columns = [model.model.idx_vs[model.model.getJointId(name)] for name in joints]
    data = model.model.createData()
    q = model.configuration(controls)
    pin.computeJointJacobians(model.model, data, q)
    pin.updateFramePlacements(model.model, data)
    matrix = np.empty((foot.phalanx_count, len(ranks), 3))
    for place, (rank, point) in enumerate(zip(ranks, contacts.points, strict=True)):
        frame = model.model.getFrameId(links[rank], pin.FrameType.BODY)
        frames = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        moved = pin.getFrameJacobian(model.model, data, frame, frames)
        jacobian = moved.reshape(6, -1)[:, columns]  # flat where one joint is all
        arm = point - data.oMf[frame].translation
        matrix[:, place] = jacobian[:3].T + np.cross(jacobian[3:].T, arm)
    return matrix


def tendon_of(
    model: FootModel, report: GraspReport, contacts: Contacts, tension: float
) -> Tendon:
    """The tendons of a stance.

    Args:
        model: The foot in Pinocchio.
        report: The verdicts on one stance.
        contacts: Its contacts.
        tension: Largest tension of each toe's tendon [N].

    Returns:
        The tendons.

    Raises:
        ParameterError: A tension that is not positive, or a foot of bare bones, whose
            tendons have no moment arm.
    """
    foot: Foot = report.foot
    value = checks.number(
        "tension",
        tension,
        allowed="a positive number of newtons",
        where=lambda force: force > 0,
        remedy="give what one tendon pulls, such as 5",
    )
    if foot.thickness == 0:
        remedy = "give the foot a thickness, or let each joint have its own torque"
        raise ParameterError("thickness", 0.0, "positive for a tendon's arm", remedy)
    return Tendon(
        tension=value,
        matrix=torque_matrix(model, report.controls, contacts),
        arms=foot.radii,
        finger=foot.finger_of_phalanx,
        straight=report.controls <= STOP,
        bent=report.controls >= 1 - STOP,
    )
