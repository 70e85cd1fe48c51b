"""The foot in Pinocchio: its URDF as a rigid-body model, and the bones from there."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds, names
from zygopin.description import to_urdf
from zygopin.errors import DescriptionError, ParameterError
from zygopin.foot import Foot
from zygopin.kinematics import Controls, as_azimuths, read_controls
from zygopin.urdf_check import REMEDY, check_urdf

AZIMUTH_TOLERANCE = 1e-12
"""Turn of a finger that cannot turn which passes as none [rad]: rounding."""


class FootModel:
    """A foot as a Pinocchio model, read from its URDF.

    The second route to the bones: the URDF's joints and offsets, where
    `forward_kinematics` has the closed form. It can be pickled, and shared by threads.

    Attributes:
        foot: The foot.
        urdf: The URDF that was read; `to_urdf(foot)` unless another was given.
        model: The model; its joints are in Pinocchio's order, so map them by name.

    Raises:
        DescriptionError: The URDF is malformed, or is not one of this foot.
    """

    def __init__(self, foot: Foot, urdf: str | None = None) -> None:
        kinds.instance("foot", foot, Foot)
        self.foot = foot
        self.urdf = to_urdf(foot) if urdf is None else kinds.text("urdf", urdf)
        self.model: pin.Model = _read(self.urdf, foot)
        turning = [finger for finger in foot.fingers if names.is_reversible(finger)]
        self._turning = [foot.fingers.index(finger) for finger in turning]
        self._reversal = self.coordinates(map(names.reversal_joint, turning))
        flexion = map(names.flexion_joints, foot.fingers)
        self._flexion = self.coordinates(chain.from_iterable(flexion))
        self._frames = [
            self.model.getFrameId(link, pin.FrameType.BODY)
            for link in names.bone_links(foot)
        ]
        # Each finger's tip comes after its phalanges: one frame more for each.
        starts = np.arange(foot.phalanx_count) + foot.finger_of_phalanx
        self._ends = np.stack((starts, starts + 1), axis=1)
        self._neutral = pin.neutral(self.model)
        self._idle: list[_Memory] = []

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_idle": []}

    def coordinates(self, joints: Iterable[str]) -> NDArray[np.intp]:
        """Where joints' angles stand in Pinocchio's q.

        Args:
            joints: Names of n joints that move.

        Returns:
            Indices, shape (n,).
        """
        if isinstance(joints, str) or not isinstance(joints, Iterable):
            raise ParameterError("joints", joints, "a list", "list names of joints")
        known = self.model.names[1:]  # but the universe, which does not move
        wanted = [kinds.one_of("joint", joint, known) for joint in joints]
        ids = [self.model.getJointId(joint) for joint in wanted]
        return np.array([self.model.idx_qs[i] for i in ids], dtype=np.intp)

    def configuration(
        self, controls: Controls, azimuths: ArrayLike | None = None
    ) -> NDArray[np.float64]:
        """Pinocchio's configuration for given controls: angle = omega·control.

        Args:
            controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
            azimuths: Azimuth of each finger [rad], shape (…, F); None: the foot's own.

        Returns:
            q [rad], shape (…, nq), in the model's order.

        Raises:
            ParameterError: A control is outside [0, 1], a shape is wrong, or an
                azimuth turns a finger that has no reversal.
            UnknownNameError: A finger does not exist.
        """
        controls = read_controls(self.foot, controls)
        batch, turns = controls.shape[:-1], None
        if azimuths is not None:
            turns = self._turns(azimuths)
            shapes = batch, turns.shape[:-1]
            batch = checks.common_batch("controls and azimuths", *shapes)
        q = np.empty((*batch, self.model.nq))
        q[...] = self._neutral
        q[..., self._flexion] = self.foot.omega * controls
        if turns is not None:
            q[..., self._reversal] = turns[..., self._turning]
        return q

    def forward(
        self, controls: Controls, *, azimuths: ArrayLike | None = None
    ) -> NDArray[np.float64]:
        """Bones of every phalanx, like `forward_kinematics`, from Pinocchio.

        Args:
            controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
            azimuths: Azimuth of each finger [rad], shape (…, F); None: the foot's own.

        Returns:
            Bones in the foot's frame [m], shape (…, P, 2, 3): start and end junctions.

        Raises:
            ParameterError: A control is outside [0, 1], a shape is wrong, or an
                azimuth turns a finger that has no reversal.
            UnknownNameError: A finger does not exist.
        """
        q = self.configuration(controls, azimuths)
        origins = np.empty((*q.shape[:-1], len(self._frames), 3))
        flat = origins.reshape(-1, 3 * len(self._frames))
        memory = self._memory()
        for row, out in zip(q.reshape(-1, self.model.nq), flat, strict=True):
            pin.framesForwardKinematics(self.model, memory.data, row)
            np.concatenate(memory.views, out=out)
        self._idle.append(memory)
        return origins.take(self._ends, axis=-2)

    def _memory(self) -> _Memory:
        """Memory that no other thread works with: some that is idle, or new."""
        try:
            return self._idle.pop()
        except IndexError:
            return _Memory(self.model, self._frames)

    def _turns(self, azimuths: ArrayLike) -> NDArray[np.float64]:
        """Turn of each finger from its own azimuth [rad], shape (…, F)."""
        values = as_azimuths(self.foot, azimuths)
        turns = values - as_azimuths(self.foot, None)
        for place, finger in enumerate(self.foot.fingers):
            stray = np.abs(turns[..., place]) > AZIMUTH_TOLERANCE
            if not names.is_reversible(finger) and np.any(stray):
                raise ParameterError(
                    f"azimuths[{finger.name}]",
                    values[..., place][stray].flat[0],
                    f"its own azimuth, {finger.azimuth:g} rad",
                    "this finger has no reversal: give it a reversed_azimuth",
                )
        return turns


class _Memory:
    """What one thread works with: Pinocchio's data, and views of it.

    Attributes:
        data: The data.
        views: Origins of the frames, which each pass renews.
    """

    def __init__(self, model: pin.Model, frames: Iterable[int]) -> None:
        self.data = model.createData()
        self.views = [self.data.oMf[frame].translation for frame in frames]


def _read(urdf: str, foot: Foot) -> pin.Model:
    """The model of a URDF that has every link and joint of the foot."""
    check_urdf(urdf, foot)
    try:
        model = pin.buildModelFromXML(urdf)
    except (ValueError, RuntimeError) as error:
        raise DescriptionError(f"the URDF is malformed: {error}", REMEDY) from error
    sizes = dict(zip(model.names, model.nqs, strict=True))
    for joint in names.moving_joints(foot):
        if sizes.get(joint) != 1:
            problem = f"the URDF's joint {joint} does not turn by one angle"
            raise DescriptionError(problem, REMEDY)
    return model
