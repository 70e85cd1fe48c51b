"""Which toe of the owl turns."""

from __future__ import annotations

import numpy as np

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.paper.entry import Entry, Measurement, equal
from zygopin.paper.owl_poses import POSES
from zygopin.paper.toe_planes import first_azimuths
from zygopin.stance import azimuths_at


def erratum_14() -> Entry:
    """Which toe of the owl turns.

    Returns:
        The entry.
    """
    owl = Foot.preset("owl")
    model = FootModel(owl).model
    turning = [name for name in model.names if name.endswith("_reversal")]
    moved = model.subtrees[model.getJointId(turning[0])]
    return Entry(
        key="erratum-14",
        kind="erratum",
        title="The toe that turns",
        place="section 5, first paragraph and figure 6",
        printed="Owls rotate “the a third toe” to the front in flight; “isodactyl”.",
        ours=(
            "Toe 4, the outer toe with 5 phalanges, turns. The pose is called spread; "
            "the paper's name for it is kept beside."
        ),
        finding=(
            "Finger 3 points forward already: it cannot be turned to the front. The "
            "toe that owls turn is digit IV, finger 4 in the paper's count. Read as "
            "“one more toe, the third in front”, the sentence is right: two toes point "
            "forward in one pose and three in the other. Three in front and one behind "
            "is what anatomists call anisodactyl."
        ),
        measurements=(
            Measurement(
                "turning",
                "toes with a joint about the vertical, in Pinocchio's model of the "
                "URDF",
                len(turning),
                equal(1, 0, "one toe turns"),
            ),
            Measurement(
                "phalanges",
                "phalanges that this joint moves, in Pinocchio's tree",
                sum(model.names[i].startswith("finger4_joint") for i in moved),
                equal(5, 0, "digit IV of birds"),
            ),
            *_forward(owl),
        ),
    )


def _forward(owl: Foot) -> tuple[Measurement, ...]:
    """How many toes point forward in each pose, and that toe 3 always does."""
    found = []
    for pose, turn in POSES.items():
        bones = forward_kinematics(
            owl,
            np.zeros(owl.phalanx_count),
            azimuths=azimuths_at(owl, np.array(turn)),
        )
        ahead = np.cos(first_azimuths(owl, bones)) > 0
        count, which = 2 + int(turn), f"{pose} pose"
        by_angle = equal(count, 0, "signs of the azimuths' cosines")
        words = f"toes that point forward, {which}"
        found.append(Measurement(f"forward_{pose}", words, int(ahead.sum()), by_angle))
        words = f"whether toe 3 points forward, {which}: 1 if so"
        found.append(
            Measurement(
                f"toe_3_{pose}", words, int(ahead[2]), equal(1, 0, "cos(−15°) > 0")
            )
        )
    return tuple(found)
