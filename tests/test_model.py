"""The Pinocchio model against the closed form, and against hand-worked numbers."""

from __future__ import annotations

import itertools
import math
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import controls_for, feet

from zygopin.description import to_urdf
from zygopin.errors import DescriptionError, ParameterError, UnknownNameError
from zygopin.foot import Finger, Foot
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.presets import preset_names

PARROT = Foot.preset("parrot")
OWL = Foot.preset("owl")


@pytest.fixture(scope="module")
def parrot():
    return FootModel(PARROT)


@pytest.fixture(scope="module")
def owl():
    return FootModel(OWL)


@pytest.mark.parametrize("name", preset_names())
def test_pinocchio_and_the_closed_form_agree(name):
    foot = Foot.preset(name)
    controls = np.random.default_rng(2).random((50, foot.phalanx_count))
    bones = FootModel(foot).forward(controls)
    assert np.abs(bones - forward_kinematics(foot, controls)).max() < 1e-12 * foot.size


@settings(max_examples=15, deadline=None)
@given(st.data())
def test_they_agree_for_any_foot(data):
    foot = data.draw(feet())
    controls = data.draw(controls_for(foot, batch=(2,)))
    own = np.array([finger.azimuth for finger in foot.fingers])
    part = data.draw(st.floats(0, 1))
    azimuths = own + [part * finger.reversal for finger in foot.fingers]
    bones = FootModel(foot).forward(controls, azimuths=azimuths)
    expected = forward_kinematics(foot, controls, azimuths=azimuths)
    assert np.abs(bones - expected).max() < 1e-12 * foot.size


@pytest.mark.parametrize(
    ("rho", "scale", "thickness", "density"),
    [(10.0, 1e-6, 1e-300, 1e-3), (1.0000001, 1e6, 9e5, 1e6)],
)
def test_the_smallest_and_the_largest_foot_are_valid(rho, scale, thickness, density):
    finger = Finger("toe", 12, 1.0, reversed_azimuth=2.0)
    foot = Foot(
        rho=rho, scale=scale, thickness=thickness, density=density, fingers=(finger,)
    )
    model = FootModel(foot)
    bones = model.forward(np.ones(12))
    expected = forward_kinematics(foot, np.ones(12))
    assert np.abs(bones - expected).max() < 1e-12 * foot.size
    for inertia in model.model.inertias[1:]:
        assert 0 < inertia.mass < math.inf
        assert np.linalg.eigvalsh(inertia.inertia).min() > 0


def test_four_junctions_by_hand():
    # ρ = φ, ω = π/6, v ≡ 1, straight ahead (MODEL.md, section 2): x + iz.
    foot = Foot(fingers=(Finger("toe", 4, 0.0),))
    bones = FootModel(foot).forward(np.ones(4))
    junctions = [
        (0.535233, -0.309017),
        (0.726216, -0.639809),
        (0.726216, -0.875877),
        (0.653267, -1.002229),
    ]
    assert bones[:, 1, [0, 2]] == pytest.approx(np.array(junctions), abs=5e-7)
    assert bones[:, 1, 1] == pytest.approx(0.0, abs=1e-15)
    assert (bones[1:, 0] == bones[:-1, 1]).all()
    assert (bones[0, 0] == 0).all()


def test_batches_keep_their_shape(parrot):
    controls = np.random.default_rng(3).random((2, 3, 14))
    bones = parrot.forward(controls)
    assert bones.shape == (2, 3, 14, 2, 3)
    assert (bones[1, 2] == parrot.forward(controls[1, 2])).all()
    assert parrot.forward(np.empty((0, 14))).shape == (0, 14, 2, 3)
    assert parrot.configuration(controls).shape == (2, 3, 14)


def test_controls_may_be_given_by_finger(parrot):
    named = {f.name: [0.5] * f.phalanges for f in PARROT.fingers}
    assert (parrot.forward(named) == parrot.forward(np.full(14, 0.5))).all()


def test_configuration_maps_joints_by_name():
    # Pinocchio sorts siblings by name: b before z, whatever the foot's order.
    foot = Foot(fingers=(Finger("z", 1, 0.0), Finger("b", 2, 1.0)), omega=2.0)
    q = FootModel(foot).configuration([0.1, 0.2, 0.3])
    assert q == pytest.approx([0.4, 0.6, 0.2])


def test_a_reversed_toe_follows_its_azimuth(owl):
    own = [finger.azimuth for finger in OWL.fingers]
    spread = [*own[:3], OWL.fingers[3].reversed_azimuth]
    controls = np.random.default_rng(4).random(14)
    bones = owl.forward(controls, azimuths=[own, spread])
    expected = forward_kinematics(OWL, controls, azimuths=[own, spread])
    assert np.abs(bones - expected).max() < 1e-12 * OWL.size
    q = owl.configuration(controls, azimuths=spread)
    joint = owl.model.getJointId("finger4_reversal")
    assert q[owl.model.idx_qs[joint]] == OWL.fingers[3].reversal


def test_a_toe_without_reversal_keeps_its_azimuth(parrot):
    azimuths = np.array([finger.azimuth for finger in PARROT.fingers])
    controls = np.zeros(14)
    bones = parrot.forward(controls, azimuths=azimuths)
    assert (bones == parrot.forward(controls)).all()
    with pytest.raises(ParameterError, match=r"azimuths\[finger2\] = 0\.36.*reversal"):
        parrot.forward(controls, azimuths=azimuths + 0.1 * np.eye(4)[1])


@pytest.mark.parametrize("bad", [np.full(14, 1.5), np.full(14, np.nan), np.zeros(13)])
def test_bad_controls_are_refused(parrot, bad):
    with pytest.raises(ParameterError, match="controls"):
        parrot.forward(bad)


def test_unknown_fingers_and_batches_that_differ_are_refused(parrot, owl):
    with pytest.raises(UnknownNameError, match="thumb"):
        parrot.forward({"thumb": [0.0]})
    own = [finger.azimuth for finger in OWL.fingers]
    with pytest.raises(ParameterError, match="broadcastable"):
        owl.forward(np.zeros((3, 14)), azimuths=[own, own])


def test_it_survives_pickling(owl):
    copy = pickle.loads(pickle.dumps(owl))  # noqa: S301
    controls = np.random.default_rng(5).random((4, 14))
    assert copy.foot == owl.foot
    assert (copy.forward(controls) == owl.forward(controls)).all()


def test_threads_may_share_it_and_no_answer_changes_later(owl):
    poses = np.random.default_rng(7).random((8, 60, 14))
    expected = [forward_kinematics(OWL, each) for each in poses]
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(owl.forward, poses))
    for one, other in zip(found, expected, strict=True):
        assert np.abs(one - other).max() < 1e-14 * OWL.size


def test_lengths_scale_with_the_foot():
    controls = np.random.default_rng(6).random(14)
    double = {"scale": 2 * PARROT.scale, "thickness": 2 * PARROT.thickness}
    large = FootModel(PARROT.replace(**double)).forward(controls)
    small = FootModel(PARROT).forward(controls)
    assert large == pytest.approx(2 * small, abs=1e-15)


def test_the_mass_is_that_of_the_links(parrot):
    # Σ of density·(π r²ℓ + 4π r³/3) over the phalanges, its second part over tips.
    balls = 4 / 3 * PARROT.radii**3
    tips = balls[[part.stop - 1 for part in PARROT.finger_slices.values()]]
    volume = (PARROT.radii**2 * PARROT.lengths + balls).sum() + tips.sum()
    moving = sum(inertia.mass for inertia in parrot.model.inertias[1:])
    assert moving == pytest.approx(PARROT.density * math.pi * volume, rel=1e-12)


def test_the_tendon_variant_is_a_urdf_of_the_foot_too(parrot):
    controls = np.random.default_rng(7).random(14)
    other = FootModel(PARROT, to_urdf(PARROT, tendon=True))
    assert (other.forward(controls) == parrot.forward(controls)).all()


def test_a_urdf_on_a_larger_robot_keeps_its_other_joints_neutral():
    extra = (
        '<link name="wing"/><joint name="flap" type="continuous"><parent link="foot"/>'
        '<child link="wing"/><axis xyz="1 0 0"/></joint></robot>'
    )
    model = FootModel(PARROT, to_urdf(PARROT).replace("</robot>", extra))
    assert model.configuration(np.zeros(14)).shape == (16,)
    assert (model.forward(np.ones(14)) == FootModel(PARROT).forward(np.ones(14))).all()


URDF = to_urdf(PARROT)
FIRST_LIMIT = URDF[URDF.index("<limit ") :].partition(">")[0] + ">"


@pytest.mark.parametrize(
    ("urdf", "message"),
    [
        ("", "not XML"),
        ("<robot", "not XML"),
        (URDF[:5000], "not XML"),
        ("<sdf/>", "has the root <sdf>"),
        ("<robot/>", "0 links named foot"),
        (URDF.replace('"finger3_tip"', '"other"'), "0 links named finger3_tip"),
        (URDF.replace('"finger1_joint2"', '"other"'), "0 joints named finger1_joint2"),
        (URDF.replace("</robot>", '<link name="foot"/></robot>'), "2 links named foot"),
        (URDF.replace('xyz="0 1 0"', 'xyz="0 1"'), 'xyz="0 1" in <axis>'),
        (URDF.replace('lower="0"', 'lower="nan"'), 'lower="nan" in <limit>'),
        (URDF.replace('<mass value="', '<mass value="x'), "in <mass>"),
        (URDF.replace(FIRST_LIMIT, "", 1), "no limits for the joint finger1_joint1"),
        (URDF.replace('<parent link="foot"/>', "", 1), "no parent link"),
        (URDF.replace('"revolute"', '"fixed"', 1), "does not turn by one angle"),
        (URDF.replace('"revolute"', '"continuous"', 1), "does not turn by one angle"),
        (URDF.replace('link="foot"', 'link="finger1_phalanx2"', 1), "finger1_joint1"),
    ],
    ids=itertools.count(),
)
def test_a_malformed_urdf_is_one_line_and_silent(capfd, urdf, message):
    with pytest.raises(DescriptionError) as caught:
        FootModel(PARROT, urdf)
    assert message in str(caught.value)
    assert str(caught.value).endswith(
        "give the URDF of this foot, as to_urdf writes it"
    )
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


def test_a_urdf_that_pinocchio_rejects_is_one_line():
    spare = '<link name="spare"/></robot>'  # a second root
    with pytest.raises(DescriptionError, match="malformed") as caught:
        FootModel(PARROT, URDF.replace("</robot>", spare))
    assert "\n" not in str(caught.value)
