# SPDX-License-Identifier: MIT
"""Viewer in the browser.

    python3 -m clpv.view SCENE [--model PATH] [--port N] [--host ADDRESS]
    clpv.view.show(scene)      the same for a clpv.Scene, also one of meshes in memory

Drag to look round, W A S D Q E to walk, the wheel to move, R to return to the scene's camera.
Frames are small while the camera moves, sharp when it rests, and then nearer to path tracing. Needs
viser: python3 -m pip install viser==1.1.1 (in a virtual environment with --system-site-packages).
"""
import argparse
import collections
import functools
import io
import logging
import math
import os
import socket
import sys
import threading
import time

import clpv
from clpv import view_controls, view_gate

# Distance from the eye to the point that a drag turns the camera about, of the scene's diagonal.
PIVOT = 0.03
PATHS = 16    # paths of a path-traced pixel
# Frames of a view that rests: seconds without a change, height [pixels], rays of the near field.
LEVELS = (0, 288, "2"), (0.3, 720, "4"), (1, 720, "64")
TRACED_AFTER = 1.5    # rest before a view is path-traced [s]
MAX_RENDERERS = 4     # kept, by size and options
RATE_SPAN = 1.0       # [s] of motion that the frame rate is measured over


def size_of(height, aspect):
    """Width and height of a frame; multiples of 8, so that small changes of the window need no new
    renderer."""
    return max(64, min(1920, 8 * round(height * aspect / 8))), height


def camera_of(client):
    """The camera of a browser: x right, y down, z forward, as viser has it."""
    w, x, y, z = client.camera.wxyz
    eye = client.camera.position
    forward = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    down = 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)
    return clpv.Camera(eye=eye, target=[e + f for e, f in zip(eye, forward)], up=[-d for d in down],
                       fov=math.degrees(client.camera.fov))


class Rate:
    """Frames per second over the last second of motion; it stays while the camera rests."""

    def __init__(self):
        self.times, self.shown = collections.deque(), "-"

    def add(self, now):
        """A frame of a moving camera was shown at `now` [s]."""
        self.times.append(now)
        while now - self.times[0] > RATE_SPAN:
            self.times.popleft()
        if len(self.times) > 1:
            self.shown = f"{(len(self.times) - 1) / (now - self.times[0]):.0f}"


class Client:
    """One browser: when its view last changed, and how many of LEVELS it has shown since."""

    def __init__(self, handle):
        self.handle, self.changed, self.shown = handle, time.monotonic(), 0
        self.rate, self.served = Rate(), 0.0  # served: when it last got a frame
        self.image = None  # (image, view, displayed pixels) of its last frame

    def touch(self):
        self.changed, self.shown = time.monotonic(), 0


def next_client(clients, now, traced=False):
    """The client with the fewest levels whose next one is due, of these the one that waits longest;
    or None. traced: path tracing follows the last level."""
    waits = [seconds for seconds, *_ in LEVELS] + [TRACED_AFTER] * traced
    due = [client for client in clients
           if client.shown < len(waits) and now - client.changed >= waits[client.shown]]
    return min(due, key=lambda client: (client.shown, client.served), default=None)


class Interrupted(Exception):
    """A view has changed while another was path-traced."""


class Viewer:
    """`load`: makes the scene again, as it is in its file."""

    def __init__(self, server, scene, device="", load=None):
        self.server, self.scene, self.load = server, scene, load
        self.renderer = functools.lru_cache(MAX_RENDERERS)(
            lambda size, **options: clpv.Renderer(self.scene, device, width=size[0],
                                                  height=size[1], **options))
        self.clients, self.lock, self.wake = {}, threading.Lock(), threading.Event()
        self.frames = 0  # rendered so far
        self.lights, self.sun = scene.lights, None
        server.scene.set_up_direction("+y")
        server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
        self.place(server.initial_camera, scene.cameras[0])
        # Lights that move cannot be assigned: a sun in their place needs a way back.
        has_sun = load is not None or not scene.moves
        self.controls = view_controls.Controls(server, scene, has_sun, self.touch_all)
        self.controls.camera.on_update(self.jump)
        self.controls.back.on_click(self.jump)
        self.controls.copied.on_click(self.copy_camera)
        self.controls.saved.on_click(self.save)
        server.scene.on_click()(self.read_pixel)
        server.gui.add_command("return to the camera", hotkey="R").on_trigger(self.jump)
        server.on_client_connect(self.connect)
        server.on_client_disconnect(self.disconnect)

    def place(self, view, camera):
        """Sets the camera of a browser, or of all new ones."""
        view.position = camera.eye
        towards = [t - e for t, e in zip(camera.target, camera.eye)]
        scale = PIVOT * math.dist(*self.scene.bounds) / math.hypot(*towards)
        view.look_at = tuple(e + scale * t for e, t in zip(camera.eye, towards))
        view.fov = math.radians(camera.fov)

    def jump(self, event):
        camera = next(each for each in self.scene.cameras
                      if each.name == self.controls.camera.value)
        if event.client is not None:
            self.place(event.client.camera, camera)

    def connect(self, handle):
        client = Client(handle)
        with self.lock:
            self.clients[handle.client_id] = client

        def moved(_):
            client.touch()
            self.wake.set()

        handle.camera.on_update(moved)
        self.wake.set()

    def disconnect(self, handle):
        with self.lock:
            self.clients.pop(handle.client_id, None)

    def touch_all(self):
        with self.lock:
            for client in self.clients.values():
                client.touch()
        self.wake.set()

    def copy_camera(self, event):
        if event.client is not None:
            self.controls.said.content = view_controls.text_of(camera_of(event.client))

    def last_frame(self, event):
        client = event.client and self.clients.get(event.client.client_id)
        return client and client.image

    def read_pixel(self, event):
        frame = self.last_frame(event)
        if frame:
            image, view, _ = frame
            self.controls.said.content = view_controls.value_at(image, view, *event.screen_pos)

    def save(self, event):
        frame = self.last_frame(event)
        if frame:
            import imageio.v3  # viser needs it, too
            file = io.BytesIO()
            imageio.v3.imwrite(file, frame[2], extension=".png")
            event.client.send_file_download(f"clpv-{frame[1]}.png", file.getvalue())

    def update_lights(self):
        sun = self.controls.sun_light()
        if sun == self.sun:
            return
        self.sun = sun
        if sun:
            self.scene.lights = [sun]
        elif self.load:
            self.scene = self.load()
            self.renderer.cache_clear()
        else:
            self.scene.lights = self.lights

    def draw(self, client):
        changed, handle = client.changed, client.handle
        client.served = time.monotonic()
        moving = client.shown == 0
        _, height, rays = LEVELS[client.shown]
        size, view = size_of(height, handle.camera.aspect), self.controls.view.value
        self.update_lights()
        renderer = self.renderer(size, **self.controls.options(rays))
        if self.controls.automatic:  # a page's first camera may be anywhere
            self.controls.expose(renderer.render("full", self.scene.cameras[0]))
        image = renderer.render(view, camera_of(handle), time=self.controls.time.value)
        shown = self.send(client, image, view)
        self.frames += 1
        if client.changed == changed:  # else it is old already
            client.shown += 1
        if moving:
            client.rate.add(time.monotonic())
        self.controls.show(renderer.stats, size, client.rate.shown,
                           view_controls.unseen(image, shown))

    def send(self, client, image, view, right=None):
        """Shows an image, in its right half `right` of half the size."""
        diagonal = math.dist(*self.scene.bounds)
        exposure = self.controls.exposure.value
        shown = view_controls.displayed(image, view, exposure, diagonal)
        if right:
            other = view_controls.displayed(right, view, exposure, diagonal)
            half = shown.shape[1] // 2
            shown[:, half:] = other.repeat(2, axis=0).repeat(2, axis=1)[:, half:]
        client.handle.scene.set_background_image(shown, format="jpeg", jpeg_quality=85)
        client.handle.flush()
        client.image = image, view, shown
        return shown

    def trace(self, client):
        """Path-traces the view of a client that rests, and shows it beside the frame."""
        changed, (image, view, _) = client.changed, client.image
        client.shown += 1
        if view == "cells":
            return

        def stop_for_others(_):
            with self.lock:
                due = next_client(self.clients.values(), time.monotonic())
            if due or client.changed != changed:
                raise Interrupted

        bounces = {"1": 1, "2": 2, "all": 0}[self.controls.options("")["bounces"]]
        try:
            right = clpv.pathtrace(
                self.scene, view, camera_of(client.handle), width=image.width // 2,
                height=image.height // 2, bounces=bounces, samples=PATHS,
                time=self.controls.time.value, progress=stop_for_others)
        except Interrupted:
            if client.changed == changed:
                client.shown -= 1
            return
        self.send(client, image, view, right)

    def step(self, wait=0.05):
        """Draws one image if one is due, else waits for a change."""
        self.wake.clear()
        with self.lock:
            client = next_client(self.clients.values(), time.monotonic(),
                                 self.controls.traced.value)
        if client is None:
            self.wake.wait(wait)
            return
        try:
            (self.draw if client.shown < len(LEVELS) else self.trace)(client)
        except clpv.Error as error:
            # Such as options that exclude each other: shown until the next change.
            client.shown = len(LEVELS) + 1
            self.controls.status.content = f"**{error}**"
        except Exception as error:
            # An error of this client alone, which may have left while it was drawn for.
            self.disconnect(client.handle)
            print(f"clpv.view: lost a client: {error!r}", file=sys.stderr)


def show(scene: "clpv.Scene | str | os.PathLike[str]", *,
         model: "str | os.PathLike[str] | None" = None, host: str = "127.0.0.1", port: int = 8080,
         device: str = "") -> None:
    """Shows a scene or a file in the browser until Ctrl-C. Raises clpv.Error, ImportError without
    viser, RuntimeError for another version of it or an address that is taken."""
    import viser  # noqa: F401
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        socket.create_server((host, port), family=family).close()  # viser would take the next port
    except (OSError, OverflowError) as error:
        raise RuntimeError(f"{host}:{port}: {error}; choose another --port or --host") from None
    load = None
    if not isinstance(scene, clpv.Scene):
        load = functools.partial(clpv.Scene, scene, model)
        scene = load()
    clpv.Renderer(scene, device, width=16, height=16).release()  # no page where none can render
    server, path = view_gate.opened(host, port)
    viewer = Viewer(server, scene, device, load)
    address = f"[{host}]" if ":" in host else host
    print(f"clpv.view: http://{address}:{server.get_port()}{path}", flush=True)
    try:
        while True:
            viewer.step()
    except KeyboardInterrupt:
        server.stop()


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python3 -m clpv.view",
                                     description="Shows a scene in the browser.")
    parser.add_argument("scene", help="scene file (.json) or model (.gltf, .glb)")
    parser.add_argument("--model", help="model file instead of the scene file's")
    parser.add_argument("--device", default="",
                        help="OpenCL device: an index, or a part of its name")
    parser.add_argument("--host", default="127.0.0.1",
                        help="address to listen on (default: %(default)s, this machine only)")
    parser.add_argument("--port", type=int, default=8080, help="(default: %(default)s)")
    given = parser.parse_args(arguments)
    logging.basicConfig(format="%(name)s: %(message)s")
    logging.getLogger("clpv").setLevel(logging.INFO)
    try:
        show(given.scene, model=given.model, host=given.host, port=given.port, device=given.device)
    except ImportError:
        sys.exit("clpv.view: viser is not installed; in a virtual environment: "
                 f"python3 -m pip install viser=={view_gate.VISER}")
    except (clpv.Error, RuntimeError) as error:
        sys.exit(f"clpv.view: {error}")
    except KeyboardInterrupt:
        sys.exit(130)  # before the page was there


if __name__ == "__main__":
    main()
