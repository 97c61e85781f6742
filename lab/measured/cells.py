# SPDX-License-Identifier: MIT
"""Rows of results/ and cells of tables. Only the standard library."""
import functools
import json
import string
import sys

from . import RESULTS

TABLES = {}  # by name: function that returns lines of cells, the head first
ROWS = {}  # by name: function that returns the rows of a table whose columns are data
MEASURED = {}  # by name: documents in place of files of results/docs
LOADED = set()  # files that tables of the current page use


def table(function):
    TABLES[function.__name__.replace("_", "-")] = function
    return function


def rows(function):
    ROWS[function.__name__] = function
    return function


@functools.cache
def read(name):
    if name in MEASURED:
        return MEASURED[name]
    return json.loads((RESULTS / f"docs/{name}.json").read_text(encoding="utf-8"))


def result(name):
    """A file of results/ by its name, "docs/claims"; tables that use one of results/docs say where
    it was measured."""
    folder, _, file = name.rpartition("/")
    if folder == "docs":
        return load(file)
    return json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))


def load(name):
    LOADED.add(name)
    return read(name)


def found(rows, **fields):
    """The one row with these fields; None where there is none."""
    matches = [row for row in rows if all(row.get(key) == value for key, value in fields.items())]
    if len(matches) > 1:
        sys.exit(f"scripts/tables: {len(matches)} rows have {fields}")
    return matches[0] if matches else None


# Cells: "-" for what was not measured.


def number(value):
    """Three digits: 0.48, 5.27, 20.4, 1801."""
    if value is None:
        return "-"
    return f"{value:.0f}" if value >= 99.95 else f"{value:.1f}" if value >= 9.995 else f"{value:.2f}"


def time(row):
    """Median and minimum [ms] of a row of `clpv bench`."""
    return f"{number(row['median'])} ({number(row['min'])})" if row else "-"


def ratio(a, b):
    return f"{number(a / b)}x" if a and b else "-"


def percent(value, digits=0):
    return "-" if value is None else f"{100 * value:.{digits}f}"


def summed(values):
    return None if None in values else round(sum(values), 3)


class Form(string.Formatter):
    """str.format with None as "-", and formats: {x:#} is number(x), {x:%2} is percent(x, 2), {x:?}
    is yes or no."""

    def format_field(self, value, format_spec):
        if value is None:
            return "-"
        if format_spec == "#":
            return number(value)
        if format_spec == "?":
            return "yes" if value else "no"
        if format_spec.startswith("%"):
            return percent(value, int(format_spec[1:]))
        return super().format_field(value, format_spec)


def shown(columns, lines):
    """Lines of a table. `columns`: {title: form of a row}."""
    return [[*columns]] + [[Form().format(form, **line) for form in columns.values()]
                           for line in lines]


def of_data(columns, given, *arguments):
    """A table whose columns are data. `given`: a list in results/docs, "claims/lambdas", or the name
    of a function of rows."""
    if "/" in given:
        file, member = given.split("/")
        return shown(columns, load(file)[member])
    return shown(columns, ROWS[given](*arguments))


def crossed(head, columns, lines, cell):
    """A line for each of `lines` and a cell for each of `columns`; both {title: key}."""
    return [[head, *columns]] + [[title, *(cell(line, column) for column in columns.values())]
                                 for title, line in lines.items()]
