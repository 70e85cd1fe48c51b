"""Types of the names that `zygopin` loads lazily."""

from zygopin.branch import Branch as Branch
from zygopin.branch import branch_axis as branch_axis
from zygopin.description import to_srdf as to_srdf
from zygopin.description import to_urdf as to_urdf
from zygopin.description import write_description as write_description
from zygopin.engine import Engine as Engine
from zygopin.engine import make_engine as make_engine
from zygopin.errors import DescriptionError as DescriptionError
from zygopin.errors import FileError as FileError
from zygopin.errors import ParameterError as ParameterError
from zygopin.errors import UnknownNameError as UnknownNameError
from zygopin.errors import ZygopinError as ZygopinError
from zygopin.finger import Finger as Finger
from zygopin.finger import zygodactyl_fingers as zygodactyl_fingers
from zygopin.foot import Foot as Foot
from zygopin.grasp import Criteria as Criteria
from zygopin.grasp import GraspReport as GraspReport
from zygopin.grasp import check_grasp as check_grasp
from zygopin.kinematics import forward_kinematics as forward_kinematics
from zygopin.model import FootModel as FootModel
from zygopin.paths import PACKAGE_PATH as PACKAGE_PATH
from zygopin.paths import PRESETS_PATH as PRESETS_PATH
from zygopin.paths import SRDF_PATH as SRDF_PATH
from zygopin.paths import URDF_PATH as URDF_PATH
from zygopin.paths import XACRO_PATH as XACRO_PATH
from zygopin.perch import PerchPlan as PerchPlan
from zygopin.perch import plan_perch as plan_perch
from zygopin.presets import preset_names as preset_names
from zygopin.scene import export_scene as export_scene

__version__: str
