# SPDX-License-Identifier: MIT
"""The report page: one self-contained HTML file.

report.json: "subtitle"; "methods", each with "title" and "options" (null: images of another
program); "views", each with "name", "width", "height", "exposure" [EV] and "images", of which the
first is the truth: "title", "file" (NPY of height x width x channels, R, G and B first) and, but for
the truth, "flip" (NPY of height x width x 1) and "errors"; "quality" and "benchmarks": {"file",
"document"} of `clpv quality` and `clpv bench` with --output; "marked": options of variants to
highlight.
"""
import pathlib
import re

import jinja2
import numpy
from markupsafe import Markup
from matplotlib import pyplot

from clpv import output
from clpv.draw import bench, documents, style, viewer
from clpv.draw.documents import NUMBER

VARIANT = {"options": dict, "rejected": int, "nrmse": NUMBER, "worst_nrmse": NUMBER,
           "energy_ratio": NUMBER, "frame_ms": NUMBER}


def inlined(figure, titles=()):
    """A figure as inline SVG in the page's colours; titles[i]: tooltip of the artist point<i>."""
    if figure is None:
        return ""
    figure.tight_layout()
    svg = style.rendered(figure, "svg", transparent=True, bbox_inches="tight").decode("utf-8")
    svg = re.sub(r' xmlns(:xlink)?="[^"]*"| (width|height)="[0-9.]+pt"', "",
                 svg[svg.index("<svg"):])
    for name, colour in page_colours().items():
        svg = svg.replace(colour, f"var(--{name})")
    for i, title in enumerate(titles):
        group = f'<g id="point{i}">'
        svg = svg.replace(group, f"{group}<title>{Markup.escape(title)}</title>")
    return Markup(svg)


def page_colours():
    """Returns the page's colours by name, as charts have them; dark screens have others."""
    return {"ink": style.INK, "soft": style.SOFT, "line": style.LINE,
            **{f"c{i}": colour for i, colour in enumerate(style.COLOURS)}}


def variants(quality, marked):
    """Cells that were not rejected and have an error, best first."""
    rows = []
    for source in quality:
        file = source["file"]
        listed = documents.checked(source["document"], file, "variants", {"rejected": int})
        for i, row in enumerate(listed):
            if row["rejected"] == 0 and row.get("nrmse", 0) is not None:
                documents.checked({"variants": listed[i:i + 1]}, file, "variants", VARIANT)
                rows.append({**row, "name": " ".join(map(str, row["options"].values())),
                             "series": str(row["options"].get("transport", "preset")),
                             "marked": row["options"] in marked})
    return sorted(rows, key=lambda row: row["nrmse"])


def front_of(points):
    """Returns the Pareto front of points (x, y), sorted by x: no other point is lower in both."""
    front = []
    for x, y in sorted(points):
        if not front or y < front[-1][1]:
            front.append((x, y))
    return front


def error_against_cost(rows):
    if not rows:
        return None
    figure, axis = pyplot.subplots(figsize=(8, 4.5))
    series = bench.distinct(row["series"] for row in rows)
    places = [(row["frame_ms"], 100 * row["nrmse"]) for row in rows]
    axis.step(*zip(*front_of(places)), where="post", color=style.SOFT, ls="--", lw=1)
    middle = numpy.sqrt(min(x for x, _ in places) * max(x for x, _ in places))
    for i, (row, (x, y)) in enumerate(zip(rows, places)):
        axis.plot([x], [y], "o", gid=f"point{i}", ms=10 if row["marked"] else 6.5,
                  color=style.colour(series.index(row["series"])), mec=style.INK,
                  mew=1.5 if row["marked"] else 0)
        if row["marked"]:
            left = x > middle
            axis.annotate(row["name"], (x, y), textcoords="offset points",
                          xytext=(-8 if left else 8, 7), ha="right" if left else "left",
                          weight="bold")
    for i, name in enumerate(series):
        axis.plot([], [], "o", color=style.colour(i), label=name)
    axis.set(ylim=(0, 1.08 * max(y for _, y in places)), xlabel="frame [ms]",
             ylabel="mean NRMSE [%]")
    style.logarithmic(axis.xaxis)
    axis.legend()
    return figure


def table1(rows):
    """Returns (bases, [(stage, cells)]): one line per stage and cascade, one column per basis."""
    bases, lines = bench.distinct(str(row["basis"]) for row in rows), {}
    for row in rows:
        cascade = "" if row.get("cascade") is None else f" cascade {row['cascade']}"
        line = (f"{row['stage']}{cascade}, lobes {row.get('lobe') or '-'}, "
                f"{'with' if row.get('occlusion') else 'without'} indirect shadows")
        cell = f"{row['median']:.3g}" if row["status"] == "ok" else row["status"]
        lines.setdefault(line, {})[str(row["basis"])] = cell
    return bases, [(line, [cells.get(basis, "") for basis in bases])
                   for line, cells in lines.items()]


def images(source, views):
    """HTML of the images of all views, empty without views."""
    def entry(image):
        flip = numpy.load(source / image["flip"]) if "flip" in image else None
        return viewer.entry(image["title"], numpy.load(source / image["file"])[..., :3], flip)

    rows = [{"view": view["name"], "image": image["title"], **image["errors"]}
            for view in views for image in view["images"][1:]]
    shown = [{**view, "images": [entry(image) for image in view["images"]]} for view in views]
    return Markup(viewer.markup(shown, rows)) if views else ""


def draw(source: pathlib.Path, target: pathlib.Path) -> None:
    report = documents.read(source / "report.json")
    rows = [row for given in report["benchmarks"]
            for row in documents.checked(given["document"], given["file"], "benchmarks", bench.ROW)]
    quality = variants(report["quality"], report["marked"])
    layouts = [row for row in rows if row["suite"] == "layouts"]
    tables = table1([row for row in rows if row["suite"] == "table1"])
    missing = [words for given, words in ((report["views"], "scenes"), (quality, "--quality"),
                                          (tables[1], "--bench of clpv bench table1"),
                                          (layouts, "--bench of clpv bench layouts")) if not given]
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent),
                                     autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    html = environment.get_template("page.html").render(
        subtitle=report["subtitle"], methods=report["methods"],
        viewer=images(source, report["views"]), quality=quality,
        quality_chart=inlined(error_against_cost(quality), [row["name"] for row in quality]),
        table1=tables, layouts=layouts, layouts_chart=inlined(bench.layouts(layouts)),
        missing=missing, colours=page_colours())
    output.write(target, html)
