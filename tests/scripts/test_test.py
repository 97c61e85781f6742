# SPDX-License-Identifier: MIT
"""scripts/test around a stub of ctest: what it reports, and its exit codes."""
import unittest

from bystanders import ROOT
from test_scripts import InTree

RESULTS = """<testsuite>
<testcase name="quick" time="0.1" status="run"><system-out/></testcase>
<testcase name="trust" time="9" status="run"><system-out>
/a/trust_test.cpp:104: Skipped
only root can give files away

[  SKIPPED ] Cache.OfOthers (0 ms)
</system-out></testcase>
<testcase name="python.view" time="3" status="run"><system-out>
SKIPPED [2] tests/python/test_view.py:410: no Chromium
</system-out></testcase>
<testcase name="score.unittest" time="2" status="run"><system-out>
test_a (test_page.Page.test_a) ... skipped 'needs a page'
</system-out></testcase>
<testcase name="clang.syntax" time="0" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>
	<system-out>skipped: no clang++ (Debian: apt install {})</system-out></testcase>
<testcase name="long" time="12.34" status="run"/><testcase name="b" time="1" status="run"/>
</testsuite>
"""


class Tests(InTree):
    """A tree with a stub of ctest that writes these results."""

    def setUp(self):
        super().setUp()
        (self.tree / "tests").symlink_to(ROOT / "tests")
        self.home = self.folder / "home"
        self.home.mkdir()

    def run_tests(self, package, *arguments, also="", code=0, **environment):
        (self.folder / "results").write_text(RESULTS.format(package))
        stub = self.folder / "bin/ctest"
        stub.write_text(f"""#!/bin/sh
[ "$1" != --help ] || exec /usr/bin/ctest --help
echo "$@"
while [ "$1" != --output-junit ]; do shift; done
cp {self.folder}/results "$2"
{also}
""")
        stub.chmod(0o755)
        return self.run_script("test", *arguments, HOME=str(self.home), **environment)

    def test_a_user_runs_no_test_for_developers(self):
        left_out = "--label-exclude developer"
        self.assertIn(left_out, self.run_tests("chromium", CI="").stdout)
        for arguments, ci in (((), "true"), (("--long",), ""), (("-R", "x"), "")):
            found = self.run_tests("chromium", *arguments, CI=ci)
            self.assertNotIn(left_out, found.stdout)
            self.assertNotIn("Not run", found.stdout)

    def test_skipped_and_slowest_are_named(self):
        found = self.run_tests("chromium", "-R", "x", CI="true")
        self.assertEqual(found.returncode, 0, found.stderr)
        self.assertNotIn("--build-config", found.stdout)
        for words in ("-R x", "Skipped: 4\n", "trust: Cache.OfOthers: only root can give files away",
                      "python.view: test_view.py: no Chromium",
                      "score.unittest: test_page.Page.test_a: needs a page",
                      "clang.syntax: no clang++", "Slowest: long 12.3 s, trust 9.0 s, python.view"):
            self.assertIn(words, found.stdout)

    def test_a_package_of_setup_that_is_missing_fails_where_ci_is_true(self):
        self.assertEqual(self.run_tests("clang-15").returncode, 0)
        found = self.run_tests("clang-15", CI="true")
        self.assertEqual(found.returncode, 1)
        self.assertIn("scripts/setup installs what it needs: clang.syntax", found.stderr)

    def test_a_failure_of_ctest_is_that_of_the_script(self):
        self.assertEqual(self.run_tests("chromium", also="exit 8").returncode, 8)

    def test_long_ones_have_a_configuration(self):
        found = self.run_tests("chromium", "--long", "-L", "long")
        self.assertIn("--build-config long", found.stdout)
        self.assertIn("-L long", found.stdout)

    def test_files_left_in_the_home_folder_fail(self):
        found = self.run_tests("chromium", also='mkdir "$HOME/.cache" "$HOME/.config"')
        self.assertEqual(found.returncode, 1)
        self.assertIn(f"> {self.home}/.config", found.stderr)
        self.assertNotIn(".cache", found.stderr)


if __name__ == "__main__":
    unittest.main()
