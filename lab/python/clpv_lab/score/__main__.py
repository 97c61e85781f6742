# SPDX-License-Identifier: MIT
"""python3 -m clpv_lab.score DIR...: errors of folders of images of indirect light against the truths of
a suite."""
import argparse
import json
import pathlib
import sys

from clpv.draw import viewer
from clpv.output import BAD_INPUT, RUN_TIME, Failure, target_of, write
from clpv_lab.score import page, suite
from clpv_lab.score.exr import BadImage


def table(score):
    """Lines of text: a view each, then the mean."""
    lines = viewer.cells([*score["views"], {"view": "mean", **score["mean"]}], ["view"])
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join("  ".join(
        cell.ljust(width) if i == 0 else cell.rjust(width)
        for i, (cell, width) in enumerate(zip(line, widths))) for line in lines)


def report(score):
    """Prints to stderr what is suspected in images, and where errors are undefined."""
    method = suite.printable(score["method"])
    for row in score["views"]:
        for suspicion in row["suspected"]:
            print(f"clpv_lab.score: {method}: {row['view']} {suspicion}", file=sys.stderr)
    for measure, count in score["undefined"].items():
        if count:
            print(f"clpv_lab.score: {method}: {measure} is undefined in {count} of "
                  f"{len(score['views'])} views, whose truth is black, and so is its mean",
                  file=sys.stderr)


def main(arguments, program="python3 -m clpv_lab.score"):
    parser = argparse.ArgumentParser(prog=program, description=__doc__)
    parser.add_argument(
        "folders", metavar="DIR", type=pathlib.Path, nargs="+",
        help="images VIEW.exr, or frames VIEW.NUMBER.exr of the same still view: linear radiance")
    parser.add_argument("--suite", metavar="FOLDER", type=pathlib.Path, default=pathlib.Path("."),
                        help="folder with suite.json (default: the current one)")
    parser.add_argument("--method", metavar="NAME",
                        help="name of the method in the JSON (default: that of DIR)")
    parser.add_argument("--only", metavar="PATTERN", action="append",
                        help="views, such as 'cornell-*'; repeatable (default: all)")
    parser.add_argument("--layer", choices=suite.LAYERS, default=suite.LIGHT,
                        help="layer of the truths to compare with (default: %(default)s)")
    parser.add_argument("-o", "--output", metavar="FILE.json", type=pathlib.Path,
                        help="writes the score")
    parser.add_argument("--page", metavar="FILE.html", type=pathlib.Path,
                        help="writes a page: images of all DIR beside the truths")
    given = parser.parse_args(arguments)
    if len(given.folders) > 1 and (given.method or given.output):
        parser.error("--method and --output: found several DIR; allowed: one")
    if given.page and given.layer != suite.LIGHT:
        parser.error(f"--page: found --layer {given.layer}; allowed: {suite.LIGHT}")
    only = given.only or ["*"]
    try:
        outputs = [path for path in (given.output, given.page) if path]
        for i, path in enumerate(outputs):
            target_of(path, *suite.inputs(given.folders, given.suite), *outputs[:i])
        scores = [suite.score(folder, given.suite, given.method, only, given.layer)
                  for folder in given.folders]
        titles = [score["method"] for score in scores]
        if given.page and len(set(titles)) < len(titles):
            parser.error("--page: found folders of the same name; allowed: different names")
        if given.page:
            write(given.page, page.made(given.suite, zip(titles, given.folders), only))
        if given.output:
            write(given.output, json.dumps(scores[0], indent=1, allow_nan=False) + "\n")
    except (BadImage, Failure) as error:
        print(f"clpv_lab.score: {suite.printable(error)}", file=sys.stderr)
        return getattr(error, "code", BAD_INPUT)
    try:
        for score in scores:
            report(score)
            names = [suite.printable(score["method"])] if len(scores) > 1 else []
            sys.stdout.write("\n".join([*names, table(score), ""]))
        sys.stdout.flush()
    except (OSError, AttributeError) as error:  # a full disk; None where stdout is closed
        sys.stdout = None  # Python would try again at its exit
        print(f"clpv_lab.score: stdout: cannot be written: {error}", file=sys.stderr)
        return RUN_TIME
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
