# SPDX-License-Identifier: MIT
"""`clpv check` compares every member of every struct that host and kernels share."""
import re
import unittest

from bystanders import ROOT

STRUCT = re.compile(r"typedef struct[^{;]*\{([^}]*)\}\s*(\w+);")
MEMBER = re.compile(r"(\w+)\s*(?:\[\w+\])*\s*[,;]")


class SharedStructs(unittest.TestCase):
    def test_each_member_is_compared(self):
        found, listed = set(), set()
        for header in (ROOT / "kernels/shared").glob("*.h"):
            text = re.sub(r"//[^\n]*", "", header.read_text(encoding="utf-8"))
            listed |= set(re.findall(r"FIELD\((\w+), (\w+)\)", text))
            found |= {(name, member) for body, name in STRUCT.findall(text)
                      for member in MEMBER.findall(body) if member != "unused"}
        self.assertGreater(len(found), 90)
        self.assertEqual(found, listed)


if __name__ == "__main__":
    unittest.main()
