# SPDX-License-Identifier: MIT
"""The paper's claims judged by rule, for results/paper/claims.json and docs/paper/figures.md.

A claim is a function that yields points (place on its axis, outcome, numbers). An outcome is True,
False, or None for 'not resolved'. The verdict is a sentence made from the outcomes. Only the
standard library.
"""
import itertools
import math
import statistics

SIMILAR = 0.1  # 'similar': errors that differ by a tenth at most
ABOUT = 1.5  # 'about': within this factor
SPREADS = 3  # medians differ if they are this many median absolute deviations apart
CLAIMS = []  # (section, statement, rule, axis, command, function)


def claim(section, axis, command):
    """Adds a function whose docstring has the statement and, after 'Holds if:', the rule."""

    def add(function):
        statement, rule = " ".join(function.__doc__.split()).split(" Holds if: ")
        CLAIMS.append((section, statement, rule, axis, command, function))
        return function

    return add


def row(rows, **fields):
    return next(
        each for each in rows if all(each.get(key) == value for key, value in fields.items())
    )


def similar(a, b):
    return abs(a - b) <= SIMILAR * abs(b)


def sentence(axis, points):
    """'holds', 'not resolved', 'holds for lambda <= 0.4', 'holds for a, b; not for c'."""
    outcomes = [outcome for _, outcome, _ in points]
    names = {True: "holds", False: "does not hold", None: "not resolved"}
    if len(set(outcomes)) == 1:
        return names[outcomes[0]]
    places = {value: [place for place, outcome, _ in points if outcome is value] for value in names}
    if None not in outcomes and all(isinstance(place, (int, float)) for place, _, _ in points):
        for last, sign in ((places[True][-1], "<="), (places[True][0], ">=")):
            if all(
                outcome == (place <= last if sign == "<=" else place >= last)
                for place, outcome, _ in points
            ):
                return f"holds for {axis} {sign} {last:g}"
    texts = {True: "holds for", False: "not for", None: "not resolved for"}
    if len(places[False]) > len(places[True]) + 2 and places[True] and not places[None]:
        places[False] = ["the others"]
    return "; ".join(
        f"{texts[value]} {', '.join(map(str, found))}" for value, found in places.items() if found
    )


def judged(read):
    """All claims as JSON. `read`: returns a file of results by its name ("docs/claims")."""
    made = []
    for section, statement, rule, axis, command, function in CLAIMS:
        points = list(function(read))
        made.append(
            {
                "section": section,
                "statement": statement,
                "rule": rule,
                "axis": axis,
                "command": command,
                "verdict": sentence(axis, points),
                "points": [
                    {"at": place, "holds": outcome, "numbers": numbers}
                    for place, outcome, numbers in points
                ],
            }
        )
    return made


# Theory (sections 2 and 3).


def sets(read):
    return {each["basis"]: each for each in read("docs/claims")["lobes"]["sets"]}


@claim("theory", "SH", "scripts/claims lobes")
def many(read):
    """SRBF beat SH where both use many coefficients (Tsai and Shih say so of all-frequency
    transfer: not tested)

    Holds if: clamped cosines, mean L of srbf14 < that of SH by at least a tenth
    """
    for name in ("sh3", "sh5"):
        a, b = (sets(read)[each]["mean"] for each in ("srbf14", name))
        yield name, a < (1 - SIMILAR) * b, f"{a:.3f}, {b:.3f}"


@claim("theory", "lambda", "closed form of G")
def narrower(_):
    """a larger lambda makes a narrower function

    Holds if: half width of G at half its maximum falls
    """

    def width(value):
        return math.degrees(
            math.acos(max(-1, (1 + value**2 - 2 ** (2 / 3) * (1 - value) ** 2) / (2 * value)))
        )

    for value in (0.25, 0.4, 0.55, 0.6):
        yield (value, width(value) < width(value - 0.05), f"{width(value):.0f} degrees")


@claim("theory", "set", "scripts/claims lobes")
def normalised(read):
    """coefficients must be normalised by A^-1

    Holds if: L along +z with A^-1 < without
    """
    for name in ("srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14"):
        each = sets(read)[name]
        yield (
            name,
            each["up"] < each["up_without_inverse"],
            f"{each['up']:.3f}, without {each['up_without_inverse']:.3g}",
        )


@claim("theory", "set", "scripts/claims lobes")
def must_rotate(read):
    """SRBF lobes must be rotated by a matrix; SH has a short cut

    Holds if: exact projection has a larger mean L than rotation
    """
    for name in ("srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14"):
        each = sets(read)[name]
        yield (
            name,
            each["mean"] > each["oblique_rotated"],
            f"exact {each['mean']:.3f}, rotated {each['oblique_rotated']:.3f}",
        )


@claim("theory", "set", "clpv basis --axis=-2,1,-3 --lobe rotate")
def invariant(read):
    """SRBF are rotation invariant

    Holds if: L along (-2,1,-3): projected exactly and rotated from +z are similar
    """
    for name in ("sh2", "srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14"):
        each = sets(read)[name]
        yield (
            name,
            similar(each["oblique_rotated"], each["oblique"]),
            f"{each['oblique']:.3f}, {each['oblique_rotated']:.3f}",
        )


@claim("theory", "set", "scripts/claims tables")
def buffered(read):
    """the singular integral may come from a buffer

    Holds if: energy after 8 steps within a tenth of that with H computed; tables of 256, 257,
    512 and 1024 entries
    """
    rows = read("docs/claims")["tables"]
    for name in dict.fromkeys(each["basis"] for each in rows):
        energies = {
            each["entries"]: each["energy_sampled_8"] for each in rows if each["basis"] == name
        }
        found = [value for entries, value in energies.items() if entries]
        yield (
            name,
            all(similar(value, energies[0]) for value in found),
            f"{min(found):.3f} to {max(found):.3f}, computed {energies[0]:.3f}",
        )


@claim("theory", "change", "clpv bench factors")
def evaluated(read):
    """G may come from a buffer

    Holds if: NRMSE of srbf8v2's light against `--preset paper`, which reads G from an image, is at
    most 0.01
    """
    for change in ("evaluate=buffer", "evaluate=exact"):
        found = row(
            read("docs/factors")["benchmarks"], stage="sum", basis="srbf8v2", changed=change
        )
        yield (change, found["difference"] <= 0.01, f"{found['difference']:.4f}")


# Lobes (section 4 and appendix 1), by lambda.


def by_lambda(read):
    return [each for each in read("docs/claims")["lambdas"] if each["srbf14"] is not None]


OF_THE_PAPER = "srbf4", "srbf8v1", "srbf8v2", "srbf8v3"


@claim("lobes", "lambda", "scripts/claims lambdas")
def best_up(read):
    """along +z srbf14 is best

    Holds if: L of srbf14 < L of all others
    """
    for each in by_lambda(read):
        least = min(each[name] for name in (*OF_THE_PAPER, "sh2"))
        yield (each["lambda"], each["srbf14"] < least, f"{each['srbf14']:.3f}, next {least:.3f}")


@claim("lobes", "lambda", "scripts/claims lambdas")
def similar_up(read):
    """along +z srbf4, 8v1 and 8v3 are similar

    Holds if: L of srbf4 and of 8v3 within a tenth of that of 8v1
    """
    for each in read("docs/claims")["lambdas"]:
        yield (
            each["lambda"],
            all(similar(each[name], each["srbf8v1"]) for name in ("srbf4", "srbf8v3")),
            ", ".join(f"{each[name]:.3f}" for name in ("srbf4", "srbf8v1", "srbf8v3")),
        )


@claim("lobes", "lambda", "scripts/claims lambdas")
def worse_up(read):
    """and worse than SH

    Holds if: L of srbf4, 8v1 and 8v3 > L of SH, 0.354
    """
    for each in read("docs/claims")["lambdas"]:
        values = [each[name] for name in ("srbf4", "srbf8v1", "srbf8v3")]
        yield (
            each["lambda"],
            min(values) > each["sh2"],
            ", ".join(f"{value:.3f}" for value in values),
        )


@claim("lobes", "lambda", "scripts/claims lambdas")
def similar_to_sh(read):
    """along +z 8v2 is very similar to SH

    Holds if: L of 8v2 within a tenth of that of SH, 0.354
    """
    for each in read("docs/claims")["lambdas"]:
        yield (each["lambda"], similar(each["srbf8v2"], each["sh2"]), f"{each['srbf8v2']:.3f}")


@claim("lobes", "guess", "scripts/claims lobes")
def guesses(read):
    """the same for other guesses of the centres

    Holds if: L along +z > 0.354 at lambda 0.25
    """
    for name, each in sets(read).items():
        if name in ("srbf4", "srbf8v1", "srbf8v3") or ":" in name:
            yield (name, each["up"] > sets(read)["sh2"]["up"], f"{each['up']:.3f}")


ROTATED = "srbf14", "sh2", "srbf4", "srbf8v1", "srbf8v2", "srbf8v3"
LOBE = "clpv basis --axis=-2,1,-3 --lobe rotate"


def order(read, key):
    return sorted(ROTATED, key=lambda name: sets(read)[name][key])


@claim("lobes", "measure", LOBE)
def best_oblique(read):
    """along (-2,1,-3) srbf14 is best, SH second

    Holds if: ranks 1 and 2 of six, rotated lobes
    """
    for place, key, form in (
        ("L", "oblique_rotated", ".3f"),
        ("the peak's direction", "oblique_rotated_peak", ".0f"),
    ):
        found = order(read, key)
        yield (
            place,
            found[:2] == ["srbf14", "sh2"],
            ", ".join(f"{name} {sets(read)[name][key]:{form}}" for name in found),
        )


@claim("lobes", "set", LOBE)
def distorted(read):
    """there srbf14 is distorted at the origin

    Holds if: its least value, for a peak of 1, is below that of all others
    """
    least = {name: sets(read)[name]["oblique_rotated_minimum"] for name in ROTATED}
    yield (
        "srbf14",
        min(least, key=least.get) == "srbf14",
        ", ".join(f"{name} {value:.3f}" for name, value in least.items()),
    )


@claim("lobes", "measure", LOBE)
def deformed(read):
    """there srbf4, 8v1 and 8v3 are the most deformed

    Holds if: last three of six, rotated lobes
    """
    for place, key, form in (
        ("L", "oblique_rotated", ".3f"),
        ("the peak's direction", "oblique_rotated_peak", ".0f"),
    ):
        last = order(read, key)[3:]
        yield (
            place,
            set(last) == {"srbf4", "srbf8v1", "srbf8v3"},
            ", ".join(f"{name} {sets(read)[name][key]:{form}}" for name in last),
        )


@claim("lobes", "direction", "scripts/claims lobes")
def important(read):
    """positions of centres are extremely important

    Holds if: largest L of eight functions is at least twice the smallest
    """
    eight = [each for name, each in sets(read).items() if name.startswith("srbf8")]
    for place, key in (("+z", "up"), ("(-2,1,-3)", "oblique"), ("mean", "mean")):
        values = [each[key] for each in eight]
        yield (place, max(values) >= 2 * min(values), f"{min(values):.3f} to {max(values):.3f}")


# Light (section 6).


def setting(each):
    return f"{each['cascade_size']:g} m and {each['iterations']} steps"


def bootstrap(blocks):
    """95 % interval of the mean over all draws of blocks with replacement: 4 blocks have 256."""
    means = sorted(
        statistics.fmean(itertools.chain(*draw))
        for draw in itertools.product(blocks, repeat=len(blocks))
    )
    return means[math.floor(0.025 * (len(means) - 1))], means[math.ceil(0.975 * (len(means) - 1))]


def interval(apart):
    """Union of the intervals by blocks of cameras and of suns. `apart`: by "camera-sun"."""
    ends = []
    for part in (0, 1):
        blocks = {}
        for name, value in apart.items():
            blocks.setdefault(name.rsplit("-", 1)[part], []).append(value)
        ends.append(bootstrap(list(blocks.values())))
    return min(low for low, _ in ends), max(high for _, high in ends)


def signed(apart, wanted):
    """Outcome and numbers of 'the mean is above 0' (wanted 1) or below (-1)."""
    low, high = interval(apart)
    outcome = None if low <= 0 <= high else (low > 0) == (wanted > 0)
    return outcome, f"{statistics.fmean(apart.values()):+.3f} ({low:+.3f} to {high:+.3f})"


VIEWS = "scripts/claims views"
SPREAD = "95 % interval of the mean, block bootstrap over 4 cameras and 3 suns"


@claim("light", "camera", "scripts/claims lit")
def unlit(read):
    """most surfaces of Sponza are lit indirectly only

    Holds if: pixels without direct light > half
    """
    for each in read("docs/claims")["lit"]:
        yield (each["camera"], each["unlit"] > 0.5, f"{100 * each['unlit']:.0f} %")


@claim("light", "setting", VIEWS)
def better_small(read):
    """8v2 is slightly better than SH in small cascades

    Holds if: E of SH less E of 8v2 > 0; 95 % interval of the mean, block bootstrap over 4
    cameras and 3 suns
    """
    for each in read("docs/claims")["views"]["summary"]:
        if each["cascade_size"] == 12.5:
            yield setting(each), *signed(each["apart"], 1)


@claim("light", "setting", VIEWS)
def worse_big(read):
    """and worse in bigger ones

    Holds if: E of SH less E of 8v2 < 0; 95 % interval of the mean, block bootstrap over 4
    cameras and 3 suns
    """
    for each in read("docs/claims")["views"]["summary"]:
        if each["cascade_size"] == 50:
            yield setting(each), *signed(each["apart"], -1)


@claim("light", "setting", "scripts/claims light")
def detail(read):
    """since bigger cascades have less detail in the RSM

    Holds if: 16 times the texels change the difference of both images by more than a tenth
    """
    rows = read("docs/claims")["light"]
    for each in (each for each in rows if each["rsm_size"] == 256):
        fine = row(
            rows, cascade_size=each["cascade_size"], iterations=each["iterations"], rsm_size=1024
        )
        yield (
            setting(each),
            not similar(fine["difference"], each["difference"]),
            f"{each['difference']:.3f}, {fine['difference']:.3f}",
        )


@claim("light", "cascade [m]", "scripts/claims texels")
def texels(read):
    """neighbouring texels of the RSM then differ completely

    Holds if: normals of most pairs more than 60 degrees apart
    """
    for each in read("docs/claims")["texels"]:
        yield (
            each["size"],
            each["normals"] > 0.5,
            f"{100 * each['normals']:.1f} %, flux {each['flux']:.2f} of the mean",
        )


@claim("light", "cascade [m]", "clpv quality")
def diverse(read):
    """since few coefficients cannot hold diverse lobes

    Holds if: exact lobes, 8 steps, atrium: E of srbf14 < that of SH by at least a tenth
    """
    for size in ("12.5", "50"):
        exact = {
            "preset": "paper",
            "lobe": "exact",
            "lobe-time": "host",
            "evaluate": "exact",
            "cascade-size": size,
            "iterations": "8",
        }
        many_functions, few = (
            row(read("docs/quality-steps")["cells"], options={**exact, "basis": basis})["nrmse"]
            for basis in ("srbf14", "sh2")
        )
        yield (
            float(size),
            many_functions < (1 - SIMILAR) * few,
            f"{many_functions:.2f}, {few:.2f}",
        )


@claim("light", "cascade, RSM", "scripts/claims light")
def more_steps(read):
    """24 steps increase the difference

    Holds if: difference of both images after 24 steps > after 8
    """
    rows = read("docs/claims")["light"]
    for few in (each for each in rows if each["iterations"] == 8):
        many_steps = row(
            rows, cascade_size=few["cascade_size"], rsm_size=few["rsm_size"], iterations=24
        )
        yield (
            f"{few['cascade_size']:g} m and {few['rsm_size']}^2",
            many_steps["difference"] > few["difference"],
            f"{few['difference']:.3f}, {many_steps['difference']:.3f}",
        )


@claim("light", "basis, cascade", VIEWS)
def gathers(read):
    """since each step gathers error

    Holds if: E after 24 steps > after 8, in at least 11 of 12 views
    """
    yield from grows(read, "iterations", "8", "24", "cascade-size", ("12.5", "50"))


@claim("light", "basis, steps", VIEWS)
def suffers(read):
    """SH suffers likewise in bigger cascades

    Holds if: E at 50 m > at 12.5 m, in at least 11 of 12 views
    """
    yield from grows(read, "cascade-size", "12.5", "50", "iterations", ("8", "24"))


def grows(read, varied, first, second, fixed, values):
    rows = read("docs/claims")["views"]["rows"]
    for basis, value in itertools.product(("sh2", "srbf8v2"), values):
        errors = [
            {
                each["camera"]: each["nrmse"]
                for each in rows
                if each["basis"] == basis and each[varied] == at and each[fixed] == value
            }
            for at in (first, second)
        ]
        more = sum(errors[1][camera] > error for camera, error in errors[0].items())
        yield (
            f"{basis} at {value}{' m' if fixed == 'cascade-size' else ' steps'}",
            more >= len(errors[0]) - 1,
            f"{more} of {len(errors[0])}",
        )


@claim("light", "steps, RSM", "scripts/claims light")
def decrease(read):
    """bigger cascades decrease the difference

    Holds if: difference of both images at 50 m < at 12.5 m
    """
    rows = read("docs/claims")["light"]
    for small in (each for each in rows if each["cascade_size"] == 12.5):
        big = row(rows, cascade_size=50, rsm_size=small["rsm_size"], iterations=small["iterations"])
        yield (
            f"{small['iterations']} steps and {small['rsm_size']}^2",
            big["difference"] < small["difference"],
            f"{small['difference']:.3f}, {big['difference']:.3f}",
        )


@claim("light", "setting", VIEWS)
def sh_better(read):
    """SH still gets better results

    Holds if: E of SH less E of 8v2 < 0; 95 % interval of the mean, block bootstrap over 4
    cameras and 3 suns
    """
    for each in read("docs/claims")["views"]["summary"]:
        yield setting(each), *signed(each["apart"], -1)


# Shadows (section 6).

NAMES = {
    "paper sh2": "sh2",
    "paper srbf8v2": "srbf8v2",
    "paper sh2 64 16": "sh2 in 64^3 cells",
    "best": "the defaults",
}
SHADOWS = "scripts/claims shadows"


def contrasts(read, *images):
    rows = {each["image"]: each for each in read("docs/claims")["shadows"]["rows"]}
    return [(NAMES[name], rows[name]) for name in images or NAMES]


@claim("shadows", "image", SHADOWS)
def soft(read):
    """indirect shadows are too soft in both bases

    Holds if: contrast on the floor < 0.9 of the path-traced 1
    """
    for name, each in contrasts(read, "paper sh2", "paper srbf8v2"):
        yield name, each["on"] < 0.9, f"{each['on']:.2f}"


@claim("shadows", "basis", SHADOWS)
def few_cells(read):
    """so few cells make shadows soft

    Holds if: contrast of SH by 64^3 cells and 16 steps > by 32^3 and 8
    """
    (_, coarse), (_, fine) = contrasts(read, "paper sh2", "paper sh2 64 16")
    yield ("sh2", fine["on"] > coarse["on"], f"{coarse['on']:.2f}, {fine['on']:.2f}")


@claim("shadows", "image", SHADOWS)
def simulated(read):
    """shadows are still simulated

    Holds if: contrast with blockers > without
    """
    for name, each in contrasts(read):
        yield (name, each["on"] > each["off"], f"{each['on']:.2f}, without {each['off']:.2f}")


COLUMNS = {
    "preset=paper lobe-time=host basis=sh2": "sh2",
    "preset=paper lobe-time=host basis=srbf8v2": "srbf8v2",
    "preset=best": "the defaults",
    "grid=64": "the defaults in 64^3 cells",
}


@claim("shadows", "image", "scripts/claims columns")
def first_column(read):
    """the first column casts a shadow

    Holds if: the floor behind it has less than 0.9 of the irradiance behind the curtains beside
    it
    """
    for each in read("docs/claims")["columns"]:
        ratio, off = (each[f"column{end}"] / each[f"curtains{end}"] for end in ("", "_off"))
        yield (COLUMNS[each["options"]], ratio < 0.9, f"{ratio:.2f}, without blockers {off:.2f}")


@claim("shadows", "camera", "clpv quality --vary blockers=seen,scene")
def curtains(read):
    """curtains cannot block indirect light

    Holds if: the defaults with seen blockers: energy over the ground truth's above that with
    triangles by more than a tenth
    """
    cells = read("docs/quality")["cells"]
    for camera in ("curtains", "atrium", "columns"):
        seen, scene = (
            row(cells, camera=camera, options=options)["energy_ratio"]
            for options in ({"blockers": "seen", "preset": "fast"}, {"preset": "fast"})
        )
        yield (camera, seen > (1 + SIMILAR) * scene, f"{seen:.2f}, {scene:.2f}")


# Cost (section 6, Table 1).

DRIVERS = {"PoCL 3.1": "docs/table1", "Intel": "intel-2026.22-epyc-2-cores/table1"}
PUBLISHED, BUFFERS = "as published", "in buffers"
BENCH = "clpv bench table1"


def cost(read, file, basis, layout, shadows, stages=("inject-light", "propagate", "gather")):
    """Sum of Table 1 [ms] and its spread, without the geometry volume."""
    rows = [
        each
        for each in read(file)["benchmarks"]
        if (each["basis"], each["layout"], each["occlusion"]) == (basis, layout, shadows)
        and each["stage"] in stages
    ]
    return sum(each["median"] for each in rows), math.hypot(*(each["mad"] for each in rows))


def ratio(a, b):
    """Ratio and its spread."""
    value = a[0] / b[0]
    return value, SPREADS * value * math.hypot(a[1] / a[0], b[1] / b[0])


def compared(read, basis, about):
    for (driver, file), (layout, name), shadows in itertools.product(
        DRIVERS.items(), (("image", PUBLISHED), ("soa", BUFFERS)), (True, False)
    ):
        value, spread = ratio(*(cost(read, file, each, layout, shadows) for each in (basis, "sh2")))
        low, high = about / ABOUT, about * ABOUT
        sure = (
            low <= value - spread
            and value + spread <= high
            or value + spread < low
            or value - spread > high
        )
        yield (
            f"{driver} {name} {'with' if shadows else 'without'} shadows",
            low <= value <= high if sure else None,
            f"{value:.3g}x +- {spread:.2g}",
        )


@claim("cost", "driver", BENCH)
def three_times(read):
    """8v2 takes approximately three times as long as SH (published: 2.95x with, 2.61x without
    shadows)

    Holds if: ratio of the sums of Table 1 between 2 and 4.5
    """
    yield from compared(read, "srbf8v2", 3)


@claim("cost", "driver", BENCH)
def srbf4_times(read):
    """srbf4 takes 1.44 and 1.30 times as long as SH

    Holds if: ratio of the sums of Table 1 between 0.93 and 2.1
    """
    yield from compared(read, "srbf4", 1.4)


@claim("cost", "pass, basis", BENCH)
def medium(read):
    """the medium cascade takes longest

    Holds if: median of the medium cascade > of both others, by three times the spread
    """
    for stage, basis in itertools.product(
        ("inject-light", "propagate"), ("sh2", "srbf4", "srbf8v2")
    ):
        rows = [
            row(
                read("docs/table1")["benchmarks"],
                stage=stage,
                basis=basis,
                layout="image",
                occlusion=True,
                cascade=cascade,
            )
            for cascade in range(3)
        ]
        apart = min(rows[1]["median"] - each["median"] for each in (rows[0], rows[2]))
        spread = SPREADS * max(
            math.hypot(rows[1]["mad"], each["mad"]) for each in (rows[0], rows[2])
        )
        yield (
            f"{stage} {basis}",
            None if abs(apart) < spread else apart > 0,
            ", ".join(f"{each['median']:.3g}" for each in rows),
        )


@claim("cost", "driver, basis", BENCH)
def shadows_cost(read):
    """shadows cost little (published: 1.07x, 1.18x, 1.21x)

    Holds if: sum with shadows at most 1.25 of that without; not resolved within the spread, or
    below 1, since shadows only add work
    """
    for (driver, file), basis in itertools.product(DRIVERS.items(), ("sh2", "srbf4", "srbf8v2")):
        value, spread = ratio(
            *(cost(read, file, basis, "image", shadows) for shadows in (True, False))
        )
        sure = value + spread <= 1.25 or value - spread > 1.25
        yield (
            f"{driver} {basis}",
            value <= 1.25 if sure and value >= 1 else None,
            f"{value:.2f}x +- {spread:.2g}",
        )


# Conclusions (section 7).


@claim("conclusions", "lambda", "scripts/claims lambdas")
def equal(read):
    """8v2 and SH are practically equal

    Holds if: NRMSE of both images at curtains <= 0.1
    """
    for each in read("docs/claims")["lambdas"]:
        yield (
            each["lambda"],
            each["difference"] <= SIMILAR,
            f"{each['difference']:.3f}, E of 8v2 {each['error']:.3f}",
        )


def means(read):
    """Mean NRMSE over four views, by basis, of `--preset fast`."""
    return {
        each["options"].get("basis", "sh3"): each["nrmse"]
        for each in read("docs/quality")["variants"]
        if each["options"].get("preset") == "fast" and set(each["options"]) <= {"preset", "basis"}
    }


@claim("conclusions", "scheme, basis", "clpv quality")
def suitable(read):
    """SRBF of few coefficients are not suitable (main conclusion)

    Holds if: mean E > 0.5
    """
    for basis in ("sh2", "srbf8v2"):
        error = row(read("docs/quality")["variants"], options={"basis": basis, "preset": "paper"})[
            "nrmse"
        ]
        yield f"published {basis}", error > 0.5, f"{error:.2f}"
    for basis in ("sh2", "srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3"):
        yield (f"sweep {basis}", means(read)[basis] > 0.5, f"{means(read)[basis]:.2f}")


@claim("conclusions", "N", "scripts/claims lobes")
def difficult(read):
    """perfect lobes are very difficult to find

    Holds if: the best centres of a search (one lambda, seconds) have an error above the bound for
    any N functions by more than a tenth
    """
    rows = read("docs/claims")["lobes"]["searched"]
    for n in dict.fromkeys(each["n"] for each in rows):
        best = row(rows, n=n, over="all", lambdas="one")
        bound = row(rows, n=n, over="all", lambdas="none")["bound"]
        yield (n, best["error"] > (1 + SIMILAR) * bound, f"{best['error']:.3f}, bound {bound:.3f}")


@claim("conclusions", "other set", "python3 -m clpv.search")
def centres(read):
    """centres should be tested for each scene

    Holds if: mean E with centres for Sponza's normals < 0.9 of that of
    """
    variants = read("docs/quality-centres")["variants"]
    found, general = (
        row(variants, options={"centres": f"out/{name}.json", "preset": "fast"})["nrmse"]
        for name in ("searched8-normals", "searched8")
    )
    for name, error in (
        ("eight for all directions", general),
        ("srbf8v1", means(read)["srbf8v1"]),
        ("srbf8v2", means(read)["srbf8v2"]),
    ):
        yield (name, found < (1 - SIMILAR) * error, f"{found:.3f}, {error:.3f}")


@claim("conclusions", "scheme", "clpv quality")
def more_sh(read):
    """more coefficients of SH should be investigated

    Holds if: mean E of sh3 < that of sh2 by at least a tenth
    """
    variants = read("docs/quality-centres")["variants"]
    exact = row(
        variants,
        options={
            "basis": "sh3",
            "evaluate": "exact",
            "lobe": "exact",
            "lobe-time": "host",
            "preset": "paper",
        },
    )["nrmse"]
    published = row(read("docs/quality")["variants"], options={"basis": "sh2", "preset": "paper"})[
        "nrmse"
    ]
    for name, a, b in (
        ("published", exact, published),
        ("sweep", means(read)["sh3"], means(read)["sh2"]),
    ):
        yield name, a < (1 - SIMILAR) * b, f"{a:.3f}, {b:.3f}"


@claim("conclusions", "basis", "clpv bench layouts")
def reads(read):
    """GPGPU reduces texture reads

    Holds if: reads per cell of propagation in buffers < in images of halves
    """
    rows = [
        each
        for each in read("docs/layouts")["benchmarks"]
        if each["stage"] == "propagate" and not each["occlusion"]
    ]
    for basis in dict.fromkeys(each["basis"] for each in rows):
        image, buffers = (
            row(rows, basis=basis, layout=layout, storage=storage)
            for layout, storage in (("image", "half"), ("soa", "float"))
        )
        yield (
            basis,
            buffers["reads_per_cell"] < image["reads_per_cell"],
            f"{image['reads_per_cell']:g} and {buffers['reads_per_cell']:g} reads, "
            f"and yet {image['median'] / buffers['median']:.0f}x as fast",
        )
