# SPDX-License-Identifier: MIT
"""Writes EXR files for tests."""
import struct

from clpv_lab.score import exr


def write(file, planes, data=None, display=None, more=b""):
    """An uncompressed EXR of floats. data, display: windows (left, top, right, bottom)."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value

    names, (height, width) = sorted(planes), next(iter(planes.values())).shape
    data = data or (0, 0, width - 1, height - 1)
    window, shown = struct.pack("<4i", *data), struct.pack("<4i", *(display or data))
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1)
                        for name in names) + b"\0"
    head = struct.pack("<2i", exr.MAGIC, 2) + attribute(b"channels", b"chlist", channels) + \
        attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", window) + \
        attribute(b"displayWindow", b"box2i", shown) + attribute(b"lineOrder", b"lineOrder", b"\0") + \
        attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) + \
        attribute(b"screenWindowCenter", b"v2f", bytes(8)) + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + more + b"\0"
    rows = [
        b"".join(planes[name][y].astype("<f4").tobytes() for name in names) for y in range(height)
    ]
    first, size = len(head) + 8 * height, 8 + len(rows[0])
    chunks = b"".join(
        struct.pack("<2i", data[1] + y, len(row)) + row for y, row in enumerate(rows))
    file.write_bytes(head + struct.pack(f"<{height}Q", *(first + y * size
                                                         for y in range(height))) + chunks)
