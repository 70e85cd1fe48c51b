"""Routes to clearances and verdicts: exact, FCL, coal, sampling; batch and single."""

from __future__ import annotations

from collections.abc import Sequence

import coal
import numpy as np

from differ.comparison import Booleans, Comparison, close, same
from differ.draw import Draw, Size
from differ.route import Route
from zygopin import Branch, Foot, check_grasp, collision, grasp_verdicts, make_engine
from zygopin.clearance import Floats, dot, norm
from zygopin.grasp import PARAMETER_SLACK, GraspReport, least_gap

ULPS = 32
"""Rounding of a distance, in units of the last place of the lengths that go into it."""

EPS = float(np.finfo(float).eps)

VERDICTS = ("stable", "grasping", "feasible")


def rounding(foot: Foot, branch: Branch) -> Floats:
    """What rounding may change a clearance by [m], shape (…, 1).

    Lengths of the foot's size and of the branch's extent are subtracted.
    """
    extent = np.asarray(branch.radius) + norm(branch.centre)
    return np.asarray(ULPS * EPS * (foot.size + extent))[..., None]


def determined(report: GraspReport) -> Floats:
    """How well a nearest point on a bone is determined, shape (…, P).

    Junctions are rounded, so a bone's direction is the less sure the shorter it is;
    that moves the nearest point with the distance from the axis as its lever, and the
    more the nearer to parallel bone and axis are.
    """
    lines = report.bones[..., 1, :] - report.bones[..., 0, :]
    size = norm(lines)
    sine = norm(np.cross(report.branch.axis[..., None, :], lines)) / size
    reach = np.maximum(_reach(report), report.foot.size)
    return np.asarray(sine**2 * size / reach)


def _reach(report: GraspReport) -> Floats:
    """Distances of bones from axes [m], shape (…, P)."""
    radius = np.asarray(report.branch.radius)[..., None]
    return np.asarray(report.clearance + report.foot.radii + radius)


def sure(report: GraspReport) -> Booleans:
    """Poses of which no verdict is within rounding of its threshold, shape (…)."""
    foot, branch = report.foot, report.branch
    band = rounding(foot, branch)
    clear = np.abs(np.abs(report.clearance) - report.tolerance) > band
    lengths = np.maximum(foot.lengths * determined(report), TINY)
    off = np.abs(np.abs(report.t - 0.5) - 0.5 - PARAMETER_SLACK)
    clear &= ~report.touching | (off > band / lengths)
    gap = report.finger_clearance - least_gap(foot, report.tolerance)
    apart = np.abs(gap) > band[..., 0]
    # Normals turn by the rounding over the radius.
    turn = 2 * band[..., 0] / np.asarray(branch.radius)
    product = np.nan_to_num(report.scalar_product, nan=1.0)
    decided = np.abs(product - PARAMETER_SLACK) > turn
    return np.asarray(clear.all(axis=-1) & apart & decided)


def against_fcl(drawn: Draw) -> Sequence[Comparison]:
    """Whole reports: the exact engine, and URDF, Pinocchio and FCL."""
    foot, branch = drawn.foot, drawn.branch
    exact = check_grasp(foot, drawn.controls, branch)
    engine = make_engine("fcl", foot)
    other = check_grasp(foot, drawn.controls, branch, engine=engine)
    lost, steady = _blurred(exact), _determined_by_fcl(exact)
    within = rounding(foot, branch) + lost
    reach = _reach(exact)
    one, two = (
        np.concatenate([each.point, reach[..., None] * each.normal], axis=-1)
        for each in (exact, other)
    )
    fingers = exact.finger_clearance, other.finger_clearance
    decided = sure(exact) & ~lost.any(axis=-1)
    return (
        close("clearance: exact / FCL", exact.clearance, other.clearance, within),
        close("nearest points: exact / FCL", one, two, (within / steady)[..., None]),
        close("fingers apart: exact / FCL", *fingers, rounding(foot, branch)[:, 0]),
        *(
            same(
                f"{name}: exact / FCL",
                getattr(exact, name),
                getattr(other, name),
                decided,
            )
            for name in VERDICTS
        ),
    )


def _determined_by_fcl(report: GraspReport) -> Floats:
    """The same of the branch's nearest points, and by FCL, shape (…, P).

    A bone that nearly meets the axis hardly says where around it the point lies; and
    FCL's normals are those of the gap to a slim capsule, which may nearly vanish.
    """
    radius = np.asarray(report.branch.radius)[..., None]
    reach = np.maximum(_reach(report), TINY)
    gap = np.abs(report.clearance + (1 - collision.SHRUNK) * radius)
    around = reach / (reach + radius + report.foot.radii)
    share = determined(report) * around * gap / (reach + gap)
    return np.asarray(np.maximum(share, TINY))


TINY = 1e-300
"""Least value of what may vanish below a fraction."""

REACH = 4.0
"""Half-length of coal's capsule that stands for a branch, over the foot's size."""


def against_coal(drawn: Draw) -> Sequence[Comparison]:
    """Clearances by coal's capsules, in units of the foot."""
    foot, branch = drawn.foot, drawn.branch
    exact = check_grasp(foot, drawn.controls, branch)
    bones, skin = exact.bones / foot.size, foot.radii / foot.size
    # Long capsules for the branches, their middles next to the base.
    middle = branch.centre - dot(branch.centre, branch.axis)[:, None] * branch.axis
    ends = np.array([[-REACH], [REACH]]) * branch.axis[:, None]
    stems = _capsules(
        middle[:, None] / foot.size + ends, np.divide(branch.radius, foot.size)
    )
    toes = _capsules(bones.reshape(-1, 2, 3), np.resize(skin, exact.clearance.size))
    found = np.empty(exact.clearance.size)
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    for place, toe in enumerate(toes):
        result.clear()
        stem = stems[place // foot.phalanx_count]
        found[place] = coal.distance(*toe, *stem, request, result)
    found = found.reshape(exact.clearance.shape) * foot.size
    within = rounding(foot, branch) + _blurred(exact)
    return (close("clearance: exact / coal", exact.clearance, found, within),)


PARALLEL = 200 * EPS
"""Squared length of a bone across the axis, over the foot's size, below which FCL and
coal may take the two for parallel: determinants, or squared lengths, below 100 ulp."""


def _blurred(report: GraspReport) -> Floats:
    """What FCL and coal lose at bones that they take for parallel to the axis, (…, P).

    They then take any of a bone's points for the nearest: in metres, its length across.
    """
    lines = report.bones[..., 1, :] - report.bones[..., 0, :]
    across = norm(np.cross(report.branch.axis[..., None, :], lines))
    parallel = across**2 <= PARALLEL * report.foot.size**2
    return np.where(parallel, across, 0.0)


def _capsules(
    bones: Floats, radii: Floats
) -> list[tuple[coal.Capsule, coal.Transform3s]]:
    """Segments (n, 2, 3) with radii (n,), and where they are."""
    line = bones[:, 1] - bones[:, 0]
    length = norm(line)
    axis = line / length[:, None]
    aside = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis), axis=1)])
    aside /= norm(aside)[:, None]
    turn = np.stack([aside, np.cross(axis, aside), axis], axis=2)
    places = map(coal.Transform3s, turn, bones.mean(axis=1))
    return [*zip(map(coal.Capsule, radii, length), places, strict=True)]


END_ACCURACY = 3e-2
"""FCL's capsule against capped cylinder, over the foot's size: 3e-7 in the median, a
tail to 8e-3. Its iteration, not rounding, sets it."""

SAMPLED = 1e-9
"""Accuracy of the least value found by sampling, over the foot's size and the
branch's: a slope of 1 within an interval that shrinks to this."""


def against_ends(drawn: Draw) -> Sequence[Comparison]:
    """Branches with ends: the exact engine, FCL's capped cylinder, and sampling."""
    foot, rng = drawn.foot, drawn.rng
    length = foot.size * 10 ** rng.uniform(-1, 0.5, len(drawn.controls))
    branch = Branch(drawn.branch.radius, drawn.branch.centre, drawn.branch.axis, length)
    exact = check_grasp(foot, drawn.controls, branch)
    near = collision.branch_clearance(exact.bones, foot.radii, branch)
    # Inside, FCL's depth is that of a way out, the exact one that of the deepest point.
    deep = (exact.clearance < -foot.radii) | (near.distance < -foot.radii)
    by_fcl = np.where(deep, exact.clearance, near.distance)
    sampled = _least(exact.bones, branch) - foot.radii
    extent = (foot.size + np.asarray(branch.radius) + norm(branch.centre))[:, None]
    return (
        close("clearance: exact / FCL", exact.clearance, by_fcl, END_ACCURACY * extent),
        close("clearance: exact / sampled", exact.clearance, sampled, SAMPLED * extent),
    )


SAMPLES, ROUNDS = 17, 12
"""Points looked at in each round, each an eighth as wide: 8^-12 is 1e-11."""


def _least(bones: Floats, branch: Branch) -> Floats:
    """Least signed distance of bones to capped cylinders, convex along each, (n, P)."""
    start, line = bones[:, :, 0], bones[:, :, 1] - bones[:, :, 0]
    low = np.zeros(start.shape[:2])
    width, best = np.ones_like(low), np.full(low.shape, np.inf)
    for _ in range(ROUNDS):
        t = low[..., None] + width[..., None] * np.linspace(0, 1, SAMPLES)
        t = np.minimum(t, 1.0)
        points = start[:, :, None] + t[..., None] * line[:, :, None]
        values = _signed(points, branch)
        place = np.argmin(values, axis=-1)[..., None]
        best = np.minimum(best, np.take_along_axis(values, place, -1)[..., 0])
        low = np.take_along_axis(t, np.maximum(place - 1, 0), -1)[..., 0]
        width = width / 8
    return best


def _signed(points: Floats, branch: Branch) -> Floats:
    """Signed distance of points (n, P, m, 3) to the solids, by its definition."""
    offset = points - branch.centre[:, None, None]
    axis = branch.axis[:, None, None]
    along = dot(offset, axis)
    side = norm(offset - along[..., None] * axis) - np.reshape(
        branch.radius, (-1, 1, 1)
    )
    end = np.abs(along) - branch.half_length[:, None, None]
    outside = np.hypot(np.maximum(side, 0), np.maximum(end, 0))
    return np.asarray(outside + np.minimum(np.maximum(side, end), 0))


SINGLES = 20
"""Poses that are checked one by one as well."""


def batch_and_single(drawn: Draw) -> Sequence[Comparison]:
    """Verdicts for all at once, on two threads; reports in blocks, and one by one."""
    foot, branch, controls = drawn.foot, drawn.branch, drawn.controls
    quick = grasp_verdicts(foot, controls, branch, threads=2)
    report = check_grasp(foot, controls, branch)
    single = [check_grasp(foot, controls[i], branch[i]) for i in range(SINGLES)]
    decided, few = sure(report), slice(SINGLES)
    within = rounding(foot, branch)[few]
    alone = np.array([each.clearance for each in single])
    found = [close("clearance: report / single", report.clearance[few], alone, within)]
    for name in VERDICTS:
        told = getattr(report, name)
        alone = np.array([getattr(each, name) for each in single])
        found += [
            same(f"{name}: batch / report", getattr(quick, name), told, decided),
            same(f"{name}: report / single", told[few], alone, decided[few]),
        ]
    return found


def by_loops(drawn: Draw) -> Sequence[Comparison]:
    """The engine fast: reports and verdicts, for branches with ends too."""
    foot, branch, controls = drawn.foot, drawn.branch, drawn.controls
    if drawn.rng.random() < 0.5:
        length = foot.size * 10 ** drawn.rng.uniform(-1, 0.5, len(controls))
        branch = Branch(branch.radius, branch.centre, branch.axis, length)
    report = check_grasp(foot, controls, branch)
    other = check_grasp(foot, controls, branch, engine="fast")
    quick = grasp_verdicts(foot, controls, branch, engine="fast", threads=2)
    within, decided = rounding(foot, branch), sure(report)
    fingers = report.finger_clearance, other.finger_clearance
    found = [
        close("clearance: exact / fast", report.clearance, other.clearance, within),
        close("fingers apart: exact / fast", *fingers, within[:, 0]),
    ]
    for name in VERDICTS:
        told = getattr(report, name)
        for each, way in ((other, "report"), (quick, "verdicts")):
            title = f"{name}: exact / fast {way}"
            found.append(same(title, told, getattr(each, name), decided))
    return found


STATED = f"{ULPS} ulp of the foot's size and the branch's extent: rounding"

PARALLEL_LOSS = "the length across, below 2e-7, of what they take for parallel"

ROUTES = (
    Route(
        "grasp-fcl",
        "whole reports: exact / URDF, Pinocchio and FCL's capsules",
        f"{STATED}; {PARALLEL_LOSS}; verdicts alike",
        against_fcl,
        Size(poses=200),
    ),
    Route(
        "clearance-coal",
        "clearances: exact / coal's capsules",
        f"{STATED}; {PARALLEL_LOSS}",
        against_coal,
        Size(poses=400),
    ),
    Route(
        "clearance-ends",
        "clearances of branches with ends: exact / sampling / FCL's capped cylinder",
        f"{SAMPLED:g} of the extents (sampling), {END_ACCURACY:g} (FCL's iteration)",
        against_ends,
        Size(poses=100),
    ),
    Route(
        "verdicts-batch",
        "grasp_verdicts / check_grasp in a batch / one by one",
        f"alike, but within {ULPS} ulp of a threshold",
        batch_and_single,
        Size(poses=12000),
    ),
    Route(
        "verdicts-fast",
        "check_grasp and grasp_verdicts: exact / compiled loops, with and without ends",
        f"{STATED}; verdicts alike",
        by_loops,
        Size(poses=4000),
    ),
)
"""Routes to clearances and verdicts."""
