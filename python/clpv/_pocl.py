# SPDX-License-Identifier: MIT
"""PoCL of the package pocl-binary-distribution (`clpv[pocl]`), where the system has no device."""
import functools
import importlib.util
import json
import os
import pathlib
import shutil
import subprocess

VENDORS = pathlib.Path("/etc/OpenCL/vendors")
FOLDER = pathlib.Path(__file__).parent
PROGRAM = FOLDER / "bin/clpv"


@functools.cache
def system_has_device():
    """Returns whether the system's drivers offer a supported device; the program asks them."""
    if not any(VENDORS.glob("*.icd")):
        return False
    listed = subprocess.run([PROGRAM, "devices", "--format", "json"], capture_output=True,
                            check=False).stdout
    return any(device["supported"] for device in json.loads(listed or "{}").get("devices", []))


def use():
    """Lets OpenCL's loader find the package's driver where the system offers no device and
    OCL_ICD_VENDORS is not set. Returns the driver's library, or None. PoCL calls `ld` with
    libraries of a C compiler: where there is none, the wheel's own linker comes first in PATH."""
    if os.environ.get("OCL_ICD_VENDORS") or not PROGRAM.is_file():
        return None
    found = importlib.util.find_spec("pocl_binary_distribution")
    folder = pathlib.Path(found.origin).parents[1] / "pyopencl/.libs" if found else None
    driver = next(iter(sorted(folder.glob("libpocl-*.so"))), None) if folder else None
    if driver is None or system_has_device():
        return None
    os.environ["OCL_ICD_VENDORS"] = str(driver)
    linker = FOLDER / "linker"
    if linker.is_dir() and not (shutil.which("ld") and shutil.which("cc")):
        os.environ["PATH"] = f"{linker}{os.pathsep}{os.environ.get('PATH', os.defpath)}"
    return str(driver)
