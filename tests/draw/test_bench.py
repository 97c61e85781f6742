# SPDX-License-Identifier: MIT
"""Charts of benchmarks: they go by the fields of rows."""
import unittest
from unittest import mock

from support import row
from clpv.draw import __main__ as draw, bench, documents
from matplotlib import pyplot


class Charts(unittest.TestCase):
    def tearDown(self):
        pyplot.close("all")

    def test_layouts_distinguish_texels_and_occlusion(self):
        rows = [row("layouts", "gather", layout="image", storage="half", filtered=f, median=m)
                for f, m in ((True, 2.0), (False, 1.0))]
        plain, shadowed = bench.layouts(rows + [row("layouts", "gather", occlusion=True)]).axes
        self.assertEqual([t.get_text() for t in plain.get_yticklabels()],
                         ["image/half texels", "image/half"])
        self.assertEqual(shadowed.get_title(), "gather sh2, occlusion")

    def test_a_missing_module_is_named(self):
        with mock.patch.dict("sys.modules", {"clpv.draw.report": None}):  # main is what clpv calls
            self.assertEqual(draw.main(["report"]), 1)

    def test_rows_that_failed_are_left_out(self):
        failed = row("layouts", "gather", status="unsupported", median=0, min=0, p95=0)
        self.assertIsNone(bench.layouts([failed]))

    def test_a_document_of_another_shape_is_reported_with_its_place(self):
        with self.assertRaisesRegex(documents.BadDocument,
                                    r"x.json: /benchmarks/1/median is \"4\"; allowed: a number"):
            documents.checked(
                {"benchmarks": [row("a", "b"), row("a", "b", median="4")]}, "x.json", "benchmarks",
                bench.ROW)
