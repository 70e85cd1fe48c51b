"""A foot as a URDF: what the shipped xacro templates expand to.

The URDF's numbers come from the template alone, so that what ROS users expand and
what Python returns is one text.
"""

from __future__ import annotations

from zygopin import checks, kinds
from zygopin.foot import Foot
from zygopin.shipped import shipped_urdf


def to_urdf(foot: Foot, *, tendon: bool = False) -> str:
    """The foot's URDF, the same text for equal feet on every machine.

    Links `<finger>_phalanx<k>` and `<finger>_tip`, joints `<finger>_joint<k>` with
    angle = omega·control, and `<finger>_reversal` where a toe turns. Map joints by
    name: tools differ in their order.

    Args:
        foot: The foot.
        tendon: Whether every flexion joint mimics the first finger's first.

    Returns:
        The URDF [m, rad, kg], indented, with a newline at the end.

    Raises:
        DescriptionError: The template is missing or does not expand.
    """
    kinds.instance("foot", foot, Foot)
    checks.flag("tendon", tendon)
    ready = shipped_urdf(foot, tendon=tendon)
    if ready is not None:
        return ready
    from zygopin.template import expand  # xacro takes its time: a preset needs none

    return expand(foot, tendon=tendon)
