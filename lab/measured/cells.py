# SPDX-License-Identifier: MIT
"""Rows of results, joined and computed as JSON says, and the cells and tables that show them. Only
the standard library.

Rows: {"each": SOURCE, "find": {NAME: [SOURCE, FIELDS, MEMBER]}, "all": {NAME: [SOURCE, FIELDS]},
"let": {NAME: EXPRESSION}, "where": EXPRESSION, "by": FORM, "sort": NAME}, or SOURCE alone. A row of
`each` gets the one row of a source that has the fields (`find`; MEMBER: its value), all of them
(`all`), and the values of expressions; `where` leaves rows out, `by` those whose form an earlier row
has. Fields of a find are forms of the row.

SOURCE: "claims/lobes/sets": a list in results/docs; "rows.SUNS": titles and options of rows.json;
"a + b": both; the name of a function of ROWS; a list of rows; {key: values or SOURCE}: all pairs.
FORM: str.format, see Form. EXPRESSION: Python, with the functions of WORDS.

Table: {"rows", "columns": {TITLE: FORM}}, and for a line of cells of one form {"across": {TITLE:
FIELDS}, or rows with a "title", "find", "all" and "let" as above, "cell": FORM, "after": {TITLE:
FORM}}. "then": a table whose lines follow; "like": a table that has what this one lacks. {"rows",
"text": FORM}: a paragraph."""
import functools
import itertools
import json
import math
import operator
import string
import sys
import textwrap

from clpv import ms_of

from . import RESULTS, rows as known

ROWS = {}  # by name: function that returns rows
MEASURED = {}  # by name: documents in place of files of results/docs
LOADED = set()  # files that tables of the current page use
LINE = 130  # width of the docs


def rows(function):
    ROWS[function.__name__] = function
    return function


@functools.cache
def read(name):
    if name in MEASURED:
        return MEASURED[name]
    return json.loads((RESULTS / f"docs/{name}.json").read_text(encoding="utf-8"))


def load(name):
    """A file of results/docs; the page says where it was measured."""
    LOADED.add(name)
    return read(name)


def text(value):
    """Equal for values that count as equal: 8 and "8", None and "-", options in any order."""
    if value is None:
        return "-"
    if isinstance(value, dict):
        return " ".join(sorted(f"{key}={text(each)}" for key, each in value.items()))
    return f"{value:g}" if isinstance(value, float) else str(value)


def matching(lines, fields):
    wanted = {key: text(value) for key, value in fields.items()}
    return [row for row in lines
            if all(text(row.get(key)) == value for key, value in wanted.items())]


def found(lines, **fields):
    """The one row with these fields; None where there is none."""
    matches = matching(lines, fields)
    if len(matches) > 1:
        sys.exit(f"scripts/tables: {len(matches)} rows have {fields}")
    return matches[0] if matches else None


def number(value):
    """Three digits: 0.48, 5.27, 20.4, 1801."""
    return f"{value:.0f}" if value >= 99.95 else f"{value:.1f}" if value >= 9.995 else f"{value:.2f}"


def short(value):
    return "0" if value < 0.0005 else f"{value:.2g}" if value < 10 else f"{value:.0f}"


class Form(string.Formatter):
    """str.format with None as "-", and formats: {x:#} is number(x), {x:~} short(x), {x:%2} percent
    with two digits, {x:?} yes or no. A member of None is None."""

    def __init__(self):
        self.values = []

    def get_field(self, field_name, args, kwargs):
        try:
            field = super().get_field(field_name, args, kwargs)
        except TypeError:
            field = None, field_name
        self.values.append(field[0])
        return field

    def format_field(self, value, format_spec):
        if value is None:
            return "-"
        if format_spec in ("#", "~", "?"):
            return {"#": number, "~": short, "?": lambda x: "yes" if x else "no"}[format_spec](value)
        if format_spec.startswith("%"):
            return f"{100 * value:.{format_spec[1:]}f}"
        return super().format_field(value, format_spec)


def shown(form, row):
    """The form of a row; "-" if all of its values are None."""
    made = Form()
    filled = made.vformat(form, (), row)
    return "-" if made.values and all(value is None for value in made.values) else filled


def texts(form, lines):
    return [shown(form, row) for row in lines]


def light_ms(row):
    """Time that other methods get [ms]: the frame without G-buffer, shadow maps and shading."""
    return ms_of(row["times"], "frame") - sum(ms_of(row["times"], stage) for stage in known.SHARED)


def ratio(a, b):
    return a / b if a and b else None


def mean_of(values):
    values = list(values)
    return sum(values) / len(values) if values and None not in values else None


def sum_of(lines, key):
    """The sum of published numbers of three digits has three."""
    values = [row[key] for row in lines]
    if not values or None in values:
        return None
    return round(sum(values), 3) if len(values) > 1 else values[0]


WORDS = {"__builtins__": {}, "abs": abs, "all": all, "hypot": math.hypot, "len": len,
         "light_ms": light_ms, "max": max, "mean_of": mean_of, "min": min, "ms_of": ms_of,
         "ratio": ratio, "sorted": sorted, "sum": sum, "sum_of": sum_of, "texts": texts, "zip": zip}


def evaluated(expression, row):
    return eval(expression, {**row, **WORDS})


def source(given):
    if isinstance(given, dict):
        factors = [source(each) if isinstance(each, str) else [{key: value} for value in each]
                   for key, each in given.items()]
        return [functools.reduce(operator.or_, parts) for parts in itertools.product(*factors)]
    if not isinstance(given, str):
        return given
    if " + " in given:
        return [row for each in given.split(" + ") for row in source(each)]
    if given.startswith("rows."):
        data = known.DATA[given.removeprefix("rows.")]
        return data if isinstance(data, list) else [
            {"name": name, "options": value} for name, value in data.items()]
    if given in known.DATA["joined"]:
        return rows_of(known.DATA["joined"][given])
    if "/" not in given:
        return ROWS[given]()
    file, *members = given.split("/")
    data = functools.reduce(operator.getitem, members, load(file))
    if isinstance(data, list):
        return data
    named = [{**row, "name": name} for name, row in data.items() if isinstance(row, dict)]
    return named or [data]


def filled(fields, row):
    """Fields whose values are forms, of a row. `options` and `given`: text of options."""
    values = {key: shown(value, row) if isinstance(value, str) else value
              for key, value in fields.items()}
    return {key: known.options_of(value) if key in ("options", "given") else value
            for key, value in values.items()}


def joined(row, spec):
    """The row with what `find`, `all` and `let` add."""
    row = dict(row)
    for name, (place, fields, *member) in spec.get("find", {}).items():
        there = found(source(shown(place, row)), **filled(fields, row))
        row[name] = there and there[member[0]] if member else there
    for name, (place, fields) in spec.get("all", {}).items():
        row[name] = matching(source(shown(place, row)), filled(fields, row))
    for name, expression in spec.get("let", {}).items():
        row[name] = evaluated(expression, row)
    return row


def rows_of(spec):
    spec = spec if isinstance(spec, dict) and "each" in spec else {"each": spec}
    made = (joined(row, spec) for row in source(spec["each"]))
    made = [row for row in made if evaluated(spec.get("where", "True"), row)]
    if "by" in spec:
        first = {}
        for row in made:
            first.setdefault(shown(spec["by"], row), row)
        made = list(first.values())
    return sorted(made, key=lambda row: row[spec["sort"]]) if "sort" in spec else made


def table(spec):
    """Lines of cells, the head first, or text."""
    lines, columns, after = rows_of(spec["rows"]), spec.get("columns", {}), spec.get("after", {})
    if "text" in spec:
        return textwrap.fill(shown(spec["text"], lines[0]), LINE) + "\n"
    across = spec.get("across", {})
    if "title" in across:
        across = {shown(across["title"], row): row for row in rows_of(across)}
    body = [[*(shown(form, row) for form in columns.values()),
             *(cell(row, column, spec) for column in across.values()),
             *(shown(form, row) for form in after.values())] for row in lines]
    more = table(spec["then"])[1:] if "then" in spec else []
    return [[*columns, *across, *after], *body, *more]


def cell(row, column, spec):
    """A column's fields are forms of the line, whose own members win."""
    fields = {key: shown(value, row) if isinstance(value, str) and key != "cell" else value
              for key, value in column.items()}
    form = column.get("cell") or row.get("cell") or spec["cell"]
    return shown(form, joined({**fields, **row}, spec))
