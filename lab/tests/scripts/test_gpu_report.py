# SPDX-License-Identifier: MIT
"""lab/scripts/gpu_report, with stubs in place of clpv and clang."""
import pathlib
import runpy
import unittest

import in_tree
from in_tree import ROOT, bystanders, test_scripts

CLANG = """#!/bin/bash
cat <<'END'
.amdgpu_metadata
  - .args:
    .name: gather
    .vgpr_count: 8
    .vgpr_spill_count: 0
    .private_segment_fixed_size: 0
    .group_segment_fixed_size: 0
END
"""
SCRIPT = "../lab/scripts/gpu_report"


class GpuReport(in_tree.InTree):
    def setUp(self):
        super().setUp()
        clang = self.folder / "bin/clang-15"
        clang.write_text(CLANG)
        clang.chmod(0o755)

    def test_bystanders_stay(self):
        if not pathlib.Path("/usr/lib/clc/amdgcn--amdhsa.bc").is_file():
            self.skipTest("libclc is not installed (Debian: apt install libclc-15)")
        made = self.folder / "made"
        call = SCRIPT, "--frames=default", "--output=made"
        self.made(*call)
        stays = self.add_bystanders(made)
        self.made(*call)
        self.assertEqual({path: bystanders.seen(made)[path] for path in stays}, stays)
        self.assertIn("gather", (made / "README.md").read_text())

    def test_a_folder_of_others_stays(self):
        bystanders.fill(self.full)
        self.refused(test_scripts.USAGE, f"one that {SCRIPT[3:]} wrote", SCRIPT,
                     f"--output={self.full}")

    def test_a_record_without_kernels(self):
        for text in ("", "[]", "{}", '{"frames": {"default": {"gfx1030": {}}}}',
                     '{"frames": {"default": {"gfx1030": {"gather": {}}}}}'):
            (self.folder / "record.json").write_text(text)
            self.refused(test_scripts.BAD_INPUT, "record.json: found", SCRIPT,
                         "--check=record.json")
        self.refused(test_scripts.BAD_INPUT, "none.json: found", SCRIPT, "--check=none.json")

    def test_kernels_that_only_the_record_has(self):
        changes = runpy.run_path(str(ROOT / "lab/scripts/gpu_report"))["changes"]
        self.assertEqual(changes({"gather": {}}, {}), ["gather: only in the record"])


if __name__ == "__main__":
    unittest.main()
