"""The command line: each command parses, calls one function, and formats."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from zygopin.cli_atlas import atlas
from zygopin.cli_branches import branches
from zygopin.cli_design import design
from zygopin.cli_paper import paper
from zygopin.cli_reach import reach, validate
from zygopin.cli_strike import strike
from zygopin.cli_sweep import sweep
from zygopin.cli_touch import touch
from zygopin.command_group import OneLineErrors
from zygopin.given_controls import read_controls
from zygopin.options import (
    MM,
    POSITIVE_MM,
    branch_options,
    foot_options,
    hold_options,
    make_branch,
    make_foot,
    make_strength,
)
from zygopin.path_options import FILE, FOLDER
from zygopin.terminal import print_table, waiting

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    from zygopin.grasp import GraspReport
    from zygopin.perch import PerchPlan
    from zygopin.strength import Strength

_HTML = click.option("--html", type=FILE, help="Write the scene to this file.")
_JSON = click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")


@click.group(
    cls=OneLineErrors, context_settings={"help_option_names": ["-h", "--help"]}
)
@click.version_option(package_name="zygopin")
def main() -> None:
    """The zygodactyl bird's foot: description, kinematics, grasp checks.

    Lengths are in millimetres and angles in degrees, as each option's name says;
    x points forward, y left, z up, and the base of the foot is the origin.
    """


main.add_command(reach)
main.add_command(validate)
main.add_command(strike)
main.add_command(branches)
main.add_command(touch)
main.add_command(atlas)
main.add_command(sweep)
main.add_command(design)
main.add_command(paper)


@main.command()
@foot_options
@click.option(
    "-o",
    "--output",
    required=True,
    type=FOLDER,
    help="Folder to write to.",
)
@click.option("--mjcf", is_flag=True, help="Add foot.xml and others, for MuJoCo.")
@click.option("--glb", is_flag=True, help="Add foot.glb, for renderers and viewers.")
@_JSON
def urdf(output: Path, mjcf: bool, glb: bool, as_json: bool, **foot: Any) -> None:
    """Write foot.urdf, foot.srdf and both with a tendon."""
    from zygopin.bundle import write_description

    paths = write_description(make_foot(**foot), output, mjcf=mjcf, glb=glb)
    if as_json:
        click.echo(json.dumps({"files": [str(path) for path in paths]}, indent=2))
        return
    for path in paths:
        click.echo(path)


@main.command()
@foot_options
@branch_options
@click.option("--height-mm", "height", type=MM, help="z of the centre; else searched.")
@click.option(
    "--prefer",
    type=click.Choice(["wrap", "quality", "pull", "margin", "opposition"]),
    default="wrap",
    show_default=True,
    help="What the best grasp has most of.",
)
@click.option("--all", "every", is_flag=True, help="List all ways to grasp it found.")
@hold_options
@_HTML
@_JSON
@click.pass_context
def perch(
    context: click.Context,
    /,
    radius: float,
    height: float | None,
    html: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Find controls that grasp a branch, check them, show the scene.

    Without a height, the branch is placed under the foot where it is grasped best.
    Exit status 0: a feasible grasp; 1: none found, with the reason, which says so where
    it is proved that none exists; 2: bad input.
    """
    from zygopin.perch import perch_solutions, plan_perch

    strength = make_strength(options.pop("friction"), options.pop("toe_force"))
    prefer, every = options.pop("prefer"), options.pop("every")
    pose = {name: options.pop(name) for name in ("yaw", "pitch", "length")}
    foot = make_foot(**options)
    search = height is None
    level = max(abs(math.cos(pose["pitch"])), 1e-9)
    start = -2 * (radius + foot.size) / level if height is None else height
    branch = make_branch(radius, start, **pose)
    with waiting("planning", quiet=as_json):
        wanted: Any = {"find_height": search, "prefer": prefer, "strength": strength}
        plans = perch_solutions(foot, branch, **wanted) if every else ()
        plan = plans[0] if plans else plan_perch(foot, branch, **wanted)
        shown = _Shown(plan.report, strength, plan.reason, plans, plan.existence.value)
    _show(shown, html, as_json)
    context.exit(0 if plan.grasping else 1)


@main.command()
@foot_options
@branch_options
@click.option("--height-mm", "height", type=MM, required=True, help="z of the centre.")
@click.option(
    "--controls",
    required=True,
    help="One number in [0, 1] for each phalanx, separated by commas; or JSON.",
)
@click.option(
    "--reading",
    type=click.Choice(["section", "base_to_tip"]),
    default="section",
    show_default=True,
    help="Which scalar product decides on a grasp.",
)
@click.option(
    "--tolerance-mm",
    "tolerance",
    type=POSITIVE_MM,
    help="Largest gap that is a contact.  [default: 1e-6 of the foot]",
)
@hold_options
@_HTML
@_JSON
@click.pass_context
def check(
    context: click.Context,
    /,
    controls: str,
    reading: Any,
    tolerance: float | None,
    friction: float,
    toe_force: float,
    html: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Say whether given controls are stable on a branch, grasp it, are feasible.

    Controls go finger by finger, from base to tip: 0 is straight, 1 closed. A document
    that `perch --json` printed will do.

    Exit status 0: grasping; 1: not, with the reason; 2: bad input.
    """
    from zygopin.grasp import Criteria, check_grasp
    from zygopin.reason import why_not

    strength = make_strength(friction, toe_force)
    names = ("radius", "height", "yaw", "pitch", "length")
    branch = make_branch(**{name: options.pop(name) for name in names})
    criteria = Criteria(reading, tolerance)
    foot = make_foot(**options)
    values = read_controls(controls, foot)
    report = check_grasp(foot, values, branch, criteria=criteria)
    _show(_Shown(report, strength, why_not(report)), html, as_json)
    context.exit(0 if report.grasping else 1)


@main.command()
@click.argument("name", required=False)
@_JSON
def presets(name: str | None, as_json: bool) -> None:
    """List the shipped feet, or one of them with the source of each number."""
    from zygopin.presets import preset_names, read_preset

    if as_json:
        names = preset_names() if name is None else (name,)
        click.echo(json.dumps({each: read_preset(each) for each in names}, indent=2))
    elif name is None:
        _list_presets()
    else:
        _show_preset(name, read_preset(name))


@dataclass(frozen=True)
class _Shown:
    """What `perch` and `check` show.

    Attributes:
        report: The verdicts.
        strength: How hard the toes press, and their friction.
        reason: Why it is no feasible grasp; None where it is one.
        solutions: All the ways to grasp, where they were asked for.
        existence: Of a plan, whether there is a grasp at all.
    """

    report: GraspReport
    strength: Strength
    reason: str | None
    solutions: tuple[PerchPlan, ...] = ()
    existence: str | None = None


def _show(shown: _Shown, html: Path | None, as_json: bool) -> None:
    """Check a report with FCL, write its scene, print it."""
    from zygopin import output
    from zygopin.grasp import check_grasp
    from zygopin.hold import check_hold

    report = shown.report
    second = check_grasp(report.foot, report.controls, report.branch, engine="fcl")
    difference = report.difference(second)
    hold = check_hold(report, shown.strength)
    if html is not None:
        from zygopin.scene import export_scene

        export_scene(report, html, hold=hold)
    if as_json:
        document = output.report_document(report, difference, hold, shown.reason)
        _add_plan(document, shown)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
    else:
        _print_report(report, output.verdict_lines(report, difference))
        for line in output.hold_lines(hold):
            click.echo(line)
        if shown.solutions:
            _print_solutions(shown.solutions)
        if html is not None:
            click.echo(f"scene: {html}")
    if shown.reason is not None:
        click.echo(f"zygopin: no feasible grasp: {shown.reason}", err=True)


def _print_report(report: GraspReport, verdicts: list[str]) -> None:
    """The table and the verdicts."""
    from zygopin import output

    click.echo(f"{report.foot.name}, branch: {output.branch_line(report.branch)}")
    headings = ("finger", "phalanx", "control", "clearance [mm]", "t", "contact")
    print_table(headings, output.report_rows(report), "lrrrrl")
    for line in verdicts:
        click.echo(line)


def _add_plan(document: dict[str, Any], shown: _Shown) -> None:
    """What a plan's document says beside the report."""
    if shown.existence is not None:
        document["verdict"]["existence"] = shown.existence
    if shown.solutions:
        from zygopin.perch_output import solution_documents

        document["solutions"] = solution_documents(shown.solutions)


def _print_solutions(plans: tuple[PerchPlan, ...]) -> None:
    """The table of all ways to grasp."""
    from zygopin import perch_output

    click.echo(f"{len(plans)} ways to grasp it found, the best first:")
    rows = perch_output.solution_rows(plans[: perch_output.LISTED])
    print_table(perch_output.HEADINGS, rows, "rlrrr")
    if len(plans) > perch_output.LISTED:
        click.echo(f"the first {perch_output.LISTED} are listed: --json gives all")


def _list_presets() -> None:
    """A table of the presets."""
    from zygopin.foot import Foot
    from zygopin.presets import preset_names, read_preset

    rows = []
    for name in preset_names():
        values = read_preset(name)
        foot = Foot.from_mapping(values)
        numbers = (
            foot.rho,
            math.degrees(foot.omega),
            foot.scale * 1e3,
            foot.thickness * 1e3,
        )
        texts = (f"{number:.4g}" for number in numbers)
        rows.append((name, *texts, str(values["description"])))
    headings = ("preset", "ρ", "ω [°]", "s [mm]", "skin [mm]", "what it is")
    print_table(headings, rows, "lrrrrl")


def _show_preset(name: str, values: dict[str, Any]) -> None:
    """One preset: each field, its value and its source."""
    sources = values.get("sources", {})
    click.echo(f"{name}: {values['description']} (SI units)")
    rows = [
        (field, _field_text(values[field]), str(sources.get(field, "")))
        for field in values
        if field not in ("description", "sources", "name")
    ]
    print_table(("field", "value", "source"), rows, "lll")


def _field_text(value: float | list[dict[str, Any]]) -> str:
    """A field's value: a number, or the fingers one to a line."""
    if not isinstance(value, list):
        return f"{value:.6g}"
    return "\n".join(f"{each['name']}: {each['phalanges']} phalanges" for each in value)
