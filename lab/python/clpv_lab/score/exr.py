# SPDX-License-Identifier: MIT
"""Reads OpenEXR images: scanlines, uncompressed, ZIP or ZIPS. Arrays need NumPy; scripts/demo reads
without it."""
import itertools
import struct
import zlib

MAGIC, VERSION, LONG_NAMES = 20000630, 2, 0x400
NOT_SCANLINES = 0x1a00  # in the version: tiled, deep, several parts
KINDS = {"channels": "chlist", "compression": "compression", "dataWindow": "box2i",
         "displayWindow": "box2i", "lineOrder": "lineOrder", "chromaticities": "chromaticities",
         "envmap": "envmap"}  # types of attributes that are read
CUBE_MAP, LINE_ORDERS = b"\1", (b"\0", b"\1")
TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}  # with their bytes
ROWS = {0: 1, 2: 1, 3: 16}  # rows of a chunk, by compression: none, ZIPS, ZIP
REC709 = 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.3290  # x and y of red, green, blue and white
SAME_CHROMATICITY = 1e-3  # standards state three or four digits


class BadImage(Exception):
    """Says which file, what is in it, and what is allowed."""


def header(data):
    """Returns attributes {name: bytes}, of the types that they should have, and the offset behind
    them."""
    at, attributes, names = 8, {}, set()
    while data[at]:
        end = data.index(0, at)
        kind = data.index(0, end + 1)
        size = struct.unpack_from("<i", data, kind + 1)[0]
        name, type_name = data[at:end].decode(), data[end + 1:kind].decode()
        if size < 0 or name in names:
            raise ValueError(f"attribute {name}: duplicate, or of {size} bytes")
        names.add(name)
        if KINDS.get(name) == type_name:
            attributes[name] = data[kind + 5:kind + 5 + size]
        at = kind + 5 + size
    return attributes, at + 1


def channel_list(value):
    """Returns [(name, type)] in the order of the pixels."""
    at, found = 0, []
    while value[at]:
        end = value.index(0, at)
        kind, x, y = struct.unpack_from("<i4x2i", value, end + 1)
        if (x, y) != (1, 1):
            raise ValueError(f"channel {value[at:end].decode()} sampled every {x} x {y} pixels")
        found.append((value[at:end].decode(), TYPES[kind]))
        at = end + 17
    names = [name for name, _ in found]
    if names != sorted(set(names)):
        raise ValueError(f"channels {', '.join(names)}: not unique and sorted")
    return found


def unzipped(data, size):
    """Inverts ZIP compression: bytes are differences, those at even places first."""
    if len(data) == size:
        return data  # data that do not shrink are stored as they are
    values = bytearray(zlib.decompressobj().decompress(data, size + 1))
    values[:] = itertools.accumulate(values, lambda value, step: value + step - 128 & 255)
    half = (len(values) + 1) // 2
    values[0::2], values[1::2] = values[:half], values[half:]
    return values


def scanlines(data, attributes, at):
    """Width, height, and {channel: (type, bytes)}."""
    left, top, right, bottom = window(attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    channels = channel_list(attributes["channels"])
    bytes_of_row = width * sum(int(kind[-1]) for _, kind in channels)
    planes = {name: (kind, bytearray()) for name, kind in channels}
    compression = attributes["compression"][0]
    rows = ROWS[compression]
    if attributes["lineOrder"] not in LINE_ORDERS:
        raise ValueError(f"lineOrder {attributes['lineOrder']}")
    for i, offset in enumerate(struct.unpack_from(f"<{-(-height // rows)}Q", data, at)):
        y, size = struct.unpack_from("<2i", data, offset)
        first, count = rows * i, min(rows, height - rows * i)
        chunk = data[offset + 8:offset + 8 + size]
        if compression:
            chunk = unzipped(chunk, count * bytes_of_row)
        if y != top + first or len(chunk) != count * bytes_of_row:
            raise ValueError(f"rows from {y}, {len(chunk)} bytes, in place of rows from "
                             f"{top + first}, {count * bytes_of_row} bytes")
        place = 0
        for name, kind in channels * count:
            end = place + width * int(kind[-1])
            planes[name][1].extend(chunk[place:end])
            place = end
    return width, height, planes


def window(value):
    return struct.unpack("<4i", value)


def raw(file):
    """Width, height, and the channels {name: (type, bytes)}, R, G and B those of Rec. 709. Throws
    BadImage."""
    if file.exists() and not file.is_file():
        raise BadImage(f"{file}: found no regular file; allowed: an EXR file")
    try:
        data = file.read_bytes()
    except OSError as error:
        raise BadImage(f"{file}: {error.strerror}") from None
    try:
        magic, version = struct.unpack_from("<2i", data)
        if magic != MAGIC:
            raise BadImage(f"{file}: no EXR file")
        if version & ~NOT_SCANLINES & ~LONG_NAMES != VERSION:
            raise BadImage(f"{file}: found EXR of version {version:#x}; allowed: {VERSION}")
        attributes, at = header(data)
        if attributes.get("envmap") == CUBE_MAP:
            raise BadImage(f"{file}: found a cube map (attribute envmap); allowed: flat images")
        if version & NOT_SCANLINES or attributes["compression"][0] not in ROWS:
            raise BadImage(f"{file}: found a tiled, deep, multi-part or differently compressed EXR; "
                           "allowed: scanlines, uncompressed, ZIP or ZIPS")
        if attributes["dataWindow"] != attributes["displayWindow"]:
            raise BadImage(f"{file}: found pixels {window(attributes['dataWindow'])} (dataWindow); "
                           "allowed: those of the displayWindow")
        if "chromaticities" in attributes:
            found = struct.unpack("<8f", attributes["chromaticities"])
            if not all(abs(a - b) <= SAME_CHROMATICITY for a, b in zip(found, REC709)):
                raise BadImage(f"{file}: found chromaticities {found}; allowed: Rec. 709")
        return scanlines(data, attributes, at)
    except (struct.error, zlib.error, IndexError, KeyError, ValueError, TypeError, RuntimeError,
            MemoryError, OverflowError) as error:
        raise BadImage(f"{file}: damaged EXR ({type(error).__name__}: {error})") from None


def read(file):
    """Returns the channels {name: float32 array of height x width}. Throws BadImage."""
    import numpy
    width, height, planes = raw(file)
    return {name: numpy.frombuffer(data, kind).reshape(height, width).astype("f4")
            for name, (kind, data) in planes.items()}


def colours(planes, file, layer=""):
    """Returns R, G and B of a layer (height x width x 3) and its alpha, 1 where there is none.
    Throws BadImage for values that are not finite."""
    import numpy
    prefix = f"{layer}." if layer else ""
    if any(prefix + name not in planes for name in "RGB"):
        raise BadImage(
            f"{file}: found channels {', '.join(sorted(planes))}; allowed: {', '.join(prefix + c for c in 'RGB')}"
        )
    rgb = numpy.stack([planes[prefix + name] for name in "RGB"], axis=-1)
    alpha = planes.get(f"{prefix}A", numpy.ones(rgb.shape[:2], numpy.float32))
    for name, plane in planes.items():
        bad = numpy.argwhere(~numpy.isfinite(plane))
        if len(bad) and name.rpartition(".")[0] == layer:
            y, x = bad[0]
            raise BadImage(f"{file}: pixel ({x}, {y}), channel {name}: found {plane[y, x]}, "
                           f"{len(bad)} such values; allowed: finite values")
    return rgb, alpha
