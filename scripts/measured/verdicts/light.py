# SPDX-License-Identifier: MIT
"""Light and shadows (section 6)."""
import itertools
import math
import statistics

from .. import rows as known
from .judge import SIMILAR, claim, row, similar

SETTING = "{cascade_size:g} m and {iterations} steps"
LIGHT, VIEWS = "scripts/reproduce --part light", "scripts/reproduce --part views"
SPREAD = "95 % interval of the mean, block bootstrap over 4 cameras and 3 suns"


def bootstrap(blocks):
    """95 % interval of the mean over all draws of blocks with replacement: 4 blocks have 256."""
    means = sorted(statistics.fmean(itertools.chain(*draw))
                   for draw in itertools.product(blocks, repeat=len(blocks)))
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


def claim_by_views(statement, sizes, wanted):
    """The mean of E of SH less E of 8v2 in cascades of these sizes is above 0 (wanted 1) or
    below."""

    def rows(read):
        for each in read("docs/claims")["views"]["summary"]:
            if each["cascade_size"] in sizes:
                outcome, text = signed(each["apart"], wanted)
                yield {**each, "outcome": outcome, "text": text}

    claim("light", statement, f"E of SH less E of 8v2 {'>' if wanted > 0 else '<'} 0; {SPREAD}",
          "setting", VIEWS, rows, SETTING, lambda each: each["outcome"], "{text}")


def pairs(**changed):
    """Rows of the part light that have another value of one key than `changed`, with the
    difference where it has that value."""
    (key, value), = changed.items()

    def rows(read):
        every = read("docs/claims")["light"]
        for each in every:
            if each[key] != value:
                others = {name: each[name] for name in ("cascade_size", "rsm_size", "iterations")}
                yield {**each, "then": row(every, **{**others, key: value})["difference"]}

    return rows


def exact_lobes(read):
    """E of srbf14 and of SH by exact lobes, in the atrium."""
    cells = read("docs/quality-steps")["cells"]
    for size in ("12.5", "50"):
        options = {**known.EXACT_LOBES, "cascade-size": size, "iterations": "8"}
        yield {"size": float(size), **{name: row(cells, options={**options, "basis": name})["nrmse"]
                                       for name in ("srbf14", "sh2")}}


def grown(varied, first, second, fixed, values, unit):
    """Number of views whose E is larger at the second value."""

    def rows(read):
        every = read("docs/claims")["views"]["rows"]
        for basis, value in itertools.product(("sh2", "srbf8v2"), values):
            before, after = ({each["camera"]: each["nrmse"] for each in every
                              if (each["basis"], each[varied], each[fixed]) == (basis, at, value)}
                             for at in (first, second))
            yield {"basis": basis, "at": f"{value} {unit}", "count": len(before),
                   "more": sum(after[camera] > error for camera, error in before.items())}

    return rows


claim("light", "most surfaces of Sponza are lit indirectly only",
      "pixels without direct light > half", "camera", "scripts/reproduce --part lit",
      lambda read: [{**each, "percent": 100 * each["unlit"]}
                    for each in read("docs/claims")["lit"]],
      "camera", lambda each: each["unlit"] > 0.5, "{percent:.0f} %")
claim_by_views("8v2 is slightly better than SH in small cascades", (12.5, ), 1)
claim_by_views("and worse in bigger ones", (50, ), -1)
claim("light", "since bigger cascades have less detail in the RSM",
      "16 times the texels change the difference of both images by more than a tenth", "setting",
      LIGHT, pairs(rsm_size=1024), SETTING,
      lambda each: not similar(each["then"], each["difference"]), "{difference:.3f}, {then:.3f}")
claim("light", "neighbouring texels of the RSM then differ completely",
      "normals of most pairs more than 60 degrees apart", "cascade [m]",
      "scripts/reproduce --part texels",
      lambda read: [{**each, "percent": 100 * each["normals"]}
                    for each in read("docs/claims")["texels"]],
      "size", lambda each: each["normals"] > 0.5, "{percent:.1f} %, flux {flux:.2f} of the mean")
claim("light", "since few coefficients cannot hold diverse lobes",
      "exact lobes, 8 steps, atrium: E of srbf14 < that of SH by at least a tenth", "cascade [m]",
      "clpv quality", exact_lobes, "size",
      lambda each: each["srbf14"] < (1 - SIMILAR) * each["sh2"], "{srbf14:.2f}, {sh2:.2f}")
claim("light", "24 steps increase the difference",
      "difference of both images after 24 steps > after 8", "cascade, RSM", LIGHT,
      pairs(iterations=24), "{cascade_size:g} m and {rsm_size}^2",
      lambda each: each["then"] > each["difference"], "{difference:.3f}, {then:.3f}")
claim("light", "since each step gathers error",
      "E after 24 steps > after 8, in at least 11 of 12 views", "basis, cascade", VIEWS,
      grown("iterations", "8", "24", "cascade-size", ("12.5", "50"), "m"), "{basis} at {at}",
      lambda each: each["more"] >= each["count"] - 1, "{more} of {count}")
claim("light", "SH suffers likewise in bigger cascades",
      "E at 50 m > at 12.5 m, in at least 11 of 12 views", "basis, steps", VIEWS,
      grown("cascade-size", "12.5", "50", "iterations", ("8", "24"), "steps"), "{basis} at {at}",
      lambda each: each["more"] >= each["count"] - 1, "{more} of {count}")
claim("light", "bigger cascades decrease the difference",
      "difference of both images at 50 m < at 12.5 m", "steps, RSM", LIGHT, pairs(cascade_size=50),
      "{iterations} steps and {rsm_size}^2", lambda each: each["then"] < each["difference"],
      "{difference:.3f}, {then:.3f}")
claim_by_views("SH still gets better results", (12.5, 50), -1)

NAMES = {
    "paper sh2": "sh2", "paper srbf8v2": "srbf8v2", "paper sh2 64 16": "sh2 in 64^3 cells",
    "best": "the defaults", "64": "the defaults in 64^3 cells"
}
SHADOWS, ARCADE = "scripts/reproduce --part shadows", "scripts/reproduce --part arcade"


def contrasts(*images):
    """Rows of these images, with and without blockers."""

    def rows(read):
        found = {each["image"]: each for each in read("docs/claims")["shadows"]["rows"]}
        return [{**found[image], "name": NAMES[image]} for image in images]

    return rows


def coarse_and_fine(read):
    coarse, fine = contrasts("paper sh2", "paper sh2 64 16")(read)
    return [{"name": "sh2", "coarse": coarse["on"], "fine": fine["on"]}]


def of_arcade(read):
    """The path-traced shadow, then those of all images, each with the traced one."""
    rows = read("docs/claims")["arcade"]
    return [{**each, "name": NAMES.get(each["image"], each["image"]), "traced": rows[0]["on"]}
            for each in rows]


def seen_blockers(read):
    """Energy with blockers seen and with triangles."""
    for camera in ("curtains", "atrium", "columns"):
        seen, scene = (row(read("docs/quality")["cells"], camera=camera,
                           options={**known.FAST, **blockers})["energy_ratio"]
                       for blockers in ({"blockers": "seen"}, {}))
        yield {"camera": camera, "seen": seen, "scene": scene}


claim("shadows", "indirect shadows are too soft in both bases",
      "contrast on the floor < 0.9 of the path-traced 1", "image", SHADOWS,
      contrasts("paper sh2", "paper srbf8v2"), "name", lambda each: each["on"] < 0.9, "{on:.2f}")
claim("shadows", "so few cells make shadows soft",
      "contrast of SH by 64^3 cells and 16 steps > by 32^3 and 8", "basis", SHADOWS,
      coarse_and_fine, "name", lambda each: each["fine"] > each["coarse"],
      "{coarse:.2f}, {fine:.2f}")
claim("shadows", "shadows are still simulated", "contrast with blockers > without", "image",
      SHADOWS, contrasts("paper sh2", "paper srbf8v2", "paper sh2 64 16", "best"), "name",
      lambda each: each["on"] > each["off"], "{on:.2f}, without {off:.2f}")
claim("shadows", "columns cast shadows beside the light that passes through curtains (Figure 5)",
      "the wall behind the arcade is darker behind columns than behind curtains, by more than a "
      "tenth", "image", ARCADE, of_arcade, "name", lambda each: each["on"] > 0.1, "{on:+.2f}")
claim("shadows", "the arcade's shadows are too soft",
      "they are less than half of the path-traced ones", "image", ARCADE,
      lambda read: of_arcade(read)[1:], "name",
      lambda each: abs(each["on"]) < abs(each["traced"]) / 2, "{on:+.2f} of {traced:+.2f}")
claim("shadows", "they are still simulated", "they are at least twice those without blockers",
      "image", ARCADE, lambda read: of_arcade(read)[1:], "name",
      lambda each: abs(each["on"]) >= 2 * abs(each["off"]), "{on:+.3f}, without {off:+.3f}")
claim("shadows", "curtains cannot block indirect light",
      "the defaults with seen blockers: energy over the ground truth's above that with triangles "
      "by more than a tenth", "camera", "clpv quality --vary blockers=seen,scene", seen_blockers,
      "camera", lambda each: each["seen"] > (1 + SIMILAR) * each["scene"],
      "{seen:.2f}, {scene:.2f}")
