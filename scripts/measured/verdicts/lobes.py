# SPDX-License-Identifier: MIT
"""Lobes (section 4 and appendix 1): verdicts by lambda."""
from .judge import claim, similar
from .theory import sets


def by_lambda(read):
    return [each for each in read("docs/claims")["lambdas"] if each["srbf14"] is not None]


OF_THE_PAPER = "srbf4", "srbf8v1", "srbf8v2", "srbf8v3"


@claim("lobes", "lambda", "scripts/reproduce --part lambdas")
def best_up(read):
    """along +z srbf14 is best

    Holds if: L of srbf14 < L of all others
    """
    for each in by_lambda(read):
        least = min(each[name] for name in (*OF_THE_PAPER, "sh2"))
        yield (each["lambda"], each["srbf14"] < least, f"{each['srbf14']:.3f}, next {least:.3f}")


@claim("lobes", "lambda", "scripts/reproduce --part lambdas")
def similar_up(read):
    """along +z srbf4, 8v1 and 8v3 are similar

    Holds if: L of srbf4 and of 8v3 within a tenth of that of 8v1
    """
    for each in read("docs/claims")["lambdas"]:
        yield (
            each["lambda"],
            all(similar(each[name], each["srbf8v1"]) for name in ("srbf4", "srbf8v3")),
            ", ".join(f"{each[name]:.3f}" for name in ("srbf4", "srbf8v1", "srbf8v3")),
        )


@claim("lobes", "lambda", "scripts/reproduce --part lambdas")
def worse_up(read):
    """and worse than SH

    Holds if: L of srbf4, 8v1 and 8v3 > L of SH, 0.354
    """
    for each in read("docs/claims")["lambdas"]:
        values = [each[name] for name in ("srbf4", "srbf8v1", "srbf8v3")]
        yield (
            each["lambda"],
            min(values) > each["sh2"],
            ", ".join(f"{value:.3f}" for value in values),
        )


@claim("lobes", "lambda", "scripts/reproduce --part lambdas")
def similar_to_sh(read):
    """along +z 8v2 is very similar to SH

    Holds if: L of 8v2 within a tenth of that of SH, 0.354
    """
    for each in read("docs/claims")["lambdas"]:
        yield (each["lambda"], similar(each["srbf8v2"], each["sh2"]), f"{each['srbf8v2']:.3f}")


@claim("lobes", "guess", "scripts/reproduce --part lobes")
def guesses(read):
    """the same for other guesses of the centres

    Holds if: L along +z > 0.354 at lambda 0.25
    """
    for name, each in sets(read).items():
        if name in ("srbf4", "srbf8v1", "srbf8v3") or ":" in name:
            yield (name, each["up"] > sets(read)["sh2"]["up"], f"{each['up']:.3f}")


ROTATED = "srbf14", "sh2", "srbf4", "srbf8v1", "srbf8v2", "srbf8v3"
LOBE = "clpv basis --axis=-2,1,-3 --lobe rotate"


def order(read, key):
    return sorted(ROTATED, key=lambda name: sets(read)[name][key])


@claim("lobes", "measure", LOBE)
def best_oblique(read):
    """along (-2,1,-3) srbf14 is best, SH second

    Holds if: ranks 1 and 2 of six, rotated lobes
    """
    for place, key, form in (
        ("L", "oblique_rotated", ".3f"),
        ("the peak's direction", "oblique_rotated_peak", ".0f"),
    ):
        found = order(read, key)
        yield (
            place,
            found[:2] == ["srbf14", "sh2"],
            ", ".join(f"{name} {sets(read)[name][key]:{form}}" for name in found),
        )


@claim("lobes", "set", LOBE)
def distorted(read):
    """there srbf14 is distorted at the origin

    Holds if: its least value, for a peak of 1, is below that of all others
    """
    least = {name: sets(read)[name]["oblique_rotated_minimum"] for name in ROTATED}
    yield (
        "srbf14",
        min(least, key=least.get) == "srbf14",
        ", ".join(f"{name} {value:.3f}" for name, value in least.items()),
    )


@claim("lobes", "measure", LOBE)
def deformed(read):
    """there srbf4, 8v1 and 8v3 are the most deformed

    Holds if: last three of six, rotated lobes
    """
    for place, key, form in (
        ("L", "oblique_rotated", ".3f"),
        ("the peak's direction", "oblique_rotated_peak", ".0f"),
    ):
        last = order(read, key)[3:]
        yield (
            place,
            set(last) == {"srbf4", "srbf8v1", "srbf8v3"},
            ", ".join(f"{name} {sets(read)[name][key]:{form}}" for name in last),
        )


@claim("lobes", "direction", "scripts/reproduce --part lobes")
def important(read):
    """positions of centres are extremely important

    Holds if: largest L of eight functions is at least twice the smallest
    """
    eight = [each for name, each in sets(read).items() if name.startswith("srbf8")]
    for place, key in (("+z", "up"), ("(-2,1,-3)", "oblique"), ("mean", "mean")):
        values = [each[key] for each in eight]
        yield (place, max(values) >= 2 * min(values), f"{min(values):.3f} to {max(values):.3f}")
