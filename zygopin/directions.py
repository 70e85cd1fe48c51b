"""Where phalanges point: the cosines and sines of their pitch, for a block of poses.

Everything that is linear in them, the junctions or a projection of the bones, is one
product with a matrix of the foot. Poses are columns, phalanges are rows.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.foot import Foot

Floats = NDArray[np.float64]

SERIAL = 2**18
"""Multiplications in a product up to which BLAS stays on the calling thread. Its own
threads would wait for ours."""

FEET = 64
"""Feet whose matrices are kept: tens of kilobytes each, of odd ones some hundreds."""


def directions(foot: Foot, controls: Floats) -> Floats:
    """Cosine and sine of each phalanx's pitch: MODEL.md, section 2.

    Phalanx k lies at v₀ + ω(v₁ + … + vₖ) below the horizontal.

    Args:
        foot: The foot.
        controls: Controls of n poses, shape (n, P).

    Returns:
        Cosines, then sines, shape (2, P, n).
    """
    turns, start = pitch_matrix(foot)
    half = product(turns / 2, controls.T)
    half += start / 2
    return cosine_and_sine(half)


def cosine_and_sine(half: Floats) -> Floats:
    """Both of twice an angle, from its tangent: one function where NumPy takes two.

    cos 2x = 2/(1 + tan²x) − 1, sin 2x = 2·tan x/(1 + tan²x), to rounding for every x:
    at the tangent's poles it is large and finite.

    Args:
        half: Half the angles [rad], shape (…); what is in it is lost.

    Returns:
        Cosines, then sines, shape (2, …).
    """
    tangent = np.tan(half, out=half)
    result = np.empty((2, *tangent.shape))
    cosine, sine = result[0, ...], result[1, ...]
    np.multiply(tangent, tangent, out=cosine)
    cosine += 1
    np.divide(2, cosine, out=cosine)
    np.multiply(tangent, cosine, out=sine)
    cosine -= 1
    return result


def product(matrix: Floats, columns: Floats, out: Floats | None = None) -> Floats:
    """A matrix times many columns, in pieces that keep BLAS on the calling thread.

    Args:
        matrix: The matrix, shape (p, q).
        columns: The columns, shape (q, n).
        out: Where the result goes, shape (p, n), in any layout; None: a new array.

    Returns:
        The result, shape (p, n).
    """
    count = columns.shape[1]
    if out is None:
        out = np.empty((len(matrix), count), matrix.dtype)
    size = max(SERIAL // matrix.size, 1)
    whole = count - count % size
    for part, length in ((slice(0, whole), size), (slice(whole, count), count - whole)):
        if part.start < part.stop:
            pieces = _pieces(columns, part, length)
            np.matmul(matrix, pieces, out=_pieces(out, part, length))
    return out


def _pieces(columns: Floats, part: slice, length: int) -> Floats:
    """Some columns as a view of pieces of a length, shape (pieces, rows, length)."""
    rows = columns[:, part].reshape(len(columns), -1, length)
    pieces: Floats = rows.transpose(1, 0, 2)
    return pieces


@lru_cache(FEET)
def running_sum(foot: Foot) -> Floats:
    """The matrix that adds to each phalanx's row those before it in its finger.

    Args:
        foot: The foot.

    Returns:
        Ones and zeros, shape (P, P), read-only.
    """
    finger = foot.finger_of_phalanx
    matrix: Floats = np.tril(finger[:, None] == finger).astype(float)
    return checks.read_only(matrix)


@lru_cache(FEET)
def pitch_matrix(foot: Foot) -> tuple[Floats, Floats]:
    """What makes pitches out of controls: v₀ + ω(v₁ + … + vₖ).

    Args:
        foot: The foot.

    Returns:
        A matrix for controls, shape (P, P), and what is added, shape (P, 1) [rad].
    """
    start = np.array([finger.orientation for finger in foot.fingers])
    start = start[foot.finger_of_phalanx, None]
    return checks.read_only(running_sum(foot) * foot.omega), checks.read_only(start)
