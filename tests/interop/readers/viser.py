"""viser's ViserUrdf: the frames that it shows a browser."""

from pathlib import Path

import numpy as np
import viser
from viser.extras import ViserUrdf
from viser.transforms import SO3


class Robot:
    server = None

    def __init__(self, case):
        self.tips = case["tips"]
        if Robot.server is None:
            Robot.server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        Robot.server.scene.reset()
        self.urdf = ViserUrdf(Robot.server, Path(case["urdf"]))

    def poses(self, angles):
        known = self.urdf.get_actuated_joint_names()
        self.urdf.update_cfg(np.array([angles.get(name, 0.0) for name in known]))
        return {tip: self._pose(tip) for tip in self.tips}

    def _pose(self, tip):
        """The product of the frames above a tip in the scene's tree of names."""
        frames = {frame.name: frame for frame in self.urdf._joint_frames}
        (path,) = (name for name in frames if name.endswith(f"/{tip}"))
        pose = np.eye(4)
        for name, frame in frames.items():
            if path == name or path.startswith(f"{name}/"):
                step = np.eye(4)
                step[:3, :3] = SO3(frame.wxyz).as_matrix()
                step[:3, 3] = frame.position
                pose = pose @ step
        return pose

    def limits(self):
        return self.urdf.get_actuated_joint_limits()
