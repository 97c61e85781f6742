# SPDX-License-Identifier: MIT
"""The viewer: its arithmetic and errors; with viser, a page that is served."""
import contextlib
import http.client
import json
import math
import os
import pathlib
import re
import socket
import subprocess
import sys
import threading
import time
import types
from unittest import mock

import numpy as np
import pytest

import clpv
from clpv import view, view_controls, view_gate
from conftest import CORNELL, ROOT


def has_ipv6():
    return any(" lo" in file.read_text() for file in pathlib.Path("/proc/net").glob("if_inet6"))


def test_a_device_that_does_not_exist_ends_it_before_there_is_a_page():
    pytest.importorskip("viser")
    with pytest.raises(SystemExit, match="no OpenCL device matches 'none'"):
        view.main([str(CORNELL), "--device", "none"])


def test_the_camera_of_a_browser():
    def handle(wxyz):
        return types.SimpleNamespace(
            camera=types.SimpleNamespace(wxyz=wxyz, position=(1, 2, 3), fov=math.pi / 3))

    ahead = view.camera_of(handle((1, 0, 0, 0)))
    assert ahead.eye == (1, 2, 3) and ahead.target == (1, 2, 4) and ahead.up == (0, -1, 0)
    assert ahead.fov == pytest.approx(60)
    half = math.sqrt(0.5)
    turned = view.camera_of(handle((half, 0, half, 0)))  # by 90 degrees about y
    assert np.allclose(np.subtract(turned.target, turned.eye), (1, 0, 0))


def test_each_choice_offers_its_default():
    server = mock.MagicMock()
    view_controls.Controls(server, clpv.Scene(CORNELL), True, None)
    for choice in server.gui.add_dropdown.call_args_list:
        assert choice.kwargs["initial_value"] in choice.args[1], choice


def test_sizes_and_suns():
    assert view.size_of(288, 16 / 9) == (512, 288)
    assert view.size_of(288, 0.01)[0] == 64 and view.size_of(720, 50)[0] == 1920
    assert np.allclose(view_controls.sun_direction(0, 90), (0, -1, 0), atol=1e-9)
    assert np.allclose(np.linalg.norm(view_controls.sun_direction(70, 20)), 1)


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
    client.shown = 2
    assert view.next_client([client, other], 3) is other
    client.touch()
    assert view.next_client([client], client.changed) is client and client.shown == 0


def image_of(*pixels):
    """One row of R, G, B, A."""
    return clpv.Image(np.array([pixels], np.float32))


def test_depth_and_normals_are_shown_as_what_they_are():
    depths = view_controls.displayed(image_of((1, 1, 1, 1), (100, 100, 100, 1), (0, 0, 0, 0)),
                                     "depth", 0, 10)[0, :, 0]
    assert depths[0] == 127 and 127 < depths[1] < 255 and depths[2] == 0
    normals = view_controls.displayed(image_of((0, 0, -1, 1), (-1, 0, 0, 1), (0, 0, 0, 0)),
                                      "normal", 0, 10)
    assert normals.tolist() == [[[127, 127, 0], [0, 127, 127], [0, 0, 0]]]
    lit = image_of((0.18, 0.18, 0.18, 1))
    assert (view_controls.displayed(lit, "full", 1, 10) == lit.display(1)[..., :3]).all()


def test_values_of_a_click_and_why_a_view_is_black():
    image = image_of((0.25, 0.5, 1, 1), (3, 3, 3, 0))
    assert view_controls.value_at(image, "full", 0.3, 1) == (
        "pixel (0, 0), full: 0.25 0.5 1 W/m^2/sr")
    assert view_controls.value_at(image, "depth", 0, 0) == "pixel (0, 0), depth: 0.25 m"
    assert view_controls.value_at(image, "normal", 0, 0) == "pixel (0, 0), normal: 0.25 0.5 1"
    assert view_controls.value_at(image, "full", 1, 1) == "pixel (1, 0): no surface"

    def unseen(pixel):
        made = image_of(pixel)
        return view_controls.unseen(made, view_controls.displayed(made, "full", 0, 1))

    assert unseen((1, 1, 1, 1)) == ""
    assert "Black" in unseen((0, 0, 0, 1)) and "No surface" in unseen((0, 0, 0, 0))


def test_a_camera_as_text_can_be_rendered():
    camera = clpv.Camera(eye=(1, 2, 3), target=(1, 2, 4.0000001), up=(0, 1, 0), fov=50)
    entry, options = (part for part in view_controls.text_of(camera).split("\n")
                      if part[0] in "{-")
    assert json.loads(entry) == {"name": "view", "eye": [1, 2, 3], "target": [1, 2, 4],
                                 "up": [0, 1, 0], "vertical_fov_degrees": 50}
    assert options == "--eye=1,2,3 --target=1,2,4 --up=0,1,0 --fov=50"


def run(*arguments, **environment):
    return subprocess.run([sys.executable, "-m", "clpv.view", *map(str, arguments)],
                          capture_output=True, text=True, check=False, timeout=120,
                          env={**os.environ, **environment})


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
    ended = run("/nowhere/scene.json", "--port", 0, **hollow)
    assert ended.returncode == 1 and "nowhere" in ended.stderr and "Traceback" not in ended.stderr
    assert "0-65535" in run(CORNELL, "--port", 65536, **hollow).stderr


@pytest.fixture(scope="module")
def viewer():
    """A viewer of the scene that draws on its own thread; the address of its page."""
    pytest.importorskip("viser", reason="viser is not installed (pip install viser)")
    server, path = view_gate.opened("127.0.0.1", 0)
    made = view.Viewer(server, clpv.Scene(CORNELL))
    done = threading.Event()

    def draw():
        while not done.is_set():
            made.step()

    thread = threading.Thread(target=draw)
    thread.start()
    yield made, f"127.0.0.1:{server.get_port()}{path}"
    done.set()
    thread.join()
    server.stop()


def status_of(address, path):
    """Status of the answer to a request for a page."""
    with contextlib.closing(http.client.HTTPConnection(address)) as connection:
        connection.request("GET", path)
        return connection.getresponse().status


@contextlib.contextmanager
def browser(address):
    """A client that speaks viser's protocol, without a page."""
    import viser
    from websockets.sync.client import connect
    with connect(f"ws://{address}", subprotocols=[f"viser-v{viser.__version__}"],
                 max_size=None) as client:
        yield client


def message(kind, **fields):
    import msgspec
    return msgspec.msgpack.encode({"type": kind, **fields})


def moved(**changes):
    return message("ViewerCameraMessage", **{
        "wxyz": (1, 0, 0, 0), "position": (0.278, 0.273, -0.18), "look_at": (0, 1, 3),
        "up_direction": (0, 1, 0), "fov": 1.0, "near": 0.01, "far": 1000.0, "image_height": 600,
        "image_width": 960, **changes})


def holds(condition, seconds=60):
    """True once the condition is."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    return condition()


def drawn_after(made, count):
    return holds(lambda: made.frames > count)


def test_requests_need_the_token(viewer):
    from websockets.exceptions import InvalidStatus
    address, _, token = viewer[1].rstrip("/").partition("/")
    for path in "", "x", token[:-1], f"{token}x", f"x/{token}":
        assert status_of(address, f"/{path}/") == 403, path
        with pytest.raises(InvalidStatus, match="403"):
            with browser(f"{address}/{path}"):
                pass
    assert status_of(address, f"/{token}/") == 200
    assert status_of(address, f"/{token}/%2e%2e/%2e%2e/_viser.py") == 404


def test_an_error_ends_one_client(viewer, monkeypatch):
    made, address = viewer
    with browser(address) as good, browser(address) as bad:
        before = made.frames
        good.send(moved())
        assert drawn_after(made, before)
        spared = set(made.clients)
        camera_of, failed = view.camera_of, []

        def fail_for_others(handle):
            if handle.client_id in spared:
                return camera_of(handle)
            failed.append(handle.client_id)
            raise ZeroDivisionError

        monkeypatch.setattr(view, "camera_of", fail_for_others)
        bad.send(moved())
        assert holds(lambda: failed and set(made.clients) == spared)
        before = made.frames
        good.send(moved(position=(0.28, 0.27, -0.21)))
        assert drawn_after(made, before) and set(made.clients) == spared


def test_r_returns_to_the_scenes_camera(viewer):
    made, address = viewer
    commands = list(made.server.gui._command_handle_from_uuid.values())
    assert [command._impl.props.hotkey for command in commands] == ["R"]
    with browser(address) as client:
        before = made.frames
        client.send(moved(position=(5.0, 5.0, 5.0)))
        assert drawn_after(made, before)
        handle = max(made.clients.values(), key=lambda each: each.handle.client_id).handle
        client.send(message("CommandTriggerMessage", uuid=commands[0]._impl.uuid))
        assert holds(lambda: np.allclose(handle.camera.position, made.scene.cameras[0].eye))


def test_a_click_shows_values_and_buttons_give_camera_and_image(viewer):
    made, address = viewer

    def said(words):
        return holds(lambda: words in made.controls.said.content)

    others = set(made.clients)
    with browser(address) as client:
        client.send(moved())
        assert holds(lambda: any(made.clients[number].image for number in {*made.clients} - others))
        client.send(message("ScenePointerMessage", event_type="click", ray_origin=(0, 0, 0),
                            ray_direction=(0, 0, 1), screen_pos=((0.5, 0.5), ), modifier=None))
        assert said("full: ")
        client.send(message("GuiUpdateMessage", uuid=made.controls.copied._impl.uuid,
                            updates={"value": True}))
        assert said("--eye=0.278,0.273,-0.18")
        client.send(message("GuiUpdateMessage", uuid=made.controls.saved._impl.uuid,
                            updates={"value": True}))
        end = time.monotonic() + 30
        while time.monotonic() < end:
            if b"clpv-full.png" in client.recv(timeout=30):
                return
        raise AssertionError("no file")


def test_path_tracing_beside_a_view_that_rests(viewer, monkeypatch):
    made, address = viewer
    rights, send = [], made.send

    def noted(client, image, name, right=None):
        shown = send(client, image, name, right)
        if right:
            rights.append((image.array.shape, right.array.shape, shown.shape))
        return shown

    monkeypatch.setattr(made, "send", noted)
    monkeypatch.setattr(view, "PATHS", 1)
    made.controls.traced.value = True
    try:
        with browser(address) as client:
            client.send(moved())
            assert holds(lambda: rights)
    finally:
        made.controls.traced.value = False
    (height, width, _), (half_height, half_width, _), shown = rights[0]
    assert (half_height, half_width) == (height // 2, width // 2) and shown == (height, width, 3)


def test_the_lights_move_again_without_the_sun():
    scene = clpv.Scene(ROOT / "scenes/atrium_living.json")
    assert scene.moves
    controls = types.SimpleNamespace(sun_light=lambda: sun)
    made = types.SimpleNamespace(controls=controls, sun=None, scene=scene, lights=scene.lights,
                                 load=lambda: clpv.Scene(ROOT / "scenes/atrium_living.json"),
                                 renderer=mock.Mock())
    sun = clpv.Light(direction=(0, -1, 0), name="sun")
    view.Viewer.update_lights(made)
    assert made.scene.lights == (sun, )
    sun = None
    view.Viewer.update_lights(made)
    assert made.scene is not scene and made.renderer.cache_clear.called
    assert made.scene.lights == made.lights and made.scene.moves


@pytest.mark.skipif(not has_ipv6(), reason="no IPv6")
def test_the_address_of_ipv6_is_printed_and_served():
    pytest.importorskip("viser", reason="viser is not installed (pip install viser)")
    words = [sys.executable, "-m", "clpv.view", str(CORNELL), "--host", "::1", "--port", "0"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True) as process:
        address, path = re.fullmatch(r"clpv.view: http://(\[::1\]:\d+)(/.*/)\n",
                                     process.stdout.readline()).groups()
        assert [status_of(address, each) for each in (path, "/")] == [200, 403]
        process.terminate()
