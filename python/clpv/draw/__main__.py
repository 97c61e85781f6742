# SPDX-License-Identifier: MIT
"""python3 -m clpv.draw compare|report [IN OUT]

    compare IN OUT  draws the images and differences of IN/compare.json and IN/*.npy into the file OUT
    report  IN OUT  writes the page of IN/report.json and its images into the file OUT

Without IN and OUT: checks that the required modules are installed. Exit codes are clpv's: 1 missing
module or no output, 2 usage, 3 invalid document.
"""
import importlib
import pathlib
import sys

from clpv import output

KINDS = "compare", "report"


def fail(code, words):
    print(words, file=sys.stderr)
    return code


def main(arguments):
    if len(arguments) not in (1, 3) or arguments[0] not in KINDS:
        return fail(output.USAGE, __doc__.strip())
    kind, *paths = arguments
    try:
        module = importlib.import_module(f"clpv.draw.{kind}")
        if paths:
            module.draw(*map(pathlib.Path, paths))
    except ImportError as error:
        return fail(output.RUN_TIME, f"{error} (Debian: python3-matplotlib python3-numpy python3-jinja2)")
    except output.Failure as error:
        return fail(error.code, error)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
