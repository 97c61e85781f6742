# SPDX-License-Identifier: MIT
"""Reads OpenEXR images with NumPy alone: scanlines, uncompressed, ZIP or ZIPS. Other files need the
module OpenEXR (PyPI)."""
import struct
import zlib

import numpy

MAGIC, NOT_SCANLINES = 20000630, 0x1a00  # in the version: tiled, deep, several parts
TYPES = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
ROWS = {0: 1, 2: 1, 3: 16}  # of a chunk, by compression: none, ZIPS, ZIP


class BadImage(Exception):
    """Says which file, what is in it, and what is allowed."""


def header(data):
    """Returns attributes {name: bytes} and the offset behind them."""
    at, attributes = 8, {}
    while data[at]:
        name, kind = data.index(0, at), data.index(0, data.index(0, at) + 1)
        size = struct.unpack_from("<i", data, kind + 1)[0]
        attributes[data[at:name].decode()] = data[kind + 5:kind + 5 + size]
        at = kind + 5 + size
    return attributes, at + 1


def channel_list(value):
    """Returns [(name, type)] in the order of the pixels."""
    at, found = 0, []
    while value[at]:
        end = value.index(0, at)
        found.append((value[at:end].decode(), TYPES[struct.unpack_from("<i", value, end + 1)[0]]))
        at = end + 17
    return found


def unzipped(data, size):
    """Inverts ZIP compression: bytes are differences, those at even places first."""
    if len(data) == size:
        return data  # what does not shrink is stored as it is
    deltas = numpy.frombuffer(zlib.decompress(data), numpy.uint8).astype(numpy.uint64)
    deltas[1:] += 128  # differences are stored with an offset of 128
    values = numpy.cumsum(deltas).astype(numpy.uint8)
    half = (len(values) + 1) // 2
    result = numpy.empty_like(values)
    result[0::2], result[1::2] = values[:half], values[half:]
    return result.tobytes()


def scanlines(data, attributes, at):
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    channels = channel_list(attributes["channels"])
    bytes_of_row = width * sum(kind.itemsize for _, kind in channels)
    # Rows that no chunk has stay NaN, which callers reject.
    planes = {name: numpy.full((height, width), numpy.nan, numpy.float32) for name, _ in channels}
    compression = attributes["compression"][0]
    rows = ROWS[compression]
    for offset in struct.unpack_from(f"<{-(-height // rows)}Q", data, at):
        y, size = struct.unpack_from("<2i", data, offset)
        first, count = y - top, min(rows, bottom - y + 1)
        chunk = data[offset + 8:offset + 8 + size]
        if compression:
            chunk = unzipped(chunk, count * bytes_of_row)
        place = 0
        for row in range(first, first + count):
            for name, kind in channels:
                planes[name][row] = numpy.frombuffer(chunk, kind, width, place)
                place += width * kind.itemsize
    return planes


def by_openexr(file):
    try:
        import OpenEXR
    except ImportError:
        raise BadImage(
            f"{file}: found a tiled, deep, multi-part or differently compressed EXR; allowed: scanlines, "
            "uncompressed, ZIP or ZIPS, or install OpenEXR (PyPI)") from None
    if not hasattr(OpenEXR, "File"):
        raise BadImage(f"{file}: found OpenEXR {OpenEXR.__version__}; allowed: at least 3.3 (PyPI)")
    with OpenEXR.File(str(file), separate_channels=True) as image:
        return {
            name: channel.pixels.astype(numpy.float32)
            for name, channel in image.channels().items()
        }


def read(file):
    """Returns the channels {name: float32 array of height x width}. Throws BadImage."""
    try:
        data = file.read_bytes()
    except OSError as error:
        raise BadImage(f"{file}: {error.strerror}") from None
    try:
        magic, version = struct.unpack_from("<2i", data)
        if magic != MAGIC:
            raise BadImage(f"{file}: no EXR file")
        attributes, at = header(data)
        if version & NOT_SCANLINES or attributes["compression"][0] not in ROWS:
            return by_openexr(file)
        return scanlines(data, attributes, at)
    except (struct.error, zlib.error, IndexError, KeyError, ValueError, RuntimeError) as error:
        raise BadImage(f"{file}: damaged EXR ({type(error).__name__}: {error})") from None


def colours(planes, file, layer=""):
    """Returns R, G and B of a layer (height x width x 3) and its alpha, 1 where there is none.
    Throws BadImage for values that are not finite."""
    prefix = f"{layer}." if layer else ""
    if any(prefix + name not in planes for name in "RGB"):
        raise BadImage(
            f"{file}: found channels {', '.join(sorted(planes))}; allowed: {', '.join(prefix + c for c in 'RGB')}"
        )
    rgb = numpy.stack([planes[prefix + name] for name in "RGB"], axis=-1)
    alpha = planes.get(f"{prefix}A", numpy.ones(rgb.shape[:2], numpy.float32))
    values = numpy.concatenate([rgb, alpha[..., None]], axis=-1)
    bad = numpy.argwhere(~numpy.isfinite(values))
    if len(bad):
        y, x, channel = bad[0]
        raise BadImage(
            f"{file}: pixel ({x}, {y}), channel {prefix}{'RGBA'[channel]}: found "
            f"{values[y, x, channel]}, {len(bad)} such values; allowed: finite values")
    return rgb, alpha
