# SPDX-License-Identifier: MIT
"""The viewer: its arithmetic and errors; with viser and Chromium, a page that opens, shows an image and follows a drag."""
import base64
import contextlib
import io
import itertools
import json
import math
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time
import types
import urllib.request

import numpy as np
import pytest

from clpv import view
from conftest import CORNELL, ROOT

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def test_the_camera_of_a_browser():
    def handle(wxyz):
        return types.SimpleNamespace(camera=types.SimpleNamespace(wxyz=wxyz, position=(1, 2, 3), fov=math.pi / 3))

    ahead = view.camera_of(handle((1, 0, 0, 0)))
    assert ahead.eye == (1, 2, 3) and ahead.target == (1, 2, 4) and ahead.up == (0, -1, 0)
    assert ahead.fov == pytest.approx(60)
    turned = view.camera_of(handle((math.sqrt(0.5), 0, math.sqrt(0.5), 0)))  # by 90 degrees about y
    assert np.allclose(np.subtract(turned.target, turned.eye), (1, 0, 0))


def test_sizes_and_suns():
    assert view.size_of(288, 16 / 9) == (512, 288)
    assert view.size_of(288, 0.01)[0] == 64 and view.size_of(720, 50)[0] == 1920
    assert np.allclose(view.sun_direction(0, 90), (0, -1, 0), atol=1e-9)
    assert np.allclose(np.linalg.norm(view.sun_direction(70, 20)), 1)


def test_a_view_that_rests_is_drawn_again_with_more_rays():
    client, other = view.Client(None), view.Client(None)
    client.changed = other.changed = 0
    drawn = []
    for now in (0, 0.1, 0.4, 0.5, 2, 3):
        due = view.next_client([client], now)
        if due:
            drawn.append((now, *view.LEVELS[due.shown][1:]))
            due.shown += 1
    assert drawn == [(0, 288, "2"), (0.4, 720, "4"), (2, 720, "64")]
    assert view.next_client([client, other], 3) is other
    client.touch()
    assert view.next_client([client], client.changed) is client and client.shown == 0


def run(*arguments, **environment):
    return subprocess.run([sys.executable, "-m", "clpv.view", *map(str, arguments)], capture_output=True, text=True,
                          check=False, timeout=120, env={**os.environ, **environment})


def test_bad_arguments(tmp_path):
    (tmp_path / "viser.py").write_text("raise ImportError\n")
    ended = run(CORNELL, PYTHONPATH=f"{tmp_path}:{os.environ['PYTHONPATH']}")
    assert ended.returncode == 1 and "pip install viser" in ended.stderr
    (tmp_path / "viser.py").write_text("")
    hollow = {"PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        ended = run(CORNELL, "--port", taken.getsockname()[1], **hollow)
    assert ended.returncode == 1 and "in use" in ended.stderr and "--port" in ended.stderr
    ended = run("/nowhere/scene.json", "--port", free_port(), **hollow)
    assert ended.returncode == 1 and "nowhere" in ended.stderr and "Traceback" not in ended.stderr
    assert run(CORNELL, "--port", 0).returncode == 2


class Tab:
    """A page of a headless Chromium, over its debugging protocol."""

    def __init__(self, port, address):
        from websockets.sync.client import connect
        request = urllib.request.Request(f"http://127.0.0.1:{port}/json/new?{address}", method="PUT")
        with urllib.request.urlopen(request, timeout=30) as answer:
            page = json.load(answer)
        self.socket, self.numbers = connect(page["webSocketDebuggerUrl"], max_size=None), itertools.count()
        self.ask("Page.enable")
        self.ask("Emulation.setDeviceMetricsOverride", width=960, height=600, deviceScaleFactor=1, mobile=False)

    def ask(self, method, **parameters):
        number = next(self.numbers)
        self.socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self.socket.recv(timeout=120))
            if answer.get("id") == number:
                return answer["result"]

    def screenshot(self):
        from PIL import Image
        shot = base64.b64decode(self.ask("Page.captureScreenshot")["data"])
        pixels = np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"))
        return shot, pixels[150:450, 100:550].astype(float)  # the scene, left of the panel

    def wait(self, condition, seconds=90):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            shot, pixels = self.screenshot()
            if condition(pixels):
                return shot, pixels
            time.sleep(0.5)
        raise AssertionError(f"mean {pixels.mean()}, deviation {pixels.std()}")

    def mouse(self, kind, x, y, buttons=1):
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons, clickCount=1)

    def drag(self, x, y, to_x, to_y):
        self.mouse("mouseMoved", x, y, 0)
        self.mouse("mousePressed", x, y)
        for i in range(1, 9):
            self.mouse("mouseMoved", x + (to_x - x) * i / 8, y + (to_y - y) * i / 8)
        self.mouse("mouseReleased", to_x, to_y)


@contextlib.contextmanager
def started(words, **more):
    with subprocess.Popen([str(word) for word in words], stderr=subprocess.STDOUT, text=True, **more) as process:
        try:
            yield process
        finally:
            process.terminate()


def wait_for(port):
    for _ in range(300):
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
            return
        time.sleep(0.2)
    raise AssertionError(f"nothing listens on port {port}")


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium (Debian: apt install chromium)")
def test_a_page_shows_the_scene_and_follows_a_drag(tmp_path):
    pytest.importorskip("viser", reason="viser is not installed")
    pytest.importorskip("PIL", reason="Pillow is not installed")
    keep = os.environ.get("CLPV_SCREENSHOTS")  # folder for the screenshots
    scene = os.environ.get("CLPV_VIEW_SCENE", str(CORNELL)).split()
    port, debug = free_port(), free_port()
    chromium = [CHROMIUM, "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader", f"--remote-debugging-port={debug}", "--remote-allow-origins=*",
                f"--user-data-dir={tmp_path / 'profile'}", "about:blank"]
    with open(tmp_path / "log", "w", encoding="utf-8") as log, \
            started([sys.executable, "-m", "clpv.view", *scene, "--port", port], stdout=log, cwd=ROOT) as viewer, \
            started(chromium, stdout=subprocess.DEVNULL):
        wait_for(port)
        wait_for(debug)
        tab = Tab(debug, f"http://127.0.0.1:{port}")
        shot, before = tab.wait(lambda pixels: pixels.std() > 10)
        time.sleep(2)  # the sharp image
        shot, before = tab.screenshot()
        if keep:
            (pathlib.Path(keep) / "viewer.png").write_bytes(shot)
        tab.drag(300, 300, 380, 320)
        shot, after = tab.wait(lambda pixels: np.abs(pixels - before).mean() > 3, 60)
        if keep:
            (pathlib.Path(keep) / "viewer-dragged.png").write_bytes(shot)
        # A second browser comes and goes.
        other = Tab(debug, f"http://127.0.0.1:{port}")
        other.wait(lambda pixels: pixels.std() > 10)
        other.drag(300, 300, 330, 300)
        other.ask("Page.close")
        time.sleep(1)
        tab.drag(380, 320, 300, 300)
        tab.wait(lambda pixels: np.abs(pixels - after).mean() > 3, 60)
        assert viewer.poll() is None, (tmp_path / "log").read_text(encoding="utf-8")
