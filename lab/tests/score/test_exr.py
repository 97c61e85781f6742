# SPDX-License-Identifier: MIT
"""Odd EXR files are read, or rejected by name; test_score has compressed ones."""
import struct
import zlib

import numpy

import test_score
from exr_writer import write
from clpv_lab.score import exr

REC2020 = 0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329
CHUNK = zlib.compress(bytes(10**6))
ROW = 4 * 4 * test_score.SIZE[0]  # bytes


def attribute(name, kind, value):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value


class Odd(test_score.Suite):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "ours/room-left.exr"
        self.planes = test_score.layered(1.1 * self.truths["room-left"], self.alpha)

    def made(self, planes=None, **options):
        write(self.file, planes or self.planes, **options)
        return bytearray(self.file.read_bytes())

    def edited(self, place, *values):
        """A file with other bytes at a place."""
        data = self.made()
        data[place:place + len(values)] = values
        return data

    def with_value(self, name, value):
        """An attribute's first byte of value replaced."""
        return self.edited(self.made().index(name) + len(name) + 4, value)

    def with_chunk(self, row, number, value):
        """y (number 0) or size (1) of a chunk replaced."""
        data = self.made()
        offset, = struct.unpack_from("<Q", data, exr.header(data)[1] + 8 * row)
        struct.pack_into("<i", data, offset + 4 * number, value)
        return data

    def bomb(self):
        """ZIPS whose first chunk grows to a megabyte."""
        data = self.with_value(b"compression\0compression\0", 2)
        place, = struct.unpack_from("<Q", data, exr.header(data)[1])
        struct.pack_into("<i", data, place + 4, len(CHUNK))
        data[place + 8:place + 8 + len(CHUNK)] = CHUNK
        return data

    def ours(self, data):
        self.file.write_bytes(data)
        return self.score(only=["room-left"])["views"][0]["nrmse"]

    def test_files_that_are_read(self):
        foreign, (width, height) = struct.pack("<8f", *REC2020), test_score.SIZE
        for data in (self.made(), self.edited(5, 4),  # long names
                     self.made(more=attribute(b"chromaticities", b"string", foreign)),
                     self.made(more=attribute(b"envmap", b"envmap", b"\0")),  # flat
                     self.made(data=(-10, -20, width - 11, height - 21))):
            self.assertAlmostEqual(self.ours(data), 0.1, 4)

    def test_files_that_are_rejected(self):
        primaries = attribute(b"chromaticities", b"chromaticities", struct.pack("<8f", *REC2020))
        cube, nan = attribute(b"envmap", b"envmap", b"\1"), numpy.full_like(self.alpha, numpy.nan)
        table, first = exr.header(self.made())[1], self.made().index(b"chlist\0") + 11
        for words, data in (
                ("found chromaticities", self.made(more=primaries)),
                ("dataWindow", self.made(display=(0, 0, 9, 9))),
                ("version", self.edited(4, 3)), ("version", self.edited(5, 0x20)),
                ("tiled", self.edited(5, 2)), ("cube map", self.made(more=cube)),
                ("lineOrder", self.with_value(b"lineOrder\0lineOrder\0", 9)),
                ("not unique", self.edited(first, ord("B"))),
                ("not unique", self.edited(first, ord("Z"))),
                ("channel Z: found nan", self.made({**self.planes, "Z": nan})),
                ("rows from -1", self.with_chunk(5, 0, -1)),
                ("rows from 4", self.with_chunk(5, 0, 4)),
                ("damaged", self.with_chunk(0, 1, 9999)), ("10 bytes", self.with_chunk(9, 1, 10)),
                (f"{ROW + 1} bytes", self.bomb()),
                ("damaged", self.edited(table, *8 * [255])),
                ("damaged", self.made(data=(0, 0, 2**31 - 2, 2**31 - 2))),
                ("damaged", self.made()[:200])):
            with self.assertRaisesRegex(exr.BadImage, f"room-left.exr: .*{words}"):
                self.ours(data)
