# SPDX-License-Identifier: MIT
"""Verdicts from outcomes, tolerances, and the rows of scripts/reproduce that need no model."""
import json
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
os.environ.setdefault("CLPV_BUILD_DIR", os.environ["CLPV_BUILD"])
sys.path.insert(0, str(ROOT / "lab"))
pytest.importorskip("jinja2",
                    reason="all of it: Jinja2 is not installed (Debian: apt install python3-jinja2)")
from measured import reproduce, verdicts  # noqa: E402


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
