# SPDX-License-Identifier: MIT
"""What the lab measures and shows, with the package `measured` of the core's scripts."""
