# SPDX-License-Identifier: MIT
"""Pictures of what clpv computed and measured: charts, sheets of plots, the report page.

clpv writes numbers (JSON, NPY) and images (PNG) into a folder and runs this package on it (host/cli/drawing.hpp);
scripts use its sheets and style. Needs matplotlib and NumPy, the page Jinja2 as well: Debian's python3-matplotlib,
python3-numpy, python3-jinja2.
"""
