"""The scene of a strike: its transforms, its bytes, and what a browser plays."""

import base64
import dataclasses
import html
import json
import re

import numpy as np
import pytest
import umsgpack
from browser import visit
from made_strikes import BALL, CONTACT, END, LOCKED, made_strike
from test_scene import HOSTILE, extent, fingers

from zygopin.branch import Branch
from zygopin.closing import Closing
from zygopin.errors import FileError, ParameterError
from zygopin.flight import Flight
from zygopin.foot import Foot
from zygopin.motion import Motion
from zygopin.obstacle import Box, Capsule, ConvexMesh
from zygopin.obstacle_drawing import PREY, obstacle_extent
from zygopin.strike import simulate_strike
from zygopin.strike_caption import outcome_words, slowdown
from zygopin.strike_scene import (
    MODE_PAINTS,
    MOST_FRAMES,
    export_strike,
    framed_since,
    kept_frames,
    phalanx_poses,
    strike_view,
)
from zygopin.trajectory import StrikeEvent

SHOWN = {
    0.0: ("free", (780, 400)),
    CONTACT: ("closing", (390, 844)),
    END: ("locked", (780, 400)),
}
"""When the page is looked at, the mode then, and the window's size [pixels]."""

PANES = {0.0: (440, 300), CONTACT: (390, 420), END: (440, 300)}
"""What of each window is surely the scene: width and height [pixels]."""

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)


STEPS = """
const happens = (target, name) =>
  new Promise((done) => target.addEventListener(name, done, { once: true }));
async function main() {
  const text = document.getElementById("text").textContent;
  const source = JSON.parse(text);
  const plain = document.createElement("iframe");
  plain.srcdoc = source;
  const loaded = happens(plain, "load");
  const calm = document.createElement("iframe");
  document.body.append(plain, calm);
  calm.contentWindow.matchMedia = () => ({ matches: true });
  calm.contentDocument.write(source);
  calm.contentDocument.close();
  await loaded;
  const view = plain.contentWindow, page = plain.contentDocument;
  const find = (id) => page.getElementById(id);
  const state = () => [
    find("play").textContent, find("mode").textContent, Number(find("time").value)];
  const press = (key, target = page.body) => target.dispatchEvent(
    new view.KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
  const goTo = (hash) => {
    view.history.replaceState(null, "", "about:srcdoc" + hash);
    view.dispatchEvent(new view.Event("hashchange"));
  };
  const log = [];
  const note = (name, value) => log.push([name, value]);
  note("loaded", state()[0]);
  note("calm", calm.contentDocument.getElementById("play").textContent);
  press(" "); note("space", state()[0]);
  press("Home"); note("home", state());
  press("ArrowRight"); note("right", state());
  press("ArrowLeft"); note("left", state());
  press("End"); note("end", state());
  press("ArrowRight"); note("beyond", state());
  const jumps = page.querySelectorAll("[data-time]");
  jumps[1].click(); note("jump", state());
  note("past", page.querySelectorAll(".past").length);
  find("time").value = "0.21"; find("time").dispatchEvent(new view.Event("input"));
  note("slide", state());
  goTo("#t=0.123"); note("address", state());
  goTo("#t=nonsense"); note("nonsense", state());
  goTo("#t=0.1799999999999999"); note("nearly", state());
  goTo("#t=9"); note("late", state());
  press(" "); note("again", [state()[0], state()[2] < 0.1]); press(" ");
  note("focus", press(" ", find("play")));
  goTo("#t=0.1");
  let tick;
  view.requestAnimationFrame = (call) => { if (call.name === "tick") tick = call; };
  find("play").click(); tick(1000); tick(1050); note("slow", state());
  tick(9000); note("hidden for long", state());
  find("speed").selectedIndex = 0; tick(9020); note("real", state());
  tick(9520); note("finished", state());
  note("spoken", find("time").getAttribute("aria-valuetext"));
  console.log("steps " + JSON.stringify(log));
}
main();
"""


def scene_of(page):
    """What the page's script reads."""
    data = re.search(r'id="scene">(.*?)</script>', page.read_text("utf-8"), re.DOTALL)
    return json.loads(data[1])


EYE = 2
"""Tracks before the phalanges': of the whole scene, and of the directions."""


def played(scene):
    """Places (n, P, 3) and x axes (n, P, 3) of the phalanges, from the integers."""
    places, along = every_track(scene)
    return places[:, EYE:], along[:, EYE:]


def every_track(scene):
    """Places (n, T, 3) and x axes (n, T, 3) of all tracks, from the file's integers."""
    motion = scene["motion"]
    numbers = np.frombuffer(base64.b64decode(motion["poses"]), "<i4") / 1e6
    numbers = numbers.reshape(len(motion["times"]), len(motion["tracks"]), 7)
    x, y, z, w = np.moveaxis(numbers[..., 3:], -1, 0)
    along = np.stack([w * w + x * x - y * y - z * z, 2 * (x * y + w * z)], -1)
    return numbers[..., :3], np.append(along, 2 * (x * z - w * y)[..., None], -1)


def drawn(scene):
    """Transforms that the solids are drawn with, by the viewer's path."""
    commands = map(umsgpack.unpackb, map(base64.b64decode, scene["commands"]))
    return {
        command["path"]: np.reshape(command["matrix"], (4, 4)).T
        for command in commands
        if command["type"] == "set_transform"
    }


@pytest.fixture(scope="module")
def strike():
    return made_strike()


@pytest.fixture(scope="module")
def page(strike, tmp_path_factory):
    return export_strike(strike, tmp_path_factory.mktemp("strike") / "strike.html")


@pytest.fixture(scope="module")
def gallery(page, tmp_path_factory):
    """One browser that shows the page at several times, in a wide window or a phone."""
    frames = "".join(
        f'<iframe style="border: 0; width: {width}px; height: {height}px" '
        f'src="{page.as_uri()}#t={time}"></iframe>'
        for time, (_, (width, height)) in SHOWN.items()
    )
    sheet = tmp_path_factory.mktemp("sheet") / "sheet.html"
    sheet.write_text(f'<body style="margin: 0; display: flex">{frames}')
    widths, heights = zip(*(size for _, size in SHOWN.values()), strict=True)
    seen = visit(sheet, (sum(widths), max(heights)))
    parts = np.split(seen.pixels, np.cumsum(widths)[:-1], axis=1)
    pictures = {
        time: part[:height]
        for time, part, height in zip(SHOWN, parts, heights, strict=True)
    }
    return seen, pictures


@pytest.fixture(scope="module")
def script(page, tmp_path_factory):
    """What came of using the page's controls, step by step, in another browser."""
    text = json.dumps(page.read_text("utf-8")).replace("<", r"\u003c")
    sheet = tmp_path_factory.mktemp("sheet") / "sheet.html"
    sheet.write_text(
        "<style>iframe { width: 130px; height: 130px }</style><body>"
        f'<script type="application/json" id="text">{text}</script>'
        f"<script>{STEPS}</script>"
    )
    (line,) = visit(sheet, (300, 150)).console
    return dict(json.loads(re.search(r"steps (\[.*\])", line)[1]))


@pytest.mark.parametrize("samples", [131, 3000])
def test_file_holds_the_bones_at_every_event(samples, tmp_path):
    strike = made_strike(samples=samples)
    scene = scene_of(export_strike(strike, tmp_path / "a.html"))
    places, along = played(scene)
    view = strike_view(strike)
    for event in strike.events:
        here = scene["motion"]["times"].index(round(event.time, 9))
        bones = strike.bones[int(np.flatnonzero(strike.times == event.time)[0])]
        starts = view.target + view.unit * places[here]
        ends = starts + strike.foot.lengths[:, None] * along[here]
        np.testing.assert_allclose(starts, bones[:, 0], atol=1e-6 * view.unit)
        np.testing.assert_allclose(ends, bones[:, 1], atol=4e-6 * view.unit)


def test_the_eye_flies_with_the_foot_and_then_stays(tmp_path):
    strike = made_strike()
    scene = scene_of(export_strike(strike, tmp_path / "a.html"))
    assert scene["motion"]["tracks"][:EYE] == [
        [["/meshcat", 0.0]],
        [["/meshcat/axes", 0.0]],
    ]
    places, along = every_track(scene)
    whole, axes = places[:, 0], places[:, 1]
    np.testing.assert_allclose(along[:, :EYE], np.broadcast_to([1, 0, 0], (131, 2, 3)))
    np.testing.assert_allclose(whole, -axes)
    base = strike.base[kept_frames(strike), :3, 3]
    since = framed_since(strike)
    assert 0 < since < len(base) - 1
    assert (whole[since:] == 0).all()
    # Until then the base stays at one place of the picture.
    seen = base[: since + 1] / strike_view(strike).unit + whole[: since + 1]
    np.testing.assert_allclose(seen, np.broadcast_to(seen[-1], seen.shape), atol=2e-6)


def test_a_simulated_strike_is_held_frame_by_frame(tmp_path):
    foot = Foot.preset("owl")
    motion = Motion.through([0, 0.16], [[-0.1, 0, 0.2], [0, 0, 0]])
    closing = Closing("paper", shape=lambda time: 0.2 + 0.8 * time / 0.04)
    strike = simulate_strike(foot, BALL, Flight(motion), closing=closing, frames=60)
    scene = scene_of(export_strike(strike, tmp_path / "a.html"))
    view, (places, along) = strike_view(strike), played(scene)
    starts = view.target + view.unit * places
    ends = starts + foot.lengths[:, None] * along
    assert len(strike.times) == len(places) > len(np.unique(strike.times))
    np.testing.assert_allclose(starts, strike.bones[:, :, 0], atol=1e-6 * view.unit)
    np.testing.assert_allclose(ends, strike.bones[:, :, 1], atol=4e-6 * view.unit)
    names = [name for _, name, _ in scene["motion"]["spans"]]
    assert names == ["FREE", "CLOSING", "LOCKED"]


def test_every_solid_of_the_foot_moves_from_where_it_was_drawn(page):
    scene = scene_of(page)
    first, along = (values[0] for values in played(scene))
    transforms, moved = drawn(scene), []
    for track, parts in enumerate(scene["motion"]["tracks"][EYE:]):
        for path, shift in parts:
            start = first[track] + shift * along[track]
            np.testing.assert_allclose(start, transforms[path][:3, 3], atol=3e-6)
            if "joint" not in path and "base" not in path:
                axis = transforms[path][:3, 0]
                np.testing.assert_allclose(along[track], axis, atol=5e-6)
            moved.append(path)
    assert len(moved) == len(set(moved)) == 14 + 10 + 4 + 1
    own = re.compile(r"/meshcat/foot/(base|\w+/(phalanx\d|joint\d|talon))")
    assert {path for path in transforms if own.fullmatch(path)} == set(moved)


def test_poses_are_turns_and_never_jump(strike):
    frames = np.arange(len(strike.times))
    turns = phalanx_poses(strike, frames)[..., :3, :3]
    unit = np.swapaxes(turns, -1, -2) @ turns
    np.testing.assert_allclose(unit, np.broadcast_to(np.eye(3), unit.shape), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(turns), 1.0)
    assert np.abs(np.diff(turns, axis=0)).max() < 0.2


@pytest.mark.parametrize("samples", [2, 131, 3000])
def test_frames_are_few_and_hold_what_matters(samples):
    strike = made_strike(samples=samples)
    kept = kept_frames(strike)
    assert len(kept) <= MOST_FRAMES
    assert kept[0] == 0
    assert kept[-1] == len(strike.times) - 1
    assert {event.time for event in strike.events} <= {*strike.times[kept].tolist()}
    assert len(kept) == len(strike.times) or np.diff(strike.times[kept]).max() < 0.001
    changes = np.flatnonzero(strike.modes[1:] != strike.modes[:-1])
    assert {*changes, *(changes + 1)} <= {*kept}


def test_contacts_appear_at_their_time(page, strike):
    appear = scene_of(page)["motion"]["appearances"]
    assert [time for _, time in appear] == [CONTACT, 0.18, 0.19]
    places = drawn(scene_of(page))
    view = strike_view(strike)
    for (path, _), event in zip(appear, strike.events, strict=False):
        point = view.target + view.unit * places[path][:3, 3]
        np.testing.assert_allclose(point, event.point, atol=1e-6 * view.unit)


def test_file_is_small_and_repeats(page, strike, tmp_path):
    again = export_strike(strike, tmp_path / "new" / "a.html")
    assert again.read_bytes() == page.read_bytes()
    assert len(page.read_bytes()) < 1_300_000
    crowded = export_strike(made_strike(samples=20_000), tmp_path / "b.html")
    assert crowded.stat().st_size < 1_500_000


def test_words_from_outside_are_text(tmp_path):
    event = StrikeEvent(HOSTILE, CONTACT, HOSTILE, 1)
    strike = made_strike(events=(event,), reading=HOSTILE)
    text = export_strike(strike, tmp_path / "a.html", title=HOSTILE).read_text("utf-8")
    assert "alert(1)</script>" not in text
    assert "<img src=x" not in text
    assert text.count(html.escape(HOSTILE)) >= 6
    assert len(re.findall("(?i)</script", text)) == 3


@pytest.mark.parametrize("other", [None, "a.html", {"times": [0.0]}])
def test_another_type_is_refused_in_one_line(other, tmp_path):
    with pytest.raises(ParameterError, match="is not a StrikeTrajectory") as caught:
        export_strike(other, tmp_path / "a.html")
    assert "\n" not in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_unwritable_file_is_a_file_error(strike, tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(FileError):
        export_strike(strike, tmp_path / "taken" / "a.html")


def test_a_strike_that_meets_nothing_is_shown_too(strike, tmp_path):
    free = made_strike(
        events=(),
        modes=np.full_like(strike.modes, "free"),
        clearance=np.full_like(strike.clearance, 0.1),
        grip=dataclasses.replace(strike.grip, fingers=()),
    )
    text = export_strike(free, tmp_path / "a.html").read_text("utf-8")
    assert "Free at the end: no toe touches the ball" in text
    assert "nothing was met" in text
    assert len(scene_of(tmp_path / "a.html")["motion"]["spans"]) == 1


def test_a_record_of_one_instant_is_shown_too(strike, tmp_path):
    series = ("times", "modes", "controls", "azimuths", "base", "bones", "clearance")
    short = {name: getattr(strike, name)[-1:] for name in series}
    page = export_strike(
        dataclasses.replace(strike, events=(), **short), tmp_path / "a.html"
    )
    assert scene_of(page)["motion"]["times"] == [END]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "2 of 4 toes touch the ball; grasping; feasible"),
        ({"scalar_product": 0.5}, "2 of 4 toes touch the ball; not grasping; feasible"),
        ({"fingers": ()}, "no toe touches the ball; feasible"),
        (
            {"feasible": False},
            "2 of 4 toes touch the ball; grasping; not feasible: toes cross",
        ),
        (
            {"feasible": False, "penetrating": np.ones(14, bool)},
            "2 of 4 toes touch the ball; grasping; "
            "not feasible: a toe is inside the ball",
        ),
    ],
)
def test_the_outcome_is_the_verdict_on_the_grip(strike, changes, words):
    values = {
        "fingers": ("finger1", "finger2"),
        "scalar_product": -0.5,
        "feasible": True,
        "penetrating": np.zeros(14, bool),
        **changes,
    }
    grip = dataclasses.replace(strike.grip, **values)
    ended = dataclasses.replace(strike, grip=grip)
    assert outcome_words(ended) == f"Locked at the end: {words}"


@pytest.mark.parametrize(
    ("duration", "slower"), [(0.35, 20), (0.26, 25), (7.0, 1), (60.0, 1), (0.007, 1000)]
)
def test_the_whole_plays_for_about_seven_seconds(duration, slower):
    assert slowdown(duration) == slower


def test_box_and_mesh_of_its_corners_take_the_same_room():
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    box = Box(np.array([1.0, 2, 3]), np.array([4.0, 5, 6]), turn)
    corners, radius = obstacle_extent(box, (0, 0))
    np.testing.assert_allclose(np.ptp(corners, axis=0), [2, 1, 3])
    np.testing.assert_allclose(corners.mean(axis=0), box.centre)
    same, zero = obstacle_extent(ConvexMesh(corners), (0, 0))
    assert {*map(tuple, same)} == {*map(tuple, corners)}
    assert radius == zero == 0


@pytest.mark.parametrize(
    "obstacle",
    [
        Branch(0.017, (0, 0, -0.018)),
        Branch(0.017, (0, 0, -0.018), (0, 0, 1), 0.03),
        Box(np.array([0.03, 0.05, 0.03]), np.zeros(3)),
        Box(np.array([2.0, 2.0, 0.1]), np.array([0, 0, -0.05])),
        Capsule(0.015, np.array([[0, -0.03, 0], [0, 0.03, 0]])),
        ConvexMesh(0.03 * CUBE),
    ],
)
def test_the_final_foot_is_large_before_any_obstacle(obstacle, tmp_path):
    strike = made_strike(obstacle)
    view = strike_view(strike)
    seen = strike.bones[-1].reshape(-1, 3) @ view.axes[:2].T
    side = np.ptp(seen, axis=0).max() + 2 * strike.foot.radii.max()
    assert side / (16 * view.half_height * view.unit) > 1 / 3
    paths = drawn(scene_of(export_strike(strike, tmp_path / "a.html")))
    assert isinstance(obstacle, ConvexMesh) or any(
        path.startswith(("/meshcat/obstacle", "/meshcat/branch")) for path in paths
    )


def test_page_is_quiet(gallery):
    assert gallery[0].console == ()
    assert gallery[0].requests == ()


def scene_at(gallery, time):
    """The scene's pixels at a time."""
    width, height = PANES[time]
    return gallery[1][time][:height, :width]


@pytest.mark.parametrize("time", [*SHOWN])
def test_mode_and_obstacle_are_seen(gallery, time):
    (wanted, _), (_, height) = SHOWN[time], PANES[time]
    prey = coloured_like_prey(scene_at(gallery, time))
    assert prey > 200 or time == 0.0  # the target comes into sight on the way down
    controls = gallery[1][time][height + 50 : height + 120, 70:200].astype(int)
    badge = {}
    for mode, paint in MODE_PAINTS.items():
        colour = np.array([paint.colour >> shift & 0xFF for shift in (16, 8, 0)])
        badge[mode] = np.sum(np.abs(controls - colour).max(-1) < 8)
    assert max(badge, key=badge.get) == wanted
    assert badge[wanted] > 500


def coloured_like_prey(pixels):
    """How many pixels are of the ball's grey-brown, lit or shaded."""
    red, green, blue = np.moveaxis(pixels.astype(float), -1, 0)
    wanted = [PREY.colour >> shift & 0xFF for shift in (16, 8, 0)]
    near = np.abs(red / green - wanted[0] / wanted[1]) < 0.06
    return np.sum(near & (np.abs(blue / green - wanted[2] / wanted[1]) < 0.06))


def broad(mask):
    """What of a mask is more than a thin line."""
    rows = mask[:-2] & mask[1:-1] & mask[2:]
    return rows[:, :-2] & rows[:, 1:-1] & rows[:, 2:]


def test_the_foot_comes_and_closes(gallery):
    seen = {time: broad(fingers(scene_at(gallery, time)).any(0)) for time in SHOWN}
    shares = {time: mask.mean() for time, mask in seen.items()}
    assert min(shares.values()) > 0.01
    open_wide, shut = (np.ptp(extent(seen[time]), axis=1) for time in (CONTACT, END))
    assert open_wide[0] > 0.85
    assert shut[0] < 0.6


def test_phone_shows_scene_above_controls_above_caption(gallery):
    words = gallery[1][CONTACT][540:]
    assert np.mean(words.min(-1) > 240) > 0.7
    assert np.mean(words.max(-1) < 110) > 0.005


def test_controls_do_what_they_say(script, strike):
    one, last = float(strike.times[1]), ["Replay", "LOCKED", END]
    rounded = {
        name: [*value[:2], round(value[2], 9)]
        if isinstance(value, list) and len(value) == 3
        else value
        for name, value in script.items()
    }
    assert rounded == {
        "loaded": "Pause",
        "calm": "Play",
        "space": "Play",
        "home": ["Play", "FREE", 0],
        "right": ["Play", "FREE", one],
        "left": ["Play", "FREE", 0],
        "end": last,
        "beyond": last,
        "jump": ["Play", "CLOSING", 0.18],
        "past": 2,
        "slide": ["Play", "LOCKED", LOCKED],
        "address": ["Play", "FREE", 0.123],
        "nonsense": ["Play", "FREE", 0.123],
        "nearly": ["Play", "CLOSING", 0.18],
        "late": last,
        "again": ["Pause", True],
        "focus": True,
        "slow": ["Pause", "FREE", 0.102],
        "hidden for long": ["Pause", "FREE", 0.122],
        "real": ["Pause", "FREE", 0.142],
        "finished": last,
        "spoken": f"{1e3 * END:.1f}\u00a0ms, locked",
    }
