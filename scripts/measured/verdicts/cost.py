# SPDX-License-Identifier: MIT
"""Cost (section 6, Table 1)."""
import itertools
import math

from .judge import ABOUT, SPREADS, claim, row


DRIVERS = {"PoCL 3.1": "docs/table1", "Intel": "intel-2026.22-epyc-2-cores/table1"}
PUBLISHED, BUFFERS = "as published", "in buffers"
BENCH = "clpv bench table1"


def cost(read, file, basis, layout, shadows, stages=("inject-light", "propagate", "gather")):
    """Sum of Table 1 [ms] and its spread, without the geometry volume."""
    rows = [
        each
        for each in read(file)["benchmarks"]
        if (each["basis"], each["layout"], each["occlusion"]) == (basis, layout, shadows)
        and each["stage"] in stages
    ]
    return sum(each["median"] for each in rows), math.hypot(*(each["mad"] for each in rows))


def ratio(a, b):
    """Ratio and its spread."""
    value = a[0] / b[0]
    return value, SPREADS * value * math.hypot(a[1] / a[0], b[1] / b[0])


def compared(read, basis, about):
    for (driver, file), (layout, name), shadows in itertools.product(
        DRIVERS.items(), (("image", PUBLISHED), ("soa", BUFFERS)), (True, False)
    ):
        value, spread = ratio(*(cost(read, file, each, layout, shadows) for each in (basis, "sh2")))
        low, high = about / ABOUT, about * ABOUT
        sure = (
            low <= value - spread
            and value + spread <= high
            or value + spread < low
            or value - spread > high
        )
        yield (
            f"{driver} {name} {'with' if shadows else 'without'} shadows",
            low <= value <= high if sure else None,
            f"{value:.3g}x +- {spread:.2g}",
        )


@claim("cost", "driver", BENCH)
def three_times(read):
    """8v2 takes approximately three times as long as SH (published: 2.95x with, 2.61x without
    shadows)

    Holds if: ratio of the sums of Table 1 between 2 and 4.5
    """
    yield from compared(read, "srbf8v2", 3)


@claim("cost", "driver", BENCH)
def srbf4_times(read):
    """srbf4 takes 1.44 and 1.30 times as long as SH

    Holds if: ratio of the sums of Table 1 between 0.93 and 2.1
    """
    yield from compared(read, "srbf4", 1.4)


@claim("cost", "pass, basis", BENCH)
def medium(read):
    """the medium cascade takes longest

    Holds if: median of the medium cascade > of both others, by three times the spread
    """
    for stage, basis in itertools.product(
        ("inject-light", "propagate"), ("sh2", "srbf4", "srbf8v2")
    ):
        rows = [
            row(
                read("docs/table1")["benchmarks"],
                stage=stage,
                basis=basis,
                layout="image",
                occlusion=True,
                cascade=cascade,
            )
            for cascade in range(3)
        ]
        apart = min(rows[1]["median"] - each["median"] for each in (rows[0], rows[2]))
        spread = SPREADS * max(
            math.hypot(rows[1]["mad"], each["mad"]) for each in (rows[0], rows[2])
        )
        yield (
            f"{stage} {basis}",
            None if abs(apart) < spread else apart > 0,
            ", ".join(f"{each['median']:.3g}" for each in rows),
        )


@claim("cost", "driver, basis", BENCH)
def shadows_cost(read):
    """shadows cost little (published: 1.07x, 1.18x, 1.21x)

    Holds if: sum with shadows at most 1.25 of that without; not resolved within the spread, or
    below 1, since shadows only add work
    """
    for (driver, file), basis in itertools.product(DRIVERS.items(), ("sh2", "srbf4", "srbf8v2")):
        value, spread = ratio(
            *(cost(read, file, basis, "image", shadows) for shadows in (True, False))
        )
        sure = value + spread <= 1.25 or value - spread > 1.25
        yield (
            f"{driver} {basis}",
            value <= 1.25 if sure and value >= 1 else None,
            f"{value:.2f}x +- {spread:.2g}",
        )


@claim("cost", "stage", "clpv bench scaling")
def parallel(read):
    """the method is highly parallelizable

    Holds if: steps of sh2 are at least 1.6 times as fast by two compute units as by one, beyond the
    spread
    """
    rows = [
        row(read("docs/scaling")["benchmarks"], name=f"propagate/sh2/soa/float/units:{units}")
        for units in (1, 2)
    ]
    value, spread = ratio(*((each["median"], each["mad"]) for each in rows))
    sure = value - spread >= 1.6 or value + spread < 1.6
    yield "propagate", value >= 1.6 if sure else None, f"{value:.2f}x +- {spread:.2g}"
