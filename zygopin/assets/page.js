
"use strict";
(function () {
  const pane = document.getElementById("pane");
  const scene = JSON.parse(document.getElementById("scene").textContent);

  // Fills the pane, which is not the window, and keeps the frame in it whole.
  class PaneViewer extends MeshCat.Viewer {
    set_3d_pane_size() {
      super.set_3d_pane_size(pane.clientWidth, pane.clientHeight);
      this.camera.zoom = Math.min(1, this.camera.aspect / scene.aspect);
      this.set_dirty();
    }
  }

  let viewer;
  try {
    viewer = new PaneViewer(pane);
  } catch (error) {
    pane.textContent = "The scene needs WebGL, which this browser does not offer.";
    return;
  }
  for (const command of scene.commands) {
    const bytes = Uint8Array.from(atob(command), (letter) => letter.charCodeAt(0));
    viewer.handle_command_bytearray(bytes);
  }
  new ResizeObserver(() => viewer.set_3d_pane_size()).observe(pane);
$player})();
