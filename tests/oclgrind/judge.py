#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Judges files of kernels by what Oclgrind found in the workloads that were run.

    judge.py FOLDER KERNELS.cl... [--expect KERNEL=TEXT...]

FOLDER holds one folder a workload, as `run` leaves it. Every kernel of the files must have been run
by a workload, and none may be reported. With --expect, exactly the kernels named must be, each with
its text: the controls. """
import pathlib
import re
import sys

KERNEL = re.compile(r"__kernel\s+(?:__attribute__\s*\(\((?:[^()]|\([^()]*\))*\)\)\s*)?void\s+(\w+)")
RUN = re.compile(r"^Instructions executed for kernel '(\w+)':", re.MULTILINE)
REPORTED = re.compile(r"^\s*Kernel: (\w+)", re.MULTILINE)
SHOWN_REPORTS = 3


def reports_by_kernel(text):
    """{kernel: [report, ...]}; what names no kernel (a message on the API, say) under None."""
    found = {}
    for report in re.split(r"\n(?=\S)", text):
        if not report.strip():
            continue
        kernel = REPORTED.search(report)
        found.setdefault(kernel.group(1) if kernel else None, []).append(report.strip())
    return found


def merge(into, other):
    for key, reports in other.items():
        into.setdefault(key, []).extend(reports)


def main(folder, sources, expected):
    faults, kernels = [], set()
    for source in sources:
        found = set(KERNEL.findall(pathlib.Path(source).read_text(encoding="utf-8")))
        faults += [] if found else [f"{source}: no kernel found in it"]
        kernels |= found
    ran, reports = set(), {}
    for output in sorted(pathlib.Path(folder).glob("*/output.txt")):
        ran |= set(RUN.findall(output.read_text(encoding="utf-8", errors="replace")))
        merge(
            reports,
            reports_by_kernel(
                (output.parent / "reports.log").read_text(encoding="utf-8", errors="replace")))
    faults += [f"{kernel}: no workload runs it" for kernel in sorted(kernels - ran)]
    for kernel in sorted(kernels | {None}, key=str):
        found = reports.get(kernel, [])
        wanted = expected.get(kernel)
        if wanted is None and found:
            faults.append("\n\n".join([f"{kernel or 'no kernel'}: {len(found)} reports"] +
                                      found[:SHOWN_REPORTS]))
        if wanted is not None and not any(wanted in report for report in found):
            faults.append(f"{kernel}: '{wanted}' is not reported")
    print("\n".join(faults) or f"{', '.join(sorted(kernels))}: as expected")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    end = sys.argv.index("--expect") if "--expect" in sys.argv else len(sys.argv)
    pairs = [argument.split("=", 1) for argument in sys.argv[end + 1:]]
    sys.exit(main(sys.argv[1], sys.argv[2:end], dict(pairs)))
