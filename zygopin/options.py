"""Options that commands share: from millimetres and degrees to a foot and a branch."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from zygopin.errors import ParameterError
from zygopin.path_options import PATH

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    from zygopin.branch import Branch
    from zygopin.foot import Foot
    from zygopin.strength import Strength

Command = TypeVar("Command", bound=Callable[..., Any])


class Quantity(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """A finite number with a unit, held in SI.

    Args:
        unit: Name of the unit, for messages.
        factor: SI units in one of it.
        positive: Whether it must be positive.
    """

    def __init__(self, unit: str, factor: float, *, positive: bool = False) -> None:
        self.name = unit
        self.factor = factor
        self.positive = positive

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Parse a text.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            The quantity in SI.
        """
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number) or (self.positive and number <= 0):
            kind = "a positive number" if self.positive else "a number"
            self.fail(f"{value!r} is not {kind} of {self.name}.", param, ctx)
        return number * self.factor


class Several(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """Values separated by commas.

    Args:
        each: The type of each of them.
    """

    def __init__(self, each: Quantity) -> None:
        self.each = each
        self.name = f"{each.name}, …"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[Any, ...]:
        """Parse a text.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            The values.
        """
        if isinstance(value, tuple):
            return value
        return tuple(self.each.convert(part, param, ctx) for part in value.split(","))


MM = Quantity("millimetres", 1e-3)
POSITIVE_MM = Quantity("millimetres", 1e-3, positive=True)
DEGREES = Quantity("degrees", math.pi / 180)

STEEP = 1e-3
"""Cosine of the pitch below which a branch through the z axis is as good as on it."""

_ALLOWED = {
    "rho": ("--rho", 1.0, "a number above 1, up to 100", "try 1.2"),
    "omega": ("--omega-deg", 180 / math.pi, "in (0, 360) without 180", "try 80"),
    "splay": ("--splay-deg", 180 / math.pi, "in [0, 90)", "try 15"),
    "scale": ("--scale-mm", 1e3, "in [1e-3, 1e9]", "try 16"),
    "thickness": ("--thickness-mm", 1e3, "from 0 to below the scale", "try 2"),
}
"""What each overridden field is called and allowed to be on the command line."""


OMEGA = click.option("--omega-deg", "omega", type=DEGREES, help="Joint limit ω.")


def foot_options(command: Command) -> Command:
    """Add the options that choose a foot.

    Args:
        command: The command's function; gets them as keyword arguments.

    Returns:
        The same function, decorated.
    """
    return foot_options_with(OMEGA)(command)


def foot_options_with(
    omega: Callable[[Command], Command],
) -> Callable[[Command], Command]:
    """Add the options that choose a foot, with another one for its joint limit.

    Args:
        omega: The option `--omega-deg` as the command wants it.

    Returns:
        What decorates the command's function.
    """

    def decorated(command: Command) -> Command:
        for option in (
            click.option("--thickness-mm", "thickness", type=MM, help="Skin radius."),
            click.option(
                "--scale-mm", "scale", type=POSITIVE_MM, help="Length scale s."
            ),
            click.option("--splay-deg", "splay", type=DEGREES, help="Splay angle Ω."),
            omega,
            click.option("--rho", type=float, help="Scaling factor ρ > 1."),
            preset_options,
        ):
            command = option(command)
        return command

    return decorated


def preset_options(command: Command) -> Command:
    """Add the options that choose a foot as it is.

    Args:
        command: The command's function; gets them as keyword arguments.

    Returns:
        The same function, decorated.
    """
    for option in (
        click.option(
            "--foot",
            "foot_file",
            type=PATH,
            help="A foot of your own, YAML.",
        ),
        click.option(
            "--preset",
            metavar="NAME",
            help="A shipped foot; see `zygopin presets`.  [default: parrot]",
        ),
    ):
        command = option(command)
    return command


def axis_options(command: Command) -> Command:
    """Add the options that turn a branch's axis.

    Args:
        command: The command's function; gets them as keyword arguments.

    Returns:
        The same function, decorated.
    """
    for option in (
        click.option(
            "--pitch-deg",
            "pitch",
            type=DEGREES,
            default=0,
            help="Rise to the left.",
        ),
        click.option(
            "--yaw-deg",
            "yaw",
            type=DEGREES,
            default=0,
            help="Turn about z; 0: the axis is y, across the foot.",
        ),
    ):
        command = option(command)
    return command


def branch_options(command: Command) -> Command:
    """Add the options that place a branch, but for its height.

    Args:
        command: The command's function; gets them as keyword arguments.

    Returns:
        The same function, decorated.
    """
    for option in (
        click.option("--length-mm", "length", type=POSITIVE_MM, help="Or endless."),
        axis_options,
        click.option(
            "--radius-mm",
            "radius",
            type=POSITIVE_MM,
            required=True,
            help="Radius of the branch.",
        ),
    ):
        command = option(command)
    return command


def hold_options(command: Command) -> Command:
    """Add the options that say how a toe holds on.

    Args:
        command: The command's function; gets them as keyword arguments.

    Returns:
        The same function, decorated.
    """
    for option in (
        click.option(
            "--toe-force-n",
            "toe_force",
            type=float,
            default=1.0,
            show_default=True,
            help="Largest normal force of a contact.",
        ),
        click.option(
            "--friction",
            type=float,
            default=0.5,
            show_default=True,
            help="Coefficient of friction on the branch.",
        ),
    ):
        command = option(command)
    return command


def make_strength(friction: float, toe_force: float) -> Strength:
    """What the options of a hold say.

    Args:
        friction: Coefficient of friction.
        toe_force: Largest normal force of a contact [N].

    Returns:
        The strength.

    Raises:
        ParameterError: A value out of range.
    """
    from zygopin.contacts import Friction
    from zygopin.strength import Strength

    return Strength(toe_force, Friction(friction))


def make_foot(preset: str | None, foot_file: Path | None, **changes: Any) -> Foot:
    """The foot that the options choose.

    Args:
        preset: Name of a preset, or None.
        foot_file: A YAML file, or None.
        **changes: Fields to replace [SI]; None: keep.

    Returns:
        The foot.

    Raises:
        UsageError: Both a preset and a file, or a value out of range.
    """
    from zygopin.foot import Foot

    if preset is not None and foot_file is not None:
        raise click.UsageError("--preset and --foot exclude each other: give one.")
    if foot_file is None:
        foot = Foot.preset("parrot" if preset is None else preset)
    else:
        foot = Foot.load(foot_file)
    given = {name: value for name, value in changes.items() if value is not None}
    try:
        return foot.replace(**given)
    except ParameterError as error:
        if error.name not in given:
            raise
        option, factor, allowed, remedy = _ALLOWED[error.name]
        shown = given[error.name] * factor
        message = f"{option} = {shown:.6g} is not {allowed}: {remedy}."
        raise click.UsageError(message) from error


def make_branch(
    radius: float, height: float, yaw: float, pitch: float, length: float | None
) -> Branch:
    """The branch that the options place, its centre on the z axis.

    Args:
        radius: Radius [m].
        height: z of the centre [m].
        yaw: Turn about z [rad].
        pitch: Slope [rad].
        length: Length [m], or None.

    Returns:
        The branch.

    Raises:
        UsageError: The branch would hold the foot's base inside it.
    """
    from zygopin.branch import Branch, branch_axis, check_base

    branch = Branch(radius, (0.0, 0.0, height), branch_axis(yaw, pitch), length)
    try:
        check_base(branch)
    except ParameterError as error:
        level = abs(math.cos(pitch))
        if level < STEEP:
            message = f"--pitch-deg = {math.degrees(pitch):.6g} is too steep: try 30."
            raise click.UsageError(message) from error
        raise click.UsageError(
            f"--height-mm = {height * 1e3:.6g} puts the foot's base inside the branch: "
            f"give at most {-radius / level * 1e3:.6g}, a branch below the base."
        ) from error
    return branch
