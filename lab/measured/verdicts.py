# SPDX-License-Identifier: MIT
"""The paper's claims judged by rule, for results/paper/claims.json and docs/paper/figures.md.

verdicts.json has the claims, in the order of docs/paper/figures.md. `rows`: a list in results/docs
("claims/lambdas"), the rows of a table, or the name of a function here and its arguments; a row for
each point of the claim's axis, but for those that `where` leaves out. `at`: key of a row's place on
the axis, or a form of it. `holds`: expression of a row's members: True, False, or None for 'not
resolved'. `numbers`: form of a row. Both have `sets`, too: errors of all sets by name. The verdict
is a sentence made from the outcomes. Only the standard library.
"""
import functools
import itertools
import json
import math
import pathlib
import statistics

from . import rows as known
from .cells import ROWS, Form, found as row

CLAIMS = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
SIMILAR = 0.1  # 'similar': errors that differ by a tenth at most
ABOUT = 1.5  # 'about': within this factor
SPREADS = 3  # medians differ if they are this many median absolute deviations apart
ROTATED = "srbf14", "sh2", "srbf4", "srbf8v1", "srbf8v2", "srbf8v3"
DRIVERS = {"PoCL 3.1": "docs/table1", "Intel": "intel-2026.22-epyc-2-cores/table1"}
BASES = "sh2", "srbf4", "srbf8v2"
NAMES = {
    "paper sh2": "sh2", "paper srbf8v2": "srbf8v2", "paper sh2 64 16": "sh2 in 64^3 cells",
    "best": "the defaults", "64": "the defaults in 64^3 cells"
}


# Functions that the expressions of verdicts.json call.


def similar(a, b):
    return abs(a - b) <= SIMILAR * abs(b)


def outside(value, spread, limit):
    """True if the ratio is on one side of a limit, beyond its spread."""
    return abs(value - limit) >= spread


def about(value, spread, factor):
    """The ratio is about a factor."""
    ends = factor / ABOUT, factor * ABOUT
    if all(outside(value, spread, end) for end in ends):
        return ends[0] <= value <= ends[1]
    return None


WORDS = {"abs": abs, "min": min, "sorted": sorted, "similar": similar, "outside": outside,
         "about": about, "SIMILAR": SIMILAR, "__builtins__": {}}

# Theory (sections 2 and 3), and lobes (section 4 and appendix 1).


def sets(read):
    """Errors of all sets, by name."""
    return {each["basis"]: each for each in read("docs/claims")["lobes"]["sets"]}


def width(value):
    """Half width of G at half its maximum [degrees]."""
    return math.degrees(
        math.acos(max(-1, (1 + value**2 - 2**(2 / 3) * (1 - value)**2) / (2 * value))))


def widths(_):
    return [{"lambda": value, "width": width(value), "before": width(value - 0.05)}
            for value in (0.25, 0.4, 0.55, 0.6)]


def energies(read):
    """By set: the least and the largest by tables, and that with H computed."""
    rows = read("docs/claims")["tables"]
    for name in dict.fromkeys(each["basis"] for each in rows):
        found = {each["entries"]: each["energy_sampled_8"] for each in rows
                 if each["basis"] == name}
        computed = found.pop(0)
        yield {"basis": name, "least": min(found.values()), "most": max(found.values()),
               "computed": computed}


def with_srbf14(read):
    """And the least error of the other sets."""
    others = "srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "sh2"
    return [{**each, "least": min(each[name] for name in others)}
            for each in read("docs/claims")["lambdas"] if each["srbf14"] is not None]


def ranked(read):
    """Rotated lobes from the best to the worst, by two measures."""
    for measure, key, form in (("L", "oblique_rotated", ".3f"),
                               ("the peak's direction", "oblique_rotated_peak", ".0f")):
        names = sorted(ROTATED, key=lambda name, key=key: sets(read)[name][key])
        texts = [f"{name} {sets(read)[name][key]:{form}}" for name in names]
        yield {"measure": measure, "names": names, "all": ", ".join(texts),
               "last": ", ".join(texts[3:])}


def minima(read):
    least = {name: sets(read)[name]["oblique_rotated_minimum"] for name in ROTATED}
    return [{"set": "srbf14", "least": min(least, key=least.get),
             "all": ", ".join(f"{name} {value:.3f}" for name, value in least.items())}]


def of_eight(read):
    eight = [each for name, each in sets(read).items() if name.startswith("srbf8")]
    for place, key in (("+z", "up"), ("(-2,1,-3)", "oblique"), ("mean", "mean")):
        values = [each[key] for each in eight]
        yield {"direction": place, "least": min(values), "most": max(values)}


# Light and shadows (section 6).


def bootstrap(blocks):
    """95 % interval of the mean over all draws of blocks with replacement: 4 blocks have 256."""
    means = sorted(statistics.fmean(itertools.chain(*draw))
                   for draw in itertools.product(blocks, repeat=len(blocks)))
    return means[math.floor(0.025 * (len(means) - 1))], means[math.ceil(0.975 * (len(means) - 1))]


def interval(differences):
    """Union of the intervals by blocks of cameras and of suns, by "camera-sun"."""
    ends = []
    for part in (0, 1):
        blocks = {}
        for name, value in differences.items():
            blocks.setdefault(name.rsplit("-", 1)[part], []).append(value)
        ends.append(bootstrap(list(blocks.values())))
    return min(low for low, _ in ends), max(high for _, high in ends)


def apart(read, sizes):
    """The mean of E of SH less E of 8v2 in cascades of these sizes, and its interval."""
    for each in read("docs/claims")["views"]["summary"]:
        if each["cascade_size"] in sizes:
            low, high = interval(each["apart"])
            yield {**each, "low": low, "high": high,
                   "mean": statistics.fmean(each["apart"].values())}


def pairs(read, **changed):
    """Rows of the part light that have another value of one key than `changed`, with the
    difference where it has that value."""
    (key, value), = changed.items()
    every = read("docs/claims")["light"]
    for each in every:
        if each[key] != value:
            others = {name: each[name] for name in ("cascade_size", "rsm_size", "iterations")}
            yield {**each, "then": row(every, **{**others, key: value})["difference"]}


def exact_lobes(read):
    """E of srbf14 and of SH by exact lobes, in the atrium."""
    cells = read("docs/quality-steps")["cells"]
    for size in ("12.5", "50"):
        options = {**known.EXACT_LOBES, "cascade-size": size, "iterations": "8"}
        yield {"size": float(size), **{name: row(cells, options={**options, "basis": name})["nrmse"]
                                       for name in ("srbf14", "sh2")}}


def grown(read, varied, first, second, fixed, values):
    """Number of views whose E is larger at the second value."""
    every = read("docs/claims")["views"]["rows"]
    for basis, value in itertools.product(("sh2", "srbf8v2"), values):
        before, after = ({each["camera"]: each["nrmse"] for each in every
                          if (each["basis"], each[varied], each[fixed]) == (basis, at, value)}
                         for at in (first, second))
        yield {"basis": basis, "fixed": value, "count": len(before),
               "more": sum(after[camera] > error for camera, error in before.items())}


def contrasts(read, images):
    """Rows of these images, with and without blockers."""
    found = {each["image"]: each for each in read("docs/claims")["shadows"]["rows"]}
    return [{**found[image], "name": NAMES[image]} for image in images]


def coarse_and_fine(read):
    coarse, fine = contrasts(read, ("paper sh2", "paper sh2 64 16"))
    return [{"name": "sh2", "coarse": coarse["on"], "fine": fine["on"]}]


def of_arcade(read, first=0):
    """The path-traced shadow, then those of all images, each with the traced one."""
    rows = read("docs/claims")["arcade"]
    return [{**each, "name": NAMES.get(each["image"], each["image"]), "traced": rows[0]["on"]}
            for each in rows[first:]]


def seen_blockers(read):
    """Energy with blockers seen and with triangles."""
    for camera in ("curtains", "atrium", "columns"):
        seen, scene = (row(read("docs/quality")["cells"], camera=camera,
                           options={**known.FAST, **blockers})["energy_ratio"]
                       for blockers in ({"blockers": "seen"}, {}))
        yield {"camera": camera, "seen": seen, "scene": scene}


# Cost (section 6, Table 1), and conclusions (section 7).


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


def over_sh(read, basis):
    for (driver, file), (layout, name), shadows in itertools.product(
            DRIVERS.items(), (("image", "as published"), ("soa", "in buffers")), (True, False)):
        yield {"place": f"{driver} {name} {'with' if shadows else 'without'} shadows",
               **ratio(*(cost(read, file, each, layout, shadows) for each in (basis, "sh2")))}


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


CHANNELS_AND_LINKS = 3 * 7  # a cell and its six neighbours, of each channel


def of_layouts(read):
    """Reads per cell of images and of buffers, and the ratio of their times."""
    rows = [each for each in read("docs/layouts")["benchmarks"]
            if each["stage"] == "propagate" and not each["occlusion"]]
    for basis in dict.fromkeys(each["basis"] for each in rows):
        image, buffers = (row(rows, basis=basis, layout=layout, storage=storage)
                          for layout, storage in (("image", "half"), ("soa", "float")))
        numbers = image["coefficients"]
        yield {"basis": basis, "image": CHANNELS_AND_LINKS * math.ceil(numbers / 4),
               "buffers": CHANNELS_AND_LINKS * numbers,
               "times": image["median"] / buffers["median"]}


# Verdicts.


def rows_of(read, name, arguments=None):
    if "/" in name:
        file, *members = name.split("/")
        return functools.reduce(lambda found, member: found[member], members, read(f"docs/{file}"))
    return globals()[name](read, **arguments or {}) if name in globals() else ROWS[name]()


def points(read, claim):
    """(place, outcome, numbers) of a claim's rows."""
    given = [claim["rows"]] if isinstance(claim["rows"], str) else claim["rows"]
    for each in rows_of(read, *given):
        members = {**each, **WORDS, "sets": sets(read)}
        if not eval(claim.get("where", "True"), members):
            continue
        outcome = eval(claim["holds"], members)
        yield (each.get(claim["at"], claim["at"].format(**each)),
               None if outcome is None else bool(outcome),  # perhaps NumPy's Boolean
               Form().format(claim["numbers"], **{**each, "sets": sets(read)}))


def sentence(axis, found):
    """'holds', 'not resolved', 'holds for lambda <= 0.4', 'holds for a, b; not for c'."""
    outcomes = [outcome for _, outcome, _ in found]
    names = {True: "holds", False: "does not hold", None: "not resolved"}
    if len(set(outcomes)) == 1:
        return names[outcomes[0]]
    places = {value: [place for place, outcome, _ in found if outcome is value] for value in names}
    if None not in outcomes and all(isinstance(place, (int, float)) for place, _, _ in found):
        for last, sign in ((places[True][-1], "<="), (places[True][0], ">=")):
            if all(outcome == (place <= last if sign == "<=" else place >= last)
                   for place, outcome, _ in found):
                return f"holds for {axis} {sign} {last:g}"
    texts = {True: "holds for", False: "not for", None: "not resolved for"}
    if len(places[False]) > len(places[True]) + 2 and places[True] and not places[None]:
        places[False] = ["the others"]
    return "; ".join(f"{texts[value]} {', '.join(map(str, each))}"
                     for value, each in places.items() if each)


def judged(read, only=None):
    """All claims, or those of a section, as JSON. `read`: returns a file of results by its name
    ("docs/claims")."""
    made = []
    for claim in CLAIMS:
        if only in (None, claim["section"]):
            found = list(points(read, claim))
            made.append({
                **{key: claim[key] for key in ("section", "statement", "rule", "axis", "command")},
                "verdict": sentence(claim["axis"], found),
                "points": [{"at": place, "holds": outcome, "numbers": numbers}
                           for place, outcome, numbers in found]
            })
    return made
