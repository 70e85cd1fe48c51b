"""Compiled loops over phalanges, one at a time: what `clearance.distances` measures."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.clearance import PARALLEL, UNTURNED
from zygopin.compiler import compiled
from zygopin.directions import Floats


class Side(NamedTuple):
    """Where phalanges are nearest to the sides of branches: `Clearance`, n poses of it.

    Attributes:
        distance: Signed clearance [m], shape (n, P).
        t: Position on the line of the bone, shape (n, P).
        point: Nearest point of the branch [m], shape (n, P, 3).
        normal: Unit normal there, shape (n, P, 3).
    """

    distance: Floats
    t: Floats
    point: Floats
    normal: Floats


@compiled
def clipped(value: float) -> float:
    """The nearest number in [0, 1]."""
    value = value if value > 0.0 else 0.0
    return value if value < 1.0 else 1.0


@compiled
def parameters(
    uu: float, vv: float, uv: float, uw: float, vw: float
) -> tuple[float, float]:
    """Where two segments are nearest, as `clearance.segment_offset` has it."""
    determinant = uu * vv - uv * uv
    crossing = determinant > UNTURNED * uu * vv
    s = (uv * vw - uw * vv) / determinant if crossing else 0.0
    t = clipped((uv * clipped(s) + vw) / vv)
    return clipped((uv * t - uw) / uu), t


@compiled
def line(bone: Floats) -> tuple[float, ...]:
    """Where a bone starts, and how it goes to its end."""
    x, y, z = bone[0, 0], bone[0, 1], bone[0, 2]
    return x, y, z, bone[1, 0] - x, bone[1, 1] - y, bone[1, 2] - z


@compiled
def side_clearance(
    bones: Floats, radii: Floats, branches: Floats, side: Side, left: NDArray[np.bool_]
) -> bool:
    """Clearance between phalanges and branches' sides: MODEL.md, section 4.

    Args:
        bones: Bones [m], shape (n, P, 2, 3) or (1, P, 2, 3).
        radii: Skin radii [m], shape (P,).
        branches: Centre, axis, radius and half the length, shape (n, 8) or (1, 8).
        side: Written.
        left: Where a bone meets the axis, or an end may be nearer than the side, shape
            (n,): written, from all False.

    Returns:
        Whether anything is left.
    """
    some = False
    for k in range(len(left)):
        pose = bones[k if len(bones) > 1 else 0]
        branch = branches[k if len(branches) > 1 else 0]
        cx, cy, cz, ax, ay, az, radius, half = branch
        for p in range(len(radii)):
            x, y, z, u, v, w = line(pose[p])
            x, y, z = x - cx, y - cy, z - cz
            start, step = x * ax + y * ay + z * az, u * ax + v * ay + w * az
            x, y, z = x - start * ax, y - start * ay, z - start * az
            right, ahead, up = u - step * ax, v - step * ay, w - step * az
            square = right * right + ahead * ahead + up * up
            t = 0.5
            if square > PARALLEL**2 * (u * u + v * v + w * w):
                t = -(x * right + y * ahead + z * up) / square
            s = clipped(t)
            x, y, z = x + s * right, y + s * ahead, z + s * up
            away, axial = sqrt(x * x + y * y + z * z), start + s * step
            bark = away - radius
            left[k] |= (away <= PARALLEL * radius) | (
                abs(axial) - half > min(bark, 0.0)
            )
            x, y, z = x / away, y / away, z / away
            side.distance[k, p], side.t[k, p] = bark - radii[p], t
            side.normal[k, p, 0], side.point[k, p, 0] = x, cx + axial * ax + radius * x
            side.normal[k, p, 1], side.point[k, p, 1] = y, cy + axial * ay + radius * y
            side.normal[k, p, 2], side.point[k, p, 2] = z, cz + axial * az + radius * z
        some |= left[k]
    return some


@compiled
def least_gap(
    bones: Floats,
    radii: Floats,
    pairs: tuple[NDArray[np.intp], NDArray[np.intp]],
    least: Floats,
) -> bool:
    """Least distance between the skins of pairs of phalanges.

    Args:
        bones: Bones [m], shape (n, P, 2, 3).
        radii: Skin radii [m], shape (P,).
        pairs: Numbers of the first phalanges and of the second, shape (M,) each.
        least: The distances [m], shape (n,): written, from all infinite.

    Returns:
        Whether there are such phalanges; nothing was written where there are not.
    """
    for side in pairs:
        for p in side:
            if not 0 <= p < len(radii):
                return False
    middle, half = np.empty((len(radii), 3)), np.empty(len(radii))
    for k in range(len(bones)):
        for p in range(len(radii)):
            x, y, z, u, v, w = line(bones[k, p])
            middle[p, 0], middle[p, 1], middle[p, 2] = x + u / 2, y + v / 2, z + w / 2
            half[p] = sqrt(u * u + v * v + w * w) / 2 + radii[p]
        for i, j in zip(*pairs):  # noqa: B905
            # Spheres around the two first: most pairs are not the nearest.
            x, y, z = (
                middle[i, 0] - middle[j, 0],
                middle[i, 1] - middle[j, 1],
                middle[i, 2] - middle[j, 2],
            )
            reach = half[i] + half[j] + least[k]
            if reach < 0.0 or x * x + y * y + z * z > reach * reach:
                continue
            x, y, z, u, v, w = line(bones[k, i])
            right, ahead, up, a, b, c = line(bones[k, j])
            x, y, z = x - right, y - ahead, z - up
            s, t = parameters(
                u * u + v * v + w * w,
                a * a + b * b + c * c,
                u * a + v * b + w * c,
                u * x + v * y + w * z,
                a * x + b * y + c * z,
            )
            x, y, z = x + s * u - t * a, y + s * v - t * b, z + s * w - t * c
            gap = sqrt(x * x + y * y + z * z) - (radii[i] + radii[j])
            least[k] = min(least[k], gap)
    return True


@compiled
def least_products(
    tangent: NDArray[np.bool_],
    normals: Floats,
    bones: Floats,
    pairs: tuple[NDArray[np.intp], NDArray[np.intp]],
    least: Floats,
) -> None:
    """Least scalar products over tangent phalanges of opposable fingers.

    Args:
        tangent: Which phalanges are tangent, shape (n, P).
        normals: Unit normals at their contacts, shape (n, P, 3).
        bones: Bones [m], shape (n, P, 2, 3) or (1, P, 2, 3).
        pairs: Numbers of the first phalanges and of the second, shape (M,) each.
        least: Those of normals and of unit vectors along the bones, shape (2, n):
            written, from all NaN.
    """
    for k in range(len(tangent)):
        pose, normal = bones[k if len(bones) > 1 else 0], normals[k]
        for i, j in zip(*pairs):  # noqa: B905
            if not (tangent[k, i] and tangent[k, j]):
                continue
            _, _, _, x, y, z = line(pose[i])
            _, _, _, u, v, w = line(pose[j])
            lengths = sqrt((x * x + y * y + z * z) * (u * u + v * v + w * w))
            along = (x * u + y * v + z * w) / lengths
            section = (
                normal[i, 0] * normal[j, 0]
                + normal[i, 1] * normal[j, 1]
                + normal[i, 2] * normal[j, 2]
            )
            # NaN is what is not there yet.
            least[0, k] = least[0, k] if least[0, k] <= section else section
            least[1, k] = least[1, k] if least[1, k] <= along else along
