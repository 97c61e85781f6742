# SPDX-License-Identifier: MIT
"""Scores that others hand in, lab/results/quality/scores: each has the form that `python3 -m
clpv_lab.score -o` writes."""
import json
import math
import re
import unittest

import test_score  # noqa: F401, the paths of the modules
from clpv_lab.score import suite as scored
from lab_measured import suite

FILES = sorted((test_score.ROOT / "lab/results/quality/scores").glob("*.json"))
NEEDED = "nrmse", "nrmse_best_gain", "energy_ratio", "flip"


def view_names():
    for scene, cameras in suite.SCENES.items():
        document = json.loads((test_score.ROOT / f"scenes/{scene}.json").read_text())
        yield from (f"{scene}-{camera['name']}" for camera in document["cameras"]
                    if not cameras or camera["name"] in cameras)


def faults(document):
    """Faults of a score, in words; empty if there is none."""
    found, views, names = [], document.get("views", []), list(view_names())
    if document.get("schema") != scored.SCHEMA:
        found.append(f"schema: found {document.get('schema')}; allowed: {scored.SCHEMA}")
    if not re.fullmatch("[0-9a-f]{16}", str(document.get("suite"))):
        found.append(f"suite: found {document.get('suite')}; allowed: hash of suite.json")
    if not str(document.get("method", "")).strip():
        found.append("method: found no name")
    found += [
        f"view {row.get('view')}: allowed: {', '.join(names)}" for row in views
        if row.get("view") not in names
    ]
    if "layer" in document:
        found.append(f"layer: found {document['layer']}; allowed: none, indirect light")
    if not views or len({row.get("view") for row in views}) < len(views):
        found.append(f"views: found {len(views)}, some twice or none")
    if document.get("complete") != (len(views) == len(names)):
        found.append(
            f"complete: found {document.get('complete')} with {len(views)} of {len(names)} views")
    for row in views:
        found += [
            f"view {row.get('view')}, {name}: found {row.get(name)}; allowed: numbers"
            for name in NEEDED
            if not isinstance(row.get(name), (int, float)) or not math.isfinite(row[name])
        ]
    for name, mean in document.get("mean", {}).items():
        values = [row.get(name) for row in views]
        if None in values or abs(sum(values) / len(values) - mean) > 1.1 * 10 ** -scored.DIGITS:
            found.append(f"mean {name}: found {mean}; allowed: mean of the views")
    return found + [
        f"mean {name}: missing" for name in NEEDED if name not in document.get("mean", {})
    ]


class HandedIn(unittest.TestCase):
    def test_files_have_the_form(self):
        self.assertTrue(FILES)
        documents = [json.loads(file.read_text()) for file in FILES]
        for file, document in zip(FILES, documents):
            self.assertEqual(faults(document), [], file.name)
        self.assertEqual(len({document["suite"]
                              for document in documents}), 1,
                         "scores of different suites in one table")


if __name__ == "__main__":
    unittest.main()
