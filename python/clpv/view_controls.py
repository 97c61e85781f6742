# SPDX-License-Identifier: MIT
"""Panel of the viewer (clpv.view), and how it shows each view."""
import json
import math

import numpy

import clpv

VIEWS = "full", "direct", "indirect", "irradiance", "albedo", "normal", "depth", "cells"
UNITS = {"irradiance": "W/m^2", "cells": "W/m^2", "albedo": "", "normal": "", "depth": "m"}
RADIANCE = "W/m^2/sr"
STAGES = ("rasterize-camera", "rasterize-shadow", "rasterize-rsm", "emit", "inject-light",
          "inject-geometry", "blockers", "reflectors", "propagate", "visibility", "gather",
          "near-trace", "near", "medium", "shade")
MID_DEPTH = 0.1  # that is shown as mid grey, of the scene's diagonal


def displayed(image, view, exposure, diagonal):
    """uint8 array (height, width, 3) of a frame. Depth is brighter with distance, and never white;
    normals -1..1 are 0..255."""
    pixels, surface = image.array[..., :3], image.array[..., 3:] > 0
    if view == "depth":
        shown = pixels / (pixels + MID_DEPTH * diagonal)
    elif view == "normal":
        shown = 0.5 * pixels + 0.5
    else:
        return image.display(exposure)[..., :3]
    return (255 * numpy.where(surface, numpy.clip(shown, 0, 1), 0)).astype(numpy.uint8)


def value_at(image, view, x, y):
    """Text of the values at a point of the image, 0..1 to the right and down."""
    height, width = image.array.shape[:2]
    column, row = min(width - 1, int(x * width)), min(height - 1, int(y * height))
    *values, alpha = (float(value) for value in image.array[row, column])
    if not alpha > 0:
        return f"pixel ({column}, {row}): no surface"
    numbers = f"{values[0]:.4g}" if view == "depth" else " ".join(f"{v:.4g}" for v in values)
    return f"pixel ({column}, {row}), {view}: {numbers} {UNITS.get(view, RADIANCE)}".rstrip()


def unseen(image, shown):
    """Why a view is black, or an empty text."""
    if not (image.array[..., 3] > 0).any():
        return "No surface in view; R returns."
    if shown.max() <= 2:
        return "Black, as behind a wall; R returns."
    return ""


def text_of(camera):
    """A camera as scene files have it, and as options of `clpv render`."""
    def rounded(values):
        return [float(f"{value:.6g}") for value in values]

    entry = {"name": "view", "eye": rounded(camera.eye), "target": rounded(camera.target),
             "up": rounded(camera.up), "vertical_fov_degrees": round(camera.fov, 2)}
    options = " ".join(f"--{name}={','.join(f'{value:g}' for value in entry[name])}"
                       for name in ("eye", "target", "up"))
    return f"```\n{json.dumps(entry)}\n```\n```\n{options} --fov={camera.fov:.4g}\n```"


def sun_direction(azimuth, elevation):
    """Direction of the light of a sun at these angles [degrees]."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return -math.cos(e) * math.sin(a), -math.sin(e), -math.cos(e) * math.cos(a)


class Controls:
    """The panel beside the image. Clients share it. Above the controls is one line; what changes
    its height lies at the end, so that no control moves."""

    def __init__(self, server, scene, has_sun, changed):
        gui = server.gui

        def choice(name, values, initial):
            return gui.add_dropdown(name, values, initial_value=initial)

        def checkbox(name, initial=False):
            return gui.add_checkbox(name, initial_value=initial)

        def slider(name, low, high, step, initial, **more):
            return gui.add_slider(name, low, high, step, initial_value=initial, **more)

        defaults = {option["name"]: option["value"] for option in clpv.options()}
        views = VIEWS if scene.medium is None else (*VIEWS, "medium")
        self.status = gui.add_markdown("starting")
        self.view = choice("view", views, "full")
        self.basis = choice("basis", clpv.bases(), defaults["basis"])
        self.transport = choice("transport", ("sweep", "exact", "sampled"), defaults["transport"])
        self.bounces = choice("bounces", ("1", "2", "all"), "all")  # as auto of a sweep
        self.near = checkbox("near field", True)
        self.traced = checkbox("path tracing beside")
        self.automatic = scene.exposure is None  # until the first frame sets the exposure
        self.exposure = slider("exposure [EV]", -10, 10, 0.25,
                               max(-10, min(10, scene.exposure or 0)))
        self.time = slider("time [s]", 0, 20, 0.05, 0, visible=scene.moves)
        with gui.add_folder("sun", visible=has_sun, expand_by_default=False):
            self.sun = checkbox("in place of lights")
            self.azimuth = slider("azimuth [°]", 0, 360, 1, 30)
            self.elevation = slider("elevation [°]", 1, 90, 1, 60)
            self.lux = slider("illuminance [lx]", 0, 50, 0.5, 10)
        names = [camera.name for camera in scene.cameras]
        self.camera = choice("camera", names, names[0])
        self.back, self.copied, self.saved = (gui.add_button(name) for name in (
            "return to the camera (R)", "camera as text", "save the image"))
        gui.add_markdown("W A S D Q E walk, through walls too; a click shows a pixel's values.")
        self.said, self.times = gui.add_markdown(""), gui.add_markdown("")
        for control in (self.view, self.basis, self.transport, self.bounces, self.near, self.traced,
                        self.exposure, self.time, self.sun, self.azimuth, self.elevation, self.lux):
            control.on_update(lambda _: changed())

    def options(self, rays):
        if self.transport.value != "sweep":
            sweep = {"bounces": "1", "near": "off"}
        else:
            near = {"near_rays": rays} if self.near.value else {"near": "off"}
            sweep = {"bounces": self.bounces.value, **near}
        return {"basis": self.basis.value, "transport": self.transport.value, **sweep}

    def expose(self, image):
        """Sets the exposure to the image's automatic one."""
        self.automatic = False
        self.exposure.value = round(4 * max(-10, min(10, image.automatic_exposure()))) / 4

    def sun_light(self):
        """The sun, or None."""
        if not self.sun.value:
            return None
        return clpv.Light(direction=sun_direction(self.azimuth.value, self.elevation.value),
                          intensity=self.lux.value, name="sun")

    def show(self, stats, size, rate, why):
        ms = {stage: clpv.ms_of(stats["times"], stage) for stage in (*STAGES, "frame")}
        rows = "\n".join(f"| {stage} | {ms[stage]:.1f} |" for stage in STAGES if ms[stage] > 0)
        self.status.content = why or (
            f"{size[0]} x {size[1]}, {rate} frames/s, {ms['frame']:.0f} ms")
        self.times.content = (f"| stage | ms |\n|---|---|\n{rows}\n| frame | {ms['frame']:.1f} |"
                              f"\n\n{stats['device_bytes'] / 2**20:.0f} MiB on the device")
