# SPDX-License-Identifier: MIT
"""Verdicts from outcomes, tolerances, and the rows of scripts/reproduce that need no model."""
import json
import os
import pathlib
import subprocess
import sys
import tarfile

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
os.environ.setdefault("CLPV_BUILD_DIR", os.environ["CLPV_BUILD"])
sys.path.insert(0, str(ROOT / "scripts"))
pytest.importorskip("jinja2", reason="all of it")
from measured import expected, reproduce, verdicts  # noqa: E402


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


def test_outcomes_of_fresh_measurements_count(monkeypatch):
    numpy = pytest.importorskip("numpy")
    points = [(0.1, numpy.float64(1) > 0, "a"), (0.4, numpy.float64(0) > 0, "b")]
    rows = [("light", "statement", "rule", "lambda", "command", lambda read: points)]
    monkeypatch.setattr(verdicts.judge, "CLAIMS", rows)
    assert verdicts.judged(None)[0]["verdict"] == "holds for lambda <= 0.1"


def test_an_interval_covers_both_kinds_of_blocks():
    same = {f"{camera}-{sun}": 0.5 for camera in "abcd" for sun in "xyz"}
    assert verdicts.interval(same) == (0.5, 0.5)
    by_sun = {
        name: 1.0 if name.endswith("x") else -0.1 for name in same
    }  # cameras agree, suns do not
    low, high = verdicts.interval(by_sun)
    assert low < 0 < high and verdicts.signed(by_sun, 1)[0] is None
    assert verdicts.signed(same, 1)[0] is True and verdicts.signed(same, -1)[0] is False


def test_numbers_that_left_their_tolerance_are_named():
    document = {"numbers": {"a": [1.0, 0.1], "b": [2.0, 0.1]}}
    assert expected.left(document, {"a": 1.05}) == []
    assert expected.left(document, {"a": 1.2, "c": 1}) == [
        "a: found 1.2; allowed: 1 +- 0.1",
        "c: found 1; allowed: a number of results/paper/expected.json",
    ]
    assert len(expected.left(document, {"b": float("nan")})) == 1


def test_rows_of_a_run_replace_those_of_the_record():
    record = {"x": [{"basis": "sh2", "up": 1, "mean": 2}, {"basis": "srbf4", "up": 3}], "y": 1}
    assert reproduce.merged(record, {"x": [{"basis": "sh2", "up": 5}]}) == {
        "x": [{"basis": "sh2", "up": 5, "mean": 2}, {"basis": "srbf4", "up": 3}],
        "y": 1,
    }
    assert reproduce.merged(record, {"x": []}) == record


def run(folder):
    return subprocess.run(
        [
            str(ROOT / "scripts/reproduce"),
            "--no-build",
            "--quick",
            "--part=lobes",
            "--part=tables",
            f"--out={folder}",
        ],
        capture_output=True,
        text=True,
        check=False,
    )


def test_lobes_and_tables_have_the_expected_values(tmp_path):
    first = run(tmp_path)
    assert first.returncode == 0, first.stdout[-2000:] + first.stderr
    assert "0 left their tolerance" in first.stdout
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "holds for lambda &gt;= 0.6" in page and 'src="http' not in page
    part = tmp_path / "parts/lobes.json"
    document = json.loads(part.read_text())
    document["result"]["sets"][0]["up"] += 0.01
    part.write_text(json.dumps(document))
    second = run(tmp_path)  # continues: reads the altered part
    assert second.returncode == reproduce.LEFT
    assert "claims/lobes/sets/sh2,4/up: found 0.363553; allowed: 0.353553 +- " in second.stdout
    tar = tmp_path.parent / "paper.tar"
    subprocess.run(
        [str(ROOT / "scripts/archive"), f"--from={tmp_path}", f"--output={tar}"], check=True
    )
    with tarfile.open(tar) as archive:
        names = archive.getnames()
        sums = (
            archive.extractfile(next(name for name in names if name.endswith("/SHA256SUMS")))
            .read()
            .decode()
            .splitlines()
        )
    assert len(sums) == len(names) - 1
    assert any(line.endswith("  paper/index.html") for line in sums)


def test_parts_that_need_a_model_are_rejected_without_one():
    refused = subprocess.run(
        [str(ROOT / "scripts/reproduce"), "--no-build", "--part=light"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert refused.returncode == 2 and "--part light: allowed: lobes, tables" in refused.stderr
