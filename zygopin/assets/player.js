
  // Plays the motion. The pose at any time follows from that time alone: parts turn and
  // shift evenly between two frames, or stay until the next where frames have labels.
  const motion = scene.motion;
  const times = motion.times;
  const first = times[0];
  const last = times[times.length - 1];
  const packed = Uint8Array.from(atob(motion.poses), (letter) => letter.charCodeAt(0));
  const numbers = new Int32Array(packed.buffer);
  const STRIDE = 7;
  const LONGEST_TICK = 0.5; // s: a slow machine keeps time, a hidden page loses none

  const found = (path) => viewer.scene_tree.find(path.split("/").filter(Boolean)).object;
  const tracks = motion.tracks.map((parts) =>
    parts.map(([path, along]) => ({ object: found(path), along }))
  );
  const latecomers = motion.appearances.map(([path, time]) => ({ object: found(path), time }));

  const glimpses = (motion.glimpses || []).map(([path, spans]) => ({ object: found(path), spans }));

  const element = (id) => document.getElementById(id);
  const button = element("play");
  const slider = element("time");
  const clock = element("clock");
  const mode = element("mode");
  const speed = element("speed");
  const jumps = Array.from(document.querySelectorAll("button[data-time]"), (jump) => ({
    jump,
    time: Number(jump.dataset.time),
  }));

  let now = first;
  let playing = false;
  let ticked = null;
  let awaited = 0;

  // The last of some ascending times that is not after a time, or the first.
  function latest(ascending, time) {
    let low = 0;
    let high = ascending.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (ascending[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  function read(frame, track, position, turn) {
    const start = STRIDE * (frame * tracks.length + track);
    position.fromArray(numbers, start).multiplyScalar(motion.quantum);
    turn.fromArray(numbers, start + 3).normalize();
  }

  const { Vector3, Quaternion } = MeshCat.THREE;
  const [here, there] = [new Vector3(), new Vector3()];
  const [turned, turning] = [new Quaternion(), new Quaternion()];

  function move(time) {
    const frame = latest(times, time);
    const next = Math.min(frame + 1, times.length - 1);
    const span = times[next] - times[frame];
    const share = span > 0 && !motion.labels ? (time - times[frame]) / span : 0;
    tracks.forEach((parts, track) => {
      read(frame, track, here, turned);
      read(next, track, there, turning);
      here.lerp(there, share);
      turned.slerp(turning, share);
      for (const { object, along } of parts) {
        object.quaternion.copy(turned);
        object.position.set(along, 0, 0).applyQuaternion(turned).add(here);
      }
    });
  }

  const inMilliseconds = (time) => (1e3 * time).toFixed(motion.decimals) + "\u00a0ms";
  const clockText = (time) =>
    motion.labels ? motion.labels[latest(times, time)] : inMilliseconds(time);
  const spanTimes = motion.spans.map(([time]) => time);

  function show(time) {
    now = Math.min(Math.max(time, first), last);
    move(now);
    for (const { object, time: from } of latecomers) object.visible = now >= from;
    for (const { object, spans } of glimpses) {
      object.visible = spans.some(([from, until]) => from <= now && now < until);
    }
    const [, name, colour] = motion.spans[latest(spanTimes, now)];
    if (mode.textContent !== name) mode.textContent = name;
    mode.style.backgroundColor = colour;
    clock.textContent = clockText(now);
    slider.value = now;
    slider.setAttribute("aria-valuetext", clock.textContent + ", " + name.toLowerCase());
    for (const { jump, time: from } of jumps) jump.classList.toggle("past", now >= from);
    viewer.set_dirty();
  }

  function tick(instant) {
    const passed = ticked === null ? 0 : (instant - ticked) / 1e3;
    ticked = instant;
    show(now + Math.min(Math.max(passed, 0), LONGEST_TICK) * Number(speed.value));
    if (now >= last) setPlaying(false);
    else awaited = requestAnimationFrame(tick);
  }

  function setPlaying(wanted) {
    if (wanted && now >= last) show(first);
    playing = wanted;
    button.textContent = playing ? "Pause" : now >= last ? "Replay" : "Play";
    cancelAnimationFrame(awaited);
    ticked = null;
    if (playing) awaited = requestAnimationFrame(tick);
  }

  function jumpTo(time) {
    show(time);
    setPlaying(false);
  }

  function step(count) {
    const frame = latest(times, now);
    const between = count < 0 && now > times[frame] ? 1 : 0;
    const target = Math.min(Math.max(frame + count + between, 0), times.length - 1);
    jumpTo(times[target]);
  }

  function onKey(event) {
    const kind = event.target.tagName;
    if (event.ctrlKey || event.metaKey || event.altKey || kind === "SELECT") return;
    const pressed = {
      ArrowLeft: () => step(event.shiftKey ? -10 : -1),
      ArrowRight: () => step(event.shiftKey ? 10 : 1),
      Home: () => jumpTo(first),
      End: () => jumpTo(last),
    };
    if (kind !== "BUTTON") pressed[" "] = () => event.repeat || setPlaying(!playing);
    if (!Object.hasOwn(pressed, event.key)) return;
    event.preventDefault();
    pressed[event.key]();
  }

  // Whether the address names a time: "#t=0.123", in seconds. It is rounded as the
  // frames' times are, so that an event's own time shows the event.
  function obeyAddress() {
    const named = /^#t=([-+0-9.e]+)$/i.exec(location.hash);
    const time = named ? Number(Number(named[1]).toFixed(motion.timeDecimals)) : NaN;
    if (Number.isFinite(time)) jumpTo(time);
    return Number.isFinite(time);
  }

  button.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => jumpTo(Number(slider.value)));
  document.addEventListener("keydown", onKey);
  window.addEventListener("hashchange", obeyAddress);
  for (const { jump, time } of jumps) jump.addEventListener("click", () => jumpTo(time));

  element("player").hidden = false;
  show(first);
  if (!obeyAddress()) {
    setPlaying(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  }
