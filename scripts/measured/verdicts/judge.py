# SPDX-License-Identifier: MIT
"""The paper's claims judged by rule, for results/paper/claims.json and docs/paper/figures.md.

A claim is a function that yields points (place on its axis, outcome, numbers). An outcome is True,
False, or None for 'not resolved'. The verdict is a sentence made from the outcomes. Only the
standard library.
"""
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


def judged(read, only=None):
    """All claims, or those of a section, as JSON. `read`: returns a file of results by its name
    ("docs/claims")."""
    made = []
    for section, statement, rule, axis, command, function in CLAIMS:
        if only not in (None, section):
            continue
        points = [  # a fresh measurement may hold NumPy's Booleans
            (place, None if outcome is None else bool(outcome), numbers)
            for place, outcome, numbers in function(read)
        ]
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
