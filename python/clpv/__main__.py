# SPDX-License-Identifier: MIT
"""The program of a wheel, as `clpv` and as `python3 -m clpv`.

    clpv --scenes    prints the folder of the scenes in the wheel, for `cp -r "$(clpv --scenes)" .`
"""
import os
import sys

from clpv import _pocl
from clpv._pocl import FOLDER, PROGRAM


def main():
    if not PROGRAM.is_file():
        sys.exit(f"clpv: {PROGRAM}: found no program; allowed: a package of `pip install`")
    if sys.argv[1:] == ["--scenes"]:
        print(FOLDER / "scenes")
        return
    driver = _pocl.use()
    if driver and "devices" in sys.argv[1:]:
        print(f"clpv: the system offers no OpenCL device; uses {driver}", file=sys.stderr,
              flush=True)
    os.environ.setdefault("CLPV_PYTHON", sys.executable)
    os.execv(PROGRAM, [str(PROGRAM), *sys.argv[1:]])


if __name__ == "__main__":
    main()
