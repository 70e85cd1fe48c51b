"""Trials in MuJoCo of what the programmes predict: pulls, tilts, locked joints."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from holds import EDGES, HARD, SOFT, Bench, Perch, Pull, bench

from zygopin.closure import force_closure
from zygopin.contacts import Friction
from zygopin.load import GRAVITY, PullLimit, pull_limit

SQUEEZE = 5.0
"""Time for which the foot squeezes before a load comes, over T."""

RAMP = 30.0
"""Time in which a load grows, over T."""

PULL_END = 1.5
"""Largest pull that is tried, over the programme's upper bound."""

SLIPPED = 0.1
"""Way of the base that is a slip, over the branch's radius."""

MARKS = (0.0, 0.01, 0.02, 0.05, SLIPPED)
"""Ways of the base at which the programme is asked again, over the radius."""


@dataclass(frozen=True)
class Slip:
    """How a pull ended.

    Attributes:
        force: The pull at which the foot slipped, or the largest that was tried [N].
        held: Whether it did not slip at all.
        bound: The programme's greatest upper bound among poses on the way [N].
        torque_error: Of the servos beside what they were told, root mean square over
            the joints, over their greatest torques.
        lost: Planned contacts that had let go.
        gained: Contacts that were not planned.
    """

    force: float
    held: bool
    bound: float
    torque_error: float
    lost: int
    gained: int


def pulled(pull: Pull, *, squeeze: bool = True, stiffness: float | None = None) -> Slip:
    """Pull ever harder at a foot that squeezes as the programme says, or not."""
    stiffness = stiffness or (SOFT if squeeze else HARD)
    stand = bench(pull.perch, pull.friction, stiffness)
    if squeeze:
        stand.squeeze(pull.perch.needed(pull.limit))
    stand.run(SQUEEZE)
    start, steps = stand.base.xpos.copy(), stand.steps(RAMP)
    bound, marks, force = pull.limit.bound, list(MARKS), 0.0
    for step in range(steps):
        force = PULL_END * pull.limit.bound * (step + 1) / steps
        stand.base.xfrc_applied[:3] = force * pull.direction
        mujoco.mj_step(stand.model, stand.data)
        offset = stand.offset(start)
        if offset >= marks[0]:
            marks.pop(0)
            bound = max(bound, stand.bound(pull.direction))
            if not marks:
                break
    if marks:
        bound = max(bound, stand.bound(pull.direction))
    ranks = {rank for rank, _, _ in stand.touching()}
    planned = set(pull.perch.contacts.phalanges.tolist())
    return Slip(
        force=force,
        held=bool(marks),
        bound=bound,
        torque_error=float(np.sqrt(np.mean(stand.torque_error**2))),
        lost=len(planned - ranks),
        gained=len(ranks - planned),
    )


TILT_SPEED = 0.04
"""Speed at which branch and foot are tilted [rad] over T: gravity turns slowly."""

FALLEN = 0.5
"""Way of the base that is a fall, over the branch's radius."""

CLOSING = 0.5
"""Torque with which every joint closes before it is locked, over its greatest."""

HANGING = 15.0
"""Time for which a locked foot has to hold in each direction of gravity, over T."""

EVERYWHERE = np.vstack([np.eye(3), -np.eye(3)])
"""Directions in which a locked foot is loaded, shape (6, 3)."""


@dataclass(frozen=True, eq=False)
class Body:
    """A bird's body above a perched foot.

    Attributes:
        perch: The foot.
        friction: Friction of its contacts.
        mass: Mass of the body [kg].
        centre: Its centre of mass [m], shape (3,).
    """

    perch: Perch
    friction: float
    mass: float
    centre: np.ndarray

    def limit(self, down) -> PullLimit:
        """What the foot bears of a pull at the body along gravity."""
        strength, contacts = self.perch.strength(self.friction), self.perch.contacts
        return pull_limit(contacts, strength, down, point=self.centre)

    def borne(self, down) -> float:
        """How many of the body's weights the foot bears, at most."""
        return self.limit(down).bound / (GRAVITY * self.mass)

    def needed(self, down) -> np.ndarray:
        """Torques for as many weights as can be borne [N·m], shape (P,)."""
        return self.perch.needed(self.limit(down))

    def attached(self, spec) -> None:
        """Weld the body to the base; it alone has weight."""
        for body in spec.bodies:
            body.gravcomp = 1
        size = 0.2 * self.perch.foot.size
        spec.body("foot").add_body(
            name="body",
            pos=self.centre,
            mass=self.mass,
            inertia=[0.4 * self.mass * size**2] * 3,
            ipos=[0, 0, 0],
            explicitinertial=True,
        )


def random_body(rng, perch, friction=(0.2, 0.9)) -> Body:
    """A body as heavy as a bird's, as feet go, above a foot."""
    return Body(
        perch,
        friction=float(np.exp(rng.uniform(*np.log(friction)))),
        mass=float(perch.weight / GRAVITY * rng.uniform(5, 25)),
        centre=np.array([0, 0, rng.uniform(0.3, 1.2) * perch.foot.size]),
    )


@dataclass(frozen=True)
class Fall:
    """How a tilt ended.

    Attributes:
        slipped: Tilt at which the foot slipped [rad]; π where it did not.
        fell: Tilt at which it fell [rad]; π where it hangs on.
    """

    slipped: float
    fell: float


def tilted(body: Body, axis, limit: float) -> Fall:
    """Turn gravity about an axis until the foot falls.

    It squeezes as the programme says at the limit; where there is none, where the
    weight is borne worst.
    """
    stand = bench(body.perch, body.friction, SOFT, body.attached)
    worst = [limit] if limit < np.pi else np.radians(np.arange(0, 181, 10))
    hardest = min(worst, key=lambda angle: body.borne(_down(axis, angle)))
    stand.squeeze(body.needed(_down(axis, hardest)))
    stand.run(SQUEEZE)
    start, steps = stand.base.xpos.copy(), stand.steps(1)
    slipped, angle = np.pi, 0.0
    for step in range(int((1 + np.pi / TILT_SPEED) * steps)):
        angle = max(0.0, TILT_SPEED * (step / steps - 1))  # the weight comes first
        weight = GRAVITY * min(1.0, step / steps)
        stand.model.opt.gravity[:] = weight * _down(axis, angle)
        mujoco.mj_step(stand.model, stand.data)
        offset = stand.offset(start)
        if offset > SLIPPED:
            slipped = min(slipped, angle)
        if offset > FALLEN:
            return Fall(float(slipped), angle)
    return Fall(float(slipped), float(np.pi))


def _down(axis, angle):
    """Where gravity points as branch and foot turn about an axis, in their frame."""
    down = np.array([0.0, 0.0, -1.0])
    return down * np.cos(angle) - np.sin(angle) * np.cross(axis, down)


@dataclass(frozen=True)
class Lock:
    """How a foot held whose joints were locked.

    Attributes:
        stayed: In which of the directions EVERYWHERE it stayed.
        planned: Whether the planned contacts close by force.
        closed: Whether those do that it had when it was locked.
        grip: Friction's torque about the branch, μ·radius·Σ normal forces when it
            was locked, over that of the weight at its longest lever.
    """

    stayed: tuple[bool, ...]
    planned: bool
    closed: bool
    grip: float


def locked(body: Body, closing: float = CLOSING) -> Lock:
    """Close a foot, lock its joints, and let the body's weight pull everywhere."""
    perch = body.perch

    def change(spec):
        body.attached(spec)
        for joint in perch.joints:
            _add_lock(spec, joint)

    stand = bench(perch, body.friction, HARD, change)
    stand.squeeze(closing * perch.torques)
    stand.run(SQUEEZE)
    _lock(stand)
    stand.run(SQUEEZE)
    friction = Friction(body.friction, EDGES)
    closed = bool(stand.touching()) and force_closure(stand.contacts(), friction)
    branch = perch.plan.branch
    off = stand.base.xpos + body.centre - branch.centre
    lever = np.linalg.norm(np.cross(off, branch.axis))
    torque = body.friction * branch.radius * stand.pressed()
    return Lock(
        stayed=tuple(_stays(stand, down) for down in EVERYWHERE),
        planned=force_closure(perch.contacts, friction),
        closed=closed,
        grip=float(torque / (GRAVITY * body.mass * lever)),
    )


def _lock(stand: Bench) -> None:
    """Hold each joint at the angle where it is, and turn the servos off."""
    for joint, angle in zip(stand.perch.joints, stand.angles(), strict=True):
        lock = stand.model.equality(joint).id
        stand.model.eq_data[lock, 0] = angle
        stand.data.eq_active[lock] = 1
    stand.model.actuator_gainprm[:] = stand.model.actuator_biasprm[:] = 0


def _add_lock(spec, joint):
    """Add what can hold a joint at an angle, as hard as contacts are."""
    lock = spec.add_equality(name=joint, type=mujoco.mjtEq.mjEQ_JOINT, active=False)
    lock.name1, lock.data[:5] = joint, 0
    lock.solref, lock.solimp = spec.geoms[1].solref, spec.geoms[1].solimp


def _stays(stand: Bench, down) -> bool:
    """Whether a foot stays on as gravity comes to act along a direction."""
    before = stand.data.qpos.copy(), stand.data.qvel.copy()
    start, steps = stand.base.xpos.copy(), stand.steps(HANGING)
    fell = False
    for step in range(steps):
        stand.model.opt.gravity[:] = GRAVITY * down * min(1, 3 * step / steps)
        mujoco.mj_step(stand.model, stand.data)
        fell = stand.offset(start) > FALLEN
        if fell:
            break
    stand.model.opt.gravity[:] = 0
    stand.data.qpos[:], stand.data.qvel[:] = before
    mujoco.mj_forward(stand.model, stand.data)
    return not fell
