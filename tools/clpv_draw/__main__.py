# SPDX-License-Identifier: MIT
"""python3 clpv_draw check|bench|basis|report ...

    check KIND           names what KIND lacks here, a Debian package a line; exit code 1 where there is something
    bench  IN OUT        charts of IN/bench.json into the folder OUT
    basis  IN OUT        figures 2, 3 and 6 of IN/figures.json and IN/surfaces.npy into the folder OUT
    report IN OUT        the page of IN/report.json and its images into the file OUT

Exit codes are clpv's: 2 usage, 3 a document that is not of the shape clpv writes.
"""
import importlib
import pathlib
import sys

# Run as a folder, so that nothing need be installed: the package is what lies beside this file.
sys.path[0] = str(pathlib.Path(__file__).resolve().parent.parent)

NEEDS = {
    "bench": ("matplotlib", "numpy"),
    "basis": ("matplotlib", "numpy"),
    "report": ("matplotlib", "numpy", "jinja2"),
}
USAGE, BAD_INPUT = 2, 3


def check(kind):
    missing = []
    for module in NEEDS[kind]:
        try:
            importlib.import_module(module)
        except ImportError:
            missing.append(f"python3-{module}")
    print("\n".join(missing))
    return 1 if missing else 0


def draw(kind, source, target):
    from clpv_draw.documents import BadDocument
    module = importlib.import_module(f"clpv_draw.{kind}")
    try:
        module.draw(pathlib.Path(source), pathlib.Path(target))
    except BadDocument as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    return 0


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "check" and arguments[1] in NEEDS:
        return check(arguments[1])
    if len(arguments) == 3 and arguments[0] in NEEDS:
        return draw(*arguments)
    print(__doc__.strip(), file=sys.stderr)
    return USAGE


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
