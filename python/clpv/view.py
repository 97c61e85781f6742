# SPDX-License-Identifier: MIT
"""Viewer in the browser: python3 -m clpv.view SCENE [--model PATH] [--port N] [--host ADDRESS]

Drag to look round, W A S D Q E to walk, the wheel to move, R to return to the scene's camera.
Frames are small while the camera moves, sharp when it rests, and then nearer to path tracing. Needs
viser: python3 -m pip install viser==1.1.1 (in a virtual environment with --system-site-packages).
"""
import argparse
import collections
import math
import socket
import sys
import threading
import time

import clpv
from clpv import view_gate

VIEWS = "full", "direct", "indirect", "irradiance", "albedo", "normal", "depth", "cells"
STAGES = ("rasterize-camera", "rasterize-shadow", "rasterize-rsm", "inject-light", "blockers",
          "visibility", "propagate", "gather", "near-trace", "near", "medium", "shade")
# Frames of a view that rests: seconds without a change, height [pixels], rays of the near field.
LEVELS = (0, 288, "2"), (0.3, 720, "4"), (1, 720, "64")
MAX_RENDERERS = 4     # kept, by size and options
RATE_SPAN = 1.0       # [s] of motion that the frame rate is measured over
# Distance from the eye to the point that a drag turns the camera about, of the scene's diagonal.
PIVOT = 0.03


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


def sun_direction(azimuth, elevation):
    """Direction of the light of a sun at these angles [degrees]."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return -math.cos(e) * math.sin(a), -math.sin(e), -math.cos(e) * math.cos(a)


class Renderers:
    """Renderers by size and options; the ones used last are kept."""

    def __init__(self, scene, device):
        self.scene, self.device, self.kept = scene, device, collections.OrderedDict()

    def get(self, size, options):
        key = size, tuple(sorted(options.items()))
        if key not in self.kept:
            while len(self.kept) >= MAX_RENDERERS:
                self.kept.popitem(last=False)
            self.kept[key] = clpv.Renderer(self.scene, self.device, width=size[0], height=size[1],
                                           **options)
        self.kept.move_to_end(key)
        return self.kept[key]


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


class Controls:
    """The panel beside the image. Clients share it."""

    def __init__(self, server, gate, scene, changed):
        self.lights = scene.lights
        gui = server.gui

        def choice(name, values, initial):
            return gate.allow(gui.add_dropdown(name, values, initial_value=initial),
                              lambda value: value in values)

        def checkbox(name, initial=False):
            return gate.allow(gui.add_checkbox(name, initial_value=initial),
                              lambda value: isinstance(value, bool))

        def slider(name, low, high, step, initial, **more):
            return gate.allow(gui.add_slider(name, low, high, step, initial_value=initial, **more),
                              lambda value: view_gate.is_number(value, low, high))

        defaults = {option["name"]: option["value"] for option in clpv.options()}
        self.status = gui.add_markdown("starting")
        self.view = choice("view", VIEWS, "full")
        self.basis = choice("basis", clpv.bases(), defaults["basis"])
        self.transport = choice("transport", ("sweep", "exact", "sampled"), defaults["transport"])
        self.near = checkbox("near field", True)
        self.exposure = slider("exposure [EV]", -10, 10, 0.25, max(-10, min(10, scene.exposure)))
        self.time = slider("time [s]", 0, 20, 0.05, 0, visible=scene.moves)
        with gui.add_folder("sun"):
            self.sun = checkbox("sun instead of the lights")
            self.azimuth = slider("azimuth [degrees]", 0, 360, 1, 30)
            self.elevation = slider("elevation [degrees]", 1, 90, 1, 60)
            self.lux = slider("illuminance [lx]", 0, 50, 0.5, 10)
        names = [camera.name for camera in scene.cameras]
        self.camera = choice("camera", names, names[0])
        self.back = gate.allow(gui.add_button("return to the camera (R)"),
                               lambda value: isinstance(value, bool))
        gui.add_markdown("W A S D Q E walk, through walls too; R returns to the camera.")
        for control in (self.view, self.basis, self.transport, self.near, self.exposure, self.time,
                        self.sun, self.azimuth, self.elevation, self.lux):
            control.on_update(lambda _: changed())

    def options(self, rays):
        steps = {} if self.transport.value == "sweep" else {"bounces": "1"}
        near = {"near_rays": rays
                } if self.near.value and self.transport.value == "sweep" else {"near": "off"}
        return {"basis": self.basis.value, "transport": self.transport.value, **steps, **near}

    def scene_lights(self):
        if not self.sun.value:
            return self.lights
        return [
            clpv.Light(direction=sun_direction(self.azimuth.value, self.elevation.value),
                       intensity=self.lux.value, name="sun")
        ]

    def show(self, stats, size, rate):
        rows = "\n".join(f"| {stage} | {stats[stage]:.1f} |" for stage in STAGES
                         if stats[stage] > 0)
        self.status.content = (
            f"{size[0]} x {size[1]}, {rate} frames/s in motion, "
            f"{stats['device_bytes'] / 2**20:.0f} MiB\n\n| stage | ms |\n|---|---|\n{rows}\n"
            f"| frame | {stats['frame']:.1f} |")


class Client:
    """One browser: when its view last changed, and how many of LEVELS it has shown since."""

    def __init__(self, handle):
        self.handle, self.changed, self.shown = handle, time.monotonic(), 0
        self.rate, self.served = Rate(), 0.0  # served: when it last got a frame

    def touch(self):
        self.changed, self.shown = time.monotonic(), 0


def next_client(clients, now):
    """The client with the fewest levels whose next one is due, of these the one that waits longest;
    or None."""
    due = [
        client for client in clients
        if client.shown < len(LEVELS) and now - client.changed >= LEVELS[client.shown][0]
    ]
    return min(due, key=lambda client: (client.shown, client.served), default=None)


class Viewer:
    def __init__(self, server, gate, scene, device=""):
        self.server, self.scene = server, scene
        self.renderers = Renderers(scene, device)
        self.clients, self.lock, self.wake = {}, threading.Lock(), threading.Event()
        self.frames = 0  # rendered so far
        self.lit_by = scene.lights
        server.scene.set_up_direction("+y")
        server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
        self.place(server.initial_camera, scene.cameras[0])
        self.controls = Controls(server, gate, scene, self.touch_all)
        self.controls.camera.on_update(self.jump)
        self.controls.back.on_click(self.jump)
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

    def update_lights(self):
        lights = self.controls.scene_lights()
        if tuple(lights) != tuple(self.lit_by):
            self.scene.lights = self.lit_by = lights

    def draw(self, client):
        changed, handle = client.changed, client.handle
        client.served = time.monotonic()
        moving = client.shown == 0
        _, height, rays = LEVELS[client.shown]
        size = size_of(height, handle.camera.aspect)
        self.update_lights()
        renderer = self.renderers.get(size, self.controls.options(rays))
        image = renderer.render(self.controls.view.value, camera_of(handle),
                                time=self.controls.time.value)
        handle.scene.set_background_image(
            image.display(self.controls.exposure.value)[..., :3], format="jpeg", jpeg_quality=85)
        handle.flush()
        self.frames += 1
        if client.changed == changed:  # else it is old already
            client.shown += 1
        if moving:
            client.rate.add(time.monotonic())
        self.controls.show(renderer.stats, size, client.rate.shown)

    def step(self, wait=0.05):
        """Draws one image if one is due, else waits for a change."""
        self.wake.clear()
        with self.lock:
            client = next_client(self.clients.values(), time.monotonic())
        if client is None:
            self.wake.wait(wait)
            return
        try:
            self.draw(client)
        except clpv.Error as error:
            # Such as options that exclude each other: shown until the next change.
            client.shown = len(LEVELS)
            self.controls.status.content = f"**{error}**"
        except Exception as error:
            # An error of this client alone, which may have left while it was drawn for.
            self.disconnect(client.handle)
            print(f"clpv.view: lost a client: {error!r}", file=sys.stderr)


def require_free(host, port):
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except OSError as error:
            sys.exit(f"clpv.view: {host}:{port}: {error.strerror}; choose another --port or --host")


def port_number(text):
    """Value of --port. As choices argparse would list all of them."""
    if not (text.isascii() and text.isdigit() and len(text) <= 5 and 1 <= int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"found '{text}', allowed: 1..65535")
    return int(text)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python3 -m clpv.view",
                                     description="Shows a scene in the browser.")
    parser.add_argument("scene", help="scene file (.json) or model (.gltf, .glb)")
    parser.add_argument("--model", help="model file instead of the scene file's")
    parser.add_argument("--device", default="",
                        help="OpenCL device: an index, or a part of its name")
    parser.add_argument(
        "--host", default="127.0.0.1", help=
        "address to listen on (default: %(default)s, this machine only); whoever reaches it controls the viewer"
    )
    parser.add_argument("--port", type=port_number, default=8080, metavar="1..65535",
                        help="(default: %(default)s)")
    given = parser.parse_args(arguments)
    try:
        import viser  # noqa: F401
    except ImportError:
        sys.exit(
            "clpv.view: viser is not installed; in a virtual environment: python3 -m pip install "
            f"viser=={view_gate.VISER}")
    require_free(given.host, given.port)
    try:
        scene = clpv.Scene(given.scene, given.model)
        gate = view_gate.Gate(given.host)
        server = gate.open(given.host, given.port)
        viewer = Viewer(server, gate, scene, given.device)
    except (clpv.Error, RuntimeError) as error:
        sys.exit(f"clpv.view: {error}")
    print(f"clpv.view: http://{given.host}:{given.port}", flush=True)
    try:
        while True:
            viewer.step()
    except KeyboardInterrupt:
        server.stop()


if __name__ == "__main__":
    main()
