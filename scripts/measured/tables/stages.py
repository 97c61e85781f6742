# SPDX-License-Identifier: MIT
"""Stage times of `clpv render --stats`, side by side."""
import json
import pathlib


def stage_sums(stats):
    """Returns {stage: (ms, whether the host's clock measured it)}, in the order of the frame."""
    sums = {}
    for entry in stats["stages"]:
        ms, wall = sums.get(entry["stage"], (0.0, False))
        sums[entry["stage"]] = (ms + entry["ms"], wall or entry["timer"] == "wall")
    return sums


def milliseconds(value, wall=False):
    return f"{value:.2f}{' wall' if wall else ''}"


def print_stages(paths):
    """One column per file; sums over cascades and lights. `wall`: times of the host's clock, where
    event times are implausible."""
    stats = [json.loads(pathlib.Path(path).read_text(encoding="utf-8")) for path in paths]
    columns = [stage_sums(one) for one in stats]
    stages = list(dict.fromkeys(stage for column in columns for stage in column))
    rows = [["stage [ms]"] + [one["options"]["basis"] for one in stats]]
    for stage in stages:
        rows.append(
            [stage] +
            [milliseconds(*column[stage]) if stage in column else "-" for column in columns])
    for key in ("frame_ms", "first_launch_ms", "build_ms", "startup_ms"):
        rows.append([key.removesuffix("_ms").replace("_", " ")] +
                    [milliseconds(one[key]) for one in stats])
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for number, row in enumerate(rows):
        print("  ".join([row[0].ljust(widths[0])] +
                        [text.rjust(width) for text, width in zip(row[1:], widths[1:])]))
        if number in (0, len(stages)):
            print("  ".join("-" * width for width in widths))
    device = stats[0]["device"]
    print(f"on {device['name']} ({device['platform']}, driver {device['driver']})")
