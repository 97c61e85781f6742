# SPDX-License-Identifier: MIT
"""Tables of docs/bases.md and docs/paper/: errors of clamped cosines, claims, brightness over
steps."""
import functools

from .. import rows as known, verdicts
from .quality import mean
from .cells import TABLES, found, load, result, shown, table


# Bases: errors of clamped cosines, by scripts/reproduce.


OF_SETS = {"+z": "{up:.3f}", "(-2,1,-3)": "{oblique:.3f}"}


def sets(named):
    """Errors of the named sets, or of other guesses."""
    return [row for row in load("claims")["lobes"]["sets"] if (":" not in row["basis"]) == named]


@table
def basis_lobes():
    return shown({
        "basis": "{basis}", "N": "{n}", "condition of A": "{condition:#}", **OF_SETS,
        "(-2,1,-3), rotated": "{oblique_rotated:.3f}", "mean": "{mean:.3f}",
        "minimum, +z": "{minimum:.3f}",
        "energy after 8 / 24 steps": "{energy_sampled_8:.3f} / {energy_sampled_24:.3f}"
    }, sets(True))


@table
def basis_tables():
    """Rotated lobes by the number of table entries."""
    rows = load("claims")["tables"]
    sizes = list(dict.fromkeys(row["entries"] for row in rows))
    lines = [[
        "error along +z; energy after 8 steps",
        *(f"{size} entries" if size else "H computed" for size in sizes)
    ]]
    for name in dict.fromkeys(row["basis"] for row in rows):
        cells = (found(rows, basis=name, entries=size) for size in sizes)
        lines.append([name, *(f"{row['up']:.3f}; {row['energy_sampled_8']:.3f}" for row in cells)])
    return lines


@table
def basis_guesses():
    """Other sets that fit the paper's description."""
    return shown({"set": "{basis}", **OF_SETS, "mean": "{mean:.3f}"}, sets(False))


@table
def basis_lambdas():
    """Lobes along +z and light at `curtains`, by lambda."""
    names = ("sh2", "srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14")
    return shown({
        "lambda": "{lambda}", **{name: f"{{{name}:.3f}}" for name in names},
        "4, 8v1, 8v3 worse than SH": "{worse:?}", "8v2 very similar to SH": "{similar:?}",
        "light: 8v2 and SH differ by": "{difference:.3f}", "*E* of 8v2": "{error:.3f}"
    }, load("claims")["lambdas"])


@table
def basis_search():
    lines = [["N", "lambda 0.25", "best lambda", "bound", "over axes, best lambda"]]
    rows = load("claims")["lobes"]["searched"]
    for n in dict.fromkeys(row["n"] for row in rows):
        fixed, best = (found(rows, n=n, over="all", lambdas=lambdas) for lambdas in ("none", "one"))
        axes = found(rows, n=n, over="axes", lambdas="one")
        lines.append([
            str(n), f"{fixed['error']:.3f}", f"{best['error']:.3f} ({best['lambda']:.2f})",
            f"{fixed['bound']:.3f}", f"{axes['error']:.3f}"
        ])
    return lines


@table
def basis_images():
    """Errors of images by searched centres."""
    lines = [[
        "NRMSE of indirect light, mean of four views [%]", "published scheme, exact lobes",
        "`--preset fast`"
    ]]
    for name, options in known.CENTRES.items():
        lines.append([name, mean("quality-centres", {**known.EXACT_LOBES, **options}),
                      mean("quality-centres" if "centres" in options else "quality",
                           known.FAST if name == "sh2" else {**known.FAST, **options})])
    return lines


# Claims about light, by scripts/reproduce.


@table
def claims_light():
    rows = load("claims")["light"]

    def large(row):
        return found(rows, cascade_size=row["cascade_size"], iterations=row["iterations"],
                     rsm_size=1024)

    return shown({
        "smallest cascade, steps": "{cascade_size:g} m, {iterations} steps", "sh2": "{sh2:.3f}",
        "srbf8v2": "{srbf8v2:.3f}", "difference of both": "{difference:.3f}",
        "the same, RSM 1024^2": "{large[difference]:.3f}"
    }, [{**row, "large": large(row) or {"difference": None}}
        for row in rows if row["rsm_size"] == 256])


@table
def claims_views():
    """Errors of both bases by the published scheme, paired in twelve views."""
    views = load("claims")["views"]
    lines = [[
        "E of sh2, srbf8v2 (difference)",
        *(f"{s['cascade_size']:g} m, {s['iterations']} steps" for s in views["summary"])
    ]]
    for camera in dict.fromkeys(row["camera"] for row in views["rows"]):
        line = [camera.replace("-", ", ")]
        for setting in views["summary"]:
            sh, srbf = (next(
                row["nrmse"] for row in views["rows"]
                if row["camera"] == camera and row["basis"] == basis and float(row["cascade-size"])
                == setting["cascade_size"] and int(row["iterations"]) == setting["iterations"])
                        for basis in ("sh2", "srbf8v2"))
            line.append(f"{sh:.3f}, {srbf:.3f} ({sh - srbf:+.3f})")
        lines.append(line)
    lines.append([
        "mean difference, standard error",
        *(f"{s['mean']:+.3f}, {s['standard_error']:.3f}" for s in views["summary"])
    ])
    lines.append(
        ["8v2 better", *(f"{s['srbf8v2_better']} of {s['views']}" for s in views["summary"])])
    return lines


@table
def claims_shadows():
    names = {"path traced": "path traced", "paper sh2": "published scheme, sh2",
             "paper srbf8v2": "published scheme, srbf8v2", "best": "the defaults",
             "paper sh2 64 16": "published scheme, sh2, 64^3 cells, 16 steps"}
    return shown({
        "contrast on the floor": "{title}", "with indirect shadows": "{on:.2f}",
        "without": "{off:.2f}"
    }, [{**row, "title": names[row["image"]]} for row in load("claims")["shadows"]["rows"]])


SHOWN = 6  # points of a claim whose numbers its line shows


def verdict_lines(section):
    """A line for each claim of a section."""
    lines = [["statement", "holds if", "verdict", "numbers", "command"]]
    for claim in verdicts.judged(result, section):
        points = [f"{point['at']}: {point['numbers']}" for point in claim["points"]]
        more = [f"{len(points) - SHOWN} more"] if len(points) > SHOWN + 1 else []
        command = f"`{claim['command']}`" if claim["command"].split()[0] in (
            "clpv", "python3", "scripts/reproduce") else claim["command"]
        lines.append([
            claim["statement"], claim["rule"],
            f"**{claim['verdict']}**" if len(claim["verdict"]) < 20 else claim["verdict"],
            "; ".join(points[:SHOWN if more else None] + more), command
        ])
    return lines


for each in ("theory", "lobes", "light", "shadows", "cost", "conclusions"):
    TABLES[f"verdicts-{each}"] = functools.partial(verdict_lines, each)


# Figures: brightness over steps, by scripts/reproduce.


@table
def figures_brightness():
    rows = load("figures")["rows"]
    lines = [[
        "mean luminance",
        *(f"{size} m, {steps} steps" for size in ("12.5", "50") for steps in (8, 24))
    ]]
    exact = {
        name.replace("-", "_"): value
        for name, value in known.EXACT_LOBES.items() if name != "preset"
    }
    for name, variant in (("published scheme, sh2", {"basis": "sh2"}),
                          ("published scheme, srbf8v2", {"basis": "srbf8v2"}),
                          ("published scheme, srbf14", {"basis": "srbf14"}),
                          ("srbf14, exact lobes",
                           {"basis": "srbf14",
                            **exact}), ("srbf14, exact lobes and transport",
                                        {"basis": "srbf14", **exact, "transport": "exact"})):
        cells = []
        for size in (12.5, 50):
            fields = {"lobe": None, "transport": None, **variant, "cascade_size": size}
            row = found(rows, **fields)
            cells += [f"{row['mean_8']:.4f}", f"{row['mean_24']:.4f}"]
        lines.append([name, *cells])
    return lines
