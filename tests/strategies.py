"""Hypothesis strategies for feet and their controls."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from zygopin.foot import Finger, Foot

TRICKY_NAMES = ("true", "no", "inf", "nan", "e1", "pi", "none", "foot", "file", "rho")
"""Names that YAML, XML or xacro could take for something else."""


def reals(low, high):
    """Finite floats in [low, high], without subnormal ones."""
    return st.floats(low, high, allow_subnormal=False)


@st.composite
def fingers(draw, name):
    """A finger of a given name, anywhere, of up to five phalanges."""
    turn = reals(-math.pi, 2 * math.pi)
    return Finger(
        name=name,
        phalanges=draw(st.integers(1, 5)),
        azimuth=draw(turn),
        orientation=draw(st.just(0.0) | reals(-1.0, 1.0)),
        splay_gain=draw(st.integers(-1, 1)),
        reversed_azimuth=draw(st.none() | turn),
    )


@st.composite
def feet(draw):
    """A foot of one to five fingers, of any size that a foot may have."""
    scale = 10.0 ** draw(reals(-6, 6))
    names = st.sampled_from(TRICKY_NAMES) | st.from_regex(r"\A[a-z][a-z0-9_]{0,8}\Z")
    chosen = draw(st.lists(names, min_size=1, max_size=5, unique=True))
    return Foot(
        rho=draw(reals(1.01, 3.0)),
        omega=draw(reals(0.05, 2 * math.pi - 0.05).filter(lambda x: x != math.pi)),
        splay=draw(reals(0.0, 1.5)),
        scale=scale,
        thickness=draw(st.just(0.0) | reals(0.0, 0.9).map(lambda x: x * scale)),
        density=draw(reals(1.0, 1e4)),
        fingers=tuple(draw(fingers(name)) for name in chosen),
        name=draw(names),
    )


def controls_for(foot, batch=()):
    """Controls in [0, 1] for a foot, of shape (*batch, P)."""
    shape = (*batch, foot.phalanx_count)
    return hnp.arrays(np.float64, shape, elements=reals(0.0, 1.0), fill=st.nothing())


def omegas():
    """Largest joint angles that are allowed [rad]."""
    return reals(0.05, 2 * math.pi - 0.05).filter(lambda x: x != math.pi)


def level_sets(most=5):
    """A number of equal levels, or a few levels of [0, 1]."""
    few = st.lists(reals(0.0, 1.0), min_size=1, max_size=most, unique=True)
    return st.integers(2, most) | few


def planar_points(reach=2.5):
    """Points x + iz in a square around the base."""
    part = reals(-reach, reach)
    return st.builds(complex, part, part)
