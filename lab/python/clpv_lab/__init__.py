# SPDX-License-Identifier: MIT
"""The lab's Python (lab/README.md); it stands on the package clpv.

    python3 -m clpv_lab.score DIR    errors of images by any renderer; works without clpv
"""
