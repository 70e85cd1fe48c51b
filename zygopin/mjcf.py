"""A foot as a MuJoCo model (MJCF): the URDF's bodies, and what a URDF cannot say.

The text is written here, not by MuJoCo, whose own writer rounds to six digits and
changes with its version: masses, lengths and limits are the URDF's to the last bit,
the same foot is the same text everywhere, and writing it needs no MuJoCo.
"""

from __future__ import annotations

import math
from xml.etree import ElementTree as ET

from zygopin import dynamics, names
from zygopin.adjacency import touching_links
from zygopin.errors import DescriptionError
from zygopin.foot import Foot
from zygopin.load import GRAVITY
from zygopin.masses import Inertial
from zygopin.mjcf_bodies import add_bodies, brief, exact
from zygopin.simulated import SimulatedFoot

FLEXOR = "flexor"
"""The tendon over all flexion joints, and the actuator that pulls it."""

LEAST_INERTIA = 1e-15
"""Mass [kg] and inertia [kg·m²] above which MuJoCo takes a body that moves."""

FRICTION = 0.8
"""Sliding friction of a toe's pad on bark; illustrative, as of rubber on dry wood."""

PATCH = 0.3
"""Radius of the patch that a pad presses flat, over the thinnest phalanx's radius.

It is the lever of torsional friction, which MuJoCo takes as a length; its own default
of 5 mm is more than a small bird's toe is thick.
"""

ROLLING = 0.02
"""Lever of rolling friction over the thinnest phalanx's radius: a soft pad's loss."""

CONTACT_STEPS = 3
"""Time constant of contacts and limits, in time steps; MuJoCo asks for two at least.

With its default of 20 ms a small toe sinks deeper into its perch than it is thick.
"""

IMPEDANCE = (0.99, 0.999)
"""Least and greatest impedance of contacts (solimp): hard pads, little sinking in."""

WIDTH = 0.1
"""Depth at which the impedance is greatest, over the thinnest phalanx's radius."""

_NOTE = """
    A bird's foot: fingers of similar phalanges about one junction, the body foot.
    Units: m, rad, kg, s, N. Frame of foot: x forward, y left, z up. A phalanx lies
    along its own x axis; its joint turns about its own y axis, positive closing.
    Joint angle = omega * control; 0: straight, 1: closed. A joint named reversal turns
    its finger about z; 0: the finger's azimuth. Sites named tip are the fingers' ends.
    Bodies, masses and ranges are the URDF's. Strength, stiffness, damping and contacts
    follow from the foot's weight and size; they ask for this time step, or a shorter
    one where the foot is attached to another model.
"""

_SERVOS = """\
    One position actuator for each joint: ctrl is the joint's angle.
  """

_TENDON = """\
    One tendon over all flexion joints, pulled by one actuator: ctrl is the angle of
    every joint while the toes are free. Its tension is shared, springs open the toes:
    on a branch each phalanx stops where it touches, and the others go on.
  """


def to_mjcf(foot: Foot, *, tendon: bool = False, free: bool = False) -> str:
    """The foot's MuJoCo model, the same text for equal feet on every machine.

    Bodies are the URDF's links but the fingertips, whose mass is in the last phalanx
    and whose frames are sites `<finger>_tip`. Each phalanx is one capsule, seen and
    touched alike. Joints keep the URDF's names; actuators have those of their joints.
    Keyframes are the poses of `named_poses`, `closed` only as far as solid toes close.

    With `tendon` the actuator `flexor` pulls a fixed tendon over all flexion joints,
    whose length is their mean angle, weighted by their levers. In free motion each
    joint follows it, as in the URDF's variant of that name: joint angle = ctrl, up to
    what the toes sag. But where the URDF's joints mimic their leader rigidly, these
    share one tension: those that meet a branch stop, the others go on, and once the
    toes lie on it the tension rises to the actuator's limit. The tendon pulls only;
    springs open the toes, and the pose `perch` is held only around its branch. A
    reversal has its own position actuator in both.

    Args:
        foot: The foot.
        tendon: Whether one tendon drives the toes, not a servo at each joint.
        free: Whether the base is free to move, not fixed where it is put.

    Returns:
        The model [m, rad, kg, s], indented, with a newline at the end.

    Raises:
        DescriptionError: The template does not expand, or a phalanx is too light for
            MuJoCo.
    """
    simulated = SimulatedFoot(foot)
    _check_inertias(simulated.bodies)
    root = ET.Element("mujoco", model=foot.name)
    root.append(ET.Comment(_NOTE + (_TENDON if tendon else _SERVOS)))
    _add_settings(root, simulated)
    world = ET.SubElement(root, "worldbody")
    add_bodies(world, simulated, springs=tendon, free=free)
    contact = ET.SubElement(root, "contact")
    for body1, body2 in touching_links(foot):
        if {body1, body2} <= simulated.bodies.keys():
            ET.SubElement(contact, "exclude", body1=body1, body2=body2)
    if tendon:
        _add_tendon(root, simulated)
    _add_actuators(ET.SubElement(root, "actuator"), simulated, tendon)
    _add_keyframes(ET.SubElement(root, "keyframe"), simulated, tendon, free)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _check_inertias(bodies: dict[str, Inertial]) -> None:
    """No body is so light that MuJoCo refuses it."""
    for name, body in bodies.items():
        least = min(body.mass, body.axial, body.transverse)
        if not least > LEAST_INERTIA:
            raise DescriptionError(
                f"{name} is too light for MuJoCo, its least inertia {least:.3g} kg m^2 "
                f"not above {LEAST_INERTIA:g}",
                "scale the foot up, or give it a thicker skin",
            )


def _add_settings(root: ET.Element, foot: SimulatedFoot) -> None:
    """Add the settings of compiler and solver, the defaults, the skin."""
    step = dynamics.timestep(foot.foot)
    compiler = {"angle": "radian", "eulerseq": "XYZ"}  # roll, pitch, yaw, as in a URDF
    ET.SubElement(root, "compiler", compiler)
    option = {"timestep": brief(step), "gravity": f"0 0 {-GRAVITY}"}
    # Elliptic cones, friction a hundred times as stiff: else a grasp creeps.
    solver = {"integrator": "implicitfast", "cone": "elliptic", "impratio": "100"}
    ET.SubElement(root, "option", option | solver)
    default = ET.SubElement(root, "default")
    _add_defaults(ET.SubElement(default, "default", {"class": names.BASE}), foot, step)
    asset = ET.SubElement(root, "asset")
    ET.SubElement(asset, "material", name="skin", rgba=foot.colour)


def _add_defaults(whole: ET.Element, foot: SimulatedFoot, step: float) -> None:
    """Add what all joints, geoms, sites and servos of the foot have in common.

    The pads decide on a contact, whatever they touch: hence their priority.
    """
    reference = brief(CONTACT_STEPS * step, 1)
    joint = {"axis": "0 1 0", "range": exact(0, foot.foot.omega)}
    limit = {"solreflimit": reference, "solimplimit": brief(*IMPEDANCE)}
    ET.SubElement(whole, "joint", joint | limit)
    levers = (PATCH * foot.thinnest, ROLLING * foot.thinnest)
    pad = {"priority": "1", "condim": "6", "friction": brief(FRICTION, *levers)}
    solimp = brief(*IMPEDANCE, WIDTH * foot.thinnest)
    geom = {"type": "capsule", "material": "skin"} | pad
    ET.SubElement(whole, "geom", geom, solref=reference, solimp=solimp)
    ET.SubElement(whole, "site", group="4", size=brief(foot.thinnest / 2))
    ET.SubElement(whole, "position", inheritrange="1")


def _add_tendon(root: ET.Element, foot: SimulatedFoot) -> None:
    """Add the tendon over all flexion joints; its length is their mean angle."""
    tendon = ET.SubElement(ET.SubElement(root, "tendon"), "fixed", name=FLEXOR)
    for joint, share in _shares(foot).items():
        ET.SubElement(tendon, "joint", joint=joint, coef=exact(share))


def _shares(foot: SimulatedFoot) -> dict[str, float]:
    """{flexion joint: its share of the tendon's pull}, together 1."""
    drives = {joint: foot.drives[joint].stiffness for joint in foot.flexion_joints}
    whole = math.fsum(drives.values())
    return {joint: stiffness / whole for joint, stiffness in drives.items()}


def _add_actuators(parent: ET.Element, foot: SimulatedFoot, tendon: bool) -> None:
    """Add a servo for each joint; one for all flexion joints where they share one."""
    if tendon:
        _add_flexor(parent, foot)
    for joint in _servo_joints(foot, tendon):
        strength = foot.drives[joint].stiffness  # its torque at one radian
        servo = {"kp": brief(strength), "forcerange": brief(-strength, strength)}
        ET.SubElement(parent, "position", {"name": joint, "joint": joint} | servo)


def _add_flexor(parent: ET.Element, foot: SimulatedFoot) -> None:
    """Add the tendon's actuator: a servo that pulls only, and feeds the springs.

    With the tendon's length λ its force is S·ctrl + K·(ctrl − λ), for the springs S and
    the stiffness K of all joints together: in balance where every angle is ctrl.
    """
    drives = [foot.drives[joint] for joint in foot.flexion_joints]
    strength = math.fsum(drive.stiffness for drive in drives)
    springs = math.fsum(drive.spring for drive in drives)
    limits = {"ctrlrange": exact(0, foot.foot.omega), "forcerange": brief(0, strength)}
    law = {"gainprm": brief(strength + springs), "biasprm": brief(0, -strength)}
    flexor = {"name": FLEXOR, "tendon": FLEXOR, "biastype": "affine"}
    ET.SubElement(parent, "general", flexor | limits | law)


def _add_keyframes(
    parent: ET.Element, foot: SimulatedFoot, tendon: bool, free: bool
) -> None:
    """Add the poses, and the controls that hold them."""
    base = (0, 0, 0, 1, 0, 0, 0) if free else ()
    for pose, angles in foot.keyframes.items():
        shares = _shares(foot).items()
        # `sum` rounds otherwise from one Python to another.
        mean = math.fsum(share * angles[joint] for joint, share in shares)
        pull = (min(mean, foot.foot.omega),) if tendon else ()
        servos = [angles[joint] for joint in _servo_joints(foot, tendon)]
        place = exact(*base, *(angles[joint] for joint in foot.drives))
        ET.SubElement(parent, "key", name=pose, qpos=place, ctrl=brief(*pull, *servos))


def _servo_joints(foot: SimulatedFoot, tendon: bool) -> list[str]:
    """The joints that have an actuator of their own, in the bodies' order."""
    return [j for j in foot.drives if not (tendon and j in foot.flexion_joints)]
