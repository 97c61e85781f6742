# SPDX-License-Identifier: MIT
"""Tables of docs/benchmark_results.md, docs/gpu.md and docs/paper/table1.md, by `clpv bench` and `clpv
render --stats`."""
import math

from clpv import ms_of

from .. import rows as known
from .cells import found, load, number, ratio, summed, table, time


def bench(suite):
    return load(suite)["benchmarks"]


TABLE1_BASES = "sh2", "srbf4", "srbf8v2"


def table1(shadows):
    """The paper's Table 1: of each basis the published time and the one measured here."""
    lines = [["[ms]"] +
             [f"{basis}, {column}" for basis in TABLE1_BASES
              for column in ("paper", "here")] + ["srbf8v2 / sh2, paper", "here"]]

    def add(title, published, here, spreads):
        times = [
            cell for a, b, s in zip(published, here, spreads)
            for cell in ("-" if a is None else f"{a:g}",
                         "-" if b is None else f"{number(b)} +- {number(s)}")
        ]
        lines.append([title, *times, ratio(published[-1], published[0]), ratio(here[-1], here[0])])

    def at(stage, cascade, layout):
        rows = [
            found(bench("table1"), stage=stage, cascade=cascade, layout=layout, basis=basis,
                  occlusion=shadows) for basis in TABLE1_BASES
        ]
        return [[row and row[key] for row in rows] for key in ("published_ms", "median", "mad")]

    for layout in ("image", "soa"):
        terms = []
        for stage, name in (("inject-light", "injection"), ("inject-geometry", "geometry volume"),
                            ("propagate", "propagation"), ("gather", "light buffer")):
            if stage == "inject-geometry" and not shadows:
                continue
            for cascade, size in enumerate(
                ("small", "medium", "big")) if stage != "gather" else ((None, None), ):
                cells = at(stage, cascade, layout)
                if layout == "image":
                    add(f"{name}, {size}" if size else name, *cells)
                elif not shadows and stage == "propagate":
                    add(f"in buffers and constants: {name}, {size}", *cells)
                if stage != "inject-geometry":
                    terms.append(cells)
        published, here, spreads = zip(*terms)
        add(
            "sum, without geometry volume"
            if layout == "image" else "in buffers and constants: the same sum",
            *([summed(column) for column in zip(*times)] for times in (published, here)),
            [math.hypot(*column) for column in zip(*spreads)])
    return lines


@table
def table1_shadows():
    return table1(shadows=True)


@table
def table1_no_shadows():
    return table1(shadows=False)


@table
def layouts():
    formats = [
        "image/half", "image/float", "aos/float", "soa/float", "soa/half", "tiled/float",
        "tiled/half"
    ]
    lines = [["stage [ms]", *formats, "best over image/half"]]
    works = dict.fromkeys(
        (row["stage"], row["basis"], row["occlusion"]) for row in bench("layouts"))
    for stage, basis, occlusion in works:
        rows = [
            found(bench("layouts"), stage=stage, basis=basis, occlusion=occlusion, filtered=True,
                  **dict(zip(("layout", "storage"), name.split("/")))) for name in formats
        ]
        best = min(row["median"] for row in rows if row["layout"] != "image")
        lines.append([f"{stage} {basis}{', blockers' if occlusion else ''}", *map(time, rows),
                      ratio(rows[0]["median"], best)])
    return lines


@table
def bases():
    lines = [["basis", "N", "without blockers", "with blockers"]]
    rows = [row for row in bench("bases") if row["stage"] == "propagate" and row["lobe"] == "exact"]
    for basis, size in dict.fromkeys((row["basis"], row["coefficients"]) for row in rows):
        lines.append([basis, str(size)] + [time(found(rows, basis=basis, occlusion=occlusion))
                                           for occlusion in (False, True)])
    return lines


@table
def ceilings():
    measured = load("layouts")["context"]["ceilings"]
    lines = [["multiply-adds [GFLOP/s]"], [number(measured["gflops"])]]
    for bandwidth in measured["bandwidths"]:
        lines[0].append(f"{bandwidth['working_set'] / 2**20:.3g} MiB [GB/s]")
        lines[1].append(number(bandwidth["gbps"]))
    return [[*lines[0], "a launch [us]"], [*lines[1], number(1e3 * measured["launch_ms"])]]


STAGES = ("rasterize-camera", "rasterize-shadow", "rasterize-rsm", "inject-light",
          "inject-geometry", "propagate", "gather", "near-trace", "near", "medium", "shade")


@table
def frames():
    return [["[ms]", "frame", *STAGES]] + [[
        name,
        *(number(frame and ms_of(frame["times"], stage) or None) for stage in ("frame", *STAGES))
    ] for name, frame in ((name, found(load("frames")["frames"], given=given))
                          for name, given in known.FRAMES.items())]


@table
def frames_recomputed():
    lines = [["recomputed", "frame [ms]", "blockers and visibility [ms]"]]
    for recompute, name in (("everything", "light, blockers and visibility"), ("light",
                                                           "light, as if lights had changed"),
                            ("nothing", "nothing: only the camera moves")):
        rows = [row for row in bench("frame") if row["recompute"] == recompute]
        parts = [row["median"] for row in rows if row["stage"] in ("blockers", "visibility")]
        lines.append(
            [name,
             time(found(rows, stage="frame")),
             number(sum(parts)) if sum(parts) else "-"])
    return lines
