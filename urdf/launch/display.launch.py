"""Show the foot in RViz, with a slider for each joint (ROS 2 Humble or newer).

ros2 launch zygopin_description display.launch.py preset:=owl tendon:=true
"""

from pathlib import Path
from shlex import quote

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

SHARE = Path(__file__).resolve().parent.parent
"""The package's share folder, or the checkout's `urdf/`."""

NUMBERS = {
    "rho": "scaling factor between a phalanx and the next",
    "omega": "largest joint angle [rad]",
    "splay": "angle between the fingers and the xz-plane [rad]",
    "scale": "length s; phalanx k has length s * rho^-k [m]",
    "thickness": "radius of the skin before scaling [m]",
    "density": "mass density [kg/m^3]",
}
"""Arguments of the template that take a number; None: as in the foot's file."""


def generate_launch_description() -> LaunchDescription:
    """Expand the template, publish the robot and its joints, open RViz."""
    description = ParameterValue(_urdf(), value_type=str)
    with_sliders = LaunchConfiguration("gui")
    return LaunchDescription(
        [
            *_arguments(),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
            ),
            Node(
                package="joint_state_publisher_gui",
                executable="joint_state_publisher_gui",
                condition=IfCondition(with_sliders),
            ),
            Node(
                package="joint_state_publisher",
                executable="joint_state_publisher",
                condition=UnlessCondition(with_sliders),
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", LaunchConfiguration("rviz_config")],
                output="screen",
            ),
        ]
    )


def _arguments() -> list[DeclareLaunchArgument]:
    """What `ros2 launch` takes, with defaults."""
    presets = sorted(path.stem for path in (SHARE / "presets").glob("*.yaml"))
    file = ["presets/", LaunchConfiguration("preset"), ".yaml"]
    switch = ["true", "false"]
    return [
        _argument("preset", "parrot", "which of the shipped feet", presets),
        _argument("foot", file, "absolute path of a YAML file, in place of a preset"),
        *(_argument(name, "None", text) for name, text in NUMBERS.items()),
        _argument("tendon", "false", "one leader joint moves all others", switch),
        _argument("gui", "true", "a window with a slider for each joint", switch),
        _argument("rviz_config", str(SHARE / "rviz" / "foot.rviz"), "for RViz"),
    ]


def _argument(
    name: str, default: str | list, text: str, choices: list[str] | None = None
) -> DeclareLaunchArgument:
    """One argument."""
    return DeclareLaunchArgument(
        name, default_value=default, description=text, choices=choices
    )


def _urdf() -> Command:
    """The command that prints the URDF; quoted, for paths with spaces."""
    words = [f"xacro {quote(str(SHARE / 'foot.urdf.xacro'))}"]
    for name in ("foot", *NUMBERS, "tendon"):
        words += [f" '{name}:=", LaunchConfiguration(name), "'"]
    return Command(words)
