#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Judges files of kernels by what Oclgrind found in the workloads that were run.

    judge.py FOLDER KERNELS.cl...

FOLDER holds one folder a workload, as `run` leaves it. Every kernel of the files must have been run
by a workload, and nothing may be reported. """
import pathlib
import re
import sys

KERNEL = re.compile(r"__kernel\s+(?:__attribute__\s*\(\((?:[^()]|\([^()]*\))*\)\)\s*)?void\s+(\w+)")
RUN = re.compile(r"^Instructions executed for kernel '(\w+)':", re.MULTILINE)
SHOWN_REPORTS = 3


def main(folder, sources):
    faults, kernels, ran = [], set(), set()
    for source in sources:
        found = set(KERNEL.findall(pathlib.Path(source).read_text(encoding="utf-8")))
        faults += [] if found else [f"{source}: no kernel found in it"]
        kernels |= found
    for output in sorted(pathlib.Path(folder).glob("*/output.txt")):
        ran |= set(RUN.findall(output.read_text(encoding="utf-8", errors="replace")))
        text = (output.parent / "reports.log").read_text(encoding="utf-8", errors="replace")
        reports = [report for report in re.split(r"\n(?=\S)", text) if report.strip()]
        if reports:
            faults.append("\n\n".join([f"{output.parent.name}: {len(reports)} reports"]
                                      + reports[:SHOWN_REPORTS]))
    faults += [f"{kernel}: no workload runs it" for kernel in sorted(kernels - ran)]
    print("\n".join(faults) or f"{', '.join(sorted(kernels))}: as expected")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    sys.exit(main(sys.argv[1], sys.argv[2:]))
