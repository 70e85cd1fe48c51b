"""A posed foot as binary glTF, read back."""

from __future__ import annotations

import io
import json
import math
import os
import struct
import subprocess
import sys

import numpy as np
import pytest
import trimesh

from zygopin.bundle import write_description
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Finger, Foot
from zygopin.kinematics import forward_kinematics
from zygopin.mesh import FACETS, to_glb
from zygopin.presets import preset_names

SAG = 1 - math.cos(math.pi / FACETS[1]) * math.cos(math.pi / FACETS[0] / 2)
"""How far a facet lies inside the round it stands for, over the radius."""

SINGLE = 1e-6
"""glTF holds 32-bit numbers."""


def loaded(content):
    return trimesh.load_scene(io.BytesIO(content), file_type="glb")


def header(content):
    """The JSON part of a GLB file."""
    magic, version, total, size, kind = struct.unpack("<4sII I4s", content[:20])
    assert (magic, version, total, kind) == (b"glTF", 2, len(content), b"JSON")
    return json.loads(content[20 : 20 + size])


def seen(points):
    """Points of the foot in glTF's frame: x left, y up, z forward."""
    return points[..., [1, 2, 0]]


@pytest.fixture(scope="module")
def posed():
    """Feet with random controls and the scene that they become."""
    rng = np.random.default_rng(0)
    cases = []
    for name in preset_names():
        foot = Foot.preset(name)
        controls = rng.random(foot.phalanx_count)
        cases.append((foot, controls, loaded(to_glb(foot, controls))))
    return cases


def test_a_finger_by_hand():
    # s = 40 mm, rho = 2: one bone of 20 mm along y (azimuth 90°), radius 5 mm, and the
    # base's ball of 5 mm. Flexed by 90° it points down. glTF: x left, y up, z forward.
    finger = Finger("toe", 1, math.pi / 2)
    foot = Foot(rho=2, omega=math.pi / 2, scale=0.04, thickness=0.01, fingers=(finger,))
    straight, flexed = loaded(to_glb(foot)), loaded(to_glb(foot, [1.0]))
    low, high = straight.bounds
    assert low == pytest.approx([-0.005, -0.005, -0.005], abs=1e-8)
    assert high == pytest.approx([0.025, 0.005, 0.005], abs=1e-8)
    low, high = flexed.bounds
    assert low == pytest.approx([-0.005, -0.025, -0.005], abs=1e-8)
    assert high == pytest.approx([0.005, 0.005, 0.005], abs=1e-8)


def test_each_drawn_link_is_one_mesh_of_its_name(posed):
    for foot, _, scene in posed:
        names = {
            f"{finger.name}_phalanx{k}"
            for finger in foot.fingers
            for k in range(1, finger.phalanges + 1)
        }
        assert scene.geometry.keys() == names | {"foot"}
        assert set(scene.graph.nodes_geometry) == names | {"foot"}


def test_capsules_lie_about_the_bones_within_the_facets_error(posed):
    for foot, controls, scene in posed:
        bones = forward_kinematics(foot, controls)
        radii = np.where(foot.radii > 1e-6 * foot.scale, foot.radii, foot.lengths / 100)
        names = [
            f"{finger.name}_phalanx{k}"
            for finger in foot.fingers
            for k in range(1, finger.phalanges + 1)
        ]
        for name, bone, radius in zip(names, seen(bones), radii, strict=True):
            transform, geometry = scene.graph[name]
            mesh = scene.geometry[geometry].copy().apply_transform(transform)
            slack = SINGLE * foot.size
            low, high = bone.min(axis=0) - radius, bone.max(axis=0) + radius
            assert (mesh.bounds[0] >= low - slack).all()
            assert (mesh.bounds[0] <= low + SAG * radius + slack).all()
            assert (mesh.bounds[1] <= high + slack).all()
            assert (mesh.bounds[1] >= high - SAG * radius - slack).all()


def test_meshes_are_closed_and_have_nearly_the_capsules_volume(posed):
    for foot, _, scene in posed:
        radius, length = foot.radii[0], foot.lengths[0]
        if radius == 0:
            radius = length / 100
        capsule = math.pi * radius**2 * (length + 4 * radius / 3)
        mesh = scene.geometry[f"{foot.fingers[0].name}_phalanx1"]
        assert mesh.is_watertight
        assert 0.985 < mesh.volume / capsule < 1
        assert all(mesh.is_watertight for mesh in scene.geometry.values())


def test_normals_are_those_of_the_round_shape():
    mesh = loaded(to_glb(Foot.preset("parrot"))).geometry["finger1_phalanx1"]
    foot = Foot.preset("parrot")
    ends = np.clip(mesh.vertices[:, 0], 0, foot.lengths[0])
    outward = mesh.vertices - np.column_stack([ends, 0 * ends, 0 * ends])
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    cosines = (outward * mesh.vertex_normals).sum(axis=1)
    assert cosines.min() > math.cos(math.pi / FACETS[0])
    assert header(to_glb(foot))["meshes"][1]["primitives"][0]["attributes"].keys() == {
        "POSITION",
        "NORMAL",
    }


def test_tips_are_nodes_at_the_ends_of_the_bones(posed):
    for foot, controls, scene in posed:
        ends = seen(forward_kinematics(foot, controls))[:, 1]
        for name, part in foot.finger_slices.items():
            place = scene.graph.get(f"{name}_tip")[0][:3, 3]
            assert place == pytest.approx(ends[part.stop - 1], abs=1e-9 * foot.size)


def test_a_node_carries_all_beyond_it():
    nodes = header(to_glb(Foot.preset("owl")))["nodes"]
    below = {
        node["name"]: [nodes[child]["name"] for child in node.get("children", [])]
        for node in nodes
    }
    assert sorted(below["foot"]) == [
        "finger1_phalanx1",
        "finger2_phalanx1",
        "finger3_phalanx1",
        "finger4_base",
    ]
    assert below["finger4_base"] == ["finger4_phalanx1"]
    assert below["finger1_phalanx2"] == ["finger1_tip"]


def test_the_skin_has_the_urdf_s_colour():
    (material,) = header(to_glb(Foot.preset("parrot")))["materials"]
    colour = material["pbrMetallicRoughness"]["baseColorFactor"]
    assert material["name"] == "skin"
    assert colour == pytest.approx([0.72, 0.56, 0.42, 1], abs=0.5 / 255)


def test_a_tiny_foot_keeps_its_shape():
    large = Foot(fingers=(Finger("toe", 2, 0.3),), thickness=0.2)
    small = large.replace(thickness=0.2e-6, scale=1e-6)
    meshes = [loaded(to_glb(foot)).geometry["toe_phalanx2"] for foot in (large, small)]
    assert len(meshes[0].faces) == len(meshes[1].faces)
    assert meshes[1].vertices * 1e6 == pytest.approx(meshes[0].vertices, abs=SINGLE)


def test_the_bytes_are_the_same_in_another_process():
    code = (
        "import sys; from zygopin import Foot, to_glb;"
        "sys.stdout.buffer.write(to_glb(Foot.preset('owl'), [0.3] * 14))"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "7"}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, check=True, env=environment)
    assert done.stdout == to_glb(
        Foot.preset("owl"), {f"finger{i}": [0.3] * (i + 1) for i in (1, 2, 3, 4)}
    )


def test_without_controls_the_foot_is_straight():
    foot = Foot.preset("parrot")
    assert to_glb(foot) == to_glb(foot, np.zeros(foot.phalanx_count))


@pytest.mark.parametrize(
    "controls", [[0.5] * 13, [0.5] * 13 + [1.5], [math.nan] * 14, [[0.5] * 14] * 2]
)
def test_bad_controls_are_a_parameter_error(controls):
    with pytest.raises(ParameterError, match="controls"):
        to_glb(Foot.preset("parrot"), controls)


def test_an_unknown_finger_is_named():
    with pytest.raises(UnknownNameError, match="thumb"):
        to_glb(Foot.preset("parrot"), {"thumb": [0.5]})


def test_the_bundle_adds_the_straight_foot(tmp_path):
    foot = Foot.preset("parrot")
    *_, file = write_description(foot, tmp_path, glb=True)
    assert file.name == "foot.glb"
    assert file.read_bytes() == to_glb(foot)
