# SPDX-License-Identifier: MIT
"""The paper's claims judged by rule, for results/paper/claims.json and docs/paper/figures.md.

verdicts.json has the claims, in the order of docs/paper/figures.md. `rows`: as in cells.py, a row
for each point of the claim's axis. `at`: key of a row's place on the axis, or a form of it. `holds`:
expression of a row: True, False, or None for 'not resolved'. `numbers`: form of a row. The verdict
is a sentence made from the outcomes. Only the standard library.
"""
import itertools
import json
import math
import pathlib
import statistics

from . import RESULTS, cells

CLAIMS = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
SIMILAR = 0.1  # 'similar': errors that differ by a tenth at most
ABOUT = 1.5  # 'about': within this factor
SPREADS = 3  # medians differ if they are this many median absolute deviations apart


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


def half_width(value):
    """Half width of G at half its maximum [degrees]."""
    return math.degrees(
        math.acos(max(-1, (1 + value**2 - 2**(2 / 3) * (1 - value)**2) / (2 * value))))


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


def cost(file, basis, layout, shadows):
    """Sum of Table 1 [ms] and its spread, without the geometry volume."""
    folder, _, name = file.rpartition("/")
    document = cells.load(name) if folder == "docs" else json.loads(
        (RESULTS / f"{file}.json").read_text(encoding="utf-8"))
    rows = [each for stage in ("inject-light", "propagate", "gather")
            for each in cells.matching(document["benchmarks"], {
                "basis": basis, "layout": layout, "occlusion": shadows, "stage": stage})]
    return sum(each["median"] for each in rows), math.hypot(*(each["mad"] for each in rows))


def spread_of(a, b):
    return SPREADS * math.hypot(a, b)


def cost_ratio(a, b):
    """Ratio and its spread."""
    return a[0] / b[0], a[0] / b[0] * spread_of(a[1] / a[0], b[1] / b[0])


cells.WORDS.update({each.__name__: each for each in (similar, outside, about, half_width, interval,
                                                     cost, spread_of, cost_ratio)}, SIMILAR=SIMILAR)


# Verdicts.


def points(claim):
    """(place, outcome, numbers) of a claim's rows."""
    for row in cells.rows_of(claim["rows"]):
        outcome = cells.evaluated(claim["holds"], row)
        yield (row.get(claim["at"], claim["at"].format(**row)),
               None if outcome is None else bool(outcome),  # perhaps NumPy's Boolean
               cells.shown(claim["numbers"], row))


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


def judged(only=None):
    """All claims, or those of a section, as JSON."""
    made = []
    for claim in CLAIMS:
        if only in (None, claim["section"]):
            found = list(points(claim))
            made.append({
                **{key: claim[key] for key in ("section", "statement", "rule", "axis", "command")},
                "verdict": sentence(claim["axis"], found),
                "points": [{"at": place, "holds": outcome, "numbers": numbers}
                           for place, outcome, numbers in found]
            })
    return made
