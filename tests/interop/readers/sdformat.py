"""sdformat's converter; Drake reads what it writes."""

import shutil
import subprocess
from pathlib import Path
from xml.etree.ElementTree import parse

import numpy as np

from readers.drake import Robot as Drake


class Robot(Drake):
    """The converter lumps a fixed tip into its phalanx and leaves nothing of its name.

    So a tip's pose is that of its phalanx times the offset that the URDF gives it.
    """

    def __init__(self, case):
        program = "gz" if shutil.which("gz") else "ign"
        command = [program, "sdf", "-p", case["urdf"]]
        done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
        file = Path(case["urdf"]).with_suffix(".sdf")
        file.write_text(done.stdout)
        super().__init__({**case, "urdf": str(file)})
        joints = parse(case["urdf"]).getroot().findall("joint")  # noqa: S314
        self.fixed = {
            joint.find("child").get("link"): joint
            for joint in joints
            if joint.get("type") == "fixed"
        }

    def _pose(self, link):
        joint, offset = self.fixed[link], np.eye(4)
        offset[:3, 3] = [float(x) for x in joint.find("origin").get("xyz").split()]
        return super()._pose(joint.find("parent").get("link")) @ offset
