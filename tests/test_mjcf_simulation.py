"""The MuJoCo model in MuJoCo: the URDF's numbers, poses held, perches held on to."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from strategies import feet

from zygopin import keyframes, mjcf
from zygopin.description import to_urdf
from zygopin.dynamics import GRIP, characteristic_time
from zygopin.errors import DescriptionError
from zygopin.foot import Finger, Foot
from zygopin.kinematics import forward_kinematics
from zygopin.load import GRAVITY
from zygopin.mjcf import to_mjcf
from zygopin.names import flexion_joints, phalanx_links, tip_link, turning_link
from zygopin.paths import PACKAGE_PATH
from zygopin.poses import standard_perch
from zygopin.presets import preset_names

mujoco = pytest.importorskip("mujoco", reason="the models are text without it")

from simulations import drop, expanded, loaded, pull, run, warnings_of, written  # noqa: E402

BOTH = pytest.mark.parametrize("tendon", [False, True], ids=["servos", "tendon"])
EVERY = pytest.mark.parametrize("name", preset_names())


def no_poses(foot):  # noqa: ARG001
    """In place of named_poses: to plan a perch takes a second."""
    return {}


def some_angles(model, seed=5):
    """{joint: an angle in its range [rad]}."""
    draw = np.random.default_rng(seed)
    joints = map(model.joint, range(model.njnt))
    return {joint.name: float(draw.uniform(*joint.range)) for joint in joints}


def posed(model, data, angles):
    """The data with the joints at some angles, all derived quantities computed."""
    for joint, angle in angles.items():
        data.joint(joint).qpos = angle
    mujoco.mj_forward(model, data)
    return data


def pinocchio_of(foot, angles, *base):
    """Pinocchio's model of the URDF, its data, its configuration."""
    model = pin.buildModelFromXML(to_urdf(foot), *base)
    q = pin.neutral(model)
    for joint, angle in angles.items():
        q[model.idx_qs[model.getJointId(joint)]] = angle
    return model, model.createData(), q


# The same foot as the URDF --------------------------------------------------------


@EVERY
@BOTH
def test_mass_and_centre_of_mass_are_the_urdfs(name, tendon):
    model, data = loaded(name, tendon=tendon)
    angles = some_angles(model)
    posed(model, data, angles)
    foot = Foot.preset(name)
    other, other_data, q = pinocchio_of(foot, angles, pin.JointModelFreeFlyer())
    centre = pin.centerOfMass(other, other_data, q)  # free: else it drops the base
    mass, base = other_data.mass[0], other.inertias[1].mass
    assert model.body_subtreemass[0] == pytest.approx(mass, rel=1e-12, abs=0)
    assert model.body("foot").mass[0] == pytest.approx(base, rel=1e-12, abs=0)
    assert data.subtree_com[0] == pytest.approx(centre, abs=1e-12 * foot.size)


@EVERY
def test_the_inertia_matrix_is_pinocchios(name):
    model, data = loaded(name)
    angles = some_angles(model)
    posed(model, data, angles)
    other, other_data, q = pinocchio_of(Foot.preset(name), angles)
    theirs = pin.crba(other, other_data, q)
    theirs = np.triu(theirs) + np.triu(theirs, 1).T
    ours = np.zeros((model.nv, model.nv))
    for column, unit in zip(ours, np.eye(model.nv), strict=True):
        mujoco.mj_mulM(model, data, column, unit)
    ours -= np.diag(model.dof_armature)
    order = [model.joint(joint).dofadr[0] for joint in other.names[1:]]
    places = [other.idx_vs[other.getJointId(joint)] for joint in other.names[1:]]
    ours, theirs = ours[np.ix_(order, order)], theirs[np.ix_(places, places)]
    armature = model.dof_armature.max()  # what rounding is relative to
    assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-12 * armature)


@EVERY
@BOTH
def test_tips_are_where_the_bones_end(name, tendon):
    foot = Foot.preset(name)
    model, data = loaded(name, tendon=tendon)
    controls = np.random.default_rng(1).random(foot.phalanx_count)
    joints = [joint for finger in foot.fingers for joint in flexion_joints(finger)]
    posed(model, data, dict(zip(joints, foot.omega * controls, strict=True)))
    bones = forward_kinematics(foot, controls)
    for finger, part in zip(foot.fingers, foot.finger_slices.values(), strict=True):
        tip = data.site(tip_link(finger)).xpos
        assert tip == pytest.approx(bones[part.stop - 1, 1], abs=1e-12 * foot.size)


@EVERY
def test_all_frames_are_pinocchios_with_toes_turned(name):
    model, data = loaded(name)
    angles = some_angles(model)
    posed(model, data, angles)
    foot = Foot.preset(name)
    other, other_data, q = pinocchio_of(foot, angles)
    pin.framesForwardKinematics(other, other_data, q)
    for body in map(model.body, range(1, model.nbody)):
        frame = other_data.oMf[other.getFrameId(body.name)]
        place, turn = data.body(body.name).xpos, data.body(body.name).xmat
        assert place == pytest.approx(frame.translation, abs=1e-9 * foot.size)
        assert turn.reshape(3, 3) == pytest.approx(frame.rotation, abs=1e-9)


@EVERY
def test_mujocos_own_reading_of_the_urdf_agrees(name):
    # It fuses what is fixed: tips with their phalanges, but the base with the world.
    theirs = mujoco.MjModel.from_xml_string(to_urdf(Foot.preset(name)))
    ours, _ = loaded(name)
    assert theirs.nbody == ours.nbody - 1
    for body in map(ours.body, range(2, ours.nbody)):
        own = theirs.body(body.name)
        assert body.mass == pytest.approx(own.mass, rel=1e-14, abs=0)
        assert body.ipos == pytest.approx(own.ipos, rel=1e-12, abs=1e-15)
        moments = sorted(body.inertia), sorted(own.inertia)
        assert moments[0] == pytest.approx(moments[1], rel=1e-12, abs=0)
    for joint in map(ours.joint, range(ours.njnt)):
        own = theirs.joint(joint.name)
        assert np.array_equal(joint.range, own.range)
        assert np.array_equal(joint.axis, own.axis)
    for geom in map(ours.geom, range(1, ours.ngeom)):
        rod, ball = theirs.geom(f"{geom.name}_rod"), theirs.geom(f"{geom.name}_start")
        assert geom.size[:2] == pytest.approx(rod.size[:2], rel=1e-14)
        assert geom.size[0] == ball.size[0]


@EVERY
def test_a_capsule_weighs_what_its_volume_does(name):
    # The inertials are the URDF's; MuJoCo can also infer them from shape and density.
    foot = Foot.preset(name)
    spec = mujoco.MjSpec.from_file(str(PACKAGE_PATH / "expanded" / f"{name}.xml"))
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    for geom in spec.geoms:
        geom.density = foot.density
    inferred = spec.compile()
    ours, _ = loaded(name)
    lasts = {phalanx_links(finger)[-1] for finger in foot.fingers}  # they bear a claw
    hinges = {turning_link(finger) for finger in foot.fingers}  # they have no shape
    for body in map(ours.body, range(1, ours.nbody)):
        own = inferred.body(body.name)
        if body.name not in lasts | hinges:
            assert own.mass[0] == pytest.approx(body.mass[0], rel=1e-12, abs=0)
            moments = sorted(own.inertia), sorted(body.inertia)
            assert moments[0] == pytest.approx(moments[1], rel=1e-12, abs=0)


# Poses ----------------------------------------------------------------------------


@EVERY
@BOTH
def test_no_keyframe_starts_in_contact(name, tendon):
    model, data = loaded(name, tendon=tendon)
    for key in range(model.nkey):
        mujoco.mj_resetDataKeyframe(model, data, key)
        mujoco.mj_forward(model, data)
        assert data.ncon == 0


@pytest.mark.parametrize("name", ["parrot", "owl", "anisodactyl"])
def test_mujoco_touches_the_perch_where_the_planner_says(name):
    model = expanded(name, "_scene")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("perch").id)
    perch = model.geom("perch").id
    model.geom_margin[perch] = 1e-5 * model.stat.extent
    mujoco.mj_forward(model, data)
    gaps = {
        model.geom(int(sum(contact.geom)) - perch).name: contact.dist
        for contact in data.contact
    }
    foot = Foot.preset(name)
    report = standard_perch(foot).report
    links = [
        f"{f.name}_phalanx{k + 1}" for f in foot.fingers for k in range(f.phalanges)
    ]
    touching = {n for n, on in zip(links, report.tangent, strict=True) if on}
    assert touching
    assert {n for n in gaps if n in touching} == touching
    assert all(abs(gaps[n]) < 1e-5 * foot.size for n in touching)


SAG = 0.03
"""Largest distance of a joint from a pose that its actuators hold [rad]."""


@EVERY
@BOTH
def test_poses_are_held_and_come_to_rest(name, tendon):
    model, data = loaded(name, tendon=tendon)
    foot = Foot.preset(name)
    for key in range(model.nkey):
        mujoco.mj_resetDataKeyframe(model, data, key)
        pose = data.qpos.copy()
        speed = run(model, data, 40 * characteristic_time(foot))
        assert speed * characteristic_time(foot) < 1e-4
        assert warnings_of(data) == 0
        off = data.qpos - pose
        if tendon and model.key(key).name == "perch":  # needs its branch: toes even out
            off = data.tendon("flexor").length - data.actuator("flexor").ctrl
        assert np.abs(off).max() < SAG


@pytest.mark.parametrize(("tendon", "pose"), [(False, "closed"), (True, "rest")])
def test_ten_seconds_lose_energy_and_then_nothing_moves(tendon, pose):
    model, data = loaded("parrot", tendon=tendon)
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    mujoco.mj_resetDataKeyframe(model, data, model.key(pose).id)
    start = data.qpos.copy()
    mujoco.mj_step(model, data)
    weight = GRAVITY * model.body_subtreemass[0] * Foot.preset("parrot").size
    first = data.energy.sum()
    assert run(model, data, 10.0) < 1e-9
    assert np.abs(data.energy.sum() - first) < 0.1 * weight
    assert data.energy[1] < 1e-12 * weight
    assert np.abs(data.qpos - start).max() < SAG
    assert warnings_of(data) == 0


@EVERY
def test_without_weight_free_toes_follow_the_tendon_as_a_leader(name):
    foot = Foot.preset(name)
    model, data = loaded(name, tendon=True)
    model.opt.gravity[:] = 0
    angle = 0.3 * foot.omega
    data.actuator("flexor").ctrl = angle
    run(model, data, 30 * characteristic_time(foot))
    for finger in foot.fingers:
        for joint in flexion_joints(finger):
            assert data.joint(joint).qpos[0] == pytest.approx(angle, rel=1e-5)


@EVERY
@BOTH
def test_toes_pressed_against_each_other_stay_sound(name, tendon):
    model, data = loaded(name, tendon=tendon)
    foot = Foot.preset(name)
    data.ctrl[: 1 if tendon else None] = model.actuator_ctrlrange[:1, 1]
    run(model, data, 20 * characteristic_time(foot))
    assert np.isfinite(data.qpos).all()
    assert warnings_of(data) == 0
    assert np.abs(data.qvel).max() * characteristic_time(foot) < 0.1
    assert min((c.dist for c in data.contact), default=0) > -0.01 * foot.size


# The base -------------------------------------------------------------------------


def test_a_free_foot_falls_as_everything_does():
    text = written(Foot.preset("parrot"), tendon=True, free=True)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("perch").id)
    for _ in range(200):
        mujoco.mj_step(model, data)
    seconds = 200 * model.opt.timestep
    mujoco.mj_forward(model, data)
    height = data.subtree_com[0, 2]
    mujoco.mj_resetDataKeyframe(model, data, model.key("perch").id)
    mujoco.mj_forward(model, data)
    fall = GRAVITY * seconds**2 / 2
    assert data.subtree_com[0, 2] - height == pytest.approx(fall, rel=0.02)


def attached(text):
    """A wrist with a model mounted 0.98 m above the world's origin."""
    parent = mujoco.MjSpec()
    wrist = parent.worldbody.add_body(name="wrist", pos=[0.0, 0.0, 1.0])
    wrist.add_freejoint()
    wrist.add_geom(size=[0.01, 0.0, 0.0])
    mount = wrist.add_site(name="mount", pos=[0.0, 0.0, -0.02])
    child = mujoco.MjSpec.from_string(text)
    for option in ("timestep", "integrator", "cone", "impratio"):  # else: a warning
        setattr(parent.option, option, getattr(child.option, option))
    parent.attach(child, prefix="left_", site=mount)
    return parent.compile()


def test_a_toe_with_an_orientation_points_where_it_should(monkeypatch):
    monkeypatch.setattr(keyframes, "named_poses", no_poses)
    toe = Finger("toe", 2, azimuth=1.0, orientation=0.4)
    foot = Foot(scale=0.1, thickness=0.01, fingers=(toe,))
    text = to_mjcf(foot)
    _, (_, tip) = forward_kinematics(foot, np.zeros(2))
    for model, site, origin in (
        (mujoco.MjModel.from_xml_string(text), "toe_tip", 0.0),
        (attached(text), "left_toe_tip", 0.98),
    ):
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        place = data.site(site).xpos - [0, 0, origin]
        assert place == pytest.approx(tip, abs=1e-12)


def test_a_foot_is_attached_to_a_wrist_with_everything_it_has():
    model = attached((PACKAGE_PATH / "expanded" / "owl_tendon.xml").read_text())
    alone, alone_data = loaded("owl", tendon=True)
    mujoco.mj_forward(alone, alone_data)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for body in map(alone.body, range(1, alone.nbody)):
        place = data.body(f"left_{body.name}").xpos - [0, 0, 0.98]
        assert place == pytest.approx(alone_data.body(body.name).xpos, abs=1e-12)
    assert model.tendon(0).name == "left_flexor"
    assert {model.key(i).name for i in range(model.nkey)} >= {"left_rest", "left_perch"}
    assert model.nexclude == alone.nexclude
    for joint in map(alone.joint, range(alone.njnt)):
        assert np.array_equal(model.joint(f"left_{joint.name}").range, joint.range)


# The drop -------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["parrot", "owl", "anisodactyl"])
def test_a_dropped_foot_closes_on_the_perch_and_holds(name):
    foot = Foot.preset(name)
    landing = drop(name)
    assert landing.warnings == 0
    ahead = np.cos([finger.azimuth for finger in foot.fingers])
    holding = [
        any(link.startswith(finger.name) for link in landing.holding)
        for finger in foot.fingers
    ]
    assert any(holding & (ahead > 0))
    assert any(holding & (ahead < 0))
    assert 0.02 < landing.offset[2] < 0.15  # still on top: fallen off, far below
    assert np.abs(landing.offset[:2]).max() < 0.15
    assert landing.penetration < 0.8
    assert landing.late_penetration < 0.05
    assert landing.closing_speed * characteristic_time(foot) < 3
    assert landing.drift < 0.02


@pytest.mark.parametrize("name", ["parrot", "owl", "anisodactyl"])
def test_a_bird_can_hang_from_one_foot(name):
    assert pull(name, [0.0, 0.0, 1.0], GRIP) < 0.2  # toes give, but do not let go


# Any foot, and the smallest -------------------------------------------------------


def test_mujoco_takes_what_is_just_heavy_enough_and_no_less(monkeypatch):
    foot = Foot.preset("parrot")

    def shrunk(factor):
        small = foot.replace(scale=factor * 0.011, thickness=factor * 0.0018)
        return to_mjcf(small)

    monkeypatch.setattr(keyframes, "named_poses", no_poses)
    mujoco.MjModel.from_xml_string(shrunk(0.19))
    with pytest.raises(DescriptionError, match="finger4_phalanx5 is too light"):
        shrunk(0.185)
    monkeypatch.setattr(mjcf, "LEAST_INERTIA", 0.0)
    with pytest.raises(ValueError, match="mass and inertia of moving bodies"):
        mujoco.MjModel.from_xml_string(shrunk(0.185))


@settings(max_examples=12)
@given(feet())
def test_any_foot_compiles_and_steps(foot):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(keyframes, "named_poses", no_poses)
        try:
            text = to_mjcf(foot, tendon=len(foot.fingers) % 2 == 0, free=True)
        except DescriptionError:
            return  # too small a foot
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for _ in range(100):
        mujoco.mj_step(model, data)
    assert np.isfinite(data.qpos).all()
    assert warnings_of(data) == 0
