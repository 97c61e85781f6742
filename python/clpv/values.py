# SPDX-License-Identifier: MIT
"""Camera, Light, Medium and Material: immutable values. Ranges are checked where they are used."""
import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy
from numpy.typing import NDArray

from clpv import _native

Vector = Sequence[float] | NDArray[Any]  # as given; a tuple in the value
Colour = float | Vector  # one number is red, green and blue


def _number(given):
    if isinstance(given, str):
        raise TypeError
    return float(given)


def _vector(given):
    x, y, z = map(_number, given)
    return x, y, z


def _colour(given):
    return _vector(given) if numpy.ndim(given) else (_number(given), ) * 3


def _base_colour(given):
    made = tuple(map(_number, given)) if numpy.ndim(given) and len(given) == 4 else _colour(given)
    return made if len(made) == 4 else (*made, 1.0)


def _box(given):
    low, high = map(_vector, given)
    return low, high


def _text(given):
    if not isinstance(given, str):
        raise TypeError
    return given


def _texture(given):
    if isinstance(given, numpy.ma.MaskedArray):  # hidden numbers would count
        raise TypeError
    made = _native._texture(numpy.asarray(given))
    made.flags.writeable = False
    return made


# How a field of a name or a type is converted, and what an error allows.
KINDS = {
    str: (_text, "a text"), float: (_number, "a number"), bool: (bool, "True or False"),
    Vector: (_vector, "three numbers"), Colour: (_colour, "one number or three"),
    "base_colour": (_base_colour, "one number, three or four"),
    "box": (_box, "two corners or None"), "alpha_cutoff": (_number, "a number or None"),
    "texture": (_texture, "an array (height, width, 4) or None")
}


def _made(kind, fields):
    return kind(**fields)


class _Value:
    """Converts its fields. A value of another kind raises UsageError."""

    def __post_init__(self):
        for field in dataclasses.fields(self):
            given = getattr(self, field.name)
            convert, allowed = KINDS.get(field.name) or KINDS[field.type]
            try:
                made = None if given is None and field.default is None else convert(given)
            except (TypeError, ValueError, OverflowError) as error:
                if isinstance(error, _native.InputError):  # of a texture's content
                    raise
                raise _native.UsageError(f"{type(self).__name__}: {field.name}: found {given!r}, "
                                         f"allowed: {allowed}") from None
            object.__setattr__(self, field.name, made)

    def _key(self):
        return tuple((value.shape, value.tobytes()) if isinstance(value, numpy.ndarray) else value
                     for value in vars(self).values())

    def __eq__(self, other):
        return type(self) is type(other) and self._key() == other._key()

    def __hash__(self):
        return hash(self._key())

    def __reduce__(self):  # copies convert their fields again: arrays stay read-only
        return _made, (type(self), vars(self))

    def replace(self, **changes):
        """A copy with other values of some fields."""
        return dataclasses.replace(self, **changes)


@dataclasses.dataclass(frozen=True, eq=False)
class Camera(_Value):
    """Perspective camera.

    eye, target, up: x, y, z [m]; fov: vertical field of view [degrees]; near: nearest visible depth
    [m]; light: name of its only light, empty for all."""
    eye: Vector
    target: Vector
    up: Vector = (0, 1, 0)
    fov: float = 60
    near: float = 0.05
    name: str = ""
    light: str = ""


@dataclasses.dataclass(frozen=True, eq=False)
class Light(_Value):
    """Light without extent.

    kind: 'directional', 'spot' or 'point'; position [m]; direction in which light travels;
    intensity: red, green, blue, or one number: illuminance [lx = W/m^2] if directional, else
    [cd = W/sr]; range [m], 0 for no limit; inner_cone, outer_cone: angles of a spot [degrees]."""
    kind: str = "directional"
    position: Vector = (0, 0, 0)
    direction: Vector = (0, -1, 0)
    intensity: Colour = 1
    range: float = 0
    inner_cone: float = 0
    outer_cone: float = 45
    name: str = ""


@dataclasses.dataclass(frozen=True, eq=False)
class Medium(_Value):
    """Homogeneous fog or dust in a box.

    scattering, absorption: red, green, blue, or one number [1/m]; anisotropy: -0.9 to 0.9, above 0
    forwards; box: lower and upper corner [m], None for the scene's bounding box."""
    scattering: Colour = 0
    absorption: Colour = 0
    anisotropy: float = 0
    box: Sequence[Vector] | None = None


@dataclasses.dataclass(frozen=True, eq=False, kw_only=True)
class Material(_Value):
    """Diffuse surface of a mesh.

    base_colour: linear red, green, blue and optionally alpha, or one number, 0 to 1; emission:
    radiance of the front [W/m^2/sr], three numbers or one; texture: array (height, width, 4), uint8
    with sRGB-encoded colour, or floats, linear; alpha_cutoff: alpha below which there are holes;
    double_sided: visible, and emissive, from both sides."""
    base_colour: Colour = 1
    emission: Colour = 0
    texture: NDArray[Any] | None = None
    alpha_cutoff: float | None = None
    double_sided: bool = False
