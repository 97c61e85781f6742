# SPDX-License-Identifier: MIT
"""Odd EXR files: read or rejected as by `clpv compare`, whose tests are exr_header and image_kinds."""
import struct
import unittest
import zlib

import numpy

import test_score
from exr_writer import write
from clpv_lab.score import exr

REC2020 = 0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329


def attribute(name, kind, value):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value


def zipped(rows, more=b""):
    """Rows of bytes as ZIPS, `more` behind each."""
    for row in rows:
        values = numpy.frombuffer(row, numpy.uint8).astype(int)
        halves = numpy.concatenate([values[0::2], values[1::2]])
        halves[1:] = (numpy.diff(halves) + 128) % 256
        yield zlib.compress(halves.astype(numpy.uint8).tobytes() + more)


class Odd(test_score.Suite):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "ours/room-left.exr"
        self.planes = test_score.layered(1.1 * self.truths["room-left"], self.alpha)

    def made(self, planes=None, **options):
        write(self.file, planes or self.planes, **options)
        return bytearray(self.file.read_bytes())

    def split(self):
        """A file and the offset of its table of chunks."""
        data = self.made()
        return data, exr.header(bytes(data))[1]

    def edited(self, change):
        data, table = self.split()
        change(data, table)
        return data

    def with_value(self, name, value):
        """An attribute's first byte of value replaced."""
        def change(data, _):
            data[data.index(name) + len(name) + 4] = value
        return self.edited(change)

    def with_chunk(self, row, number, value):
        """y (number 0) or size (1) of a chunk replaced."""
        def change(data, table):
            offset = struct.unpack_from("<Q", data, table + 8 * row)[0]
            struct.pack_into("<i", data, offset + 4 * number, value)
        return self.edited(change)

    def compressed(self, more):
        data, table = self.split()
        data[data.index(b"compression\0compression\0") + 28] = 2
        count = test_score.SIZE[1]
        size = 4 * 4 * test_score.SIZE[0]
        first = table + 8 * count
        rows = [data[first + (8 + size) * y + 8:first + (8 + size) * (y + 1)] for y in range(count)]
        chunks = [struct.pack("<2i", y, len(row)) + row for y, row in enumerate(zipped(rows, more))]
        places = numpy.cumsum([first] + [len(chunk) for chunk in chunks[:-1]])
        return data[:table] + struct.pack(f"<{count}Q", *places) + b"".join(chunks)

    def with_lines_downwards(self):
        data, table = self.split()
        data[data.index(b"lineOrder\0lineOrder\0") + 24] = 1
        count = test_score.SIZE[1]
        places = struct.unpack_from(f"<{count}Q", data, table)
        size = places[1] - places[0]
        chunks = [data[place:place + size] for place in reversed(places)]
        return data[:table] + struct.pack(f"<{count}Q", *reversed(places)) + b"".join(chunks)

    def ours(self):
        return self.score(only=["room-left"])["views"][0]["nrmse"]

    def test_files_that_are_read(self):
        foreign, (width, height) = struct.pack("<8f", *REC2020), test_score.SIZE
        for name, data in {
                "plain": self.made(), "ZIPS": self.compressed(b""),
                "long names": self.edited(lambda data, _: data.__setitem__(5, 4)),
                "lines from the bottom": self.with_lines_downwards(),
                "chromaticities of another type":
                    self.made(more=attribute(b"chromaticities", b"string", foreign)),
                "environment, flat": self.made(more=attribute(b"envmap", b"envmap", b"\0")),
                "window elsewhere": self.made(data=(-10, -20, width - 11, height - 21))
        }.items():
            self.file.write_bytes(data)
            self.assertAlmostEqual(self.ours(), 0.1, 4, name)

    def test_other_windows_and_primaries_are_named(self):
        foreign = attribute(b"chromaticities", b"chromaticities", struct.pack("<8f", *REC2020))
        for words, options in (("chromaticities", {"more": foreign}),
                               ("dataWindow", {"display": (0, 0, 9, 9)})):
            self.made(**options)
            with self.assertRaisesRegex(exr.BadImage, f"room-left.exr: found .*{words}"):
                exr.read(self.file)

    def test_files_that_are_rejected(self):
        nan = numpy.full_like(self.alpha, numpy.nan)
        for name, data in {
                "cube map": self.made(more=attribute(b"envmap", b"envmap", b"\1")),
                "version": self.edited(lambda data, _: data.__setitem__(4, 3)),
                "flag": self.edited(lambda data, _: data.__setitem__(5, 0x20)),
                "row -1": self.with_chunk(5, 0, -1), "row of another": self.with_chunk(5, 0, 4),
                "long chunk": self.with_chunk(0, 1, 9999), "short chunk": self.with_chunk(9, 1, 10),
                "long ZIPS": self.compressed(b"\x80" * 7),
                "far chunk": self.edited(lambda data, table: data.__setitem__(
                    slice(table, table + 8), b"\xff" * 8)),
                "line order": self.with_value(b"lineOrder\0lineOrder\0", 9),
                "duplicate channel": self.edited(lambda data, _: data.__setitem__(
                    data.index(b"chlist\0") + 11, ord("B"))),
                "unsorted channels": self.edited(lambda data, _: data.__setitem__(
                    data.index(b"chlist\0") + 11, ord("Z"))),
                "other channel": self.made({**self.planes, "Z": nan}),
                "more than fits memory": self.made(data=(0, 0, 2**31 - 2, 2**31 - 2))
        }.items():
            self.file.write_bytes(data)
            with self.assertRaises(exr.BadImage, msg=name):
                self.ours()


if __name__ == "__main__":
    unittest.main()
