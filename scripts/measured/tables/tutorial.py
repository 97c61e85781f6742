# SPDX-License-Identifier: MIT
"""Numbers of docs/tutorial.md and of README.md's picture, which tests/docs/run_tutorial --write
measures."""
import textwrap

from .cells import load, shown, table

LINE = 130  # width of the docs
MEANINGS = {
    "nrmse_valid": "root mean square error divided by the root mean square of the truth",
    "energy_ratio": "mean of the image divided by the mean of the truth",
    "flip": "mean difference that an observer sees, from 0 to 1",
}


def variants(part):
    rows = [{**row, "name": name} for name, row in load("tutorial")[part].items()]
    return shown({"": "`{name}`", "NRMSE": "{nrmse:%0} %", "energy": "{energy:.2f}",
                  "frame": "{frame_ms:#} ms"}, sorted(rows, key=lambda row: row["nrmse"]))


@table
def tutorial_compare():
    found = load("tutorial")["compare"]
    return [["key", "here", "meaning"]] + [[f"`{key}`", f"{found[key]:.2f}", meaning]
                                           for key, meaning in MEANINGS.items()]


@table
def tutorial_grid():
    return variants("grid")


@table
def tutorial_transport():
    return variants("transport")


@table
def demo_caption():
    found = load("tutorial")["demo"]
    return textwrap.fill(
        "*The atrium under sun and sky: direct light, global illumination by clpv, and path tracing, all at one "
        f"exposure. `scripts/demo` makes it. All bounces take {found['frame_ms']} ms per frame of "
        f"{found['width']}x{found['height']} on two CPU cores. The error of their indirect light (normalised "
        f"root mean square, NRMSE) is {100 * found['error']:.0f} %.*", LINE) + "\n"
