"""A finger seen along axes: distances, slopes, and what the plane across shows."""

from __future__ import annotations

import numpy as np
import pytest
from axes import axes_around, distances, one_finger

from zygopin import Branch, Foot
from zygopin.axis_chain import AxisChain, nearest_on

EVERY = np.arange(12)


def chain_and_controls(foot, seed=0):
    """A foot's last finger before twelve axes, and random controls."""
    axes = axes_around(foot, len(EVERY), seed)
    chain = AxisChain.of(foot, len(foot.fingers) - 1, axes)
    rng = np.random.default_rng(seed)
    return axes, chain, rng.random((chain.count, len(EVERY)))


@pytest.mark.parametrize("name", ["paper", "parrot", "owl"])
def test_distances_are_those_of_the_exact_engine(name):
    foot = Foot.preset(name)
    axes, chain, controls = chain_and_controls(foot)
    padded = np.zeros((len(EVERY), foot.phalanx_count))
    padded[:, -chain.count :] = controls.T
    length = foot.lengths[-chain.count :].sum()
    expected = distances(foot, padded, axes)[:, -1] / length
    np.testing.assert_allclose(chain.distance(controls, EVERY), expected, atol=1e-12)
    gap = chain.contact(controls, EVERY).gap
    np.testing.assert_allclose(gap.min(axis=0), expected, atol=1e-12)


def test_slopes_are_those_of_small_changes():
    foot = one_finger(4, 0.7, 0.3, rho=1.3, omega=1.2)
    _, chain, controls = chain_and_controls(foot, seed=3)
    step, slopes = 1e-6, chain.slopes(chain.contact(controls, EVERY))
    for control in range(chain.count):
        change = step * (np.arange(chain.count) == control)[:, None]
        after = chain.contact(controls + change, EVERY).gap
        before = chain.contact(controls - change, EVERY).gap
        apart = chain.contact(controls, EVERY).gap > 1e-3
        expected = (after - before) / (2 * step)
        np.testing.assert_allclose(
            slopes[:, control][apart], expected[apart], atol=1e-5
        )


def test_a_unit_step_is_projected_between_its_least_and_greatest_length():
    foot = one_finger(1, 0.7)
    chain = AxisChain.of(foot, 0, axes_around(foot, len(EVERY)))
    controls = np.linspace(0, 1, 721) * 2 * np.pi / foot.omega
    for axis in EVERY:
        which = np.full(len(controls), axis)
        steps, _ = chain.steps(controls[None], which)
        assert np.abs(steps).max() == pytest.approx(chain.stretch[axis], abs=1e-5)
        narrow = chain.narrow[axis]
        seen = np.real(steps * np.conj(narrow)).max()
        reach = chain.height(chain.narrow, EVERY)[axis]
        assert seen == pytest.approx(reach, abs=1e-5)
        assert reach == pytest.approx(np.abs(steps).min(), abs=2e-2)


def test_an_axis_in_the_plane_is_no_nearer_than_the_plane():
    foot = one_finger(3)
    beside = Branch(1.0, [(0, 0.3, -0.2), (5, -0.3, 1)], [(0, 0, 1), (1, 0, 2)])
    chain = AxisChain.of(foot, 0, beside)
    np.testing.assert_allclose(chain.off_plane * foot.size, 0.3, rtol=1e-12)
    across = AxisChain.of(foot, 0, Branch(1.0, (0.1, 0.3, -0.2)).broadcast((1,)))
    assert np.all(across.off_plane == 0)


def test_bones_never_pass_the_bound_of_their_plane():
    foot = one_finger(4, 0.2, rho=1.2, omega=2.0)
    nearly = Branch(1.0, (0.0, 2.0, 0.0), [(1, 0.2, 0.01), (0.1, 0, 1), (1, 0.3, 0.2)])
    chain = AxisChain.of(foot, 0, nearly.broadcast((3,)))
    assert np.all(chain.off_plane > 0)
    controls = np.random.default_rng(0).random((4, 3000))
    contact = chain.contact(controls, np.repeat(np.arange(3), 1000))
    assert np.all(contact.gap >= np.repeat(chain.off_plane, 1000, axis=1) - 1e-12)


def test_the_nearest_point_of_a_bone_of_no_length_is_its_start():
    t, point = nearest_on(np.array([1 + 1j]), np.array([0j]))
    assert t[0] == 0
    assert point[0] == 1 + 1j
