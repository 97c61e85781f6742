# SPDX-License-Identifier: MIT
"""Numbers of the paper's claims, for docs/bases.md and docs/paper/figures.md: a function for each
part of scripts/reproduce, which gives its rows or a document of lists of them.

All but lobes and tables are of Sponza. `arguments`: model, out (output.Folder) and
quick, of scripts/reproduce. """
import itertools
import math

import numpy as np

from . import ROOT, native

clpv = native()

BASES = ("sh2", "srbf8v2")
STEPS, SIZES, TEXELS = (8, 24), (12.5, 50), (256, 1024)
WIDTH, HEIGHT = 240, 135  # size of images that are compared with path tracing
NOISE = 0.02
NOISE_OF_PAIRS = 0.05  # noise of the views' ground truths: both bases of a pair meet the same
NOISE_OF_QUICK = 0.05  # noise of truths for errors of 0.8 and more: adds 0.002
UP = 0.99  # minimum y of a floor's normals


# Other sets that fit the paper's description.
def ring(z, first_degrees):
    radius = math.sqrt(1 - z * z)
    turns = (math.radians(first_degrees + 120 * i) for i in range(3))
    return [[radius * math.cos(a), radius * math.sin(a), z] for a in turns]


AXES = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
POLES = [[0, 0, 1], [0, 0, -1]]
GUESSES = {
    "srbf4: a centre down": [[0, 0, -1]] + ring(1 / 3, -90),
    "srbf4: on four of the cube's corners": [[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]],
    "srbf8v1: the same azimuths in both rings": POLES + ring(1 / 3, 0) + ring(-1 / 3, 0),
    "srbf8v1: six round the equator": POLES + ring(0, 0) + ring(0, 60),
    "srbf8v1: rings at z = 0.5 and -0.5": POLES + ring(0.5, 0) + ring(-0.5, 60),
    "srbf8v3: (1, 1, 1) and (-1, -1, 1)": AXES + [[1, 1, 1], [-1, -1, 1]],
    "srbf8v3: (-2, 1, -3) and its opposite": AXES + [[-2, 1, -3], [2, -1, 3]],
}


NAMED = ("sh2", "sh3", "sh4", "sh5", "srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14",
         "bins24", "bins96")
ALONG_Z, OBLIQUE = (0, 0, 1), (-2, 1, -3)
OF_THE_PAPER = ("srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14")
LAMBDAS = 0.1, 0.25, 0.4, 0.55, 0.6
TABLE_SIZES = 256, 257, 512, 1024, 0  # 0: H is computed


def gram(basis):
    """A_ij: integrals of products of functions, by Gauss and Legendre in z and evenly in
    azimuth."""
    z, weights = np.polynomial.legendre.leggauss(64)
    azimuth = np.arange(128) * 2 * np.pi / 128
    radius = np.sqrt(1 - z ** 2)[:, None]
    directions = np.stack(
        (radius * np.cos(azimuth), radius * np.sin(azimuth), np.repeat(z[:, None], 128, axis=1)),
        axis=-1)
    values = basis.evaluate(directions.reshape(-1, 3))
    return (values * np.repeat(weights * 2 * np.pi / 128, 128)[:, None]).T @ values


def of_lobes(bases):
    for name, basis in bases.items():
        up, oblique = map(basis.lobe, (ALONG_Z, OBLIQUE))
        rotated = basis.lobe(OBLIQUE, basis.clamped_cosine(OBLIQUE, TABLE_SIZES[0]))
        scaled = basis.lobe(ALONG_Z, gram(basis) @ basis.clamped_cosine(ALONG_Z))
        yield {
            "basis": name, "n": len(basis), "condition": basis.condition, "up": up["relative_l2"],
            "oblique": oblique["relative_l2"], "oblique_rotated": rotated["relative_l2"],
            "oblique_rotated_minimum": rotated["minimum"],
            "oblique_rotated_peak": rotated["peak_error_degrees"],
            "up_without_inverse": scaled["relative_l2"], "mean": basis.mean_error,
            "minimum": up["minimum"], "energy_sampled_8": basis.energy(8),
            "energy_sampled_24": basis.energy(24)
        }


def lobes(_):
    """Errors of the named bases, and of other guesses."""
    guesses = {name: clpv.Basis(name, centres=centres) for name, centres in GUESSES.items()}
    return {"sets": list(of_lobes({**{name: clpv.Basis(name) for name in NAMED}, **guesses}))}


def along_z(name, value):
    """Relative L2 error of a set's lobe along +z; None where A is too close to singular."""
    try:
        return clpv.Basis(name, bandwidth=value).lobe(ALONG_Z)["relative_l2"]
    except clpv.UsageError:
        return None


def lambdas(arguments):
    """Errors of lobes along +z by lambda, which the paper gives for one figure only. Light:
    --preset paper, 12.5 m, 8 steps."""
    views_of = Views(arguments)
    settings = {"preset": "paper", "cascade_size": 12.5, "iterations": 8}
    image_of_sh2 = views_of.image("curtains", basis="sh2", **settings)
    for value in LAMBDAS:
        image = views_of.image("curtains", basis="srbf8v2", lambda_=value, **settings)
        yield {
            "lambda": value, "sh2": clpv.Basis("sh2").lobe(ALONG_Z)["relative_l2"],
            **{name: along_z(name, value) for name in OF_THE_PAPER},
            "difference": clpv.compare(image, image_of_sh2).nrmse,
            "error": views_of.error(image, "curtains")
        }


def tables(_):
    """Lobes that are rotated through tables of H: errors along +z, and energies of the
    transport."""
    for name, size in itertools.product((name for name in NAMED if name.startswith("srbf")),
                                        TABLE_SIZES):
        basis = clpv.Basis(name)
        lobe = basis.lobe(ALONG_Z, basis.clamped_cosine(ALONG_Z, size))
        yield {"basis": name, "entries": size, "up": lobe["relative_l2"],
               "peak_error_degrees": lobe["peak_error_degrees"],
               "energy_sampled_8": basis.energy(8, table_size=size),
               "energy_sampled_24": basis.energy(24, table_size=size)}


class Views:
    """The scene of claims about light, its images and its ground truth."""

    def __init__(self, arguments, scene="sponza_suns"):
        self.scene = clpv.Scene(ROOT / f"scenes/{scene}.json", arguments.model)
        self.noise = NOISE_OF_QUICK if arguments.quick else NOISE
        self.out = arguments.out

    traced = {}  # truths of all instances: a scene's cameras and lights have their own names

    def truth(self, camera, view="indirect", noise=None):
        noise = noise or self.noise
        key = camera, view, noise
        if key not in Views.traced:
            Views.traced[key] = clpv.pathtrace(self.scene, view, camera, WIDTH, HEIGHT, bounces=1,
                                               noise=noise)
            Views.traced[key].save(self.out.file(f"truths/{camera}-{view}-{noise:g}.exr"))
        return Views.traced[key]

    def renderer(self, **options):
        """By one bounce, as in the paper. Lobes of --preset paper are constants: the light of
        run-time lobes within 2e-4, five times as fast."""
        fixed = {"width": WIDTH, "height": HEIGHT, "bounces": 1}
        if options.get("preset") == "paper":
            fixed["lobe_time"] = "host"
        return clpv.Renderer(self.scene, **{**fixed, **options})

    def image(self, camera, **options):
        return self.renderer(**options).render("indirect", camera)

    def with_blockers(self, number, traced, more):
        """Rows: the number of path tracing, and those of both bases by the published scheme, of the
        defaults and of options, with blockers and without."""
        yield {"image": "path traced", "on": traced, "off": None}
        for variant in (*({"preset": "paper", "basis": name} for name in BASES),
                        {"preset": "best"}, more):
            on, off = (number(**variant, **blockers) for blockers in ({}, {"blockers": "none"}))
            yield {"image": " ".join(variant.values()), "on": on, "off": off}

    def error(self, image, camera):
        return clpv.compare(image, self.truth(camera)).nrmse


def light(arguments):
    """Over steps, cascades and RSMs: how far apart the bases are, and how far off each is."""
    views_of = Views(arguments)
    for size, texels, steps in itertools.product(SIZES, TEXELS[:1] if arguments.quick else TEXELS,
                                                 STEPS):
        images = [views_of.image("curtains", preset="paper", basis=name, cascade_size=size,
                                 rsm_size=texels, iterations=steps) for name in BASES]
        yield {"cascade_size": size, "rsm_size": texels, "iterations": steps,
               "difference": clpv.compare(images[1], images[0]).nrmse,
               **{name: views_of.error(image, "curtains") for name, image in zip(BASES, images)}}


# A fourth camera for the paired comparison, beside the scene's own three.
FOURTH = clpv.Camera((7.4, 1.6, -0.3), (-6.0, 2.2, -0.3), name="back")


def views(arguments):
    """For each setting: both errors in every view, and mean, standard error and signs of their
    paired differences."""
    views_of = Views(arguments, "sponza_other_suns")
    views_of.scene.cameras = [*views_of.scene.cameras, *(
        FOURTH.replace(name=f"back-{sun.name}", light=sun.name) for sun in views_of.scene.lights)]
    rows, summary = [], []
    for size, steps in itertools.product(SIZES, STEPS):
        errors = {name: {} for name in BASES}
        for name in BASES:
            renderer = views_of.renderer(preset="paper", basis=name, cascade_size=size,
                                         iterations=steps)
            for camera in (each.name for each in views_of.scene.cameras):
                found = clpv.compare(renderer.render("indirect", camera),
                                     views_of.truth(camera, noise=NOISE_OF_PAIRS))
                errors[name][camera] = found.nrmse
                rows.append({"camera": camera, "basis": name, "cascade-size": str(size),
                             "iterations": str(steps), "nrmse": found.nrmse,
                             "energy_ratio": found.energy_ratio})
        apart = {camera: error - errors["srbf8v2"][camera]
                 for camera, error in errors["sh2"].items()}
        differences = np.array(list(apart.values()))
        summary.append({"cascade_size": size, "iterations": steps, "mean": differences.mean(),
                        "standard_error": differences.std(ddof=1) / math.sqrt(len(apart)),
                        "srbf8v2_better": int((differences > 0).sum()), "views": len(apart),
                        "apart": apart})
    return {"summary": summary, "rows": rows}


def shadows(arguments):
    """Contrast of irradiance between the floor's darkest and brightest quarter in the ground truth,
    for every image."""
    views_of = Views(arguments)
    albedo, normal = (views_of.truth("columns", view, NOISE).array.astype(float)
                      for view in ("albedo", "normal"))
    albedo = albedo[..., :3].sum(axis=-1)
    floor = (normal[..., 1] > UP) & (albedo > 0)

    def on_floor(image):
        return image.array[..., :3].astype(float).sum(axis=-1)[floor] / albedo[floor]

    def contrast(light):
        low, high = light[dark].mean(), light[bright].mean()
        return (high - low) / (high + low)

    irradiance = on_floor(views_of.truth("columns", noise=NOISE))
    dark, bright = (irradiance <= np.quantile(irradiance, 0.25),
                    irradiance >= np.quantile(irradiance, 0.75))
    rows = views_of.with_blockers(
        lambda **options: contrast(on_floor(views_of.image("columns", **options))),
        contrast(irradiance),
        # Light reaches as far as in 32^3 cells.
        {"preset": "paper", "basis": "sh2", "grid": "64", "iterations": "16"})
    return {"floor_pixels": int(floor.sum()), "rows": list(rows)}


OTHER_WAY = 0.5  # cosine of the angle beyond which two normals differ


def from_afar(camera, direction, size, distance=1000):
    """Nearly parallel, `size` [m] about the camera's eye, from that distance [m]."""
    along = np.array(direction) / np.linalg.norm(direction)
    return camera.replace(eye=camera.eye - distance * along, target=camera.eye, up=(0, 1, 0),
                          near=0.05, fov=math.degrees(2 * math.atan(size / 2 / distance)))


def neighbours(values):
    """All pairs of texels beside and above each other."""
    pairs = ((values[1:], values[:-1]), (values[:, 1:], values[:, :-1]))
    return (np.concatenate([each.reshape(-1, *values.shape[2:]) for each in side])
            for side in zip(*pairs))


def texels(arguments):
    """For neighbouring texels: mean difference of their flux over its mean, and share of pairs with
    other normals."""
    views_of = Views(arguments)
    camera = views_of.scene.cameras[0]
    sun = np.array(next(light.direction for light in views_of.scene.lights
                        if camera.light in ("", light.name)))
    sun /= np.linalg.norm(sun)
    renderer = views_of.renderer(width=min(TEXELS), height=min(TEXELS))
    for size in sorted({size * 2 ** cascade for size in SIZES for cascade in range(3)}):
        albedo = renderer.render("albedo", from_afar(camera, sun, size)).array[..., :3]
        normal = renderer.show("normal").array[..., :3].astype(float)
        flux = albedo.astype(float).sum(axis=-1) * np.clip(-(normal @ sun), 0, None)
        met, beside = neighbours((normal ** 2).sum(axis=-1) > 0.5)
        both, (a, b), (m, n) = met & beside, neighbours(flux), neighbours(normal)
        yield {"size": size, "flux": abs(a - b)[both].mean() / a[both].mean(),
               "normals": ((m * n).sum(axis=-1)[both] < OTHER_WAY).mean()}


# Path tracing shows the arcade most clearly in this light, of 24 suns and both sides of the nave:
# sunlit floor and walls of the nave shine through it, at z = -2.5 m, onto the wall behind it, at z
# = -6.2 m. Curtains hang between its columns.
ALONG_THE_NAVE = clpv.Light(direction=(0.1736, -0.9848, 0), intensity=10, name="along")
# Spacing of the columns in x, x of one, length of the strip in columns, its middle [m].
SPACING, A_COLUMN, PERIODS, MIDDLE = 3.78, 1.2, 4, -0.7
AT_WALL, BEFORE_WALL = -6.2, 0.05  # z [m]
STRIP = 1.5, 3.5  # y [m]
OF_ARCADE = clpv.Camera((MIDDLE, 1.8, 1.2), (MIDDLE, 2.2, AT_WALL), name="arcade", light="along")
ACROSS, SAMPLES = 180, 2048


def arcade(arguments):
    """For the wall's irradiance, over four columns: twice its mean product with -cos(2 pi (x -
    x_column) / spacing), over its mean. Above 0: darker behind columns than behind curtains."""
    views_of = Views(arguments)
    views_of.scene.lights = [ALONG_THE_NAVE]
    half, y, far = PERIODS * SPACING / 2, sum(STRIP) / 2, 40
    x = MIDDLE + half * (2 * np.arange(ACROSS) + 1 - ACROSS) / ACROSS
    wave = -2 * np.cos(2 * np.pi * (x - A_COLUMN) / SPACING)
    height = (STRIP[1] - STRIP[0]) / 2
    # From far away, through everything that is nearer than the wall's niches.
    before = clpv.Camera((MIDDLE, y, far), (MIDDLE, y, AT_WALL), name="wall", light="along",
                         near=far - AT_WALL - 2.4,
                         fov=math.degrees(2 * math.atan(height / (far - AT_WALL))))
    traced = clpv.pathtrace(views_of.scene, "irradiance", before, ACROSS,
                            round(ACROSS * height / half), bounces=1, samples=SAMPLES)
    traced.save(views_of.out.file("truths/arcade.exr"))
    line = traced.array[..., :3].astype(float).sum(axis=(0, 2))
    points = [(at, y, AT_WALL + BEFORE_WALL) for at in x]

    def number(**options):
        renderer = views_of.renderer(**options)
        renderer.render(camera=OF_ARCADE)
        light = renderer.irradiance(points, [(0, 0, 1)] * ACROSS).astype(float).sum(axis=-1)
        return (light * wave).mean() / light.mean()

    return views_of.with_blockers(number, (line * wave).mean() / line.mean(), {"grid": "64"})


def lit(arguments):
    """Share of pixels with a surface that no direct light reaches."""
    views_of = Views(arguments)
    renderer = views_of.renderer(preset="fast")
    for camera in (each.name for each in views_of.scene.cameras[:3]):
        albedo = renderer.render("albedo", camera).array[..., :3].sum(axis=-1) > 0
        direct = renderer.show("direct").array[..., :3].sum(axis=-1) > 0
        yield {"camera": camera, "unlit": float((albedo & ~direct).sum() / albedo.sum())}


