# SPDX-License-Identifier: MIT
"""The scorer: its numbers are those of `clpv compare`, bias and noise, bad input by name.

CLPV: the program.
"""
import contextlib
import copy
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / folder) for folder in ("python", "lab/python")]
from clpv_lab.score import __main__ as command, errors, exr, suite as scored  # noqa: E402
from exr_writer import write  # noqa: E402

CLPV = os.environ["CLPV"]
SIZE = 40, 24
HASH = "0123456789abcdef"
SHOWN = {
    "nrmse": "nrmse_valid", "nrmse_best_gain": "nrmse_best_gain", "energy_ratio": "energy_ratio",
    **({"flip": "flip"} if errors.flip_evaluator else {})  # pip install flip-evaluator
}


def layered(rgb, alpha, layer=""):
    prefix = f"{layer}." if layer else ""
    return {**{prefix + name: rgb[..., i] for i, name in enumerate("RGB")}, f"{prefix}A": alpha}


def smooth_image(seed):
    """Large soft patches, brighter to the right, as light is."""
    random, (width, height) = numpy.random.default_rng(seed), SIZE
    y, x = numpy.mgrid[:height, :width] / width
    image = sum(
        random.uniform(0.1, 1, 3) * numpy.exp(-((x - random.uniform())**2 +
                                                (y - random.uniform())**2)[..., None] * 30)
        for _ in range(6))
    return (0.5 * image * (0.3 + x[..., None])).astype(numpy.float32)


class Suite(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in "truths", "ours":
            (self.folder / name).mkdir()
        self.alpha = numpy.ones(SIZE[::-1], numpy.float32)
        self.alpha[:3] = 0
        self.truths = {
            name: smooth_image(seed) * self.alpha[..., None]
            for seed, name in enumerate(("room-left", "room-right"))
        }
        views = []
        for name, truth in self.truths.items():
            write(self.folder / f"truths/{name}-{HASH}.exr", layered(truth, self.alpha, "indirect"))
            views.append({
                "name": name, "truth": f"truths/{name}-{HASH}.exr", "noise": 0.02, "exposure": 1.5
            })
        (self.folder / "suite.json").write_text(
            json.dumps({"schema": 1, "hash": HASH, "views": views}))

    def put(self, change, alpha=None):
        for name, truth in self.truths.items():
            write(self.folder / f"ours/{name}.exr",
                  layered(change(truth), self.alpha if alpha is None else alpha))

    def compared(self, name, *options):
        """`clpv compare` of an image with its truth."""
        return subprocess.run([
            CLPV, "compare", "-q", self.folder / f"ours/{name}.exr",
            f"{self.folder}/truths/{name}-{HASH}.exr:indirect", *options
        ], check=False, capture_output=True, text=True)

    def score(self, **options):
        return scored.score(self.folder / "ours", self.folder, **options)

    def command(self, *more):
        printed, said = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(said):
            code = command.main(
                [str(self.folder / "ours"), "--suite", str(self.folder), *map(str, more)])
        return code, printed.getvalue(), said.getvalue()

    def rejected(self):
        with self.assertRaises(exr.BadImage) as caught:
            self.score()
        return str(caught.exception)


class Numbers(Suite):
    def test_are_those_of_the_program(self):
        random = numpy.random.default_rng(5)
        alpha = self.alpha.copy()
        alpha[:, :2] = 0
        self.put(lambda truth: truth * random.uniform(0.5, 1.4, truth.shape) + 0.02, alpha)
        ours = self.score()
        for view in ours["views"]:
            other = json.loads(self.compared(view["view"], "--exposure", "1.5").stdout)
            self.assertEqual(
                {name: view[name]
                 for name in SHOWN},
                {name: round(other[key], scored.DIGITS)
                 for name, key in SHOWN.items()})
            self.assertEqual(view["suspected"],
                             ["has no surface in 5 % of the truth's: other camera or scene"])
        self.assertAlmostEqual(ours["mean"]["nrmse"],
                               numpy.mean([view["nrmse"] for view in ours["views"]]),
                               delta=10 ** -scored.DIGITS)

    def test_bias_and_noise_of_frames_are_apart(self):
        random, truth = numpy.random.default_rng(1), self.truths["room-left"]
        frames = 24
        rms = numpy.sqrt((truth[self.alpha > 0] ** 2).mean())
        for i in range(frames):
            write(self.folder / f"ours/room-left.{i:02}.exr",
                  layered(1.1 * truth + random.normal(0, 0.2 * rms, truth.shape), self.alpha))
        row = self.score(only=["room-left"])["views"][0]
        self.assertEqual(row["frames"], frames)
        self.assertAlmostEqual(row["bias"], 0.1, delta=0.01)
        self.assertAlmostEqual(row["noise"], 0.2, delta=0.01)
        self.assertAlmostEqual(row["nrmse"] ** 2, row["bias"] ** 2 + row["noise"] ** 2, delta=1e-4)
        # |difference| of two normal variables of deviation s has the mean 2 s / sqrt(pi).
        self.assertAlmostEqual(row["change"],
                               0.4 * rms / numpy.sqrt(numpy.pi) / truth[self.alpha > 0].mean(),
                               delta=0.01)

    def test_the_command_prints_a_table_and_writes_json(self):
        self.put(lambda truth: 1.1 * truth)
        file = self.folder / "score.json"
        code, printed, _ = self.command("--method", "mine", "-o", file)
        self.assertEqual(code, 0)
        self.assertRegex(printed, r"room-left +10\.0 +0\.0 +1\.100")
        document = json.loads(file.read_text())
        self.assertEqual((document["method"], document["suite"], document["complete"]),
                         ("mine", HASH, True))


class Undefined(Suite):
    def blacken(self, name):
        self.truths[name] = numpy.zeros_like(self.truths[name])
        write(self.folder / f"truths/{name}-{HASH}.exr",
              layered(self.truths[name], self.alpha, "indirect"))

    def test_a_lit_image_of_a_black_truth_has_no_error_and_no_mean(self):
        self.blacken("room-left")
        self.put(lambda truth: truth + 0.5)
        code, printed, said = self.command("-o", self.folder / "score.json")
        self.assertEqual(code, 0)
        document = json.loads((self.folder / "score.json").read_text())
        for measure in "nrmse", "nrmse_best_gain", "energy_ratio":
            self.assertIsNone(document["views"][0][measure], measure)
            self.assertIsNone(document["mean"][measure], measure)
            self.assertEqual(document["undefined"][measure], 1)
            self.assertIn(f"{measure} is undefined in 1 of 2 views", said)
        self.assertRegex(printed, r"room-left +- +- +-")
        self.assertRegex(printed, r"mean +- +- +-")

    def test_truths_that_are_not_finite(self):
        self.put(lambda truth: truth)
        for value in numpy.nan, numpy.inf:
            truth = self.truths["room-left"].copy()
            truth[7, 5, 2] = value
            write(self.folder / f"truths/room-left-{HASH}.exr",
                  layered(truth, self.alpha, "indirect"))
            code, _, said = self.command()
            self.assertEqual(code, 3)
            self.assertIn(f"pixel (5, 7), channel indirect.B: found {value}", said)


class Outputs(Suite):
    def test_spare_what_is_read_and_each_other(self):
        self.put(lambda truth: truth)
        files = ["suite.json", f"truths/room-right-{HASH}.exr", "ours/room-left.exr"]
        os.symlink(self.folder / "suite.json", self.folder / "link")
        before = {name: (self.folder / name).read_bytes() for name in files}
        for name in *files, "link":
            for option in "--output", "--page":
                code, _, said = self.command("--only", "room-left", option, self.folder / name)
                self.assertEqual(code, 2)
                self.assertIn(f"{self.folder / name}: found the file of", said)
        code, _, said = self.command("--page", self.folder / "x", "-o", self.folder / "ours/../x")
        self.assertEqual((code, (self.folder / "x").exists()), (2, False))
        self.assertEqual({name: (self.folder / name).read_bytes() for name in files}, before)


class BadInput(Suite):
    def test_suites(self):
        self.put(lambda truth: truth)
        good = json.loads((self.folder / "suite.json").read_text())
        for change, place in (({"views": {}}, "schema 1 with views"), ({"hash": 1}, "/hash"),
                              ({"views": [1]}, "/views/0/name"),
                              ({"name": "a\x1b[2J"}, '/views/0/name: found "a\\u001b[2J"'),
                              ({"truth": None}, "/views/0/truth: found null"),
                              ({"exposure": numpy.nan}, "/views/0/exposure: found NaN"),
                              ({"exposure": 1e308}, "/views/0/exposure: found 1e+308"),
                              ({"noise": "0"}, "/views/0/noise: found \"0\"; allowed: a finite")):
            document = copy.deepcopy(good)
            (document if change.keys() & document.keys() else document["views"][0]).update(change)
            (self.folder / "suite.json").write_text(json.dumps(document))
            self.assertIn(place, self.rejected())
        (self.folder / "suite.json").write_text(json.dumps(good).replace("{", '{"schema": 1, ', 1))
        self.assertIn('duplicate key "schema"', self.rejected())

    def test_missing_views_are_named(self):
        self.put(lambda truth: truth)
        (self.folder / "ours/room-right.exr").unlink()
        self.assertIn("room-right.exr", self.rejected())
        self.assertFalse(self.score(only=["*-left"])["complete"])

    def test_values_that_are_not_finite(self):
        def spoiled(truth):
            truth = truth.copy()
            truth[7, 5, 1] = numpy.nan
            return truth
        self.put(spoiled)
        self.assertIn("pixel (5, 7), channel G: found nan", self.rejected())

    def test_frames_beside_an_image(self):
        self.put(lambda truth: truth)
        (self.folder / "ours/room-left.0.exr").write_bytes(b"")
        self.assertIn("room-left.NUMBER.exr beside it", self.rejected())


class Layers(Suite):
    """Other layers of the truths, whose images tell a wrong camera, scale or texture."""
    def setUp(self):
        super().setUp()
        self.light, self.albedo = smooth_image(9), 0.5 * smooth_image(2)
        layers = {"indirect": self.light, "depth": 3 + self.light, "albedo": self.albedo}
        write(self.folder / f"truths/room-left-{HASH}.exr",
              {name: plane for layer, rgb in layers.items()
               for name, plane in layered(rgb, self.alpha, layer).items()})

    def of(self, image, layer):
        write(self.folder / "ours/room-left.exr", layered(image, self.alpha))
        return self.score(only=["room-left"], layer=layer)

    def test_are_compared(self):
        row = self.of(3.28 * (3 + self.light), "depth")["views"][0]
        self.assertNotIn("flip", row)
        self.assertAlmostEqual(row["nrmse"], 2.28, places=4)
        document = self.of(self.albedo, "albedo")
        self.assertEqual((document["layer"], document["mean"]["nrmse"]), ("albedo", 0))
        self.assertNotIn("layer", self.of(self.light, "indirect"))
        code, printed, _ = self.command("--only", "room-left", "--layer", "albedo")
        self.assertEqual(code, 0)
        self.assertRegex(printed, r"room-left +[1-9]")

    def test_that_truths_lack_are_named(self):
        with self.assertRaisesRegex(exr.BadImage, "allowed: irradiance.R, irradiance.G"):
            self.of(self.light, "irradiance")


class Files(unittest.TestCase):
    def test_compressed_and_half(self):
        image = smooth_image(3)
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder) / "a.exr", pathlib.Path(folder) / "b.exr"
            write(source, layered(image, numpy.ones(SIZE[::-1])))
            for kind, compression, order in (("half", "zip", "decreasingY"),
                                             ("float", "zips", "increasingY"),
                                             ("half", "none", "decreasingY")):
                subprocess.run(["oiiotool", source, "-d", kind, "--compression", compression,
                                "--attrib", "openexr:lineOrder", order, "-o", target], check=True)
                expected = image.astype(numpy.float16) if kind == "half" else image
                numpy.testing.assert_array_equal(exr.colours(exr.read(target), target)[0], expected)
