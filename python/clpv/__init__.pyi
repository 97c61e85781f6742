# SPDX-License-Identifier: MIT
# Written by scripts/stubs.
import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from clpv import draw as draw, view as view

_Path = str | os.PathLike[str]
_Vector = Sequence[float] | NDArray[Any]
_View = Literal["full", "direct", "indirect", "irradiance", "albedo", "normal", "depth", "medium",
                "cells"]
__version__: str

class Error(Exception):
    """Any failure of clpv; str() names place, value found and value allowed."""

class DeviceError(Error, RuntimeError):
    """No OpenCL device, or one without a required capability."""

class InputError(Error, ValueError):
    """Invalid scene, image, or other input."""

class ResourceError(Error, RuntimeError):
    """Out of memory, or a file that cannot be written."""

class UsageError(Error, ValueError, TypeError):
    """Unknown option, value out of range, or argument of another kind; a ValueError and a TypeError."""

class ValidationError(Error, RuntimeError):
    """A result differs from its reference."""

class Basis:
    """Basis(name='sh2', bandwidth=None, centres=None): N functions b_i on the unit sphere.

    bandwidth: lambda in (0, 1) of radial functions (None: 0.25), or one for each centre; centres: array (N, 3), for
    radial functions of one's own. Directions may have any length.
    """
    def __init__(self, name: str = 'sh2', bandwidth: float | Sequence[float] | None = None, centres: ArrayLike | None = None) -> None:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def condition(self) -> float:
        """Condition number of the Gram matrix."""
    @property
    def integrals(self) -> NDArray[np.float64]:
        """Array (N,): integral of each function."""
    @property
    def centres(self) -> NDArray[np.float64]:
        """Array (N, 3) of unit vectors; (0, 3) without centres."""
    @property
    def bandwidths(self) -> NDArray[np.float64]:
        """Array (N,); (0,) without centres."""
    def evaluate(self, directions: ArrayLike) -> NDArray[np.float64]:
        """evaluate(directions (..., 3)) -> float64 array (..., N): b_i(w)."""
    def clamped_cosine(self, axes: ArrayLike, table_size: int | None = None) -> NDArray[np.float64]:
        """clamped_cosine(axes (..., 3), table_size=None) -> float64 array (..., N): projection of max(0, w . axis), exact,
        or along +z and rotated through a table of that many entries as in the paper (0: without a table).
        """
    @property
    def mean_error(self) -> float:
        """Mean relative L2 error of exactly projected clamped cosines over all axes."""
    def energy(self, steps: int, transport: Literal["sampled", "exact"] = 'sampled', table_size: int | None = None) -> float:
        """energy(steps, transport='sampled', table_size=None) -> energy of an isotropic source after `steps` steps of
        propagation over its initial one; transport: 'sampled' or 'exact'; table_size as for clamped_cosine().
        """
    def directions(self) -> NDArray[np.float64]:
        """directions() -> float64 array (K, 3): directions at which project() takes values of a function."""
    def project(self, values: ArrayLike) -> NDArray[np.float64]:
        """project(values (K,)) -> float64 array (N,): least-squares projection of a function that has these
        values at directions().
        """
    def lobe(self, axis: ArrayLike, coefficients: ArrayLike | None = None) -> dict[str, float]:
        """lobe(axis, coefficients=None) -> dict: errors of a lobe (None: clamped_cosine(axis)) against the clamped
        cosine: relative_l2, minimum, flux (pi is exact), peak_error_degrees.
        """
    def __len__(self) -> int: ...

class Camera:
    """Perspective camera. Immutable; replace() makes another. Values are checked where it is used.

    eye, target, up: x, y, z [m]; fov: vertical field of view [degrees];
    near: nearest visible depth [m]; light: name of its only light, empty for all.
    """
    def __init__(self, eye: _Vector, target: _Vector, up: _Vector = (0, 1, 0), fov: float = 60.0, near: float = 0.05, name: str = '', light: str = '') -> None:
        ...
    @property
    def eye(self) -> tuple[float, float, float]:
        ...
    @property
    def target(self) -> tuple[float, float, float]:
        ...
    @property
    def up(self) -> tuple[float, float, float]:
        ...
    @property
    def fov(self) -> float:
        ...
    @property
    def near(self) -> float:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def light(self) -> str:
        ...
    def replace(self, **changes: Any) -> Camera:
        """replace(**changes): a copy with other values of some arguments."""

class Comparison:
    """Errors of an image against its reference, over the colour channels. None: undefined."""
    @property
    def rmse(self) -> float:
        """Root mean square error."""
    @property
    def nrmse(self) -> float | None:
        """rmse over the root mean square of the reference."""
    @property
    def relative_mse(self) -> float:
        """Mean of (a - b)^2 / (b^2 + 0.01)."""
    @property
    def psnr_db(self) -> float | None:
        """Peak signal-to-noise ratio with peak 1 [dB]."""
    @property
    def max_error(self) -> float:
        ...
    @property
    def max_error_at(self) -> list[int]:
        """x, y from the top left corner."""
    @property
    def mean_luminance(self) -> list[float]:
        """Of the image and of the reference."""
    @property
    def identical(self) -> bool:
        ...
    @property
    def valid_pixels(self) -> int:
        """Pixels with alpha above 0 in both."""
    @property
    def nrmse_valid(self) -> float | None:
        """nrmse over valid pixels."""
    @property
    def best_gain(self) -> float | None:
        """Factor on the image with the least error."""
    @property
    def nrmse_best_gain(self) -> float | None:
        """nrmse with that factor."""
    @property
    def energy_ratio(self) -> float | None:
        """Sum of the image over that of the reference."""
    @property
    def flip(self) -> float | None:
        """Mean FLIP, what an observer sees, 0 to 1 (Andersson et al. 2020)."""

class DeviceEvent:
    """Completion of commands that were enqueued."""
    @property
    def int_ptr(self) -> int:
        """The cl_event, for pyopencl.Event.from_int_ptr(int_ptr, retain=True). It lives as long as this object."""
    def wait(self) -> None:
        """wait(): waits for the commands. Raises ResourceError if they failed."""

class DeviceFrame:
    """Device memory of a frame: integers for pyopencl.MemoryObject.from_int_ptr(number, retain=True), row 0 at the top.

    The renderer's next call that renders overwrites it.
    """
    @property
    def width(self) -> int:
        """Pixels of a row."""
    @property
    def height(self) -> int:
        """Rows."""
    @property
    def image(self) -> int:
        """float4 per pixel: R, G, B, A of the view, linear, without a sky."""
    @property
    def irradiance(self) -> int:
        """float4 per pixel: E [W/m^2] of red, green, blue, and 0."""
    @property
    def depth(self) -> int:
        """float per pixel [m]; 0 without a surface."""
    @property
    def normals(self) -> int:
        """float4 per pixel: unit normal, and 0."""
    @property
    def int_ptr(self) -> int:
        """The cl_event of the whole frame."""
    def wait(self) -> None:
        """wait(): waits for the frame. Raises ResourceError if it failed."""

class DeviceVolumes:
    """Light for a kernel: arguments CLPV_RADIANCE of Renderer.lookup_source(), in the order of arguments()."""
    def arguments(self) -> tuple[Any, ...]:
        """arguments() -> (grids, cascades, unit, packed[, occluded]): memory as integers, a numpy.uint32 and a numpy.float32."""

class Image:
    """Image(array, channels=None, encoding='linear'): copies an array (height, width, channels) of real numbers.

    numpy.asarray(image) and image.array are float32 views of its pixels, row 0 on top, without a copy; they keep
    the image alive.
    """
    def __init__(self, array: ArrayLike, channels: Sequence[str] | None = None, encoding: Literal["linear", "srgb"] = 'linear') -> None:
        ...
    @property
    def array(self) -> NDArray[np.float32]:
        """Pixels as a float32 array (height, width, channels), without a copy."""
    @property
    def width(self) -> int:
        ...
    @property
    def height(self) -> int:
        ...
    @property
    def channels(self) -> tuple[str, ...]:
        """Names, such as 'R' or 'indirect.R' of layer 'indirect'."""
    @property
    def metadata(self) -> dict[str, str]:
        """Dict of the options that it was rendered with."""
    @property
    def notes(self) -> tuple[str, ...]:
        """What reading its file converted or ignored."""
    @property
    def encoding(self) -> str:
        """'linear' in light, or 'srgb'."""
    def save(self, path: _Path, exposure: float = 0.0) -> None:
        """Writes a linear image with channels R, G, B and optionally A: .exr as float32 with metadata, .png tone-mapped
        (ACES) after multiplication by 2^exposure [EV], on a black background.
        """
    def display(self, exposure: float = 0.0) -> NDArray[np.uint8]:
        """uint8 array (height, width, channels), tone-mapped and sRGB-encoded as save() does for .png, with A."""
    def _repr_png_(self) -> bytes | None: ...

class Light:
    """Light without extent. Immutable; replace() makes another. Values are checked where it is used.

    kind: 'directional', 'spot' or 'point'; position [m]; direction in which light travels;
    intensity: red, green, blue, or one number: illuminance [lx = W/m^2] if directional, else [cd = W/sr];
    range [m], 0 for no limit; inner_cone, outer_cone: angles of a spot [degrees].
    """
    def __init__(self, kind: Literal["directional", "spot", "point"] = 'directional', position: _Vector = (0, 0, 0), direction: _Vector = (0, -1, 0), intensity: float | _Vector = (1, 1, 1), range: float = 0.0, inner_cone: float = 0.0, outer_cone: float = 45.0, name: str = '') -> None:
        ...
    @property
    def kind(self) -> str:
        ...
    @property
    def position(self) -> tuple[float, float, float]:
        ...
    @property
    def direction(self) -> tuple[float, float, float]:
        ...
    @property
    def intensity(self) -> tuple[float, float, float]:
        ...
    @property
    def range(self) -> float:
        ...
    @property
    def inner_cone(self) -> float:
        ...
    @property
    def outer_cone(self) -> float:
        ...
    @property
    def name(self) -> str:
        ...
    def replace(self, **changes: Any) -> Light:
        """replace(**changes): a copy with other values of some arguments."""

class Material:
    """Diffuse surface of a mesh. Immutable; replace() makes another. Values are checked where it is used.

    base_colour: linear red, green, blue and optionally alpha, or one number, 0 to 1; emission: radiance of the front
    [W/m^2/sr], three numbers or one; texture: array (height, width, 4), uint8 with sRGB-encoded colour, or floats, linear;
    alpha_cutoff: alpha below which there are holes; double_sided: visible, and emissive, from both sides.
    """
    def __init__(self, *, base_colour: float | _Vector = 1.0, emission: float | _Vector = 0.0, texture: ArrayLike | None = None, alpha_cutoff: float | None = None, double_sided: bool = False) -> None:
        ...
    @property
    def base_colour(self) -> tuple[float, float, float, float]:
        ...
    @property
    def emission(self) -> tuple[float, float, float]:
        ...
    @property
    def texture(self) -> NDArray[np.uint8] | None:
        """A copy as uint8 array (height, width, 4), or None."""
    def replace(self, **changes: Any) -> Material:
        """replace(**changes): a copy with other values of some arguments."""
    @property
    def alpha_cutoff(self) -> float | None:
        ...
    @property
    def double_sided(self) -> bool:
        ...

class Medium:
    """Homogeneous fog or dust in a box. Immutable; replace() makes another. Values are checked where it is used.

    scattering, absorption: red, green, blue, or one number [1/m]; anisotropy: -0.9 to 0.9, above 0 forwards;
    box: lower and upper corner [m], None for the scene's bounding box.
    """
    def __init__(self, scattering: float | _Vector = (0, 0, 0), absorption: float | _Vector = (0, 0, 0), anisotropy: float = 0.0, box: Sequence[_Vector] | None = None) -> None:
        ...
    @property
    def scattering(self) -> tuple[float, float, float]:
        ...
    @property
    def absorption(self) -> tuple[float, float, float]:
        ...
    @property
    def anisotropy(self) -> float:
        ...
    @property
    def box(self) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
        ...
    def replace(self, **changes: Any) -> Medium:
        """replace(**changes): a copy with other values of some arguments."""

class Renderer:
    """Renderer(scene, device='', *, context=None, queue=None, **options): renders frames of one scene on one OpenCL device.

    device: an index, 'PLATFORM:DEVICE' or a part of the name; empty: CLPV_DEVICE, else the first usable one.
    context, queue: of pyopencl, or their int_ptr; the renderer works there. The queue is in-order.
    options: those of `clpv render` with _ for - (and lambda_); options() lists them. bool is on or off.
    Results that do not change are cached from frame to frame. Calls from several threads run one after the other.
    Raises UsageError, DeviceError, ResourceError.
    """
    def __init__(self, scene: Scene, device: str = '', *, context: Any | None = None, queue: Any | None = None, preset: Literal["best", "fast", "fine", "paper"] = ..., basis: Literal["sh2", "sh3", "sh4", "sh5", "srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14", "bins24", "bins96"] = ..., centres: str = ..., lambda_: float = ..., lobe: Literal["exact", "rotate"] = ..., lobe_time: Literal["host", "kernel"] = ..., evaluate: Literal["exact", "buffer", "image"] = ..., table_size: int = ..., transport: Literal["sampled", "exact", "sweep"] = ..., directions: Literal[24, 96, 216, 384] = ..., coarser_directions: Literal[24, 96, 216, 384] = ..., bounces: Literal[1, 2, "all"] = ..., layout: Literal["image", "aos", "soa", "tiled"] = ..., storage: Literal["float", "half"] = ..., iterations: int = ..., grid: int = ..., cascades: int = ..., cascade_size: float = ..., rsm_size: int = ..., rsm_format: Literal["float", "paper"] = ..., shadow_size: int = ..., blockers: Literal["scene", "seen", "none"] = ..., blocking: Literal["areas", "one-sided"] = ..., blocker_stride: int = ..., gather: Literal["all", "visible"] = ..., gather_offset: float = ..., near: Literal["auto", "off", "traced", False] = ..., near_size: Literal["auto", "full", "half", "quarter", "eighth"] = ..., near_rays: Literal[2, 4, 8, 16, 64] = ..., width: int = ..., height: int = ...) -> None:
        ...
    def render(self, view: _View = 'full', camera: str | Camera | None = None, time: float = 0.0, size: tuple[int, int] | None = None) -> Image:
        """render(view='full', camera=None, time=0.0, size=None) -> Image (height, width, 4), linear R, G, B, A.

        view: full, direct, indirect [W/m^2/sr], irradiance [W/m^2], albedo, normal, depth [m], or cells: irradiance with
        the finest cascade's cells as spheres;
        camera: a Camera, or the name of one of the scene (None: its first); time [s] of an animated scene;
        size: (width, height), None for options width and height.
        """
    def update(self, eye: _Vector, time: float = 0.0) -> None:
        """update(eye, time=0.0): lights cascades about `eye` [m] without a frame, for irradiance(), radiance(), volumes() and
        device_volumes().
        """
    def release(self) -> None:
        """release(): frees the device's memory; the next call that lights or renders allocates it again. A `with` block ends with it."""
    def show(self, view: _View) -> Image:
        """show(view) -> Image: another view of the last frame, without rendering it again."""
    def light(self, normals: ArrayLike, *, positions: ArrayLike | None = None, depths: ArrayLike | None = None, eye: _Vector | None = None, camera: str | Camera | None = None, time: float = 0.0) -> NDArray[np.float32]:
        """light(normals, *, positions=None, depths=None, eye=None, camera=None, time=0.0) -> float32 array (height, width, 3).

        Irradiance of indirect light [W/m^2] on the pixels of a G-buffer, with the near field, as view 'irradiance' has it: normals
        (height, width, 3) of any length; positions [m] of their shape, or depths (height, width) [m] of `camera`, a Camera or a
        name (None: the scene's first). Cascades surround `eye`, or the camera's. Pixels with a normal of 0, a depth that is not
        positive or a number that is not finite have no surface, and no light.
        """
    def irradiance(self, points: ArrayLike, normals: ArrayLike) -> NDArray[np.float32]:
        """irradiance(points, normals) -> float32 array of the points' shape: indirect light [W/m^2], red, green, blue.

        points [m] and normals (of any length): arrays (..., 3), or one normal. Of the volumes of the last frame, light()
        or update(), without option near; 0 outside of the cascades. Computed on the device.
        """
    def radiance(self, points: ArrayLike, directions: ArrayLike) -> NDArray[np.float32]:
        """radiance(points, directions) -> float32 array of the points' shape: indirect light [W/m^2/sr], red, green, blue.

        points [m] and directions in which the light travels (of any length): arrays (..., 3), or one direction. As
        irradiance(), of the same volumes, on the device; negative where nine harmonics undershoot. Raises UsageError without transport 'sweep',
        and for layout 'image' with gather 'all'.
        """
    def volumes(self) -> list[Volume]:
        """volumes() -> list of Volume of the last frame, finest cascade first."""
    @property
    def stats(self) -> dict[str, Any]:
        """Dict of the last frame: 'times', a list of records {stage, cascade, light, n, min, median, mad, max} [ms], which
        ms_of() sums by stage: 'frame' (wall time of render()), 'host' (the host's work in it, without waiting), and each stage on the
        device that ran ('propagate', 'gather', ...); 'build': compilation so far [ms]; numbers of 'launches' (kernels, fills and
        copies) and of 'waits' for the device; 'device_bytes', 'peak_device_bytes'.
        """
    def enqueue(self, view: _View = 'full', camera: str | Camera | None = None, time: float = 0.0, size: tuple[int, int] | None = None) -> DeviceFrame:
        """enqueue(view='full', camera=None, time=0.0, size=None) -> DeviceFrame: render() without reading the image back.

        Does not wait for all of the frame (docs/api.md); not for view 'cells'.
        """
    def enqueue_light(self, width: int, height: int, *, normals: ArrayLike, positions: ArrayLike | None = None, depths: ArrayLike | None = None, irradiance: Any, eye: _Vector | None = None, camera: str | Camera | None = None, time: float = 0.0) -> DeviceEvent:
        """enqueue_light(width, height, *, normals, positions=None, depths=None, irradiance, ...) -> DeviceEvent: light() in device memory.

        Buffers of the renderer's context, as pyopencl's buffers or arrays, or integers: normals and positions float4 per pixel (w unused), or depths
        float; irradiance receives float4. Raises UsageError for others, and for buffers that are too small.
        """
    def device_volumes(self) -> DeviceVolumes:
        """device_volumes() -> DeviceVolumes of the last frame or light(). Raises UsageError as radiance()."""
    def lookup_source(self) -> str:
        """lookup_source() -> str: OpenCL C for the start of a program, clpv_irradiance() and clpv_radiance() at a point for kernels with
        the parameters CLPV_RADIANCE (docs/api.md).
        """
    def __enter__(self) -> "Renderer": ...
    def __exit__(self, *of_the_block: object) -> None: ...

class Scene:
    """Scene(path, model=None): a scene file (.json) or a glTF model (.gltf, .glb); `model` replaces that of the file.

    Renderers keep its data alive. Thread-safe. Raises InputError with file, place, value found and value allowed.
    """
    def __init__(self, path: _Path | None = None, model: _Path | None = None) -> None:
        ...
    def add_mesh(self, positions: ArrayLike, triangles: ArrayLike, *, normals: ArrayLike | None = None, uvs: ArrayLike | None = None, colours: ArrayLike | None = None, smooth: bool = False, material: Material | None = None, transform: ArrayLike | None = None, moves: bool = False) -> int:
        """add_mesh(positions, triangles, *, ...) -> int: a number for the mesh, which is not used again.

        positions: array (n, 3) [m], y up; triangles: integers (m, 3), counter-clockwise seen from the front; normals (n, 3), of any
        length; uvs: texture coordinates (n, 2), v = 0 in the first row; colours: linear floats (n, 3) or (n, 4), 0 to 1. Without
        normals: flat ones, as in glTF, or, if smooth, means of the triangles' normals, weighted by angle. material: None for white;
        transform: array (4, 4) to the world, which multiplies columns (x, y, z, 1). moves: it will move, so its
        first move needs no new memory (set_positions()). The arrays are copied. Raises InputError with array, index, value found and
        value allowed.
        """
    @staticmethod
    def from_arrays(positions: ArrayLike, triangles: ArrayLike, *, normals: ArrayLike | None = None, uvs: ArrayLike | None = None, colours: ArrayLike | None = None, smooth: bool = False, material: Material | None = None, transform: ArrayLike | None = None, moves: bool = False) -> "Scene":
        """from_arrays(positions, triangles, *, ...) -> Scene of one mesh, number 0, as add_mesh() describes it."""
    @staticmethod
    def from_trimesh(given: Any) -> "Scene":
        """from_trimesh(given) -> Scene of a trimesh.Trimesh or trimesh.Scene, [m], y up: geometry, instances, colours and base-colour
        textures.
        """
    def add_instance(self, mesh: int, transform: ArrayLike) -> int:
        """add_instance(mesh, transform) -> int: the same mesh at another place; its vertices are shared."""
    def remove_mesh(self, mesh: int) -> None:
        """remove_mesh(mesh): removes a mesh from one of its places."""
    def set_positions(self, mesh: int, positions: ArrayLike, normals: ArrayLike | None = None) -> None:
        """set_positions(mesh, positions, normals=None): moves its vertices, at all of its places. Normals that were given stay without
        `normals`. The next frame of each renderer recomputes what animation recomputes; at the
        first move of a mesh added without `moves`, and after an addition or removal, also its memory and what it caches.
        """
    def set_transform(self, mesh: int, transform: ArrayLike) -> None:
        """set_transform(mesh, transform): moves one place of a mesh. As set_positions()."""
    def pathtrace_points(self, positions: ArrayLike, normals: ArrayLike, *, bounces: int | Literal["all"] = 1, samples: int = 0, noise: float = 0.02, seed: int = 1, threads: int = 0, time: float = 0.0) -> dict[str, Any]:
        """pathtrace_points(positions, normals, *, ...) -> dict: path-traced irradiance [W/m^2], red, green, blue, the truth of
        Renderer.irradiance().

        positions [m] and normals (of any length; or one for all): arrays (..., 3), on a surface of the scene or in the air. 'indirect', 'direct' (of the
        scene's lights) and 'error', the standard error of 'indirect': float32 arrays of their shape; 'samples': paths per point;
        'noise': root mean square of 'error' over that of 'indirect', at which tracing stops. Arguments as for clpv.pathtrace().
        """
    @property
    def cameras(self) -> Sequence[Camera]:
        """Tuple of all Cameras, at 0 s if animated. Assign a sequence to replace them."""
    @cameras.setter
    def cameras(self, value: Sequence[Camera]) -> None: ...
    @property
    def lights(self) -> Sequence[Light]:
        """Tuple of all Lights, at 0 s if animated. Assign a sequence to replace them: the next frame of every renderer
        of this scene recomputes what depends on them.
        """
    @lights.setter
    def lights(self, value: Sequence[Light]) -> None: ...
    @property
    def medium(self) -> Medium | None:
        """Its Medium, or None. Assign to replace it: the next frame of every renderer of this scene allocates its memory again."""
    @medium.setter
    def medium(self, value: Medium | None) -> None: ...
    def save(self, path: _Path) -> None:
        """save(path): writes meshes, materials, cameras and lights at 0 s to a .glb. Logs a warning for a sky, a medium, a
        camera's only light, number and size of cascades, and an exposure, which glTF has not, and for a scene without lights.
        """
    @property
    def moves(self) -> bool:
        """True if anything is animated."""
    @property
    def notes(self) -> tuple[str, ...]:
        """One sentence for each thing skipped or added by the loader."""
    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Lower and upper corner of the bounding box [m], at 0 s."""
    @property
    def exposure(self) -> float:
        """Exposure of a display [EV]."""

class Volume:
    """Light of one cascade after propagation: n^3 cubic cells."""
    @property
    def origin(self) -> tuple[float, float, float]:
        """Minimum corner x, y, z [m]."""
    @property
    def cell(self) -> float:
        """Edge of a cell [m]."""
    @property
    def basis(self) -> str:
        """Name of the basis of the coefficients: sh3 after a sweep, else that of option basis."""
    @property
    def coefficients(self) -> NDArray[np.float32]:
        """float32 array (3, N, z, y, x): red, green, blue; N coefficients c_i of radiant intensity
        I(w) = sum_i c_i b_i(w) [W/sr], w the direction in which light travels. After a sweep I / cell^2
        is the radiance [W/m^2/sr] about the cell's centre.
        """

def bases() -> list[str]:
    """bases() -> list of the names of all bases."""

def compare(image: Image | ArrayLike, reference: Image | ArrayLike, exposure: float = 0.0) -> Comparison:
    """compare(image, reference, exposure=0.0) -> Comparison. Both: an Image, or an array (height, width, channels).
    exposure [EV]: of linear images, for FLIP.
    Raises InputError for other sizes, channels or encodings, and for values that are not finite.
    """

def devices() -> list[dict[str, Any]]:
    """devices() -> list of dict: all OpenCL devices; clpv can use those whose list `missing` is empty."""

def options() -> list[dict[str, str]]:
    """options() -> list of dict: name, help, allowed values and default of each option of Renderer."""

def ms_of(times: Sequence[dict[str, Any]], stage: str) -> float:
    """times: those of Renderer.stats or of JSON by clpv. 0 if the stage did not run. Other values raise UsageError."""

def pathtrace(scene: Scene, view: _View | Sequence[_View] = 'full', camera: str | Camera | None = None, width: int = 960, height: int = 540, bounces: int | Literal["all"] = 1, samples: int = 0, noise: float = 0.02, seed: int = 1, threads: int = 0, time: float = 0.0, progress: Callable[[float], object] | None = None) -> Image:
    """pathtrace(scene, view='full', ...) -> Image (height, width, 4): ground truth on the CPU.

    view: as of render(), or a list of several, which become layers of the image: channels 'indirect.R' and so on;
    bounces: reflections between light and visible surface, 'all' or 0 for all; samples: paths per pixel, 0 for as many as
    `noise` (relative standard error of the indirect light) needs; threads: 0 for one per processor.
    progress: a function that gets the estimated progress, 0 to 1, in this thread, up to 50 times a second; what it raises ends
    the work.
    """

def read_image(path: _Path) -> Image:
    """Reads an .exr, .png or .hdr file with all its channels -> Image. Raises InputError."""
