# SPDX-License-Identifier: MIT
"""The paper's claims judged by rule (judge.py), a file for each section of
docs/paper/figures.md."""
from . import theory, lobes, light, shadows, cost, conclusions  # in the order of the page
from .judge import judged, sentence
from .light import interval, signed

__all__ = [
    "judged",
    "sentence",
    "interval",
    "signed",
    "theory",
    "lobes",
    "light",
    "shadows",
    "cost",
    "conclusions",
]
