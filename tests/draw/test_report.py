# SPDX-License-Identifier: MIT
"""The report page: its viewer, the chart, what is escaped, what is missing, what is rejected."""
import base64
import json
import pathlib
import re
import tempfile
import unittest

from support import bench_document, row, variant
from clpv import output
from clpv.draw import documents, report
import numpy

NASTY = "<script>alert(1)</script> $x$ \"'&"


def uniform(columns, value):
    pixels = numpy.full((1, columns, 4), value, dtype="f4")
    pixels[..., 3] = 1
    return pixels


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.document = {"subtitle": NASTY, "views": [], "quality": [], "benchmarks": [],
                         "marked": [{"preset": "best"}]}

    def image(self, stem, pixels):
        numpy.save(self.folder / f"{stem}.npy", pixels)
        return f"{stem}.npy"

    def add_view(self):
        shot = {
            "title": "ours", "options": NASTY, "nrmse_valid": 0.1, "nrmse_best_gain": 0.0,
            "energy_ratio": 1.1, "flip": 0.02, "values": self.image("shot", uniform(2, 1.1))
        }
        black = {
            **shot, "title": "other", "options": None, "nrmse_valid": None, "nrmse_best_gain": None,
            "energy_ratio": None, "values": self.image("other",
                                                       uniform(2, 0)[..., :3])
        }
        self.document["views"].append({
            "scene": NASTY, "camera": NASTY, "exposure": 0,
            "truth": self.image("truth", uniform(2, 1)), "shots": [shot, black]
        })

    def page(self):
        (self.folder / "report.json").write_text(json.dumps(self.document))
        report.draw(self.folder, self.folder / "index.html")
        return (self.folder / "index.html").read_text()

    def views(self, html):
        return json.loads(
            re.search(r'<script type="application/json" id="data">(.*?)</script>', html,
                      re.DOTALL)[1])

    def test_the_viewer_has_linear_values(self):
        self.add_view()
        truth, ours, _ = self.views(self.page())[0]["images"]
        for image, value in ((truth, 1), (ours, 1.1)):
            halves = numpy.frombuffer(base64.b64decode(image["halves"]), "<f2")
            numpy.testing.assert_allclose(halves, numpy.full(6, value), rtol=1e-3)

    def test_has_everything_inside(self):
        self.add_view()
        self.document["quality"] = [{
            "file": "q.json", "document": {"variants": [variant({"preset": "best"})]}
        }]
        self.document["benchmarks"] = [{
            "file": "b.json", "document": bench_document(
                row("table1", "propagate", cascade=0, occlusion=True),
                row("layouts", "gather", layout=NASTY),
                row("layouts", "gather", status="unsupported", reason="no images"))
        }]
        html = self.page()
        self.assertIn("<td>ours</td><td>10.0</td><td>0.0</td><td>1.10</td><td>0.020</td>", html)
        self.assertIn("<td>other</td><td>-</td>", html)
        self.assertEqual([image["title"] for image in self.views(html)[0]["images"]],
                         ["path tracing", "ours", "other"])
        self.assertIn('<tr class="marked"><td>best</td><td>45.0 %', html)
        self.assertIn("<td>4.25</td>", html)
        self.assertIn("no images", html)
        self.assertNotIn("http", html)
        self.assertNotIn("<link", html)

    def test_escapes_what_users_wrote(self):
        self.add_view()
        options = {"preset": NASTY}
        self.document["quality"] = [{
            "file": "q.json", "document": {"variants": [variant(options)]}
        }]
        self.document["marked"] = [options]
        self.document["benchmarks"] = [{
            "file": "b.json",
            "document": bench_document(row("table1", NASTY), row("layouts", NASTY),
                                       row("layouts", "gather", status=NASTY, reason=NASTY))
        }]
        html = self.page()
        self.assertNotIn("<script>alert", html)
        self.assertEqual(html.count("<script"), 3)
        self.assertGreaterEqual(html.count("&lt;script&gt;alert(1)&lt;/script&gt; $x$"), 9)

    def test_the_page_spares_its_inputs(self):
        self.add_view()
        self.page()
        (self.folder / "link.html").symlink_to("truth.npy")
        for name in "report.json", "link.html":
            before = (self.folder / name).read_bytes()
            with self.assertRaisesRegex(output.BadOutput, "allowed: another file"):
                report.draw(self.folder, self.folder / name)
            self.assertEqual((self.folder / name).read_bytes(), before)

    def test_says_what_is_missing(self):
        html = self.page()
        for what in ("No views", "--quality FILE", "clpv bench table1", "clpv bench layouts"):
            self.assertIn(what, html)

    def test_the_chart_follows_the_page_and_names_its_points(self):
        self.document["quality"] = [{
            "file": "q.json", "document": {"variants": [variant({"basis": "a&b"})]}
        }]
        html = self.page()
        chart = html[html.index("<svg"):html.index("</svg>")]
        self.assertIn("<title>a&amp;b</title>", chart)
        self.assertIn("var(--ink)", chart)
        self.assertNotIn(report.style.INK, chart)

    def test_the_front_has_what_none_beats(self):
        self.assertEqual(report.front_of([(4, 30), (2, 60), (1, 50), (5, 30)]), [(1, 50), (4, 30)])

    def test_rejects_a_document_of_another_shape(self):
        self.document["quality"] = [{
            "file": "q.json", "document": {"variants": [{"rejected": 0, "options": {}}]}
        }]
        with self.assertRaisesRegex(documents.BadDocument,
                                    "q.json: /variants/0/nrmse is null; allowed: a number"):
            self.page()
        self.assertFalse((self.folder / "index.html").exists())


if __name__ == "__main__":
    unittest.main()
