"""The words around an owl's strike: its caption, its events, its controls."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape

import numpy as np

from zygopin.caption import Key, Lengths, foot_rows, legend, ratio, section
from zygopin.obstacle import obstacle_noun
from zygopin.obstacle_drawing import obstacle_rows
from zygopin.playback import Span, clock_decimals, page_time, player_controls
from zygopin.trajectory import EventKind, StrikeEvent, StrikeTrajectory

EVENT_WORDS: dict[EventKind, str] = {
    "engaged": "first contact",
    "stopped": "stopped",
    "crossed": "met a toe",
    "locked": "locked",
    "released": "released",
}

READING_WORDS = {
    "paper": "paper (toes pass)",
    "contact": "contact (toes stop)",
}

SHOWN_FOR = 7.0
"""How long the whole motion plays, about [s]."""

ROUND = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Round numbers within a factor of ten, each at most a third above the last."""

NOWHERE = "–"
HINT = (
    "Space plays and pauses, the arrow keys step from frame to frame, "
    "an event's time jumps to it."
)


def outcome_words(trajectory: StrikeTrajectory) -> str:
    """How a strike ended, in one line.

    Args:
        trajectory: The strike.

    Returns:
        Plain text.
    """
    grip, noun = trajectory.grip, obstacle_noun(trajectory.obstacle)
    mode, count = str(trajectory.modes[-1]).capitalize(), len(trajectory.foot.fingers)
    held = (
        f"{len(grip.fingers)} of {count} toes touch"
        if grip.fingers
        else "no toe touches"
    )
    words = [f"{mode} at the end: {held} the {noun}"]
    if grip.fingers:
        words.append("grasping" if grip.grasping else "not grasping")
    if grip.penetrating.any():
        words.append(f"not feasible: a toe is inside the {noun}")
    else:
        words.append("feasible" if grip.feasible else "not feasible: toes cross")
    return "; ".join(words)


def strike_caption(
    trajectory: StrikeTrajectory, title: str, colour: str, colours: Iterable[Key]
) -> str:
    """The caption as HTML, every text escaped.

    Args:
        trajectory: The strike.
        title: The scene's title, as plain text.
        colour: The final mode's CSS colour.
        colours: What the colours stand for.

    Returns:
        HTML.
    """
    foot, obstacle = trajectory.foot, trajectory.obstacle
    words = escape(outcome_words(trajectory))
    noun = obstacle_noun(obstacle).capitalize()
    return "\n".join(
        (
            f"<h1>{escape(title)}</h1>",
            f'<p class="verdict" style="border-color: {escape(colour)}">{words}</p>',
            _event_table(trajectory),
            legend(colours),
            section("Strike", strike_rows(trajectory)),
            section(noun, obstacle_rows(obstacle, foot.size)),
            section("Foot", foot_rows(foot)),
            f'<p class="hint">{escape(HINT)}</p>',
        )
    )


def strike_rows(trajectory: StrikeTrajectory) -> dict[str, str]:
    """What was simulated, and what came of it, name by value.

    Args:
        trajectory: The strike.

    Returns:
        Plain texts.
    """
    lengths = Lengths(trajectory.foot.size)
    least = float(np.min(trajectory.clearance[-1]))
    inside = bool(np.any(trajectory.grip.penetrating))
    return {
        "Reading": READING_WORDS.get(trajectory.reading, trajectory.reading),
        "Lasts": _milliseconds(trajectory, trajectory.times[-1] - trajectory.times[0]),
        "Largest penetration" if inside else "Least clearance": lengths(
            abs(least) if inside else least
        ),
        "Between fingers": lengths(float(trajectory.grip.finger_clearance)),
        "Scalar product": ratio(float(trajectory.grip.scalar_product)),
        "Tolerance": f"{trajectory.tolerance * 1e3:.1e} mm",
    }


def controls(trajectory: StrikeTrajectory, spans: Sequence[Span]) -> str:
    """The player's controls as HTML: a slider with marks, a button, mode and speed.

    Args:
        trajectory: The strike.
        spans: Its modes over time.

    Returns:
        HTML; hidden until the page's script shows it.
    """
    times = trajectory.times
    speeds = _speeds(page_time(times[-1]) - page_time(times[0]))
    marks = (event.time for event in trajectory.events)
    return player_controls((times[0], times[-1]), spans, marks, speeds)


def slowdown(duration: float) -> float:
    """How many times slower than life a motion plays at first.

    Args:
        duration: How long it lasts [s].

    Returns:
        A round number, at least 1, for which it plays about seven seconds.
    """
    wanted = SHOWN_FOR / max(duration, 1e-6)
    steps = [step * 10.0**power for power in range(8) for step in ROUND]
    whole = [step for step in steps if step == int(step)]
    return min(whole, key=lambda step: abs(math.log(step / wanted)))


def _speeds(duration: float) -> str:
    """The choice of speeds: the first one, and round ones around it."""
    first = slowdown(duration)
    steps = [step * 10.0**power for power in range(8) for step in (1, 2, 5)]
    chosen = {first, *(step for step in steps if step <= 5 * first)}
    return "".join(
        f'<option value="{1 / step!r}"{" selected" if step == first else ""}>'
        f"{'real time' if step == 1 else f'1/{step:.0f} speed'}</option>"
        for step in sorted(chosen)
    )


def _event_table(trajectory: StrikeTrajectory) -> str:
    """What happened, each with a button that jumps there."""
    if not trajectory.events:
        return "<section><h2>Events</h2><p>None: nothing was met.</p></section>"
    head = "".join(
        f'<th scope="col">{name}</th>' for name in ("Time", "Event", "Toe", "Phalanx")
    )
    rows = "".join(_event_row(trajectory, event) for event in trajectory.events)
    return (
        '<section><h2>Events</h2><table class="events">'
        f"<thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></section>"
    )


def _event_row(trajectory: StrikeTrajectory, event: StrikeEvent) -> str:
    """One event."""
    words = EVENT_WORDS.get(event.kind, event.kind)
    time = _milliseconds(trajectory, event.time)
    button = (
        f'<button type="button" data-time="{page_time(event.time)}" '
        f'aria-label="Jump to {escape(time)}: {escape(words)}">{escape(time)}</button>'
    )
    toe = NOWHERE if event.finger is None else event.finger
    phalanx = NOWHERE if event.phalanx is None else str(event.phalanx)
    texts = "".join(f"<td>{escape(text)}</td>" for text in (words, toe, phalanx))
    return f"<tr><td>{button}</td>{texts}</tr>"


def _milliseconds(trajectory: StrikeTrajectory, seconds: float) -> str:
    """A time as a text."""
    return f"{1e3 * seconds:.{clock_decimals(trajectory.times)}f}\u00a0ms"
