# SPDX-License-Identifier: MIT
"""Which frames the viewer (clpv.view) draws, for whom, and when."""
import collections
import functools
import math
import time

import clpv

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


class Renderers:
    """Renderers by size and options; the ones used last are kept."""

    def __init__(self, scene, device):
        self.scene = scene
        self.kept = functools.lru_cache(MAX_RENDERERS)(lambda size, options: clpv.Renderer(
            self.scene, device, width=size[0], height=size[1], **dict(options)))

    def get(self, size, options):
        return self.kept(size, tuple(sorted(options.items())))


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
    due = [
        client for client in clients
        if client.shown < len(waits) and now - client.changed >= waits[client.shown]
    ]
    return min(due, key=lambda client: (client.shown, client.served), default=None)
