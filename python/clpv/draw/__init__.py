# SPDX-License-Identifier: MIT
"""Draws charts and the report page from clpv's results.

clpv writes numbers (JSON, NPY) and images (PNG) into a folder and runs this package on it
(host/cli/drawing.hpp); scripts use its style. Needs matplotlib and NumPy, and Jinja2 for the page.
"""
