# SPDX-License-Identifier: MIT
"""Writes the tables of measured numbers in the docs, between <!-- table: NAME --> and <!-- end -->,
from results/docs and lab/results.

Rewrites them in README.md, docs/ and lab/, and claims.json and expected.json in results/paper.
scripts/measure writes results/docs. tables.json has the tables, written as cells.py says, but for
verdicts and light probes at equal bytes, which are functions here. Only the
standard library.
"""
import functools
import json
import pathlib
import re
import sys

from . import ROOT, RESULTS, bake as probes, expected, json_lines, output, parser_of, verdicts
from .cells import LOADED, MEASURED, load, read, rows, table

__all__ = ["MEASURED", "TABLES", "main", "read"]
BLOCK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
STANDING = ROOT / "lab/results/quality"
SHOWN = 6  # points of a claim whose numbers its line shows
RESOLVED = 0.5  # [points of %] smaller differences of light probes are none
# (a, b): does a have a smaller error than b at equal bytes?
PAIRS = (("zh3", "srbf8v2"), ("zh3", "sh3"), ("srbf8v2", "sh2"), ("srbf14", "sh3"),
         ("ambient-cube-mean", "ambient-cube"), ("sh2", "ambient-cube"))


def documents(pattern):
    return [json.loads(path.read_text(encoding="utf-8")) for path in sorted(STANDING.glob(pattern))]


# Rows that are not lists in results/docs.


@rows
def standing_runs():
    """Documents of the standing benchmark: one for each device and commit."""
    return [{**document, "number": i + 1, "except": document["measured"].get("except", "-")}
            for i, document in enumerate(documents("*.json"))]


@rows
@functools.cache
def standing_cells():
    return [{**cell, "run": run["number"], "group": group} for run in standing_runs()
            for group in ("small", "small_with_time_of_large", "large") for cell in run[group]]


@rows
def scores():
    """Views of other renderers, as `python3 -m clpv_lab.score -o` writes them."""
    return [{**row, "method": document["method"], "scene": row["view"].partition("-")[0]}
            for document in documents("scores/*.json") for row in document["views"]]


@rows
def searched():
    return json.loads((ROOT / "lab/results/centres/searched.json").read_text())["sets"]


@rows
def stage_times():
    """Times of frames by stage, summed over cascades and lights."""
    for frame in load("frames")["frames"]:
        stages = {}
        for time in frame["times"]:
            stages[time["stage"]] = stages.get(time["stage"], 0) + time["median"]
        yield from ({"given": frame["given"], "stage": stage, "ms": ms or None}
                    for stage, ms in stages.items())


@rows
def bake_spacings():
    return [{**row, "fine": int(row["spacing"] == probes.SPACINGS[probes.kind_of(row["scene"])][1])}
            for row in load("bake")["rows"]]


# Tables.


def verdict_lines(section):
    """A line for each claim of a section."""
    lines = [["statement", "holds if", "verdict", "numbers", "command"]]
    for claim in verdicts.judged(section):
        points = [f"{point['at']}: {point['numbers']}" for point in claim["points"]]
        more = [f"{len(points) - SHOWN} more"] if len(points) > SHOWN + 1 else []
        command = f"`{claim['command']}`" if claim["command"].split()[0] in (
            "clpv", "scripts/reproduce") else claim["command"]
        verdict = f"**{claim['verdict']}**" if len(claim["verdict"]) < 20 else claim["verdict"]
        numbers = "; ".join(points[:SHOWN if more else None] + more)
        lines.append([claim["statement"], claim["rule"], verdict, numbers, command])
    return lines


def difference(lines, a, b, source, place):
    """Error of a minus that of b [%] at the middle of the bytes that both have."""
    both = [probes.over_bytes(lines, name, source, place) for name in (a, b)]
    size = (max(line[0][0] for line in both) * min(line[1][0] for line in both))**0.5
    return probes.error_at(both[0], size) - probes.error_at(both[1], size)


def bake_verdicts():
    lines = [["at equal bytes of the volume", "verdict", "difference [points of %]"]]
    for a, b in PAIRS:
        points = []
        for source, kind in zip(probes.SOURCES, ("traced", "swept")):
            for place, where in (("surface", "surfaces"), ("air", "air")):
                off = difference(load("bake")["rows"], a, b, source, place)
                outcome = None if abs(off) < RESOLVED else off < 0
                points.append((f"{kind} {where}", outcome, f"{off:+.1f}"))
        lines.append([f"`{a}` beats `{b}`", verdicts.sentence("", points),
                      ", ".join(text for _, _, text in points)])
    return lines


SPECS = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
TABLES = {
    **{name: functools.partial(table, {**SPECS.get(spec.get("like"), {}), **spec})
       for name, spec in SPECS.items()},
    **{f"verdicts-{section}": functools.partial(verdict_lines, section)
       for section in dict.fromkeys(claim["section"] for claim in verdicts.CLAIMS)},
    "bake-verdicts": bake_verdicts,
}


# Pages.


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


def files():
    """(file, its text) of all that scripts/tables writes."""
    yield RESULTS / "paper/claims.json", json_lines({"claims": verdicts.judged()})
    yield RESULTS / "paper/expected.json", json_lines(expected.expected())
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md")),
                 *sorted((ROOT / "lab").glob("**/*.md"))):
        if not page.is_symlink():
            yield page, written(page.read_text(encoding="utf-8"))


def main():
    parser = parser_of(__doc__, model=False)
    parser.add_argument("--check", action="store_true",
                        help="change nothing; fail if one of them differs from the results")
    parser.add_argument("--list", action="store_true", help="print the names of all tables")
    arguments = parser.parse_args()
    if arguments.list:
        print("\n".join(["measured-on", *TABLES]))
        return 0
    differing = []
    for file, text in files():
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            differing.append(str(file.relative_to(ROOT)))
            if not arguments.check:
                output.write(file, text)
    if arguments.check and differing:
        print(f"{', '.join(differing)}: tables differ from results; run {sys.argv[0]}",
              file=sys.stderr)
        return 1
    return 0
