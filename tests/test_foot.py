"""The foot's parameters: what they derive, how they change, what is refused."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest
import yaml
from hypothesis import given
from strategies import feet, reals

from zygopin.bones import posed_bones
from zygopin.errors import FileError, ParameterError, UnknownNameError
from zygopin.foot import GOLDEN_MEAN, Finger, Foot, zygodactyl_fingers
from zygopin.presets import preset_names

OMEGA = math.pi / 12


def rays(foot):
    """Directions of the straight fingers in the xy-plane, as complex numbers."""
    return np.exp(1j * np.array([finger.azimuth for finger in foot.fingers]))


# The zygodactyl foot -------------------------------------------------------------


def test_the_default_foot_has_fourteen_phalanges_on_four_fingers():
    foot = Foot()
    assert [finger.phalanges for finger in foot.fingers] == [2, 3, 4, 5]
    assert foot.phalanx_count == 14
    assert foot.rank_of_phalanx.tolist() == [1, 2, 1, 2, 3, 1, 2, 3, 4, 1, 2, 3, 4, 5]
    assert foot.finger_of_phalanx.tolist() == [0] * 2 + [1] * 3 + [2] * 4 + [3] * 5
    assert foot.finger_slices["finger3"] == slice(5, 9)


def test_two_and_three_point_forward_one_and_four_back_at_the_splay():
    one, two, three, four = (finger.azimuth for finger in Foot().fingers)
    assert (two, three) == (OMEGA, -OMEGA)
    assert (one, four) == pytest.approx((math.pi - OMEGA, math.pi + OMEGA))


@given(reals(0.0, 1.5))
def test_one_and_three_are_coplanar_and_so_are_two_and_four(splay):
    one, two, three, four = rays(Foot(splay=splay))
    assert one == pytest.approx(-three, abs=1e-15)
    assert two == pytest.approx(-four, abs=1e-15)


def test_opposable_pairs_are_one_forward_and_one_back():
    pairs = {(i + 1, j + 1) for i, j in Foot().opposable_pairs}
    assert pairs == {(1, 2), (1, 3), (2, 4), (3, 4)}


def test_a_finger_that_points_sideways_opposes_none():
    fingers = (
        Finger("a", 1, 0.0),
        Finger("b", 1, math.pi / 2),
        Finger("c", 1, 3 * math.pi / 2),
    )
    assert Foot(fingers=fingers).opposable_pairs == ()


def test_lengths_radii_and_size_by_hand():
    # s ρ^-k: 4/2, 4/4; the thickness likewise; the longest finger is their sum.
    fingers = (Finger("a", 2, 0.0), Finger("b", 1, 1.0))
    foot = Foot(rho=2.0, scale=4.0, thickness=1.0, fingers=fingers)
    assert foot.lengths.tolist() == [2.0, 1.0, 2.0]
    assert foot.radii.tolist() == [0.5, 0.25, 0.5]
    assert foot.size == 3.0


def test_the_golden_mean_is_the_default():
    assert Foot().rho == GOLDEN_MEAN
    assert pytest.approx(GOLDEN_MEAN + 1) == GOLDEN_MEAN**2


# Change --------------------------------------------------------------------------


@given(reals(0.0, 1.5), reals(0.0, 1.5))
def test_a_new_splay_is_that_of_a_foot_made_with_it(old, new):
    turned = Foot(splay=old).replace(splay=new)
    assert turned.splay == new
    made = [finger.azimuth for finger in zygodactyl_fingers(new)]
    assert [f.azimuth for f in turned.fingers] == pytest.approx(made, abs=1e-14)


def test_a_new_splay_turns_each_finger_by_its_gain():
    foot = Foot.preset("anisodactyl")
    turned = foot.replace(splay=foot.splay + 0.1)
    changes = np.subtract(
        [f.azimuth for f in turned.fingers], [f.azimuth for f in foot.fingers]
    )
    assert changes == pytest.approx([0.0, 0.1, 0.0, -0.1])


def test_new_fingers_keep_their_azimuths_whatever_the_splay():
    fingers = (Finger("toe", 1, 1.0, splay_gain=1),)
    assert Foot().replace(splay=0.5, fingers=fingers).fingers == fingers


def test_replacing_leaves_the_foot_as_it_was_and_derives_afresh():
    foot = Foot()
    assert foot.size < 2
    larger = foot.replace(scale=2.0)
    assert larger.size == 2 * foot.size
    assert foot == Foot()


def test_what_is_derived_cannot_be_written():
    foot = Foot()
    for name in ("lengths", "radii", "finger_of_phalanx", "rank_of_phalanx"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(foot, name)[0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        foot.rho = 2.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        foot.fingers[0].azimuth = 2.0


def test_equal_feet_are_one_key():
    assert {Foot(): 1}[Foot(splay=math.pi / 12)] == 1
    assert Foot() != Foot(rho=2)


def test_reversal_is_the_turn_to_the_reversed_azimuth():
    assert Finger("a", 1, 0.5, reversed_azimuth=2.0).reversal == 1.5
    assert Finger("a", 1, 0.5).reversal == 0.0


# Plain values --------------------------------------------------------------------


@given(feet())
def test_any_foot_survives_plain_values_json_and_yaml(foot):
    mapping = foot.to_mapping()
    assert Foot.from_mapping(mapping) == foot
    assert Foot.from_mapping(json.loads(json.dumps(mapping))) == foot
    assert Foot.from_mapping(yaml.safe_load(yaml.safe_dump(mapping))) == foot


@pytest.mark.parametrize("name", preset_names())
def test_every_preset_survives_a_file(tmp_path, name):
    foot = Foot.preset(name)
    file = tmp_path / "foot.yaml"
    file.write_text(yaml.safe_dump(foot.to_mapping()))
    assert Foot.load(file) == foot


def test_an_empty_mapping_is_the_default_foot():
    assert Foot.from_mapping({}) == Foot()
    assert Foot.from_mapping({"description": "any", "sources": {}}) == Foot()


# Failure -------------------------------------------------------------------------

BAD_VALUES = [
    ("rho", 1.0, "above 1"),
    ("rho", 101, "above 1, up to 100"),
    ("omega", 0, r"in \(0, 2π\) and different from π"),
    ("omega", math.pi, "different from π"),
    ("omega", 2 * math.pi, r"in \(0, 2π\)"),
    ("splay", -0.1, r"in \[0, π/2\)"),
    ("splay", math.pi / 2, r"in \[0, π/2\)"),
    ("scale", 0, "give metres, such as 0.016 for 16 mm"),
    ("scale", 1e7, r"in \[1e-6, 1e6\]"),
    ("thickness", -1e-9, "give metres, or 0 for bare bones"),
    ("thickness", 1.0, "below the scale 1 m"),
    ("density", 0, "give kg/m³"),
    ("name", "My foot", "lower-case identifier"),
    ("fingers", 5, "a list"),
    ("fingers", "finger1", "a list"),
    ("fingers", [1], "a Finger: use zygopin.Finger"),
    ("fingers", [Finger("a", 1, 0)] * 2, "used once"),
    ("fingers", [Finger(f"f{i}", 1, 0) for i in range(13)], "from 1 to 12"),
]


@pytest.mark.parametrize(("field", "value", "message"), BAD_VALUES)
def test_a_bad_parameter_is_one_line(field, value, message):
    with pytest.raises(ParameterError, match=message) as caught:
        Foot(**{field: value})
    assert "\n" not in str(caught.value)
    assert field in str(caught.value) or field == "fingers"
    with pytest.raises(ParameterError, match=message):
        Foot().replace(**{field: value})


def test_a_phalanx_that_is_lost_in_rounding_is_refused_and_the_remedy_works():
    def foot(rho):
        fingers = (Finger("a", 12, 0.0), Finger("b", 12, math.pi))
        return Foot(rho=rho, thickness=0.1, fingers=fingers)

    with pytest.raises(ParameterError, match="length of phalanx 12") as refused:
        foot(100)
    remedy = float(str(refused.value).rpartition(" at most ")[2])
    bones = posed_bones(foot(remedy), np.full((50, 24), 0.7))
    assert (bones[..., 0, :] != bones[..., 1, :]).any(axis=-1).all()


@pytest.mark.parametrize("field", ["rho", "omega", "splay", "scale", "thickness"])
@pytest.mark.parametrize("value", [math.nan, math.inf, "1.2", None, True])
def test_a_value_that_is_no_finite_number_is_named(field, value):
    with pytest.raises(ParameterError, match=f"^{field} = ") as caught:
        Foot(**{field: value})
    assert caught.value.value is value


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("phalanges", 0, "toe.phalanges = 0 is not an integer from 1 to 12"),
        ("phalanges", 2.5, "toe.phalanges = 2.5"),
        ("azimuth", 7.0, r"toe.azimuth = 7.0 is not in \[-2π, 2π\]: give radians"),
        ("orientation", math.nan, "toe.orientation = nan"),
        ("splay_gain", 2, "toe.splay_gain = 2 is not an integer from -1 to 1"),
        ("reversed_azimuth", -7.0, "toe.reversed_azimuth = -7.0"),
        ("name", "Toe", "finger.name = 'Toe'"),
    ],
)
def test_a_bad_finger_is_one_line(field, value, message):
    values = {"name": "toe", "phalanges": 2, "azimuth": 0.0, field: value}
    with pytest.raises(ParameterError, match=message):
        Finger(**values)


@pytest.mark.parametrize(
    ("mapping", "error", "message"),
    [
        ({"rhoo": 2}, UnknownNameError, "unknown field of foot 'rhoo': did you mean"),
        ({1: 2}, UnknownNameError, "unknown field of foot 1: choose one of rho"),
        ({"fingers": 3}, ParameterError, "fingers = 3 is not a list"),
        ({"fingers": []}, ParameterError, r"fingers = \[\] is not a filled list"),
        ({"fingers": [3]}, ParameterError, "finger = 3 is not a mapping"),
        ({"fingers": [{"name": "a"}]}, ParameterError, "add phalanges"),
        ({"fingers": [{"nam": "a"}]}, UnknownNameError, "did you mean 'name'"),
        ({"rho": "1e3"}, ParameterError, "rho = '1e3'"),
    ],
)
def test_bad_plain_values_are_one_line_and_name_the_file(
    tmp_path, mapping, error, message
):
    with pytest.raises(error, match=message):
        Foot.from_mapping(mapping)
    file = tmp_path / "foot.yaml"
    file.write_text(yaml.safe_dump(mapping))
    with pytest.raises(FileError, match=message) as caught:
        Foot.load(file)
    assert str(caught.value).startswith(f"{file}: ")
    assert "\n" not in str(caught.value)


def test_an_unknown_change_is_refused_with_a_suggestion():
    with pytest.raises(UnknownNameError, match="did you mean 'thickness'"):
        Foot().replace(thicknes=0.1)
