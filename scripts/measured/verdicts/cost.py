# SPDX-License-Identifier: MIT
"""Cost (section 6, Table 1), and conclusions (section 7)."""
import itertools
import math

from .. import rows as known
from .judge import ABOUT, SIMILAR, SPREADS, claim, row

DRIVERS = {"PoCL 3.1": "docs/table1", "Intel": "intel-2026.22-epyc-2-cores/table1"}
BASES = "sh2", "srbf4", "srbf8v2"
BENCH = "clpv bench table1"


def cost(read, file, basis, layout, shadows):
    """Sum of Table 1 [ms] and its spread, without the geometry volume."""
    rows = [each for each in read(file)["benchmarks"]
            if (each["basis"], each["layout"], each["occlusion"]) == (basis, layout, shadows)
            and each["stage"] in ("inject-light", "propagate", "gather")]
    return sum(each["median"] for each in rows), math.hypot(*(each["mad"] for each in rows))


def ratio(a, b):
    """Ratio and its spread, as a row."""
    value = a[0] / b[0]
    return {"value": value, "spread": SPREADS * value * math.hypot(a[1] / a[0], b[1] / b[0])}


def outside(each, limit):
    """True if the ratio is on one side of a limit, beyond its spread."""
    return abs(each["value"] - limit) >= each["spread"]


def over_sh(basis):
    def rows(read):
        for (driver, file), (layout, name), shadows in itertools.product(
                DRIVERS.items(), (("image", "as published"), ("soa", "in buffers")), (True, False)):
            yield {"place": f"{driver} {name} {'with' if shadows else 'without'} shadows",
                   **ratio(*(cost(read, file, each, layout, shadows) for each in (basis, "sh2")))}

    return rows


def about(factor):
    """Predicate: the ratio is about a factor."""

    def holds(each):
        ends = factor / ABOUT, factor * ABOUT
        if all(outside(each, end) for end in ends):
            return ends[0] <= each["value"] <= ends[1]
        return None

    return holds


def by_cascade(read):
    """Medians by cascade, how far the medium one's is above both others, and their spread."""
    for stage, basis in itertools.product(("inject-light", "propagate"), BASES):
        small, medium, big = (row(read("docs/table1")["benchmarks"], stage=stage, basis=basis,
                                  layout="image", occlusion=True, cascade=cascade)
                              for cascade in range(3))
        yield {"place": f"{stage} {basis}",
               "apart": min(medium["median"] - each["median"] for each in (small, big)),
               "spread": SPREADS * max(math.hypot(medium["mad"], each["mad"])
                                       for each in (small, big)),
               "all": ", ".join(f"{each['median']:.3g}" for each in (small, medium, big))}


def with_shadows(read):
    for (driver, file), basis in itertools.product(DRIVERS.items(), BASES):
        yield {"place": f"{driver} {basis}",
               **ratio(*(cost(read, file, basis, "image", shadows) for shadows in (True, False)))}


claim("cost", "8v2 takes approximately three times as long as SH (published: 2.95x with, 2.61x "
      "without shadows)", "ratio of the sums of Table 1 between 2 and 4.5", "driver", BENCH,
      over_sh("srbf8v2"), "place", about(3), "{value:.3g}x +- {spread:.2g}")
claim("cost", "srbf4 takes 1.44 and 1.30 times as long as SH",
      "ratio of the sums of Table 1 between 0.93 and 2.1", "driver", BENCH, over_sh("srbf4"),
      "place", about(1.4), "{value:.3g}x +- {spread:.2g}")
claim("cost", "the medium cascade takes longest",
      "median of the medium cascade > of both others, by three times the spread", "pass, basis",
      BENCH, by_cascade, "place",
      lambda each: None if abs(each["apart"]) < each["spread"] else each["apart"] > 0, "{all}")
claim("cost", "shadows cost little (published: 1.07x, 1.18x, 1.21x)",
      "sum with shadows at most 1.25 of that without; not resolved within the spread, or below 1, "
      "since shadows only add work", "driver, basis", BENCH, with_shadows, "place",
      lambda each: each["value"] <= 1.25 if outside(each, 1.25) and each["value"] >= 1 else None,
      "{value:.2f}x +- {spread:.2g}")


def means(read):
    """Mean NRMSE over four views, by basis, of `--preset fast`."""
    return {each["options"].get("basis", "sh2"): each["nrmse"]
            for each in read("docs/quality")["variants"]
            if each["options"].get("preset") == "fast"
            and set(each["options"]) <= {"preset", "basis"}}


def published(read, basis):
    return row(read("docs/quality")["variants"],
               options={**known.PAPER, "basis": basis})["nrmse"]


def of_both_schemes(read):
    return [*({"scheme": f"published {basis}", "error": published(read, basis)}
              for basis in ("sh2", "srbf8v2")),
            *({"scheme": f"sweep {basis}", "error": means(read)[basis]}
              for basis in ("sh2", "srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3"))]


def searched(read):
    """The best error of a search and the bound, by number of functions."""
    rows = read("docs/claims")["lobes"]["searched"]
    for n in dict.fromkeys(each["n"] for each in rows):
        yield {"n": n, "error": row(rows, n=n, over="all", lambdas="one")["error"],
               "bound": row(rows, n=n, over="all", lambdas="none")["bound"]}


def of_centres(read):
    """Mean E by centres for Sponza's normals, and by each other set."""
    found, general = (row(read("docs/quality-centres")["variants"],
                          options={**known.FAST, "centres": file})["nrmse"]
                      for file in (known.SEARCHED_NORMALS, known.SEARCHED))
    others = {"eight for all directions": general,
              **{name: means(read)[name] for name in ("srbf8v1", "srbf8v2")}}
    return [{"set": name, "found": found, "error": error} for name, error in others.items()]


def of_sh3(read):
    exact = row(read("docs/quality-centres")["variants"],
                options={**known.EXACT_LOBES, "basis": "sh3"})["nrmse"]
    return [{"scheme": "published", "sh3": exact, "sh2": published(read, "sh2")},
            {"scheme": "sweep, lobes completed", **means(read)}]


def of_layouts(read):
    """Reads per cell of images and of buffers, and the ratio of their times."""
    rows = [each for each in read("docs/layouts")["benchmarks"]
            if each["stage"] == "propagate" and not each["occlusion"]]
    for basis in dict.fromkeys(each["basis"] for each in rows):
        image, buffers = (row(rows, basis=basis, layout=layout, storage=storage)
                          for layout, storage in (("image", "half"), ("soa", "float")))
        yield {"basis": basis, "image": image["reads_per_cell"],
               "buffers": buffers["reads_per_cell"], "times": image["median"] / buffers["median"]}


claim("conclusions", "8v2 and SH are practically equal", "NRMSE of both images at curtains <= 0.1",
      "lambda", "scripts/reproduce --part lambdas", lambda read: read("docs/claims")["lambdas"],
      "lambda", lambda each: each["difference"] <= SIMILAR,
      "{difference:.3f}, E of 8v2 {error:.3f}")
claim("conclusions", "SRBF of few coefficients are not suitable (main conclusion)", "mean E > 0.5",
      "scheme, basis", "clpv quality", of_both_schemes, "scheme", lambda each: each["error"] > 0.5,
      "{error:.2f}")
claim("conclusions", "perfect lobes are very difficult to find",
      "the best centres of a search (one lambda, seconds) have an error above the bound for any N "
      "functions by more than a tenth", "N", "scripts/reproduce --part lobes", searched, "n",
      lambda each: each["error"] > (1 + SIMILAR) * each["bound"], "{error:.3f}, bound {bound:.3f}")
claim("conclusions", "centres should be tested for each scene",
      "mean E with centres for Sponza's normals < 0.9 of that of", "other set",
      "python3 -m clpv_lab.search", of_centres, "set",
      lambda each: each["found"] < (1 - SIMILAR) * each["error"], "{found:.3f}, {error:.3f}")
claim("conclusions", "more coefficients of SH should be investigated",
      "mean E of sh3 < that of sh2 by at least a tenth", "scheme", "clpv quality", of_sh3, "scheme",
      lambda each: each["sh3"] < (1 - SIMILAR) * each["sh2"], "{sh3:.3f}, {sh2:.3f}")
claim("conclusions", "GPGPU reduces texture reads",
      "reads per cell of propagation in buffers < in images of halves", "basis",
      "clpv bench layouts", of_layouts, "basis", lambda each: each["buffers"] < each["image"],
      "{image:g} and {buffers:g} reads, and yet {times:.0f}x as fast")
