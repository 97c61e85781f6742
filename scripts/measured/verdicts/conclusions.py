# SPDX-License-Identifier: MIT
"""Conclusions (section 7)."""
from .judge import SIMILAR, claim, row


@claim("conclusions", "lambda", "scripts/reproduce --part lambdas")
def equal(read):
    """8v2 and SH are practically equal

    Holds if: NRMSE of both images at curtains <= 0.1
    """
    for each in read("docs/claims")["lambdas"]:
        yield (
            each["lambda"],
            each["difference"] <= SIMILAR,
            f"{each['difference']:.3f}, E of 8v2 {each['error']:.3f}",
        )


def means(read):
    """Mean NRMSE over four views, by basis, of `--preset fast`."""
    return {
        each["options"].get("basis", "sh2"): each["nrmse"]
        for each in read("docs/quality")["variants"]
        if each["options"].get("preset") == "fast" and set(each["options"]) <= {"preset", "basis"}
    }


@claim("conclusions", "scheme, basis", "clpv quality")
def suitable(read):
    """SRBF of few coefficients are not suitable (main conclusion)

    Holds if: mean E > 0.5
    """
    for basis in ("sh2", "srbf8v2"):
        error = row(read("docs/quality")["variants"], options={"basis": basis, "preset": "paper"})[
            "nrmse"
        ]
        yield f"published {basis}", error > 0.5, f"{error:.2f}"
    for basis in ("sh2", "srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3"):
        yield (f"sweep {basis}", means(read)[basis] > 0.5, f"{means(read)[basis]:.2f}")


@claim("conclusions", "N", "scripts/reproduce --part lobes")
def difficult(read):
    """perfect lobes are very difficult to find

    Holds if: the best centres of a search (one lambda, seconds) have an error above the bound for
    any N functions by more than a tenth
    """
    rows = read("docs/claims")["lobes"]["searched"]
    for n in dict.fromkeys(each["n"] for each in rows):
        best = row(rows, n=n, over="all", lambdas="one")
        bound = row(rows, n=n, over="all", lambdas="none")["bound"]
        yield (n, best["error"] > (1 + SIMILAR) * bound, f"{best['error']:.3f}, bound {bound:.3f}")


@claim("conclusions", "other set", "python3 -m clpv.search")
def centres(read):
    """centres should be tested for each scene

    Holds if: mean E with centres for Sponza's normals < 0.9 of that of
    """
    variants = read("docs/quality-centres")["variants"]
    found, general = (
        row(variants, options={"centres": f"out/{name}.json", "preset": "fast"})["nrmse"]
        for name in ("searched8-normals", "searched8")
    )
    for name, error in (
        ("eight for all directions", general),
        ("srbf8v1", means(read)["srbf8v1"]),
        ("srbf8v2", means(read)["srbf8v2"]),
    ):
        yield (name, found < (1 - SIMILAR) * error, f"{found:.3f}, {error:.3f}")


@claim("conclusions", "scheme", "clpv quality")
def more_sh(read):
    """more coefficients of SH should be investigated

    Holds if: mean E of sh3 < that of sh2 by at least a tenth
    """
    variants = read("docs/quality-centres")["variants"]
    exact = row(
        variants,
        options={
            "basis": "sh3",
            "evaluate": "exact",
            "lobe": "exact",
            "lobe-time": "host",
            "preset": "paper",
        },
    )["nrmse"]
    published = row(read("docs/quality")["variants"], options={"basis": "sh2", "preset": "paper"})[
        "nrmse"
    ]
    for name, a, b in (
        ("published", exact, published),
        ("sweep, lobes completed", means(read)["sh3"], means(read)["sh2"]),
    ):
        yield name, a < (1 - SIMILAR) * b, f"{a:.3f}, {b:.3f}"


@claim("conclusions", "basis", "clpv bench layouts")
def reads(read):
    """GPGPU reduces texture reads

    Holds if: reads per cell of propagation in buffers < in images of halves
    """
    rows = [
        each
        for each in read("docs/layouts")["benchmarks"]
        if each["stage"] == "propagate" and not each["occlusion"]
    ]
    for basis in dict.fromkeys(each["basis"] for each in rows):
        image, buffers = (
            row(rows, basis=basis, layout=layout, storage=storage)
            for layout, storage in (("image", "half"), ("soa", "float"))
        )
        yield (
            basis,
            buffers["reads_per_cell"] < image["reads_per_cell"],
            f"{image['reads_per_cell']:g} and {buffers['reads_per_cell']:g} reads, "
            f"and yet {image['median'] / buffers['median']:.0f}x as fast",
        )
