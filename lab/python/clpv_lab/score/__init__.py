# SPDX-License-Identifier: MIT
"""Scores images of indirect light, by any renderer, against path-traced truths. Needs NumPy;
lab/docs/score.md.

    python3 -m clpv_lab.score DIR [--suite FOLDER]     a folder of images, one for each view of the
                                                   suite
    clpv_lab.score.suite.score(folder, suite)          the same as a dictionary
"""
