# SPDX-License-Identifier: MIT
"""Verdicts from outcomes, tolerances, and the rows and figures of scripts/reproduce that need no
model; cameras of the suite."""
import json
import math
import os
import pathlib
import subprocess
import sys

import numpy
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
os.environ.setdefault("CLPV_BUILD_DIR", os.environ["CLPV_BUILD"])
sys.path.insert(0, str(ROOT / "lab"))
for module in "jinja2", "matplotlib":
    pytest.importorskip(module, reason=f"all of it: no {module} (Debian: apt install python3-{module})")
from measured import basis_figures, output, reproduce, sphere, suite, verdicts  # noqa: E402
from measured.sheets import style  # noqa: E402

pyplot = style.pyplot


@pytest.mark.parametrize(
    "outcomes, sentence",
    [
        ([True, True, True], "holds"),
        ([False, False, False], "does not hold"),
        ([None, None, None], "not resolved"),
        ([True, True, False], "holds for lambda <= 0.4"),
        ([False, True, True], "holds for lambda >= 0.4"),
        ([False, True, False], "holds for 0.4; not for 0.1, 0.6"),
        ([True, None, False], "holds for 0.1; not for 0.6; not resolved for 0.4"),
    ],
)
def test_a_verdict_is_made_from_its_points(outcomes, sentence):
    assert verdicts.sentence("lambda", list(zip((0.1, 0.4, 0.6), outcomes, "abc"))) == sentence


def reproduce_parts(*words):
    """Without git and a home."""
    return subprocess.run(
        [str(ROOT / "scripts/reproduce"), "--no-build", *words], capture_output=True, text=True,
        check=False,
        env={key: value for key, value in os.environ.items() if key != "HOME"} | {"PATH": "/none"})


def test_lobes_and_tables_have_the_expected_values(tmp_path):
    words = "--quick", "--part=lobes", "--part=tables", f"--out={tmp_path}"
    first = reproduce_parts(*words)
    assert first.returncode == 0, first.stdout[-2000:] + first.stderr
    assert "0 left their tolerance" in first.stdout
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "holds for lambda &gt;= 0.6" in page and 'src="http' not in page
    part = tmp_path / "parts/lobes.json"
    document = json.loads(part.read_text())
    document["result"]["sets"][0]["up"] += 0.01
    part.write_text(json.dumps(document))
    (tmp_path / "private.txt").write_text("precious")
    second = reproduce_parts(*words)  # continues: reads the altered part
    assert second.returncode == reproduce.LEFT
    assert "claims/lobes/sets/sh2,4/up: found 0.363553; allowed: 0.353553 +- " in second.stdout
    assert (tmp_path / "private.txt").read_text() == "precious"


def test_parts_that_need_a_model_are_rejected_without_one():
    refused = reproduce_parts("--part=light")
    assert refused.returncode == 2 and "--part light: allowed: lobes, tables" in refused.stderr


def test_figures_of_bases_are_drawn(tmp_path):
    names = basis_figures.draw(output.Folder(tmp_path, "test"), "rotate", ["srbf8v2"])
    assert names == [f"lobes-rotate/figure{number}.png" for number in (2, 3, 6)]
    assert all(pyplot.imread(tmp_path / name).shape[1] > 100 for name in names)


def test_the_suite_has_the_cameras_and_lights_of_its_scene():
    file = ROOT / "scenes/cornell.json"
    scene = json.loads(file.read_text())
    views = suite.views_gltf(scene, file.with_suffix(".glb"))
    assert [node["name"] for node in views["nodes"]] == [
        each["name"] for each in scene["cameras"] + scene["lights"]]
    eye = scene["metres_per_unit"] * numpy.array(scene["cameras"][0]["eye"])
    assert views["nodes"][0]["matrix"][12:15] == pytest.approx(eye)


SIZE = 200  # pixels of a spherical plot, whose surfaces have known outlines
GRID = sphere.directions((46, 91))


def image_of(values, **options):
    figure = pyplot.figure(figsize=(2, 2), dpi=SIZE / 2)
    axis = figure.add_axes((0, 0, 1, 1), projection="3d")
    axis.axis("off")
    sphere.plot(axis, values, **options)
    figure.canvas.draw()
    pixels = numpy.asarray(figure.canvas.buffer_rgba())[..., :3] / 255.0
    pyplot.close(figure)
    return pixels


def blue(image):
    return image[..., 2] > image[..., 0] + 0.1


def red(image):
    return image[..., 0] > image[..., 2] + 0.1


def box(mask):
    """left, right, top, bottom"""
    rows, columns = numpy.nonzero(mask)
    return columns.min(), columns.max(), rows.min(), rows.max()


def test_a_constant_is_a_disc_of_its_radius():
    image = image_of(numpy.full(GRID.shape[:2], 0.8), extent=1)
    left, right, top, bottom = box(blue(image))
    assert blue(image).sum() == pytest.approx(math.pi * 80**2, rel=0.03)
    assert (right - left, bottom - top) == pytest.approx((160, 160), abs=2)
    assert red(image).sum() == 0


def test_the_clamped_cosine_is_a_sphere_through_the_origin():
    left, right, _, bottom = box(blue(image_of(numpy.maximum(0, GRID[..., 2]), extent=1)))
    assert (right - left, (left + right) / 2) == pytest.approx((100, 100), abs=2)
    assert bottom < 106, "all of it is above the origin, seen from 24 degrees above"


def test_what_is_nearer_hides():
    near, far = (numpy.maximum(0, sign * GRID[..., 1]) for sign in (-1, 1))  # the eye is at -y
    alone = red(image_of(far, colours=numpy.broadcast_to(sphere.NEGATIVE, GRID.shape))).sum()
    values, colours = sphere.joint(numpy.stack([near, far]), [sphere.POSITIVE, sphere.NEGATIVE])
    both = red(image_of(values, colours=colours)).sum()
    assert 100 < both < alone - 100


def test_an_axis_is_hidden_inside_and_behind():
    axis = pyplot.figure().add_subplot(projection="3d")
    sphere.plot(axis, numpy.full(GRID.shape[:2], 0.5))
    for line in axis.lines:
        points = numpy.array(line.get_data_3d())
        assert abs(points).sum(axis=0).min() == pytest.approx(0.5)
        is_behind = points[0].sum() < 0 or points[1].sum() > 0 or points[2].sum() < 0
        assert line.zorder == (0 if is_behind else 2)
    pyplot.close()
