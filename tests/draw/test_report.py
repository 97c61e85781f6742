# SPDX-License-Identifier: MIT
"""The report page: its viewer, the chart, what is escaped, what is missing."""
import base64
import json
import pathlib
import re
import tempfile
import unittest

from support import row, variant
from clpv.draw import report
import numpy

NASTY = "<script>alert(1)</script> $x$ \"'&"


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.document = {"subtitle": NASTY, "methods": [], "views": [], "quality": [], "benchmarks": [],
                         "marked": [{"preset": "best"}]}

    def add_views(self):
        """A lit view and a black one, two pixels wide; the second method lacks the second."""
        self.document["methods"] = [{"title": "ours", "options": NASTY},
                                    {"title": NASTY, "options": None}]
        for name, lights in ("lit", (1, 1.1, 0.5)), ("black", (0, 1.1)):
            images = []
            for title, light in zip(("path tracing", "ours", NASTY), lights):
                image = {"title": title, "file": f"{name}-{len(images)}.npy"}
                numpy.save(self.folder / image["file"], numpy.full((1, 2, 4), light, "f4"))
                if images:
                    image |= {"flip": "flip.npy", "errors": {
                        "nrmse": abs(light - 1) if name == "lit" else None, "nrmse_best_gain": 0,
                        "energy_ratio": light, "flip": 0.2}}
                images.append(image)
            self.document["views"].append(
                {"name": name, "width": 2, "height": 1, "exposure": 0, "images": images})
        numpy.save(self.folder / "flip.npy", numpy.full((1, 2, 1), 0.2, "f4"))

    def page(self):
        (self.folder / "report.json").write_text(json.dumps(self.document))
        report.draw(self.folder, self.folder / "index.html")
        return (self.folder / "index.html").read_text()

    def views(self, html):
        return json.loads(
            re.search(r'<script type="application/json" id="data">(.*?)</script>', html,
                      re.DOTALL)[1])

    def test_the_viewer_has_linear_values(self):
        self.add_views()
        truth, ours, _ = self.views(self.page())[0]["images"]
        self.assertEqual(truth["title"], "path tracing")
        for image, value in ((truth, 1), (ours, 1.1)):
            halves = numpy.frombuffer(base64.b64decode(image["halves"]), "<f2")
            numpy.testing.assert_allclose(halves, numpy.full(6, value), rtol=1e-3)
        self.assertEqual(base64.b64decode(ours["flip"]), bytes([51, 51]))
        self.assertNotIn("flip", truth)

    def test_has_everything_inside(self):
        self.add_views()
        self.document["quality"] = [{
            "file": "q.json", "document": {"variants": [variant({"preset": "best"})]}
        }]
        self.document["benchmarks"] = [{
            "file": "b.json", "document": {"benchmarks": [
                row("table1", "propagate", cascade=0, occlusion=True),
                row("layouts", "gather", layout=NASTY),
                row("layouts", "gather", status="unsupported", reason="no images")
            ]}
        }]
        html = self.page()
        self.assertRegex(html, "<td>lit</td><td>ours</td><td>10.0</td><td>0.0</td><td>1.100</td>"
                               "<td>0.200</td>")
        self.assertIn("<td>black</td><td>ours</td><td>-</td>", html)
        self.assertEqual([[image["title"] for image in view["images"]] for view in self.views(html)],
                         [["path tracing", "ours", NASTY], ["path tracing", "ours"]])
        self.assertIn('<tr class="marked"><td>best</td><td>45.0 %', html)
        self.assertIn("<td>4.25</td>", html)
        self.assertEqual(html, self.page(), "two runs give the same bytes")
        self.assertIn("no images", html)
        self.assertNotIn("http", html)
        self.assertNotIn("<link", html)

    def test_escapes_what_users_wrote(self):
        self.add_views()
        options = {"preset": NASTY}
        self.document["quality"] = [{
            "file": "q.json", "document": {"variants": [variant(options)]}
        }]
        self.document["marked"] = [options]
        self.document["benchmarks"] = [{
            "file": "b.json", "document": {"benchmarks": [
                row("table1", NASTY), row("layouts", NASTY),
                row("layouts", "gather", status=NASTY, reason=NASTY)
            ]}
        }]
        html = self.page()
        self.assertNotIn("<script>alert", html)
        self.assertEqual(html.count("<script"), 2)
        self.assertGreaterEqual(html.count("&lt;script&gt;alert(1)&lt;/script&gt; $x$"), 9)

    def test_says_what_is_missing(self):
        html = self.page()
        self.assertIn("Not given: scenes; --quality; --bench of clpv bench table1; --bench of clpv "
                      "bench layouts.", html)
        self.assertNotIn("<h2>", html)

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
