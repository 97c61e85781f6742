# SPDX-License-Identifier: MIT
"""lab/scripts/corpus: the table of a folder of models, and the files that it may replace."""
import base64
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/corpus"


def model(**changes):
    """A glTF model of a square, 2 m wide."""
    corners = [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)]
    data = b"".join(struct.pack("<3f", *c) for c in corners) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": len(data), "uri": uri}],
    } | changes


class Corpus(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.beside = pathlib.Path(folder.name)
        self.root = self.beside / "models"
        self.root.mkdir()

    def write(self, name, document):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(document))

    def run_script(self, *arguments, **environment):
        return subprocess.run([sys.executable, "-B", SCRIPT, self.root, *arguments],
                              capture_output=True, text=True, check=False,
                              env=os.environ | environment)

    def test_the_table_says_what_loads_and_why_not(self):
        self.write("a/plain.gltf", model())
        self.write("Draco.GLTF", model(extensionsRequired=["KHR_draco_mesh_compression"]))
        self.write("notes.json", {})
        done = self.run_script()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 models: 1 loaded, 1 refused, 0 differs.", done.stdout)
        self.assertRegex(done.stdout, r"\| a/plain.gltf \| loaded \| albedo 0.0 %, depth 0.0 %, normal 0.0 % \|")
        self.assertRegex(done.stdout, r"\| Draco.GLTF \| refused \| render: exit 3: .*KHR_draco")

    def test_a_model_that_the_renderers_show_differently_is_listed(self):
        self.write("plain.gltf", model())
        grey = model(materials=[{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1]}}])
        grey["meshes"][0]["primitives"][0]["material"] = 0
        self.write("../grey.gltf", grey)
        stub = self.beside / "stub"  # path tracing shows another model
        stub.write_text(f"""#!{sys.executable}
import os, sys
if sys.argv[1] == "pathtrace":
    sys.argv[2] = {str(self.beside / "grey.gltf")!r}
os.execv({os.environ["CLPV"]!r}, [{os.environ["CLPV"]!r}, *sys.argv[1:]])
""")
        stub.chmod(0o755)
        done = self.run_script(CLPV=str(stub))
        self.assertIn("1 models: 0 loaded, 0 refused, 1 differs.", done.stdout)
        self.assertRegex(done.stdout, r"\| differs \| albedo [1-9][0-9.]* %, depth 0.0 %, normal 0.0 %")

    def test_without_a_device_no_model_counts_as_refused(self):
        self.write("plain.gltf", model())
        stub = self.beside / "stub"
        for text, code, words in (("echo no device >&2; exit 4", 4, "render: exit 4: no device"),
                                  (None, 1, "No such file")):
            if text:
                stub.write_text(f"#!/bin/sh\n{text}\n")
                stub.chmod(0o755)
            else:
                stub.unlink()
            done = self.run_script(CLPV=str(stub))
            self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
            self.assertIn(words, done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_only_its_own_file_is_replaced(self):
        mine, other = self.root / "mine.md", self.root / "other.md"
        done = self.run_script("--output", mine)
        self.assertEqual(done.returncode, 3)
        self.assertIn("found no model", done.stderr)
        self.assertFalse(mine.exists())
        self.write("a.gltf", {})
        for _ in range(2):  # a new one, and its own
            self.assertEqual(self.run_script("--output", mine).returncode, 0)
        self.assertIn("1 models: 0 loaded, 1 refused", mine.read_text())
        other.write_text("mine")
        (self.root / "link.md").symlink_to(mine)
        for name in ("other.md", "link.md"):
            done = self.run_script("--output", self.root / name)
            self.assertEqual(done.returncode, 2)
            self.assertIn(name, done.stderr)
        self.assertEqual(other.read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
