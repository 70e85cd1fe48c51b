"""A posed foot as one binary glTF file, for renderers, viewers and animation tools."""

from __future__ import annotations

import io
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds, names
from zygopin.description import to_urdf
from zygopin.foot import Foot
from zygopin.kinematics import Controls, as_controls

if TYPE_CHECKING:  # a second to load: only where it is used
    import trimesh
    import yourdfpy

FACETS = (16, 32)
"""Facets of a capsule from pole to pole and around: its volume is 1.1 % short."""

ROUGHNESS = 0.7
"""How dull the skin is, 0 to 1: the URDF does not say."""

_GLTF_FROM_FOOT = np.array([[0, 1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 0], [0, 0, 0, 1.0]])
"""From x forward, y left, z up to glTF's z forward, x left, y up."""


def to_glb(foot: Foot, controls: Controls | None = None) -> bytes:
    """A foot in a pose as binary glTF 2.0; equal feet and poses, equal bytes.

    In glTF's own frame: metres, +y up, +z forward. A node for each link, below that of
    its parent, so that turning a node turns what hangs on it. A mesh for each phalanx
    and for the base's ball, named after its link: smooth, in the URDF's colour. Bare
    bones are drawn as rods, as in the URDF.

    Args:
        foot: The foot.
        controls: Values in [0, 1], shape (P,), or {finger name: shape (K,)}; None:
            straight. A toe that turns points to its azimuth.

    Returns:
        What a file with the suffix .glb holds.

    Raises:
        ParameterError: A control is outside [0, 1], or the shape is wrong.
        UnknownNameError: A finger does not exist.
    """
    kinds.instance("foot", foot, Foot)
    count = foot.phalanx_count
    values = as_controls(foot, np.zeros(count) if controls is None else controls)
    checks.shaped("controls", values, (count,))
    robot = _robot(foot, values)
    scene = _scene(robot)
    return bytes(scene.export(file_type="glb", include_normals=True))


def _robot(foot: Foot, controls: NDArray[np.float64]) -> yourdfpy.URDF:
    """The foot's URDF in a pose."""
    import yourdfpy

    robot = yourdfpy.URDF.load(
        io.StringIO(to_urdf(foot)), build_scene_graph=True, load_meshes=False
    )
    joints = chain.from_iterable(map(names.flexion_joints, foot.fingers))
    angles = dict.fromkeys(robot.actuated_joint_names, 0.0)
    angles |= dict(zip(joints, (foot.omega * controls).tolist(), strict=True))
    robot.update_cfg(angles)
    return robot


def _scene(robot: yourdfpy.URDF) -> trimesh.Scene:
    """The robot's links as nodes, each below its parent; what is drawn has a mesh."""
    import trimesh

    scene = trimesh.Scene(base_frame="world")
    places = {robot.base_link: ("world", _GLTF_FROM_FOOT)}
    for joint in robot.robot.joints:
        T_parent_child = robot.get_transform(joint.child, joint.parent)
        places[joint.child] = (joint.parent, T_parent_child)
    colours = {paint.name: paint.color.rgba for paint in robot.robot.materials}
    for link in robot.robot.links:
        parent, T_parent_link = places[link.name]
        if not link.visuals:
            scene.graph.update(link.name, parent, matrix=T_parent_link)
            continue
        visual = link.visuals[0]  # a phalanx's first is its cylinder
        scene.add_geometry(
            _mesh(visual, colours[visual.material.name]),
            node_name=link.name,
            geom_name=link.name,
            parent_node_name=parent,
            transform=T_parent_link,
        )
    return scene


def _mesh(visual: Any, rgba: NDArray[np.float64]) -> trimesh.Trimesh:  # noqa: ANN401
    """A cylinder with its round ends, or a sphere, in the frame of its link.

    Made for a radius of 1 and scaled as plain numbers: trimesh's tolerances are
    lengths, and would merge the vertices of a small foot.
    """
    import trimesh

    rod = visual.geometry.cylinder
    radius = (rod or visual.geometry.sphere).radius
    height = rod.length / radius if rod else 0.0
    unit = trimesh.creation.capsule(height, 1.0, FACETS)
    unit.apply_translation(-unit.bounds.mean(axis=0))
    turn, centre = visual.origin[:3, :3], visual.origin[:3, 3]
    skin = trimesh.visual.material.PBRMaterial(
        name=visual.material.name,
        baseColorFactor=rgba,
        metallicFactor=0.0,
        roughnessFactor=ROUGHNESS,
    )
    return trimesh.Trimesh(
        vertices=centre + radius * unit.vertices @ turn.T,
        faces=unit.faces,
        vertex_normals=unit.vertex_normals @ turn.T,
        visual=trimesh.visual.TextureVisuals(material=skin),
        process=False,
    )
