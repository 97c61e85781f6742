# SPDX-License-Identifier: MIT
"""The report page: one self-contained HTML file.

report.json: "subtitle"; "views", each with "scene", "camera", the "truth", and "shots" with "title", "options" and the numbers of
`clpv compare`. Truth and shots name an "image" (.png, as shown) and "values" (.npy: rows, columns, R G B A, linear).
"quality" and "benchmarks": {"file", "document"} of `clpv quality` and `clpv bench` with --output. "marked": options of
variants to highlight.
"""
import base64
import io
import pathlib
import re

import jinja2
import numpy
from markupsafe import Markup
from matplotlib import image, pyplot

from clpv.draw import bench, documents, style
from clpv.draw.documents import NUMBER

FULL_SCALE = 1.5  # of false colour, in root mean squares of the ground truth
COLOURS = "inferno"  # readable in greyscale and by colour-blind readers
LUMINANCE = (0.2126, 0.7152, 0.0722)  # Rec. 709
VARIANT = {"options": dict, "rejected": int, "nrmse": NUMBER, "worst_nrmse": NUMBER, "energy_ratio": NUMBER,
           "frame_ms": NUMBER}


def data_uri(png):
    return "data:image/png;base64," + base64.b64encode(png).decode("ascii")


def coloured(shares):
    """Returns the colours R G B A of values in [0, 1]."""
    return pyplot.get_cmap(COLOURS)(numpy.asarray(shares, dtype=float))


def as_png(pixels):
    out = io.BytesIO()
    image.imsave(out, pixels, format="png", metadata={"Software": None})
    return out.getvalue()


def false_colour(shot, truth):
    """Returns R G B A: luminance of the absolute difference over the ground truth's root mean square, 0 to FULL_SCALE. Pixels
    without a surface in either image are transparent."""
    surface = truth[..., 3] > 0
    squares = (truth[surface, :3] @ LUMINANCE) ** 2
    rms = numpy.sqrt(squares.mean()) if squares.size else 0
    errors = abs(shot[..., :3] - truth[..., :3]) @ LUMINANCE
    colours = coloured(numpy.clip(errors / (rms * FULL_SCALE), 0, 1) if rms > 0 else 0 * errors)
    colours[~(surface & (shot[..., 3] > 0))] = 0
    return colours


def inlined(figure, titles=()):
    """Returns a figure as inline SVG in the page's colours; titles[i] is the tooltip of the artist "point<i>"."""
    if figure is None:
        return ""
    figure.tight_layout()
    svg = style.rendered(figure, "svg", transparent=True, bbox_inches="tight").decode("utf-8")
    svg = re.sub(r' xmlns(:xlink)?="[^"]*"| (width|height)="[0-9.]+pt"', "", svg[svg.index("<svg"):])
    for name, colour in page_colours().items():
        svg = svg.replace(colour, f"var(--{name})")
    for i, title in enumerate(titles):
        group = f'<g id="point{i}">'
        svg = svg.replace(group, f"{group}<title>{Markup.escape(title)}</title>")
    return Markup(svg)


def page_colours():
    """Returns the page's colour names and their values in charts; the page replaces them on dark screens."""
    return {"ink": style.INK, "soft": style.SOFT, "line": style.LINE,
            **{f"c{i}": colour for i, colour in enumerate(style.COLOURS)}}


def view(shown, folder):
    """Returns a view with its images as data URIs."""
    truth = numpy.load(folder / shown["truth"]["values"])

    def uri(entry):
        return data_uri((folder / entry["image"]).read_bytes())

    shots = [{**shot, "uri": uri(shot), "error_uri": data_uri(as_png(false_colour(numpy.load(folder / shot["values"]),
                                                                                  truth)))}
             for shot in shown["shots"]]
    return {**shown, "truth_uri": uri(shown["truth"]), "shots": shots}


def variants(quality, marked):
    """What was not rejected, best first."""
    rows = []
    for source in quality:
        listed = source["document"].get("variants")
        for i, row in enumerate(documents.checked(source["document"], source["file"], "variants", {"rejected": int})):
            if row["rejected"] == 0:
                documents.checked({"variants": listed[i:i + 1]}, source["file"], "variants", VARIANT)
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
                  color=style.colour(series.index(row["series"])), mec=style.INK, mew=1.5 if row["marked"] else 0)
        if row["marked"]:
            left = x > middle
            axis.annotate(row["name"], (x, y), textcoords="offset points", xytext=(-8 if left else 8, 7),
                          ha="right" if left else "left", weight="bold")
    for i, name in enumerate(series):
        axis.plot([], [], "o", color=style.colour(i), label=name)
    axis.set(ylim=(0, 1.08 * max(y for _, y in places)), xlabel="frame [ms]", ylabel="mean NRMSE [%]")
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
        ok = row["status"] == "ok"
        lines.setdefault(line, {})[str(row["basis"])] = f"{row['median']:.3g}" if ok else row["status"]
    return bases, [(line, [cells.get(basis, "") for basis in bases]) for line, cells in lines.items()]


def draw(source, target):
    report = documents.read(source / "report.json")
    rows = [row for given in report["benchmarks"]
            for row in documents.checked(given["document"], given["file"], "benchmarks", bench.ROW)]
    quality = variants(report["quality"], report["marked"])
    layouts = [row for row in rows if row["suite"] == "layouts"]
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent), autoescape=True,
                                     trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    html = environment.get_template("page.html").render(
        subtitle=report["subtitle"], views=[view(shown, source) for shown in report["views"]], quality=quality,
        quality_chart=inlined(error_against_cost(quality), [row["name"] for row in quality]),
        table1=table1([row for row in rows if row["suite"] == "table1"]), layouts=layouts,
        layouts_chart=inlined(bench.layouts(layouts)), full_scale=FULL_SCALE, colours=page_colours(),
        legend=data_uri(as_png(coloured(numpy.linspace(0, 1, 256)[None].repeat(12, axis=0)))))
    documents.write(target, html.encode("utf-8"))
