"""The command on an owl's strike: fly, meet, close, lock, and show it."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from zygopin.options import (
    DEGREES,
    MM,
    POSITIVE_MM,
    Quantity,
    Several,
    foot_options,
    make_foot,
)
from zygopin.path_options import FILE
from zygopin.terminal import print_table, waiting

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    from zygopin.branch import Branch
    from zygopin.flight import Flight
    from zygopin.foot import Foot
    from zygopin.obstacle import Sphere
    from zygopin.trajectory import StrikeTrajectory

_SHARE = click.FloatRange(0, 1)
_SPEED = Quantity("metres per second", 1.0, positive=True)
_MILLISECONDS = Quantity("milliseconds", 1e-3, positive=True)
_JSON = click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")

_COURSE = ("miss", "speed", "slope", "opened", "reversal")
_CLOSING = ("reading", "duration", "shape")
"""Options that make the flight, and the closing."""


@click.command()
@foot_options
@click.option("--prey-radius-mm", "prey", type=POSITIVE_MM, help="A ball to strike at.")
@click.option(
    "--branch-radius-mm", "branch", type=POSITIVE_MM, help="Or a branch across the way."
)
@click.option(
    "--miss-mm",
    "miss",
    type=Several(MM),
    default="0,0",
    show_default=True,
    help="How far x, y of the base pass the middle of the target.",
)
@click.option("--speed", type=_SPEED, default=3, show_default=True, help="In m/s.")
@click.option(
    "--slope-deg",
    "slope",
    type=DEGREES,
    default=60,
    show_default=True,
    help="Of the way down; 90: straight down.",
)
@click.option(
    "--open",
    "opened",
    type=_SHARE,
    default=0.1,
    show_default=True,
    help="Controls of the opened toes: 0 is straight.",
)
@click.option(
    "--reversal",
    type=_SHARE,
    default=1.0,
    show_default=True,
    help="Turn of a toe that can: 1 spreads it forward, 0 leaves it back.",
)
@click.option(
    "--closing-ms",
    "duration",
    type=_MILLISECONDS,
    default=40,
    show_default=True,
    help="Time T that the toes take to close.",
)
@click.option(
    "--map",
    "shape",
    type=click.Choice(["smooth", "linear"]),
    default="smooth",
    show_default=True,
    help="How the controls grow over T.",
)
@click.option(
    "--reading",
    type=click.Choice(["contact", "paper"]),
    default="contact",
    show_default=True,
    help="Whether toes stop at what they meet, or pass through.",
)
@click.option(
    "--sensing",
    type=click.Choice(["first", "any"]),
    help="Phalanges that engage the tendon.  [default: any; paper: first]",
)
@click.option(
    "--engine",
    type=click.Choice(["exact", "fcl"]),
    default="exact",
    show_default=True,
    help="What measures clearances.",
)
@click.option("--html", type=FILE, help="Write the animated scene to this file.")
@click.option("--png", type=FILE, help="Draw modes, clearances and controls.")
@click.option("--save", type=FILE, help="Write the whole record, .npz or .json.")
@_JSON
@click.pass_context
def strike(
    context: click.Context,
    /,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> None:
    """Simulate a strike: the foot comes down, its tendon engages, closes and locks.

    The target is at the origin of the world; the foot flies level with clenched toes,
    opens them, and comes down on it. Nothing that it meets is missed, however thin.

    Exit status 0: locked, grasping and feasible; 1: not; 2: bad input.
    """
    from zygopin.closing import Closing
    from zygopin.strike import simulate_strike
    from zygopin.strike_output import strike_document
    from zygopin.tendon import Contact

    html, png, save = (options.pop(name) for name in ("html", "png", "save"))
    target = _target(options.pop("prey"), options.pop("branch"))
    radius = float(target.radius)
    course = {name: options.pop(name) for name in _COURSE}
    closing = Closing(*(options.pop(name) for name in _CLOSING))
    contact = Contact(options.pop("sensing"), engine=options.pop("engine"))
    foot = make_foot(**options)
    flight = _flight(foot, radius, **course)
    with waiting("striking", quiet=as_json):
        found = simulate_strike(foot, target, flight, closing=closing, contact=contact)
    _write(found, html, png, save)
    if as_json:
        click.echo(json.dumps(strike_document(found), indent=2, allow_nan=False))
    else:
        _print(found, {"scene": html, "figure": png, "record": save})
    held = found.modes[-1] == "locked" and found.grip.feasible and found.grip.grasping
    context.exit(0 if held else 1)


def _target(prey: float | None, branch: float | None) -> Sphere | Branch:
    """What is struck at: a ball or a branch, at the origin."""
    from zygopin.branch import Branch
    from zygopin.obstacle import Sphere

    centre = (0.0, 0.0, 0.0)
    if prey is not None and branch is None:
        return Sphere(prey, centre)
    if branch is not None and prey is None:
        return Branch(branch, centre)
    raise click.UsageError("give one of --prey-radius-mm and --branch-radius-mm.")


def _flight(
    foot: Foot,
    radius: float,
    *,
    miss: tuple[float, ...],
    slope: float,
    **course: float,
) -> Flight:
    """The flight that the options describe."""
    from zygopin.attack import Attack

    if len(miss) != 2:
        given = ",".join(f"{1e3 * each:g}" for each in miss)
        raise click.UsageError(f"--miss-mm = {given} is not x,y: give two numbers.")
    if not 0 < slope <= math.radians(90) + 1e-12:
        shown = f"--slope-deg = {math.degrees(slope):.6g} is not above 0, up to 90"
        raise click.UsageError(f"{shown}: try 60.")
    return Attack(slope=slope, **course).flight(foot, (*miss, 0.0), radius=radius)


def _write(
    found: StrikeTrajectory, html: Path | None, png: Path | None, save: Path | None
) -> None:
    """Write the files that were asked for."""
    if save is not None:
        from zygopin.strike_output import save_strike

        save_strike(found, save)
    if png is not None:
        from zygopin.strike_plots import plot_strike

        plot_strike(found, png)
    if html is not None:
        from zygopin.strike_scene import export_strike

        export_strike(found, html)


def _print(found: StrikeTrajectory, files: dict[str, Path | None]) -> None:
    """The log of the events, how it ended, and where the files are."""
    from zygopin.strike_output import event_rows, grip_line, target_line

    click.echo(f"{found.foot.name} strikes at a {target_line(found.obstacle)}")
    if found.events:
        headings = ("time [ms]", "toe", "phalanx", "what happens", "clearance [µm]")
        print_table(headings, event_rows(found), "rlrlr")
    click.echo(grip_line(found))
    for name, path in files.items():
        if path is not None:
            click.echo(f"{name}: {path}")
