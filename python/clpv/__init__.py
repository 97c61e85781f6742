# SPDX-License-Identifier: MIT
"""clpv: indirect light with cascaded light propagation volumes, in OpenCL.

    import clpv
    scene = clpv.Scene("scenes/cornell.json")
    image = clpv.Renderer(scene, basis="srbf8v2", width=480, height=270).render()
    image.save("cornell.png")
    image.array.mean(axis=(0, 1))        # float32, (height, width, 4)

Lengths are metres, y is up. Illuminance in lux counts 1:1 as W/m^2, luminous intensity in candela
as W/sr.

    Scene, Camera, Light, Medium    a scene file, glTF model or meshes, and what can change in it
    Material                        surface of a mesh
    Renderer, options(), devices()  frames on an OpenCL device, light at points, volumes, stats
    DeviceFrame, DeviceVolumes      results as OpenCL memory, for pyopencl
    DeviceEvent                     when they are complete
    ms_of                           time of a stage in Renderer.stats["times"]
    Image, read_image, compare      images as arrays, files, errors
    pathtrace                       ground truth on the CPU
    Basis, bases()                  functions on the sphere
    clpv.draw                       charts (needs matplotlib); works without the native module
    clpv.view                       viewer in the browser (needs viser): python3 -m clpv.view SCENE
    Error, UsageError, InputError, DeviceError, ResourceError, ValidationError
"""
import importlib
from collections.abc import Sequence
from typing import Any

__all__ = [
    "Basis", "Camera", "Comparison", "DeviceError", "DeviceEvent", "DeviceFrame", "DeviceVolumes",
    "Error", "Image", "InputError", "Light", "Material", "Medium", "Renderer", "ResourceError",
    "Scene", "UsageError", "ValidationError", "Volume", "bases", "compare", "devices", "options",
    "ms_of", "pathtrace", "read_image"
]


def ms_of(times: Sequence[dict[str, Any]], stage: str) -> float:
    """Sum of the medians of a stage over its cascades and lights [ms]; 0 if it did not run.

    times: those of Renderer.stats or of JSON by clpv."""
    return sum(float(time["median"]) for time in times if time["stage"] == stage)


def __getattr__(name):
    """Loads the native module on first use, so that clpv.draw works without it."""
    if name in __all__ or name == "__version__":
        importlib.import_module("clpv._pocl").use()
        module = "values" if name in ("Camera", "Light", "Material", "Medium") else "_native"
        return getattr(importlib.import_module(f"clpv.{module}"), name)
    if name in ("draw", "view"):
        return importlib.import_module(f"clpv.{name}")
    raise AttributeError(f"module 'clpv' has no attribute '{name}'")


def __dir__():
    return sorted([*__all__, "__version__", "draw", "view"])
