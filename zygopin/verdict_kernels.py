"""Compiled loops over a block of poses: bones against branches and fingers.

The exact engine's arithmetic in the plane across the branch and in the toes' planes,
without its arrays. A loop runs over the poses and few arrays take part in it, so that
the compiler works on several poses at once.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.clearance import PARALLEL
from zygopin.clearance_kernels import clipped, parameters
from zygopin.compiler import compiled
from zygopin.cross_section import CrossSection
from zygopin.directions import Floats
from zygopin.grasp import PARAMETER_SLACK, Booleans


class Toes(NamedTuple):
    """A foot's constants; P phalanges, F fingers, M pairs that could collide.

    Attributes:
        first: Whether a phalanx is its finger's first, shape (P,).
        finger: Each phalanx's finger, shape (P,).
        lengths: Lengths [m], shape (P,).
        radii: Skin radii [m], shape (P,).
        opposed: Whether two fingers are opposable, shape (F, F).
        pairs: Numbers of the pairs' phalanges, shape (2, M).
        turn: Cosine and sine from the first's azimuth to the second's, shape (2, M).
        least: Least distance of the pairs' bones that is no collision [m], shape (M,).
    """

    first: Booleans
    finger: NDArray[np.intp]
    lengths: Floats
    radii: Floats
    opposed: Booleans
    pairs: NDArray[np.intp]
    turn: Floats
    least: Floats


class Near(NamedTuple):
    """Where bones are nearest to the axes of n branches.

    Attributes:
        t: Position on the line of the bone, shape (P, n).
        away: Distance of the bone from the axis [m], shape (P, n).
        normal: Unit vectors from the axis to there, across it, shape (2, P, n).
    """

    t: Floats
    away: Floats
    normal: Floats


@compiled
def laid(tangent: Floats, toes: Toes, along: Floats, down: Floats) -> None:
    """Bones in the toes' planes, as `directions.cosine_and_sine` has their directions.

    Args:
        tangent: Tangents of half the pitches, shape (P, n).
        toes: The foot.
        along: Horizontal parts of the bones [m], shape (P, n): written.
        down: How far they go down [m], shape (P, n): written.
    """
    for p in range(len(toes.first)):
        length, half, ahead, fall = toes.lengths[p], tangent[p], along[p], down[p]
        for k in range(len(half)):
            ahead[k] = length * (2.0 / (1.0 + half[k] * half[k]) - 1.0)
        for k in range(len(half)):
            fall[k] = length * (half[k] * (2.0 / (1.0 + half[k] * half[k])))


@compiled
def scaled(values: Floats, factors: Floats, out: Floats) -> None:
    """Numbers times factors, n of them or 1, each of shape (n,)."""
    if len(factors) == 1:
        factor = factors[0]
        for k in range(len(values)):
            out[k] = factor * values[k]
    else:
        for k in range(len(values)):
            out[k] = factors[k] * values[k]


@compiled
def seen(along: Floats, down: Floats, section: CrossSection, bones: Floats) -> None:
    """Bones as they lie across the branch: `CrossSection.seen`.

    Args:
        along: Horizontal parts of the bones in the toes' planes [m], shape (P, n).
        down: How far they go down [m], shape (P, n).
        section: The planes across the branches: n of them, or 1.
        bones: The bones across the axis [m], shape (2, P, n): written.
    """
    sunk = np.empty(along.shape[1])
    for p in range(len(along)):
        scaled(along[p], section.across[p], bones[0, p])
        scaled(along[p], section.rise[p], bones[1, p])
        scaled(down[p], section.level, sunk)
        up = bones[1, p]
        for k in range(len(sunk)):
            up[k] -= sunk[k]


@compiled
def across(bones: Floats, centre: Floats, toes: Toes, near: Near) -> None:
    """Where bones are nearest to the axis.

    Args:
        bones: Bones across the axis [m], shape (2, P, n).
        centre: The axes, across and up [m], shape (2, n) or (2, 1).
        toes: The foot.
        near: Written.
    """
    x, y = np.empty(bones.shape[2]), np.empty(bones.shape[2])
    for p in range(len(toes.first)):
        if toes.first[p]:
            x[:], y[:] = -centre[0], -centre[1]
        u, v, t, away = bones[0, p], bones[1, p], near.t[p], near.away[p]
        right, up = near.normal[0, p], near.normal[1, p]
        least = (PARALLEL * toes.lengths[p]) ** 2
        for k in range(len(t)):
            square = u[k] * u[k] + v[k] * v[k]
            t[k] = -(x[k] * u[k] + y[k] * v[k]) / square if square > least else 0.5
        for k in range(len(t)):
            right[k] = x[k] + clipped(t[k]) * u[k]
        for k in range(len(t)):
            up[k] = y[k] + clipped(t[k]) * v[k]
        for k in range(len(t)):
            away[k] = sqrt(right[k] * right[k] + up[k] * up[k])
        for k in range(len(t)):
            right[k] /= away[k]
            up[k] /= away[k]
        for k in range(len(t)):
            x[k] += u[k]
            y[k] += v[k]


@compiled
def met(
    near: Near,
    radius: Floats,
    toes: Toes,
    tolerance: float,
    tangent: Booleans,
    entered: Booleans,
) -> None:
    """Which phalanges are tangent to the infinite branch, and which poses enter it.

    Args:
        near: Where the bones are nearest.
        radius: The branches' radii [m], shape (n,).
        toes: The foot.
        tolerance: Contact tolerance [m].
        tangent: Whether a phalanx is tangent, shape (P, n): written.
        entered: Whether one penetrates, shape (n,): written, from all False.
    """
    for p in range(len(toes.radii)):
        t, away, skin, here = near.t[p], near.away[p], toes.radii[p], tangent[p]
        for k in range(len(t)):
            touching = abs(away[k] - radius[k] - skin) <= tolerance
            here[k] = touching & (abs(t[k] - 0.5) <= 0.5 + PARAMETER_SLACK)
        for k in range(len(t)):
            entered[k] |= away[k] - radius[k] - skin < -tolerance


@compiled
def ended(
    axial: Floats,
    start: Floats,
    toes: Toes,
    near: Near,
    branch: tuple[Floats, Floats, float],
    left: Booleans,
) -> None:
    """Which poses meet the infinite branch where the finite one may have ended.

    Args:
        axial: Bones along the axis [m], shape (P, n).
        start: The base along the axis, from the branch's middle [m], shape (n,).
        toes: The foot.
        near: Where the bones are nearest.
        branch: Radii and half lengths [m], shape (n,), and the tolerance [m].
        left: Whether that is so, shape (n,): written, from all False.
    """
    radius, half, tolerance = branch
    place = start.copy()
    for p in range(len(toes.first)):
        if toes.first[p]:
            place[:] = start
        t, away, reach = near.t[p], near.away[p], toes.radii[p] + tolerance
        for k in range(len(t)):
            bark = away[k] - radius[k]
            over = abs(place[k] + clipped(t[k]) * axial[p, k]) - half[k]
            left[k] |= (over > min(bark, 0.0)) & (bark <= reach)
        for k in range(len(t)):
            place[k] += axial[p, k]


@compiled
def least_products(
    vectors: Floats, tangent: Booleans, weights: Floats, toes: Toes, least: Floats
) -> None:
    """Least scalar products over tangent phalanges of opposable fingers.

    Args:
        vectors: Two parts of a vector for each phalanx, shape (2, P, n); overwritten.
        tangent: Whether it is tangent, shape (P, n).
        weights: What products of first parts count, shape (F, F).
        toes: The foot.
        least: The products, shape (n,): written, from all infinite.
    """
    some = [tangent[p].any() for p in range(len(tangent))]
    for p in range(len(some)):
        one, two, here = vectors[0, p], vectors[1, p], tangent[p]
        if some[p]:
            for k in range(len(least)):
                one[k] = one[k] if here[k] else np.nan  # which is less than nothing
        for q in range(p):
            first, second = toes.finger[p], toes.finger[q]
            if some[p] and some[q] and toes.opposed[first, second]:
                other, another = vectors[0, q], vectors[1, q]
                weight = weights[first, second]
                for k in range(len(least)):
                    product = weight * one[k] * other[k] + two[k] * another[k]
                    least[k] = product if product < least[k] else least[k]


@compiled
def apart(along: Floats, down: Floats, toes: Toes, free: Booleans) -> None:
    """Whether no two fingers collide.

    Args:
        along: Horizontal parts of the bones in the toes' planes [m], shape (P, n).
        down: How far they go down [m], shape (P, n).
        toes: The foot.
        free: The answers, shape (n,): written, from all True.
    """
    place, height = np.zeros_like(along), np.zeros_like(down)
    middle, level = np.empty_like(along), np.empty_like(down)
    for p in range(len(toes.first)):
        if not toes.first[p]:
            place[p] = place[p - 1] + along[p - 1]
            height[p] = height[p - 1] - down[p - 1]
        middle[p] = place[p] + along[p] / 2
        level[p] = height[p] - down[p] / 2
    square = np.empty(len(free))
    for pair in range(len(toes.least)):
        i, j = toes.pairs[0, pair], toes.pairs[1, pair]
        cosine, sine = toes.turn[0, pair], toes.turn[1, pair]
        x, z, u, w = place[i], height[i], along[i], down[i]
        other, deep, v, fall = place[j], height[j], along[j], down[j]
        least = toes.least[pair]
        # The middles first: most pairs are out of reach.
        reach, close = (toes.lengths[i] + toes.lengths[j]) / 2 + least, 0
        for k in range(len(free)):
            ahead, aside = middle[i, k] - cosine * middle[j, k], sine * middle[j, k]
            rise = level[i, k] - level[j, k]
            close += ahead * ahead + aside * aside + rise * rise < reach * reach
        if not close:
            continue
        uu, vv = toes.lengths[i] ** 2, toes.lengths[j] ** 2
        for k in range(len(free)):
            ahead, aside = x[k] - cosine * other[k], -sine * other[k]
            rise = z[k] - deep[k]
            s, t = parameters(
                uu,
                vv,
                cosine * u[k] * v[k] + w[k] * fall[k],
                u[k] * ahead - w[k] * rise,
                v[k] * (cosine * ahead + sine * aside) - fall[k] * rise,
            )
            ahead += s * u[k] - cosine * t * v[k]
            aside -= sine * t * v[k]
            rise += t * fall[k] - s * w[k]
            square[k] = ahead * ahead + aside * aside + rise * rise
        for k in range(len(free)):
            free[k] &= sqrt(square[k]) >= least
