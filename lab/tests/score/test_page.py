# SPDX-License-Identifier: MIT
"""The page of the scorer in headless Chromium: slider, exposure, error maps and values under the
cursor."""
import json
import re
import shutil
import subprocess
import tempfile
import unittest

import test_score
from clpv_lab.score import errors, exr, page

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
# Sums of all channels as the page draws them, with the controls moved.
DRIVER = """<script>
const errors = [];
addEventListener('error', event => errors.push(event.message));
const move = (name, value) => { control(name).value = value; control(name).dispatchEvent(new Event('input')); };
const sum = () => context.getImageData(0, 0, canvas.width, canvas.height).data.reduce((total, value) => total + value, 0);
const found = {};
move('split', 100); found.truth = sum();
move('split', 0); found.ours = sum();
move('exposure', 4); found.brighter = sum();
for (const map of ['relative', 'FLIP', 'signed']) { move('show', map); found[map] = sum(); }
move('split', 100); found.none = sum();
found.fits = [canvas, control('split')].map(each => each.getBoundingClientRect().width);
found.room = document.querySelector('.frame').clientWidth;
move('zoom', 8); found.wide = canvas.getBoundingClientRect().width;
const box = canvas.getBoundingClientRect();
canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: box.left + 8 * 10 + 4, clientY: box.top + 8 * 12 + 4}));
found.values = control('values').textContent;
move('show', 'image'); move('split', 0); move('view', 1); found.other = sum();
found.errors = errors;
document.documentElement.dataset.found = JSON.stringify(found);
</script>"""


class Page(test_score.Suite):
    def folders(self):
        self.put(lambda truth: 1.5 * truth)
        return [("mine", self.folder / "ours")]

    @unittest.skipUnless(CHROMIUM, "no Chromium (Debian: apt install chromium)")
    def test_controls_change_what_is_drawn(self):
        file = self.folder / "page.html"
        file.write_text(page.made(self.folder, self.folders()) + DRIVER)
        with tempfile.TemporaryDirectory() as profile:
            dumped = subprocess.run([
                CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                f"--user-data-dir={profile}", "--dump-dom", f"file://{file}"
            ], check=True, capture_output=True, text=True, timeout=120).stdout
        found = json.loads(re.search(r'data-found="([^"]*)"', dumped)[1].replace("&quot;", '"'))
        self.assertEqual(found["errors"], [])
        self.assertGreater(found["ours"], found["truth"])
        self.assertGreater(found["brighter"], found["ours"])
        for name in ("relative", *(["FLIP"] if errors.flip_evaluator else []), "signed"):
            self.assertGreater(found[name], found["none"], name)
        self.assertEqual(found["wide"], 8 * test_score.SIZE[0])
        self.assertEqual(*found["fits"])  # the slider's ends are the image's
        self.assertGreater(found["fits"][0], 0.6 * found["room"])
        self.assertNotEqual(found["other"], found["ours"])
        truth = self.truths["room-left"][12, 10]
        self.assertIn("pixel 10, 12", found["values"])
        lines = found["values"].splitlines()
        self.assertAlmostEqual(float(lines[1].split()[-3]), truth[0], delta=2e-3 * truth[0])
        self.assertAlmostEqual(float(lines[2].split()[-3]), 1.5 * truth[0], delta=2e-3 * truth[0])

    def test_names_are_data(self):
        made = page.made(self.folder, [("</script><b>DATA TABLE", self.folders()[0][1])])
        self.assertNotIn("</script><b>", made)
        self.assertEqual(made.count("<canvas"), 1)
        self.assertIn("<td>&lt;/script&gt;&lt;b&gt;DATA TABLE</td><td>50.0</td>", made)

    def test_too_large(self):
        limit, page.LARGEST = page.LARGEST, 1000
        self.addCleanup(setattr, page, "LARGEST", limit)
        with self.assertRaisesRegex(exr.BadImage, "allowed: 1000; use --only"):
            page.made(self.folder, self.folders())
