# SPDX-License-Identifier: MIT
"""Writes the tables of measured numbers in the docs, between <!-- table: NAME --> and <!-- end -->,
from results/docs and
lab/results.

    scripts/tables            rewrites them in README.md, docs/ and lab/, and claims.json and
                              expected.json in results/paper
    scripts/tables --check    changes nothing; fails if one of them differs from the results
    scripts/tables --list     names of all tables

scripts/measure writes results/docs. tables.json has the tables whose columns are data: titles,
forms, and the rows: a list in results/docs, or a function of rows and its arguments. Only the
standard library.
"""
import functools
import json
import pathlib
import re
import sys

from .. import ROOT, RESULTS, expected, json_lines, output, verdicts
from . import of_lab, of_light, of_paper  # they fill TABLES and ROWS
from ..cells import LOADED, MEASURED, TABLES, of_data, read, result

__all__ = ["MEASURED", "TABLES", "main", "of_lab", "of_light", "of_paper", "pages", "read", "result"]
BLOCK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
for name, each in json.loads(
        (pathlib.Path(__file__).parent / "tables.json").read_text(encoding="utf-8")).items():
    TABLES[name] = functools.partial(of_data, each["columns"], *each["rows"])


def drawn(lines):
    text = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([text[0], "|" + "---|" * len(lines[0]), *text[1:]]) + "\n"


def measured_on():
    """Commit, device and date of the page's tables: one line if one run of scripts/measure measured
    them all."""
    runs = {}
    for name in sorted(LOADED):
        measured = read(name)["measured"]
        key = f"clpv {measured['commit']}, {measured['device']}, {measured['driver']}, {measured['date']}"
        if "except" in measured:
            key += f"; except {measured['except']}"
        runs.setdefault(key, []).append(name)
    if len(runs) == 1:
        return f"Measured with {next(iter(runs))} (`results/docs`).\n"
    return "".join(f"- {', '.join(files)} (`results/docs`): {run}.\n"
                   for run, files in runs.items())


def block(match):
    name = match[2]
    if name == "measured-on":
        return match[0]
    if name not in TABLES:
        sys.exit(f"{sys.argv[0]}: no table '{name}'; allowed: measured-on, {', '.join(TABLES)}")
    content = TABLES[name]()
    return match[1] + (content if isinstance(content, str) else drawn(content)) + match[3]


def written(text):
    """The page with its tables, and where they were measured."""
    LOADED.clear()
    text = BLOCK.sub(block, text)
    return BLOCK.sub(
        lambda match: match[1] + measured_on() + match[3]
        if match[2] == "measured-on" else match[0], text)


def pages(files):
    """(page, its text with its tables) of files that are no links."""
    for page in files:
        if not page.is_symlink():
            yield page, written(page.read_text(encoding="utf-8"))


def files():
    """(file, its text) of all that scripts/tables writes."""
    for name, document in (("claims", {"claims": verdicts.judged(result)}),
                           ("expected", expected.expected(result))):
        yield RESULTS / f"paper/{name}.json", json_lines(document)
    yield from pages([ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md")),
                      *sorted((ROOT / "lab").glob("**/*.md"))])


def main():
    arguments = sys.argv[1:]
    if arguments in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0
    if arguments == ["--list"]:
        print("\n".join(["measured-on", *TABLES]))
        return 0
    if arguments not in ([], ["--check"]):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    differing = []
    for file, text in files():
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            differing.append(str(file.relative_to(ROOT)))
            if not arguments:
                output.write(file, text)
    if arguments and differing:
        print(f"{', '.join(differing)}: tables differ from results; run {sys.argv[0]}",
              file=sys.stderr)
        return 1
    return 0
