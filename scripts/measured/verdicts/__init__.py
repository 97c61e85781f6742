# SPDX-License-Identifier: MIT
"""The paper's claims judged by rule (judge.py), in the order of docs/paper/figures.md."""
from . import lobes, light, cost
from .judge import judged, sentence
from .light import interval, signed

__all__ = ["cost", "interval", "judged", "light", "lobes", "sentence", "signed"]
