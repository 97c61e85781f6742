# SPDX-License-Identifier: MIT
"""The paper's claims judged by rule, for results/paper/claims.json and docs/paper/figures.md.

A claim is a predicate on rows of results, one row for each point of its axis. An outcome is True,
False, or None for 'not resolved'. The verdict is a sentence made from the outcomes. Only the
standard library.
"""
import typing

SIMILAR = 0.1  # 'similar': errors that differ by a tenth at most
ABOUT = 1.5  # 'about': within this factor
SPREADS = 3  # medians differ if they are this many median absolute deviations apart
CLAIMS = []


class Claim(typing.NamedTuple):
    """`rows`: function of `read` (judged) that returns dicts. `at`: key of a row's place on the
    axis, or a format of it. `holds`: predicate on a row. `numbers`: format of a row."""
    section: str
    statement: str
    rule: str
    axis: str
    command: str
    rows: typing.Callable
    at: str
    holds: typing.Callable
    numbers: str

    def points(self, read):
        for each in self.rows(read):
            outcome = self.holds(each)  # after a fresh measurement perhaps NumPy's Boolean
            yield (each[self.at] if self.at in each else self.at.format(**each),
                   None if outcome is None else bool(outcome), self.numbers.format(**each))


def claim(*fields):
    CLAIMS.append(Claim(*fields))


def row(rows, **fields):
    return next(each for each in rows
                if all(each.get(key) == value for key, value in fields.items()))


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
            if all(outcome == (place <= last if sign == "<=" else place >= last)
                   for place, outcome, _ in points):
                return f"holds for {axis} {sign} {last:g}"
    texts = {True: "holds for", False: "not for", None: "not resolved for"}
    if len(places[False]) > len(places[True]) + 2 and places[True] and not places[None]:
        places[False] = ["the others"]
    return "; ".join(f"{texts[value]} {', '.join(map(str, found))}"
                     for value, found in places.items() if found)


def judged(read, only=None):
    """All claims, or those of a section, as JSON. `read`: returns a file of results by its name
    ("docs/claims")."""
    made = []
    for each in CLAIMS:
        if only in (None, each.section):
            points = list(each.points(read))
            made.append({
                "section": each.section, "statement": each.statement, "rule": each.rule,
                "axis": each.axis, "command": each.command,
                "verdict": sentence(each.axis, points),
                "points": [{"at": place, "holds": outcome, "numbers": numbers}
                           for place, outcome, numbers in points]
            })
    return made
