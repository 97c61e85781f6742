# SPDX-License-Identifier: MIT
"""The lab's measurements and tables, with the package `measured` of the core's scripts."""
