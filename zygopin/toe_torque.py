"""Torques at the toes' joints: what contact forces ask of muscles and tendons."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from zygopin import checks, kinds, names
from zygopin.contacts import Contacts, Floats
from zygopin.errors import ParameterError
from zygopin.grasp import GraspReport
from zygopin.model import FootModel
from zygopin.strength import Drive

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
    kinds.instance("model", model, FootModel)
    kinds.instance("contacts", contacts, Contacts)
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


def joint_torques(
    model: FootModel, controls: Floats, contacts: Contacts, forces: Floats
) -> Floats:
    """Torques that joints must bear so that the toes stay: −Σ matrix·forces.

    Args:
        model: The foot in Pinocchio.
        controls: Controls of the stance, shape (P,).
        contacts: Its contacts, each with its phalanx.
        forces: Forces on the foot at the contacts [N], shape (N, 3).

    Returns:
        Closing torque of each joint [N·m], shape (P,).

    Raises:
        ParameterError: A contact that belongs to no phalanx, or not one force for each.
    """
    kinds.instance("contacts", contacts, Contacts)
    forces = checks.array("forces", forces)
    checks.shaped("forces", forces, contacts.points.shape)
    matrix = torque_matrix(model, controls, contacts)
    return np.asarray(-np.einsum("pni,ni->p", matrix, forces))


def tendon_drive(
    model: FootModel, report: GraspReport, contacts: Contacts, tension: float
) -> Drive:
    """Toes each drawn by one tendon: all joints of a toe share its tension.

    The tendon passes each joint at its phalanx's skin radius, so that it bends it with
    tension·radius.

    Args:
        model: The foot in Pinocchio.
        report: The verdicts on one stance.
        contacts: Its contacts.
        tension: Largest tension of each toe's tendon [N].

    Returns:
        The drive.

    Raises:
        ParameterError: A tension that is not positive, or a foot of bare bones, whose
            tendons have no moment arm.
    """
    kinds.instance("report", report, GraspReport)
    foot = report.foot
    pull = _positive("tension", tension, "what one tendon pulls, such as 5", "newtons")
    if foot.thickness == 0:
        remedy = "give the foot a thickness, or let each joint have its own torque"
        raise ParameterError("thickness", 0.0, "positive for a tendon's arm", remedy)
    toes = foot.finger_of_phalanx[:, None] == np.arange(len(foot.fingers))
    torques = pull * foot.radii[:, None] * toes
    return _drive(model, report, contacts, torques, np.zeros(len(foot.fingers)))


def joint_drive(
    model: FootModel, report: GraspReport, contacts: Contacts, torques: ArrayLike
) -> Drive:
    """Joints that each have a motor, which closes and opens alike.

    Args:
        model: The foot in Pinocchio.
        report: The verdicts on one stance.
        contacts: Its contacts.
        torques: Largest torque of each joint [N·m], shape (P,), or one for all.

    Returns:
        The drive.

    Raises:
        ParameterError: A torque that is not positive, or not one for each joint.
    """
    kinds.instance("report", report, GraspReport)
    count = report.foot.phalanx_count
    values = np.atleast_1d(checks.array("torques", torques))
    remedy = "give what a joint turns with, such as 0.01"
    good = (values > 0) & (values <= checks.LARGEST)
    checks.require("torques", values, good, "a positive number of N·m", remedy)
    if values.shape != (1,):
        checks.shaped("torques", values, (count,))
    own = np.diag(np.broadcast_to(values, (count,)))
    return _drive(model, report, contacts, own, np.full(count, -1.0))


def _drive(
    model: FootModel,
    report: GraspReport,
    contacts: Contacts,
    torques: Floats,
    low: Floats,
) -> Drive:
    """A drive of a stance, its stops where the controls are at an end."""
    return Drive(
        matrix=torque_matrix(model, report.controls, contacts),
        torques=torques,
        low=low,
        straight=report.controls <= STOP,
        bent=report.controls >= 1 - STOP,
    )


def _positive(name: str, value: float, example: str, unit: str) -> float:
    """A positive number with a unit."""
    return checks.number(
        name,
        value,
        allowed=f"a positive number of {unit}",
        where=lambda x: 0 < x <= checks.LARGEST,
        remedy=f"give {example}",
    )
