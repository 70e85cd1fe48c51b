"""Every public function called once, on small things, and what came of it as a digest.

python -m tests.public_calls FOLDER prints all digests as JSON.
"""

from __future__ import annotations

import dataclasses
import hashlib
import inspect
import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np
import xarray

import zygopin as z
from tests.made_atlases import made_atlas
from tests.made_strikes import made_strike

PARROT, OWL, PAPER = map(z.Foot.preset, ("parrot", "owl", "paper"))
PERCH = z.Branch(0.008, (0, 0, -0.01))
PAIR = ("finger1", "finger3")
SYSTEM = z.ControlSystem(1.3, 0.6, 3)
STRENGTH = z.Strength(1.0, z.Friction(0.5))
CONTROLS = np.linspace(0, 1, 3 * PARROT.phalanx_count).reshape(3, -1)
CLOUDS = np.random.default_rng(0).normal(size=(2, 9000, 2))
GRID = z.BranchGrid(np.array([-0.014, -0.012]), np.array([0.008, 0.01]))

UNCALLED = {"design_foot", "paper_report", "plot_design", "write_paper_report"}
"""What takes a quarter of a minute: their own tests repeat what they compute."""


def digest(value: object) -> str:
    """SHA-256 of what a result holds: numbers to the bit, files by their content."""
    whole = hashlib.sha256()
    for part in _parts(value, 0):
        whole.update(part)
    return whole.hexdigest()


def _parts(value: object, level: int) -> Iterator[bytes]:
    """A value as bytes, its parts one after the other."""
    assert level < 12, value
    if isinstance(value, Path):
        files = sorted(value.rglob("*")) if value.is_dir() else [value]
        yield from (file.read_bytes() for file in files if file.is_file())
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype}{value.shape}".encode()
        yield value.tobytes()
    elif isinstance(value, bytes):
        yield value
    elif (held := _held(value)) is not None:
        for each in held:
            yield from _parts(each, level + 1)
    else:
        text = repr(value)
        assert " at 0x" not in text, text
        yield text.encode()


def _held(value: object) -> Iterable[object] | None:
    """What a value consists of; None: it is one thing."""
    if isinstance(value, xarray.Dataset):
        value = value.to_dict()
    elif dataclasses.is_dataclass(value):
        fields = [getattr(value, field.name) for field in dataclasses.fields(value)]
        return [each for each in fields if not callable(each)]
    if isinstance(value, Mapping):
        return value.items()
    return value if isinstance(value, (list, tuple, Iterator)) else None


def report():
    closed = z.plan_perch(PARROT, PERCH)
    return z.check_grasp(PARROT, closed.controls, PERCH, engine="fcl")


def contacts():
    return z.branch_contacts(report())


def flight():
    return z.Attack().flight(OWL, (0.0, 0.0, 0.0), radius=0.03)


def drawn(plot, *arguments, **options):
    """A picture's call: what it draws into a folder."""
    return lambda folder: plot(*arguments, folder / f"{plot.__name__}.png", **options)


def saved_atlas(folder):
    return z.load_atlas(z.save_atlas(made_atlas(), folder / "load.npz"))


def joint_torques(_):
    found = contacts()
    model = z.FootModel(PARROT)
    return z.joint_torques(model, report().controls, found, found.normals)


CALLS = {
    "attractor": lambda _: z.attractor(1.5, 0.6, 2, 0.05),
    "bearing_forces": lambda _: z.bearing_forces(
        contacts(), STRENGTH, (0, 0, -0.1, 0, 0, 0)
    ),
    "branch_atlas": lambda _: z.branch_atlas(PARROT, GRID),
    "branch_axis": lambda _: z.branch_axis(0.3, 0.2),
    "branch_contacts": lambda _: contacts(),
    "check_grasp": lambda _: z.check_grasp(PARROT, CONTROLS, PERCH, engine="fcl"),
    "check_hold": lambda _: z.check_hold(report(), STRENGTH),
    "closure_quality": lambda _: z.closure_quality(contacts(), z.Friction(0.5)),
    "contact_kept": lambda _: z.contact_kept(OWL, z.Sphere(0.02, (0, 0, -0.03))),
    "contains": lambda _: z.contains(0.5 + 0.1j, SYSTEM, 5, tolerance=1e-3),
    "count_systems": lambda _: z.count_systems(PARROT, PAIR, 2),
    "counterexample": lambda _: z.counterexample(PAPER),
    "directed_distance": lambda _: z.directed_distance(*CLOUDS),
    "export_atlas_scene": lambda f: z.export_atlas_scene(made_atlas(), f / "a.html"),
    "export_reach_scene": lambda f: z.export_reach_scene(PAPER, f / "r.html", levels=2),
    "export_scene": lambda f: z.export_scene(report(), f / "g.html"),
    "export_strike": lambda f: z.export_strike(made_strike(), f / "s.html"),
    "find_word": lambda _: z.find_word(0.5 + 0.1j, SYSTEM, 5, tolerance=1e-3),
    "finger_reach": lambda _: z.finger_reach(PARROT, "finger2", 5),
    "force_closure": lambda _: z.force_closure(contacts(), z.Friction(0.5)),
    "forward_kinematics": lambda _: z.forward_kinematics(PARROT, CONTROLS),
    "grasp_verdicts": lambda _: z.grasp_verdicts(PARROT, CONTROLS, PERCH),
    "graspable_radii": lambda _: z.graspable_radii(
        PARROT, 0.004, 0.012, levels=2, samples=5
    ),
    "hausdorff_distance": lambda _: z.hausdorff_distance(*CLOUDS),
    "inverse_reach": lambda _: z.inverse_reach(PARROT, "finger3", (0.01, 0, -0.01)),
    "iter_reachable": lambda _: z.iter_reachable(SYSTEM, 5),
    "iter_stable_branches": lambda _: z.iter_stable_branches(PAPER, PAIR, 2),
    "joint_drive": lambda _: z.joint_drive(
        z.FootModel(PARROT), report(), contacts(), np.ones(14)
    ),
    "joint_torques": joint_torques,
    "least_friction": lambda _: z.least_friction(contacts()),
    "load_atlas": saved_atlas,
    "make_engine": lambda _: z.make_engine("fcl", OWL).bones(CONTROLS),
    "named_poses": lambda _: z.named_poses(OWL),
    "nearest_reachable": lambda _: z.nearest_reachable(0.5 + 0.1j, SYSTEM, 5),
    "obstacle_clearance": lambda _: z.obstacle_clearance(
        z.forward_kinematics(OWL, CONTROLS[0]),
        OWL.radii,
        z.Sphere(0.02, (0, 0, -0.03)),
        engine="fcl",
    ),
    "perch_solutions": lambda _: z.perch_solutions(PARROT, PERCH, levels=3),
    "plan_perch": lambda _: z.plan_perch(OWL, z.Branch(0.02, (0, 0, -0.028))),
    "plot_atlas": lambda f: z.plot_atlas(made_atlas(), f / "atlas.png"),
    "plot_atlas_wrap": lambda f: z.plot_atlas_wrap(made_atlas(), f / "wrap.png"),
    "plot_engagement": drawn(z.plot_engagement, PAPER),
    "plot_remark": drawn(z.plot_remark, PAPER),
    "plot_strike": lambda f: z.plot_strike(made_strike(), f / "strike.png"),
    "plot_touch_bands": drawn(
        z.plot_touch_bands,
        z.Foot(fingers=PAPER.fingers[:1]),
        z.Branch(0.5, (0, 0, -0.6)),
        omegas=[0.4, 0.5],
        rhos=[1.3, 1.4],
    ),
    "preset_names": lambda _: z.preset_names(),
    "pull_limit": lambda _: z.pull_limit(contacts(), STRENGTH, (0, 0, 1)),
    "reachable_set": lambda _: z.reachable_set(1.3, 0.6, 3, 5),
    "region_map": lambda _: z.region_map(made_atlas()),
    "resting_branch": lambda _: z.resting_branch(PARROT, 0.008),
    "resting_branches": lambda _: z.resting_branches(PAPER, PAIR, 2),
    "resting_radii": lambda _: z.resting_radii(PAPER, "finger1", 2),
    "save_atlas": lambda f: z.save_atlas(made_atlas(), f / "save.npz"),
    "save_strike": lambda f: z.save_strike(made_strike(), f / "save.json"),
    "search_perch": lambda _: z.search_perch(PARROT, PERCH, levels=3),
    "simulate_strike": lambda _: z.simulate_strike(
        OWL, z.Sphere(0.03, (0, 0, 0)), flight(), frames=20
    ),
    "spread_study": lambda _: z.spread_study(OWL, 0.02, steps=5),
    "stable_branches": lambda _: z.stable_branches(PAPER, PAIR, 2),
    "strike_area": lambda _: z.strike_area(OWL, 0.02, reversal=[0.0, 1.0]),
    "sweep": lambda _: z.sweep(PARROT, {"radius": [0.008]}, levels=2, scheduler="sync"),
    "talon_hull_area": lambda _: z.talon_hull_area(OWL, reversal=[0.0, 1.0]),
    "tendon_drive": lambda _: z.tendon_drive(
        z.FootModel(PARROT), report(), contacts(), 1.0
    ),
    "tilt_limit": lambda _: z.tilt_limit(contacts(), STRENGTH, 0.04, (0, 0, 0.03)),
    "to_glb": lambda _: z.to_glb(PARROT),
    "to_mjcf": lambda _: z.to_mjcf(OWL, tendon=True),
    "to_mjcf_scene": lambda _: z.to_mjcf_scene(OWL, "foot.xml"),
    "to_srdf": lambda _: z.to_srdf(OWL.replace(rho=1.25)),
    "to_urdf": lambda _: z.to_urdf(OWL.replace(rho=1.25)),
    "torque_matrix": lambda _: z.torque_matrix(
        z.FootModel(PARROT), report().controls, contacts()
    ),
    "touch_intervals": lambda _: z.touch_intervals(PARROT, PERCH),
    "touching_controls": lambda _: z.touching_controls(
        z.touch_intervals(PARROT, PERCH), 0.008
    ),
    "validate_foot": lambda _: z.validate_foot(PARROT, levels=3, samples=20),
    "write_description": lambda f: z.write_description(OWL, f / "d", mjcf=True),
    "zygodactyl_fingers": lambda _: z.zygodactyl_fingers(0.2),
}


def functions() -> set[str]:
    """Names of the public functions."""
    return {name for name in z.__all__ if inspect.isfunction(getattr(z, name))}


def digests(folder: Path, names: list[str]) -> dict[str, str]:
    """What calls give, by name."""
    folder.mkdir(parents=True, exist_ok=True)
    return {name: digest(CALLS[name](folder)) for name in names}


def main() -> None:
    """Call all, and print what came of it."""
    folder = Path(sys.argv[1])
    print(json.dumps(digests(folder, sorted(CALLS))))  # noqa: T201


if __name__ == "__main__":
    main()
