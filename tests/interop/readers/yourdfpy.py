"""yourdfpy; trimesh's collision manager measures the meshes that it makes."""

import numpy as np
import trimesh.collision
import yourdfpy

from readers.parsed import Parsed

SECTIONS = 32
"""Sides of a cylinder in trimesh, unless told otherwise."""


class Robot(Parsed):
    def __init__(self, case):
        self.case, self.managers = case, {}
        self.urdf = yourdfpy.URDF.load(
            case["urdf"],
            build_collision_scene_graph=True,
            load_collision_meshes=True,
        )
        self.elements = self.urdf.robot

    def poses(self, angles):
        known = self.urdf.actuated_joint_names
        self.urdf.update_cfg({name: angles.get(name, 0.0) for name in known})
        return {tip: self.urdf.get_transform(tip, "foot") for tip in self.case["tips"]}

    def distances(self, angles, pairs):
        """trimesh's, between the meshes that yourdfpy makes, one for each link."""
        self.poses(angles)
        found = []
        for pair in pairs:
            first, second = map(self._placed, pair)
            found.append(first.min_distance_other(second))
        return found

    def _placed(self, link):
        """A manager that has one link, where it is now."""
        if link not in self.managers:
            self.managers[link] = trimesh.collision.CollisionManager()
            self.managers[link].add_object(link, self._mesh(link))
        if link != "branch":
            place = self.urdf.get_transform(link, "foot")
            self.managers[link].set_transform(link, place)
        return self.managers[link]

    def _mesh(self, link):
        if link == "branch":
            branch = self.case["branch"]
            place = np.eye(4)
            place[:3, :3], place[:3, 3] = branch["rotation"], branch["centre"]
            sizes = {"radius": branch["radius"], "height": branch["length"]}
            return trimesh.creation.cylinder(
                **sizes, sections=SECTIONS, transform=place
            )
        return self.urdf.collision_scene.geometry[f"{link}_rod"]
