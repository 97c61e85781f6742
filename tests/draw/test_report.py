# SPDX-License-Identifier: MIT
"""The report page: pictures of errors, the chart, what is escaped, what is missing, what is rejected."""
import json
import pathlib
import tempfile
import unittest

from support import bench_document, row, variant
from clpv.draw import documents, report
import numpy

NASTY = "<script>alert(1)</script> $x$ \"'&"


def uniform(columns, value):
    pixels = numpy.full((1, columns, 4), value, dtype="f4")
    pixels[..., 3] = 1
    return pixels


class FalseColour(unittest.TestCase):
    def test_runs_from_no_error_to_full_scale(self):
        truth, shot = uniform(3, 2), uniform(3, 2)
        shot[0, 1, :3] = 2 + 2 * report.FULL_SCALE  # as many times the truth's root mean square
        shot[0, 2, 3] = 0  # background
        colours, scale = report.false_colour(shot, truth), report.coloured([0, 1])
        numpy.testing.assert_allclose(colours[0, :2], scale)
        self.assertFalse(numpy.allclose(scale[0], scale[1]))
        self.assertEqual(colours[0, 2, 3], 0)

    def test_a_black_truth_has_no_scale(self):
        numpy.testing.assert_allclose(report.false_colour(uniform(1, 1), uniform(1, 0))[0], report.coloured([0]))


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.document = {"subtitle": NASTY, "views": [], "quality": [], "benchmarks": [],
                         "marked": [{"preset": "best"}]}

    def image(self, stem, pixels):
        numpy.save(self.folder / f"{stem}.npy", pixels)
        (self.folder / f"{stem}.png").write_bytes(report.as_png(pixels / pixels.max()))
        return {"image": f"{stem}.png", "values": f"{stem}.npy"}

    def add_view(self):
        shot = {"title": "ours", "options": NASTY, "nrmse_valid": 0.1, "nrmse_best_gain": 0.0, "energy_ratio": 1.1,
                **self.image("shot", uniform(2, 1.1))}
        black = {**shot, "title": "other", "nrmse_valid": None, "nrmse_best_gain": None, "energy_ratio": None}
        self.document["views"].append({"scene": NASTY, "camera": NASTY, "truth": self.image("truth", uniform(2, 1)),
                                       "shots": [shot, black]})

    def page(self):
        (self.folder / "report.json").write_text(json.dumps(self.document))
        report.draw(self.folder, self.folder / "index.html")
        return (self.folder / "index.html").read_text()

    def test_has_everything_inside(self):
        self.add_view()
        self.document["quality"] = [{"file": "q.json", "document": {"variants": [variant({"preset": "best"})]}}]
        self.document["benchmarks"] = [{"file": "b.json", "document": bench_document(
            row("table1", "propagate", cascade=0, occlusion=True), row("layouts", "gather", layout=NASTY),
            row("layouts", "gather", status="unsupported", reason="no images"))}]
        html = self.page()
        self.assertIn("ours: NRMSE 10.0 %, after the best gain 0.0 %, energy 1.10 of the ground truth", html)
        self.assertIn("other: the ground truth is black", html)
        self.assertIn('<tr class="marked"><td>best</td><td>45.0 %', html)
        self.assertIn("<td>4.25</td>", html)
        self.assertIn("no images", html)
        self.assertEqual(html.count("data:image/png;base64,iVBORw0KGgo"), 1 + 2 * 2 + 1 + 2 * 2)
        self.assertNotIn("http", html)
        self.assertNotIn("<link", html)

    def test_escapes_what_users_wrote(self):
        self.add_view()
        options = {"preset": NASTY}
        self.document["quality"] = [{"file": "q.json", "document": {"variants": [variant(options)]}}]
        self.document["marked"] = [options]
        self.document["benchmarks"] = [{"file": "b.json", "document": bench_document(
            row("table1", NASTY), row("layouts", NASTY), row("layouts", "gather", status=NASTY, reason=NASTY))}]
        html = self.page()
        self.assertNotIn("<script>alert", html)
        self.assertEqual(html.count("<script"), 1)
        self.assertGreaterEqual(html.count("&lt;script&gt;alert(1)&lt;/script&gt; $x$"), 10)

    def test_says_what_is_missing(self):
        html = self.page()
        for what in ("No views", "--quality FILE", "clpv bench table1", "clpv bench layouts"):
            self.assertIn(what, html)

    def test_the_chart_follows_the_page_and_names_its_points(self):
        self.document["quality"] = [{"file": "q.json", "document": {"variants": [variant({"basis": "a&b"})]}}]
        html = self.page()
        chart = html[html.index("<svg"):html.index("</svg>")]
        self.assertIn("<title>a&amp;b</title>", chart)
        self.assertIn("var(--ink)", chart)
        self.assertNotIn(report.style.INK, chart)

    def test_the_front_has_what_none_beats(self):
        self.assertEqual(report.front_of([(4, 30), (2, 60), (1, 50), (5, 30)]), [(1, 50), (4, 30)])

    def test_rejects_a_document_of_another_shape(self):
        self.document["quality"] = [{"file": "q.json", "document": {"variants": [{"rejected": 0, "options": {}}]}}]
        with self.assertRaisesRegex(documents.BadDocument, "q.json: /variants/0/nrmse is null; allowed: a number"):
            self.page()
        self.assertFalse((self.folder / "index.html").exists())


if __name__ == "__main__":
    unittest.main()
