"""Controls that bring a finger near an axis, or keep it away: descent from starts.

Each step is the best of a linear model in a box around the controls. For the least D
that of the nearest bone alone; for the greatest, all bones' at once, whose best step is
found by multiplicative weights (Freund and Schapire 1999: a game of steps against
bones).
"""

from __future__ import annotations

import numpy as np

from zygopin.axis_chain import TINY, AxisChain, Contact, Floats, Indices

STARTS = 64
"""Control sequences that are tried for every axis."""

KEPT = 3
"""The best of them, from which descent starts."""

STEPS = 14
"""Steps of a descent: they shrink by a quarter where none is taken."""

ROUNDS = 12
"""Rounds of the game for one step."""

FRACTIONS = np.array([1.0, 0.5, 0.2])
"""Parts of a step that are tried."""


def start_controls(count: int) -> Floats:
    """Control sequences spread over [0, 1]^K: straight, closed, corners, and more.

    Args:
        count: Number of controls K.

    Returns:
        Controls, shape (K, S).
    """
    corners = np.array(np.meshgrid(*[[0.0, 1.0]] * min(count, 5), indexing="ij"))
    corners = corners.reshape(len(corners), -1)
    tail = np.repeat(corners[-1:], count - len(corners), axis=0)
    corners = np.concatenate([corners, tail])
    # Multiples of powers of the root of x^(K+1) = x + 1 fill a cube evenly.
    root = 2.0
    for _ in range(40):
        root = (1 + root) ** (1 / (count + 1))
    ranks = np.arange(1, max(STARTS - corners.shape[1], 8) + 1)
    even = (0.5 + ranks * root ** -np.arange(1.0, count + 1)[:, None]) % 1
    return np.concatenate([corners, even], axis=1)


def first_witnesses(
    chain: AxisChain, sign: float, floor: Floats
) -> tuple[Floats, Floats]:
    """The best controls that descent finds for each axis.

    Args:
        chain: The chains before n axes.
        sign: 1 for the least D, −1 for the greatest.
        floor: Least that sign·D can be, shape (n,): what is there needs no descent.

    Returns:
        Values of D, shape (n,), and controls, shape (K, n).
    """
    starts, axes = start_controls(chain.count), len(chain.base)
    which = np.repeat(np.arange(axes), starts.shape[1])
    value = chain.distance(np.tile(starts, axes), which).reshape(axes, starts.shape[1])
    order = np.argsort(sign * value, axis=1, kind="stable")[:, :KEPT]
    value = np.take_along_axis(value, order, axis=1)
    controls = starts[:, order]
    unmet = np.nonzero(sign * value[:, 0] > floor + chain.rounding)[0]
    tried = controls[:, unmet].reshape(chain.count, KEPT * len(unmet))
    better, found = improved(chain, tried, np.repeat(unmet, KEPT), sign)
    controls[:, unmet] = better.reshape(chain.count, len(unmet), KEPT)
    value[unmet] = found.reshape(len(unmet), KEPT)
    best, row = np.argmin(sign * value, axis=1), np.arange(axes)
    return value[row, best], controls[:, row, best]


def improved(
    chain: AxisChain, controls: Floats, which: Indices, sign: float
) -> tuple[Floats, Floats]:
    """Descent from some controls.

    Args:
        chain: The chains.
        controls: Where to start, shape (K, m).
        which: Index of the axis of each, shape (m,).
        sign: 1 to lessen D, −1 to make it greater.

    Returns:
        Controls, shape (K, m), and their values of D, shape (m,): none is worse than
        its start.
    """
    value, trust = chain.distance(controls, which), np.full(len(which), 0.5)
    for _ in range(STEPS):
        contact = chain.contact(controls, which)
        bounds = np.maximum(-trust, -controls), np.minimum(trust, 1 - controls)
        step = (_nearer if sign > 0 else _farther)(chain, contact, bounds)
        tried = controls[..., None] + step
        tried = np.clip(tried, 0.0, 1.0).reshape(len(controls), -1)
        found = chain.distance(tried, np.repeat(which, step.shape[-1]))
        found = found.reshape(len(which), step.shape[-1])
        best, row = np.argmin(sign * found, axis=1), np.arange(len(which))
        better = sign * found[row, best] < sign * value
        chosen = tried.reshape(step.shape)[:, row, best]
        controls = np.where(better, chosen, controls)
        value = np.where(better, found[row, best], value)
        trust = np.where(better, trust, trust / 4)
    return controls, value


def _nearer(
    chain: AxisChain, contact: Contact, bounds: tuple[Floats, Floats]
) -> Floats:
    """Steps that bring the nearest bone nearer, shape (K, m, S).

    Down the slope as far as the box allows, in parts; and the shortest step that
    would bring the bone onto the axis.
    """
    row = np.arange(contact.gap.shape[1])
    nearest = np.argmin(contact.gap, axis=0)
    slope = chain.slopes(contact)[nearest, :, row].T
    down = np.where(slope > 0, bounds[0], np.where(slope < 0, bounds[1], 0.0))
    distance = contact.gap[nearest, row] + chain.radii[nearest]
    steepest = np.max(np.abs(slope), axis=0)
    sliding = -slope * np.max(np.abs(down), axis=0) / np.maximum(steepest, TINY)
    onto = -slope * distance / np.maximum(np.sum(slope**2, axis=0), TINY)
    return np.concatenate(
        [
            down[..., None] * FRACTIONS,
            sliding[..., None] * FRACTIONS,
            onto[..., None],
        ],
        axis=-1,
    )


def _farther(
    chain: AxisChain, contact: Contact, bounds: tuple[Floats, Floats]
) -> Floats:
    """Steps that take the bones farther, the nearest after the step most, (K, m, S).

    In turn the bones are weighted by how near they stayed, and the step is the best
    for the weights; the mean of the steps tends to the best for the nearest bone.
    """
    slope, gap = chain.slopes(contact), contact.gap
    scale = np.max(np.sum(np.abs(slope) * (bounds[1] - bounds[0]), axis=1), axis=0)
    rate = 2.0 / np.maximum(scale, TINY)
    total, mean = np.zeros_like(gap), np.zeros_like(gap)
    for turn in range(ROUNDS):
        score = rate * (total + gap)
        weight = np.exp(score.min(axis=0) - score)
        pull = np.sum(slope * (weight / weight.sum(axis=0))[:, None], axis=0)
        step = np.where(pull > 0, bounds[1], np.where(pull < 0, bounds[0], 0.0))
        total += gap + np.sum(slope * step, axis=1)
        mean += (step - mean) / (turn + 1)
    return np.asarray(mean[..., None] * FRACTIONS)
