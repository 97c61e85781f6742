# SPDX-License-Identifier: MIT
"""The scorer as a program of its own: `clpv-score DIR` and `python3 -m clpv_score DIR`."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))  # its own clpv and clpv_lab come first
from clpv_lab.score import __main__ as score  # noqa: E402


def main():
    return score.main(sys.argv[1:], "clpv-score")


if __name__ == "__main__":
    sys.exit(main())
