# SPDX-License-Identifier: MIT
"""Tables of docs/quality_results.md, docs/bake_results.md, docs/tutorial.md and README.md: NRMSE of
indirect light in %, energy over the ground truth's, and leaks. tables.json has their columns."""
import json
import textwrap

from clpv import ms_of

from .. import ROOT, bake as probes, rows as known
from ..cells import crossed, found, load, number, percent, rows, table

# Methods of README.md.
PEERS = {
    "clpv": "**clpv, the defaults**", "ddgi-converged": "DDGI, converged",
    "clpv, near off": "clpv, `--preset fast`", "paths-filtered": "path tracing, filtered",
    "vpl-interleaved": "virtual point lights, interleaved",
    "published scheme": "CLPV as published, four harmonics"
}
VIEWS = "curtains", "atrium", "columns", "front"
BOUNCES = {1: "one", 2: "two"}
LINE = 130  # width of the docs
MEANINGS = {
    "nrmse_valid": "root mean square error divided by the root mean square of the truth",
    "energy_ratio": "mean of the image divided by the mean of the truth",
    "flip": "mean difference that an observer sees, from 0 to 1",
}


def mean(name, options):
    row = found(load(name)["variants"], options=options)
    return row and row["nrmse"]


def energy(row):
    return f"{row['energy_ratio']:.2f}" if row and row.get("energy_ratio") else "-"


@rows
def errors(table_of, *files):
    """Of each variant: the error of each view in the first file, and the means of all files."""
    for name, options in known.table(table_of).items():
        cells = {camera: found(load(files[0])["cells"], options=options, camera=camera)
                 for camera in VIEWS}
        yield {"name": name, "energy": " ".join(map(energy, cells.values())),
               **{camera: cell and cell["nrmse"] for camera, cell in cells.items()},
               "means": [mean(file, options) for file in files]}


@rows
def of_grids():
    return [found(load("quality-grid")["variants"], options={**known.FAST, **grid})
            for grid in known.GRIDS.values()]


@rows
def of_suns():
    for sun in ("low", "noon", "cross"):
        for name, options in known.SUNS.items():
            cells = (found(load("quality-suns")["cells"], options=options, camera=f"{view}-{sun}")
                     for view in VIEWS[:3])
            yield {"sun": sun, "name": name, "errors": [cell and cell["nrmse"] for cell in cells]}


@rows
def of_scenes():
    for scene, title in (("atrium", "atrium, its sun"), ("atrium_overcast", "atrium, overcast"),
                         ("sponza_overcast", "Sponza, overcast")):
        for name, options in known.SUNS.items():
            cells = [row for row in load("quality-scenes")["cells"]
                     if (row["scene"], row["options"]) == (scene, options)]
            if cells and all(row["nrmse"] is not None for row in cells):  # steps reject skies
                yield {"scene": title, "name": name,
                       "each": ", ".join(f"{row['camera']} {percent(row['nrmse'])}" for row in cells),
                       "mean": sum(row["nrmse"] for row in cells) / len(cells),
                       "energy": " ".join(map(energy, cells))}


@rows
def of_media():
    views = {}  # by scene and number of bounces
    for cell in load("quality-media")["cells"]:
        place = {key: cell[key] for key in ("scene", "camera", "medium", "bounces")}
        texts = views.setdefault(tuple(place.values()), {**place, "in_medium": "-", "indirect": "-"})
        texts["in_medium" if cell["view"] == "medium" else "indirect"] = (
            f"{percent(cell['nrmse'])} %, {energy(cell)}")
    return views.values()


@rows
def of_lamp():
    runs = [("one bounce", "quality-lamp", {}, "`--preset fast`"),
            *(("all bounces", "quality-lamp-bounces", {"bounces": n},
               f"`--preset fast --bounces {n}`") for n in ("1", "2", "all"))]
    for truth, file, options, name in runs:
        cells = (found(load(file)["cells"], options={**known.FAST, **options}, camera=camera)
                 for camera in ("front", "published"))
        yield {"truth": truth, "name": name, "errors": [cell and cell["nrmse"] for cell in cells]}


@table
def quality_steps():
    def cell(options, setting):
        row = found(load("quality-steps")["cells"], options={**options, **setting})
        return f"{percent(row['nrmse'])}, {energy(row)}" if row else "-"

    return crossed("NRMSE [%], energy", known.SETTINGS, known.STEPS, cell)


def short(value):
    return "0" if value < 0.0005 else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def columns_of_leaks(*without):
    return {f"{light}, {BOUNCES.get(bounces, bounces)}": {"light": light, "bounces": bounces}
            for light, bounces in known.LEAKS["columns"] if bounces not in without}


@table
def leaks():
    def cell(shape, column):
        row = found(load("leaks")["leaks"], shape=shape, **column)
        return short(row["leak"]) if row else "-"

    lines = crossed("walls", columns_of_leaks(), {shape: shape for shape in known.SEALED}, cell)
    titles = [("walls", "thickness over cell"), *known.SEALED.values()]
    return [[*title, *cells] for title, (_, *cells) in zip(titles, lines)]


@table
def leaks_open():
    def cell(shape, column):
        row = found(load("leaks")["leaks"], shape=shape, **column)
        return f"{short(row['leak'])} ({short(row['truth'])})"

    return crossed("room", columns_of_leaks("direct"),
                   {title: shape for shape, title in known.OPEN_ROOMS.items()}, cell)


@table
def rooms():
    """Energies at both angles, by one bounce and by all."""
    lines = load("rooms")["rows"]

    def cell(title, column):
        turned, bounces = column
        row = [row for row in lines if (row["room"], row["bounces"]) == (title, bounces)][turned:]
        return f"{row[0]['energy']:.2f}" if row else "-"

    columns = {"straight, one": (0, 1), "all": (0, "all"), "turned, one": (1, 1), "turned, all": (1, "all")}
    return crossed("room", columns, {f"{room['title']}; {room['degrees']} degrees": room["title"]
                                     for room in known.ROOMS}, cell)


@rows
def peers():
    """Mean errors of clpv and other methods with the same time, over the views of the first device
    that has them."""
    path = sorted((ROOT / "lab/results/quality").glob("*.json"))[0]
    cells = json.loads(path.read_text(encoding="utf-8"))["small"]
    for method, title in PEERS.items():
        own = [cell for cell in cells if cell["method"] == method]
        light = sum(ms_of(row["times"], "frame") - sum(ms_of(row["times"], stage)
                                                       for stage in known.SHARED) for row in own)
        yield {"title": title, "error": sum(row["nrmse"] for row in own) / len(own),
               "columns": found(own, scene="sponza", camera="columns")["nrmse"],
               "light": light / len(own)}


# Light probes: errors of their formats.


@table
def bake():
    lines = load("bake")["rows"]
    columns = {f"{name}, {spacing}": (source, fine)
               for name, source in zip(("traced", "swept"), probes.SOURCES)
               for fine, spacing in enumerate(("coarse", "fine"))}
    formats = {row["format"]: row for row in lines}

    def cell(name, column):
        return ", ".join(f"{probes.mean(lines, name, column[0], place, column[1]):.1f}"
                         for place in ("surface", "air"))

    head, *cells = crossed("format", columns, {name: name for name in formats}, cell)
    return [[head[0], "numbers", "bytes", *head[1:], "negative [%]"]] + [
        [f"`{name}`", str(formats[name]["numbers"]), str(formats[name]["bytes"]), *errors_of,
         f"{probes.mean(lines, name, 'pathtrace', 'negative', 1):.1f}"]
        for name, *errors_of in cells]


@table
def bake_leaks():
    lines = load("bake-leaks")["rows"]
    columns = {f"{row['room']}, {row['spacing']:g} m": (row["room"], row["spacing"])
               for row in lines}

    def cell(name, column):
        return ", ".join(number(found(lines, format=name, room=column[0], spacing=column[1],
                                      filled=filled)["leak"]) for filled in (True, False))

    names = "sh2", "sh2-geomerics", "sh3"  # others differ little
    return crossed("format", columns, {f"`{name}`": name for name in names}, cell)


# Numbers that tests/docs/run_tutorial --write measures.


@rows
def of_tutorial(part):
    lines = [{**row, "name": name} for name, row in load("tutorial")[part].items()]
    return sorted(lines, key=lambda row: row["nrmse"])


@table
def tutorial_compare():
    compared = load("tutorial")["compare"]
    return [["key", "here", "meaning"]] + [[f"`{key}`", f"{compared[key]:.2f}", meaning]
                                           for key, meaning in MEANINGS.items()]


@table
def readme_times():
    ours, theirs = (ms_of(found(load("frames")["frames"], given=options)["times"], "frame")
                    for options in (known.BEST, known.OPTIONS["IN_BUFFERS"]))
    return textwrap.fill(
        f"A frame of Sponza at 960x540 by one bounce that recomputes all light takes {ours:.0f} ms "
        f"on two CPU cores, and {theirs:.0f} ms by the published scheme in buffers "
        "([times](docs/benchmark_results.md#frames)); on an NVIDIA H200 7.1 ms, where all "
        "comparisons of `clpv check` pass ([GPUs](docs/gpu.md)).", LINE) + "\n"


@table
def demo_caption():
    demo = load("tutorial")["demo"]
    return textwrap.fill(
        "*The atrium under sun and sky: direct light, global illumination by clpv, and path "
        f"tracing, all at one exposure. `scripts/demo` makes it. All bounces take "
        f"{demo['frame_ms']} ms per frame of {demo['width']}x{demo['height']} on two CPU cores. "
        "The error of their indirect light (normalised root mean square, NRMSE) is "
        f"{100 * demo['error']:.0f} %.*", LINE) + "\n"
