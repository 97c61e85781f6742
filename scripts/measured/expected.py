# SPDX-License-Identifier: MIT
"""Values that a reproduction must find, with tolerances: results/paper/expected.json.

Only the standard library.
"""

# Parts of results/docs, and tolerances by the end of a number's name: absolute, relative. Lobes are
# computed in double on the host. Tables are read in float, where fused multiply-adds decide single
# entries. Light: devices round differently, and the ground truth has a noise of 0.02 (views: 0.05).
PARTS = {
    "claims/lobes": {"peak": (0.5, 0), "": (1e-3, 1e-2)},
    "claims/tables": {"degrees": (0.5, 0), "": (1e-2, 1e-2)},
    "claims/lambdas": {"error": (0.03, 0), "difference": (0.01, 0), "": (1e-3, 1e-2)},
    "claims/light": {"difference": (0.01, 0), "": (0.03, 0.03)},
    "claims/views": {
        "better": (1, 0),
        "mean": (0.01, 0),
        "standard_error": (0.01, 0),
        "": (0.05, 0.05),
    },
    "claims/texels": {"": (5e-3, 0.02)},
    "claims/shadows": {"": (0.03, 0)},
    "claims/arcade": {"": (0.02, 0)},
    "claims/lit": {"": (5e-3, 0)},
    "figures/rows": {"": (5e-3, 0.03)},
    "factors/difference": {"": (5e-3, 0.05)},
}
# Fields that name a row, and fields that are no results.
IDENTITY = (
    "basis",
    "lobe",
    "transport",
    "n",
    "over",
    "lambdas",
    "lambda",
    "entries",
    "cascade_size",
    "rsm_size",
    "iterations",
    "cascade-size",
    "image",
    "options",
    "camera",
    "size",
    "changed",
)
SKIPPED = ("floor_pixels", "views", "apart")


def label(row):
    """Name of a row: what identifies it. A search names its lambda as a result."""
    return ",".join(
        str(row[key]) for key in IDENTITY if key in row and not (key == "lambda" and "over" in row)
    )


def numbers(value, path):
    """Yields (name, number) of a document; rows of lists are named by what identifies them."""
    if isinstance(value, dict):
        for key, each in value.items():
            if key not in SKIPPED:
                yield from numbers(each, f"{path}/{key}")
    elif isinstance(value, list):
        for each in value:
            yield from numbers(
                {key: one for key, one in each.items() if key not in IDENTITY},
                f"{path}/{label(each)}",
            )
    elif value is None or isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, value


def differences(document):
    """{row: NRMSE} of a file of `clpv bench factors`."""
    return {
        f"{row['basis']},{row['changed']}": row["difference"]
        for row in document["benchmarks"]
        if row["stage"] == "sum"
    }


def parts_of(read):
    """{part: its document} of the measured parts."""
    return {
        **{
            name: read(f"docs/{name.split('/')[0]}").get(name.split("/")[1])
            for name in PARTS
            if not name.startswith("factors")
        },
        "factors/difference": differences(read("docs/factors")),
    }


def found(parts):
    """{name: number, None if undefined} of {part: document}; parts that are None are left out."""
    return dict(
        pair
        for part, document in parts.items()
        if document is not None
        for pair in numbers(document, part)
    )


def tolerance(name, value):
    part = next(part for part in PARTS if name.startswith(part))
    absolute, relative = next(
        allowed for end, allowed in PARTS[part].items() if name.endswith(end)
    )
    return float(f"{max(absolute, relative * abs(value)):.2g}")


def expected(read):
    """expected.json: {number: [value, tolerance]}, and the file of each part."""
    return {
        "files": {part: f"results/docs/{part.split('/')[0]}.json" for part in PARTS},
        "numbers": {
            name: [float(f"{value:.6g}"), tolerance(name, value)]
            for name, value in found(parts_of(read)).items()
            if value is not None
        },
    }


def left(document, measured, whole=()):
    """Lines for numbers of `measured` that left their tolerance or are not expected, and for those
    of parts measured as a whole that are missing."""
    lines = []
    for name in document["numbers"]:
        if name not in measured and any(name.startswith(f"{part}/") for part in whole):
            lines.append(f"{name}: found none; allowed: {document['numbers'][name][0]:g}")
    for name, value in measured.items():
        if value is None:
            if name in document["numbers"]:
                lines.append(f"{name}: found null; allowed: {document['numbers'][name][0]:g}")
            continue
        if name not in document["numbers"]:
            lines.append(
                f"{name}: found {value:.6g}; allowed: a number of results/paper/expected.json"
            )
            continue
        wanted, allowed = document["numbers"][name]
        if not abs(value - wanted) <= allowed:
            lines.append(f"{name}: found {value:.6g}; allowed: {wanted:g} +- {allowed:g}")
    return lines
