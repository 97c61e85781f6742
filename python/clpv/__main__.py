# SPDX-License-Identifier: MIT
"""The program of a wheel, as `clpv` and as `python3 -m clpv`.

    clpv --scenes    prints the folder of the scenes in the wheel, for `cp -r "$(clpv --scenes)" .`
"""
import os
import pathlib
import sys

from clpv import _pocl

FOLDER = pathlib.Path(__file__).parent


def main():
    program = FOLDER / "bin/clpv"
    if not program.is_file():
        sys.exit(f"clpv: {program}: found no program; allowed: a package of `pip install`")
    if sys.argv[1:] == ["--scenes"]:
        print(FOLDER / "scenes")
        return
    driver = _pocl.use()
    if driver and "devices" in sys.argv[1:]:
        print(f"clpv: the system names no OpenCL driver; uses {driver}", file=sys.stderr, flush=True)
    os.environ.setdefault("CLPV_PYTHON", sys.executable)
    os.execv(program, [str(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
