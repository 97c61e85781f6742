# SPDX-License-Identifier: MIT
"""Reproduces the paper's figures, Table 1 and claims; compares numbers with expected.json.

Builds, measures part by part, and writes index.html (one self-contained page) and parts/*.json into
its output folder, a new or empty folder or one of an earlier run. A second run with the same program,
scripts, model and device continues: it measures the parts that it lacks.
Without --model only lobes, tables and Figures 2, 3 and 6 run. --quick leaves out views, large RSMs
and srbf14's frames, and times each row two or three times. --record puts the numbers into
results/docs and the figures into docs/images; scripts/tables then writes the tables. REPRODUCING.md
has the minutes of each part.

Exit code 5: numbers left the tolerances of results/paper/expected.json; they are listed. Times are
not compared. Needs the packages of scripts/setup.
"""
import base64
import json
import os
import pathlib
import subprocess
import sys
import time

from . import (BUILD, CLPV, RESULTS, ROOT, described, expected, hash_of, model_files, output,
               parser_of, run_clpv, tables, verdicts)
from .expected import CLAIMS, PARTS
from .measure import measure_suite, measured_with, write

LEFT = 5  # exit code


def result_of(name, arguments):
    """Measures a part."""
    from . import claims, figures

    if name == "table1":
        repetitions = 2 if arguments.quick else 7
        return measure_suite(name, arguments.model, f"sponza --repetitions={repetitions}", True)
    if name == "figures":
        return figures.paper(arguments)
    made = getattr(claims, name)(arguments)
    return made if isinstance(made, dict) else list(made)


def parts_of(arguments):
    """Names of the parts that can be measured."""
    return [name for name, part in PARTS.items()
            if (arguments.model or not part["model"]) and (part["quick"] or not arguments.quick)]


def key_of(arguments):
    """Key of what the numbers of a part depend on: program and module, scripts and scenes, the
    model, replaced kernels, the devices, and the environment of clpv and its drivers."""
    module = sorted((BUILD / "python/clpv").glob("_native*.so"))
    sources = [CLPV, *module, ROOT / "python/clpv", ROOT / "lab/measured", ROOT / "scenes"]
    kernels = os.environ.get("CLPV_KERNEL_DIR")
    environment = {name: value for name, value in sorted(os.environ.items())
                   if name.startswith(("CLPV_", "POCL_", "OCL_"))}
    return {"sources": hash_of(sources), "environment": environment, "quick": arguments.quick,
            "model": hash_of(model_files(arguments.model)) if arguments.model else None,
            "kernels": hash_of([pathlib.Path(kernels)]) if kernels else None,
            "devices": run_clpv("devices", "--format=json")}


def earlier(out, name, key):
    """The part of an earlier run with this key; None if there is none, if it is damaged, or if it
    lacks one of its files."""
    try:
        found = json.loads((out.path / name).read_bytes())
        whole = all((out.path / file).is_file() for file in found["files"])
        return found if found["key"] == key and whole else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def measured(arguments):
    """{part: {"minutes", "result"}} of this key, from files of an earlier run or new."""
    key, done = key_of(arguments), {}
    for name in arguments.part or parts_of(arguments):
        file = f"parts/{name}.json"
        found = earlier(arguments.out, file, key)
        if found is None:
            print(f"scripts/reproduce: {name}", file=sys.stderr, flush=True)
            start, before = time.monotonic(), len(arguments.out.written)
            result = result_of(name, arguments)
            minutes, files = (time.monotonic() - start) / 60, arguments.out.written[before:]
            found = {"key": key, "minutes": minutes, "files": files, "result": result}
            arguments.out.write(file, json.dumps(found))
        done[name] = found
    return done


def merged(record, fresh):
    """The record with the numbers of this run; labels tell which rows belong together."""
    if isinstance(record, dict) and isinstance(fresh, dict):
        return {**record, **{key: merged(record[key], value) if key in record else value
                             for key, value in fresh.items()}}
    if isinstance(record, list) and isinstance(fresh, list):
        rows = {expected.label(row): row for row in record}
        for row in fresh:
            rows[expected.label(row)] = merged(rows.get(expected.label(row)), row)
        return list(rows.values())
    return fresh


def results_of(done, names):
    return {name: done[name]["result"] for name in names if name in done}


def overlay(done):
    """Puts the numbers of this run in place of the record's, for the tables and the claims."""
    tables.MEASURED["claims"] = merged(tables.read("claims"), results_of(done, CLAIMS))
    if "table1" in done:
        tables.MEASURED["table1"] = {"measured": {}, **done["table1"]["result"]}
    tables.read.cache_clear()


def record(done, out):
    """Writes results/docs from the parts of this run, and docs/images from its figures."""
    now = measured_with(json.loads(run_clpv("devices", "--format=json"))["devices"][0])
    folder = RESULTS / "docs"
    if claims := results_of(done, CLAIMS):
        recorded = tables.read("claims")
        whole = len(claims) == len(CLAIMS)
        later = f"{', '.join(claims)}: clpv {now['commit']}, {now['date']}"
        older = recorded["measured"].get("except")
        excepted = f"{older}; {later}" if older else later
        measured = now if whole else {**recorded["measured"], "except": excepted}
        parts = {name: claims.get(name, recorded.get(name)) for name in CLAIMS}
        write(folder, "claims", {"measured": measured, **parts})
    if "table1" in done:
        write(folder, "table1", {"measured": now, **done["table1"]["result"]})
    if "figures" in done:
        figures = done["figures"]["result"]
        write(folder, "figures", {"measured": now, "rows": figures["rows"]})
        for name in figures["sheets"]:
            output.write(ROOT / "docs/images" / name, (out.path / name).read_bytes())


def uri(file):
    kind = {"jpg": "jpeg", "png": "png"}[file.suffix.lstrip(".")]
    return f"data:image/{kind};base64," + base64.b64encode(file.read_bytes()).decode("ascii")


def page(arguments, done, left, checked, unmeasured):
    import jinja2
    from clpv.draw import report

    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader([ROOT / "python/clpv/draw", ROOT / "lab/measured"]),
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    claims = verdicts.judged()
    sections = [(name, [each for each in claims if each["section"] == name])
                for name in dict.fromkeys(each["section"] for each in claims)]
    figures = done["figures"]["result"] if "figures" in done else {"sheets": [], "lobes": []}
    out = arguments.out.path
    sheets, lobes = ([{"name": name, "uri": uri(out / name)} for name in figures[kind]]
                     for kind in ("sheets", "lobes"))
    device = run_clpv("devices").splitlines()[:1]
    minutes = [["part", "minutes"],
               *([name, f"{part['minutes']:.1f}"] for name, part in done.items())]
    here = "this run" if "table1" in done else "the record"
    html = environment.get_template("paper.html").render(
        subtitle=", ".join([f"clpv {described()}", "quick run" if arguments.quick else "whole run",
                            *device, time.strftime("%Y-%m-%d")]),
        left=left, checked=checked, unmeasured=unmeasured, parts=minutes, sections=sections,
        sheets=sheets, lobes=lobes, colours=report.page_colours(),
        tables=[(f"With indirect shadows ({here})", tables.TABLES["table1-shadows"]()),
                (f"Without indirect shadows ({here})", tables.TABLES["table1-no-shadows"]())])
    arguments.out.write("index.html", html)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer rows and samples")
    parser.add_argument("--part", action="append", metavar="NAME",
                        help="only this part, repeatable")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/paper",
                        help="output folder (default: out/paper)")
    parser.add_argument("--record", action="store_true",
                        help="write results/docs and docs/images; whole runs only")
    parser.add_argument("--no-build", action="store_true", help="use the build as it is")
    arguments = parser.parse_args()
    if arguments.model and not arguments.model.is_file():
        parser.error(f"--model {arguments.model}: found no file; allowed: Sponza's glTF")
    arguments.width, arguments.height = (480, 270) if arguments.quick else (960, 540)
    allowed = parts_of(arguments)
    for name in arguments.part or []:
        if name not in allowed:
            parser.error(f"--part {name}: allowed: {', '.join(allowed)}; the others need --model, "
                         "or no --quick")
    if arguments.record and (arguments.quick or not arguments.model):
        parser.error("--record: needs --model, excludes --quick")
    arguments.out = output.Folder(arguments.out.resolve(), "scripts/reproduce")
    if not arguments.no_build:
        subprocess.run([str(ROOT / "scripts/build"), "clpv", "clpv_python"], check=True)
    if not CLPV.exists():
        parser.error(f"--no-build: found no {CLPV}; allowed: a build")
    done = measured(arguments)
    document = json.loads((RESULTS / "paper/expected.json").read_text(encoding="utf-8"))
    numbers = expected.found(results_of(done, PARTS))
    whole = [] if arguments.quick else [expected.place(name) for name in CLAIMS if name in done]
    left = expected.left(document, numbers, whole)
    if arguments.record:
        record(done, arguments.out)
    overlay(done)
    page(arguments, done, left, len(numbers), len(set(document["numbers"]) - set(numbers)))
    print(arguments.out.path / "index.html")
    print(f"{len(numbers)} numbers, {len(left)} left their tolerance", *left, sep="\n")
    return LEFT if left else 0
