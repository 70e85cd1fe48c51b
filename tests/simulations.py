"""Simulations that tests of the MuJoCo model run, and what they look at."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import mujoco
import numpy as np

from zygopin.dynamics import characteristic_time
from zygopin.foot import Foot
from zygopin.load import GRAVITY
from zygopin.mjcf import to_mjcf
from zygopin.paths import PACKAGE_PATH
from zygopin.poses import standard_branch

written = cache(to_mjcf)


def expanded(name, variant=""):
    """A preset's model as it is shipped, which needs no planning of its perch."""
    path = PACKAGE_PATH / "expanded" / f"{name}{variant}.xml"
    return mujoco.MjModel.from_xml_path(str(path))


def loaded(name, *, tendon=False):
    """A preset's shipped model and data, at rest."""
    model = expanded(name, "_tendon" if tendon else "")
    return model, mujoco.MjData(model)


def warnings_of(data):
    """How often MuJoCo has warned."""
    return sum(warning.number for warning in data.warning)


def run(model, data, seconds):
    """Step for a while; the largest speed of a joint over the last half [rad/s]."""
    speed = 0.0
    steps = round(seconds / model.opt.timestep)
    for step in range(steps):
        mujoco.mj_step(model, data)
        if step >= steps // 2:
            speed = max(speed, float(np.abs(data.qvel).max()))
    return speed


@dataclass(frozen=True)
class Landing:
    """What a drop onto a perch came to.

    Attributes:
        holding: Names of the phalanges on the perch at the end.
        offset: Where the base is at the end over the foot's size, from where the
            perch is highest, shape (3,).
        penetration: Deepest contact over the radius of the base's ball.
        late_penetration: The same at the end.
        closing_speed: Largest speed of a joint [rad/s].
        drift: Distance that the base moves in the second half, over its size.
        warnings: How often MuJoCo has warned.
    """

    holding: frozenset[str]
    offset: np.ndarray
    penetration: float
    late_penetration: float
    closing_speed: float
    drift: float
    warnings: int


def drop(name, *, height=0.25, periods=20.0):
    """Drop a foot on a tendon onto a perch, and close it once it touches.

    Args:
        name: A preset.
        height: How far it falls, over its size.
        periods: How long, over its characteristic time.
    """
    foot = Foot.preset(name)
    model = _over_perch(foot)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("rest").id)
    skin = model.geom("foot").size[0]
    data.qpos[2] = skin + height * foot.size
    steps = round(periods * characteristic_time(foot) / model.opt.timestep)
    deepest, fastest, halfway = 0.0, 0.0, data.qpos[:3].copy()
    for step in range(steps):
        mujoco.mj_step(model, data)
        if data.ncon:
            data.actuator("flexor").ctrl = foot.omega
        deepest = min(deepest, _deepest(data))
        fastest = max(fastest, float(np.abs(data.qvel[6:]).max()))
        if step == steps // 2:
            halfway = data.qpos[:3].copy()
    drift = np.linalg.norm(data.qpos[:3] - halfway)
    return Landing(
        holding=_touching(model, data, "perch"),
        offset=data.qpos[:3] / foot.size,
        penetration=-deepest / skin,
        late_penetration=-_deepest(data) / skin,
        closing_speed=fastest,
        drift=float(drift) / foot.size,
        warnings=warnings_of(data),
    )


def pull(name, direction, weights, *, periods=20.0):
    """How far a pull moves the base of a foot that has closed on a perch.

    Args:
        name: A preset.
        direction: Where to, shape (3,).
        weights: The pull at its end over the foot's weight; it grows from none.
        periods: How long the pull takes, over the characteristic time.

    Returns:
        The distance over the foot's size.
    """
    foot = Foot.preset(name)
    model = _over_perch(foot)
    data = mujoco.MjData(model)
    data.qpos[2] = 1.5 * model.geom("foot").size[0]
    data.actuator("flexor").ctrl = foot.omega
    steps = round(periods * characteristic_time(foot) / model.opt.timestep)
    for _ in range(steps):
        mujoco.mj_step(model, data)
    start = data.qpos[:3].copy()
    force = weights * GRAVITY * model.body_subtreemass[0] * np.asarray(direction)
    for step in range(steps):
        data.body("foot").xfrc_applied[:3] = force * (step + 1) / steps
        mujoco.mj_step(model, data)
    return float(np.linalg.norm(data.qpos[:3] - start)) / foot.size


def _over_perch(foot):
    """The free foot on a tendon, and a perch across with its top at the origin."""
    spec = mujoco.MjSpec.from_string(written(foot, tendon=True, free=True))
    radius = standard_branch(foot).radius
    half = 2 * foot.size
    spec.worldbody.add_geom(
        name="perch",
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0, -half, -radius, 0, half, -radius],
        size=[radius, 0, 0],
    )
    return spec.compile()


def _deepest(data):
    """The least gap of any contact [m]; 0 without one."""
    return float(data.contact.dist.min(initial=0.0))


def _touching(model, data, name):
    """Names of the geoms in contact with one."""
    one = model.geom(name).id
    pairs = [contact.geom for contact in data.contact if one in contact.geom]
    return frozenset(
        model.geom(int(i)).name for pair in pairs for i in pair if i != one
    )
