# SPDX-License-Identifier: MIT
"""Reads and validates the JSON of clpv."""
import json

from clpv import output

NUMBER = (int, float)
TEXT_OR_NULL = (str, type(None))
NAMES = {str: "text", int: "a number", float: "a number", bool: "true or false",
         dict: "an object", type(None): "null"}


class BadDocument(output.Failure):
    """An invalid document. The message has file, place, value found and value allowed."""

    def __init__(self, words):
        super().__init__(words, output.BAD_INPUT)


def read(path):
    """Raises BadDocument for a file that cannot be read, or is no JSON."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise BadDocument(f"{path}: {error}") from error


def checked(document, source, key, fields):
    """Returns the rows document[key]. Raises BadDocument unless each has the fields {name: type or
    types}."""
    rows = document.get(key) if isinstance(document, dict) else None
    if not isinstance(rows, list):
        raise BadDocument(f"{source}: no list '{key}'")
    for i, row in enumerate(rows):
        for name, kind in fields.items():
            value = row.get(name) if isinstance(row, dict) else None
            if not isinstance(value, kind):
                kinds = kind if isinstance(kind, tuple) else (kind,)
                allowed = " or ".join(dict.fromkeys(NAMES[k] for k in kinds))
                raise BadDocument(f"{source}: /{key}/{i}/{name} is {json.dumps(value)}; allowed: "
                                  f"{allowed}")
    return rows
