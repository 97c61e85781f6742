# SPDX-License-Identifier: MIT
"""Stage times of `clpv render --stats`, side by side."""
import pathlib

from clpv import ms_of
from clpv.draw import documents


KEYS = "first_launch_ms", "build_ms", "startup_ms"
OF_RENDER = {"options": dict, "device": dict, **dict.fromkeys(KEYS, documents.NUMBER)}


def print_stages(paths):
    """One column per file; sums over cascades and lights. Raises BadDocument."""
    stats = [documents.read(pathlib.Path(path)) for path in paths]
    for path, one in zip(paths, stats):
        documents.checked(one, path, "times", {"stage": str, "median": documents.NUMBER})
        documents.checked({"of": [one]}, path, "of", OF_RENDER)
    stages = list(dict.fromkeys(time["stage"] for one in stats for time in one["times"]))
    stages.sort(key=("frame", "host").__contains__)
    rows = [["stage [ms]"] + [one["options"]["basis"] for one in stats]]
    for stage in stages:
        rows.append([stage] + [f"{ms_of(one['times'], stage):.2f}" for one in stats])
    for key in KEYS:
        rows.append([key.removesuffix("_ms").replace("_", " ")] +
                    [f"{one[key]:.2f}" for one in stats])
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for number, row in enumerate(rows):
        print("  ".join([row[0].ljust(widths[0])] +
                        [text.rjust(width) for text, width in zip(row[1:], widths[1:])]))
        if number in (0, len(stages)):
            print("  ".join("-" * width for width in widths))
    device = stats[0]["device"]
    print(f"on {device['name']} ({device['platform']}, driver {device['driver']})")
