# SPDX-License-Identifier: MIT
"""Light (section 6)."""
import itertools
import math
import statistics

from .judge import SIMILAR, claim, row, similar


def setting(each):
    return f"{each['cascade_size']:g} m and {each['iterations']} steps"


def bootstrap(blocks):
    """95 % interval of the mean over all draws of blocks with replacement: 4 blocks have 256."""
    means = sorted(
        statistics.fmean(itertools.chain(*draw))
        for draw in itertools.product(blocks, repeat=len(blocks))
    )
    return means[math.floor(0.025 * (len(means) - 1))], means[math.ceil(0.975 * (len(means) - 1))]


def interval(apart):
    """Union of the intervals by blocks of cameras and of suns. `apart`: by "camera-sun"."""
    ends = []
    for part in (0, 1):
        blocks = {}
        for name, value in apart.items():
            blocks.setdefault(name.rsplit("-", 1)[part], []).append(value)
        ends.append(bootstrap(list(blocks.values())))
    return min(low for low, _ in ends), max(high for _, high in ends)


def signed(apart, wanted):
    """Outcome and numbers of 'the mean is above 0' (wanted 1) or below (-1)."""
    low, high = interval(apart)
    outcome = None if low <= 0 <= high else (low > 0) == (wanted > 0)
    return outcome, f"{statistics.fmean(apart.values()):+.3f} ({low:+.3f} to {high:+.3f})"


VIEWS = "scripts/reproduce --part views"
SPREAD = "95 % interval of the mean, block bootstrap over 4 cameras and 3 suns"


@claim("light", "camera", "scripts/reproduce --part lit")
def unlit(read):
    """most surfaces of Sponza are lit indirectly only

    Holds if: pixels without direct light > half
    """
    for each in read("docs/claims")["lit"]:
        yield (each["camera"], each["unlit"] > 0.5, f"{100 * each['unlit']:.0f} %")


@claim("light", "setting", VIEWS)
def better_small(read):
    """8v2 is slightly better than SH in small cascades

    Holds if: E of SH less E of 8v2 > 0; 95 % interval of the mean, block bootstrap over 4
    cameras and 3 suns
    """
    for each in read("docs/claims")["views"]["summary"]:
        if each["cascade_size"] == 12.5:
            yield setting(each), *signed(each["apart"], 1)


@claim("light", "setting", VIEWS)
def worse_big(read):
    """and worse in bigger ones

    Holds if: E of SH less E of 8v2 < 0; 95 % interval of the mean, block bootstrap over 4
    cameras and 3 suns
    """
    for each in read("docs/claims")["views"]["summary"]:
        if each["cascade_size"] == 50:
            yield setting(each), *signed(each["apart"], -1)


@claim("light", "setting", "scripts/reproduce --part light")
def detail(read):
    """since bigger cascades have less detail in the RSM

    Holds if: 16 times the texels change the difference of both images by more than a tenth
    """
    rows = read("docs/claims")["light"]
    for each in (each for each in rows if each["rsm_size"] == 256):
        fine = row(
            rows, cascade_size=each["cascade_size"], iterations=each["iterations"], rsm_size=1024
        )
        yield (
            setting(each),
            not similar(fine["difference"], each["difference"]),
            f"{each['difference']:.3f}, {fine['difference']:.3f}",
        )


@claim("light", "cascade [m]", "scripts/reproduce --part texels")
def texels(read):
    """neighbouring texels of the RSM then differ completely

    Holds if: normals of most pairs more than 60 degrees apart
    """
    for each in read("docs/claims")["texels"]:
        yield (
            each["size"],
            each["normals"] > 0.5,
            f"{100 * each['normals']:.1f} %, flux {each['flux']:.2f} of the mean",
        )


@claim("light", "cascade [m]", "clpv quality")
def diverse(read):
    """since few coefficients cannot hold diverse lobes

    Holds if: exact lobes, 8 steps, atrium: E of srbf14 < that of SH by at least a tenth
    """
    for size in ("12.5", "50"):
        exact = {
            "preset": "paper",
            "lobe": "exact",
            "lobe-time": "host",
            "evaluate": "exact",
            "cascade-size": size,
            "iterations": "8",
        }
        many_functions, few = (
            row(read("docs/quality-steps")["cells"], options={**exact, "basis": basis})["nrmse"]
            for basis in ("srbf14", "sh2")
        )
        yield (
            float(size),
            many_functions < (1 - SIMILAR) * few,
            f"{many_functions:.2f}, {few:.2f}",
        )


@claim("light", "cascade, RSM", "scripts/reproduce --part light")
def more_steps(read):
    """24 steps increase the difference

    Holds if: difference of both images after 24 steps > after 8
    """
    rows = read("docs/claims")["light"]
    for few in (each for each in rows if each["iterations"] == 8):
        many_steps = row(
            rows, cascade_size=few["cascade_size"], rsm_size=few["rsm_size"], iterations=24
        )
        yield (
            f"{few['cascade_size']:g} m and {few['rsm_size']}^2",
            many_steps["difference"] > few["difference"],
            f"{few['difference']:.3f}, {many_steps['difference']:.3f}",
        )


@claim("light", "basis, cascade", VIEWS)
def gathers(read):
    """since each step gathers error

    Holds if: E after 24 steps > after 8, in at least 11 of 12 views
    """
    yield from grows(read, "iterations", "8", "24", "cascade-size", ("12.5", "50"))


@claim("light", "basis, steps", VIEWS)
def suffers(read):
    """SH suffers likewise in bigger cascades

    Holds if: E at 50 m > at 12.5 m, in at least 11 of 12 views
    """
    yield from grows(read, "cascade-size", "12.5", "50", "iterations", ("8", "24"))


def grows(read, varied, first, second, fixed, values):
    rows = read("docs/claims")["views"]["rows"]
    for basis, value in itertools.product(("sh2", "srbf8v2"), values):
        errors = [
            {
                each["camera"]: each["nrmse"]
                for each in rows
                if each["basis"] == basis and each[varied] == at and each[fixed] == value
            }
            for at in (first, second)
        ]
        more = sum(errors[1][camera] > error for camera, error in errors[0].items())
        yield (
            f"{basis} at {value}{' m' if fixed == 'cascade-size' else ' steps'}",
            more >= len(errors[0]) - 1,
            f"{more} of {len(errors[0])}",
        )


@claim("light", "steps, RSM", "scripts/reproduce --part light")
def decrease(read):
    """bigger cascades decrease the difference

    Holds if: difference of both images at 50 m < at 12.5 m
    """
    rows = read("docs/claims")["light"]
    for small in (each for each in rows if each["cascade_size"] == 12.5):
        big = row(rows, cascade_size=50, rsm_size=small["rsm_size"], iterations=small["iterations"])
        yield (
            f"{small['iterations']} steps and {small['rsm_size']}^2",
            big["difference"] < small["difference"],
            f"{small['difference']:.3f}, {big['difference']:.3f}",
        )


@claim("light", "setting", VIEWS)
def sh_better(read):
    """SH still gets better results

    Holds if: E of SH less E of 8v2 < 0; 95 % interval of the mean, block bootstrap over 4
    cameras and 3 suns
    """
    for each in read("docs/claims")["views"]["summary"]:
        yield setting(each), *signed(each["apart"], -1)
