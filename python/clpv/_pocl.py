# SPDX-License-Identifier: MIT
"""PoCL of the package pocl-binary-distribution (`clpv[pocl]`), for systems without OpenCL drivers."""
import importlib.util
import os
import pathlib
import shutil

VENDORS = pathlib.Path("/etc/OpenCL/vendors")


def use():
    """Lets OpenCL's loader find the package's driver where the system and OCL_ICD_VENDORS name none.
    Returns the driver's library, or None. PoCL calls `ld` with libraries of a C compiler: where there
    is none, the wheel's own linker comes first in PATH."""
    if os.environ.get("OCL_ICD_VENDORS") or any(VENDORS.glob("*.icd")):
        return None
    found = importlib.util.find_spec("pocl_binary_distribution")
    folder = pathlib.Path(found.origin).parents[1] / "pyopencl/.libs" if found else None
    driver = next(iter(sorted(folder.glob("libpocl-*.so"))), None) if folder else None
    if driver is None:
        return None
    os.environ["OCL_ICD_VENDORS"] = str(driver)
    linker = pathlib.Path(__file__).parent / "linker"
    if linker.is_dir() and not (shutil.which("ld") and shutil.which("cc")):
        os.environ["PATH"] = f"{linker}{os.pathsep}{os.environ.get('PATH', os.defpath)}"
    return str(driver)
