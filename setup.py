"""Builds taut._core with CMake and packages it with models and experiments; all other settings are in pyproject.toml.

TAUT_BUILT: build folder (build/release) with the target taut_python; then nothing is compiled.
CMAKE_ARGS: further arguments for CMake, if anything is compiled.
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent


def version():
    text = (ROOT / "include" / "taut" / "version.h").read_text()
    return re.search(r'kVersion = "(.*)"', text)[1]


class BuildWithCMake(build_ext):
    def run(self):
        name = pathlib.Path(self.get_ext_filename("taut._core")).name
        built = os.environ.get("TAUT_BUILT")
        folder = pathlib.Path(built) if built else self.compile_here()
        made = folder / "python" / "taut" / name
        if not made.is_file():
            raise SystemExit(f"{made} is not there: TAUT_BUILT is a folder in which the target taut_python is built, "
                             f"for {sys.executable}")
        package = pathlib.Path(self.get_ext_fullpath("taut._core")).parent
        package.mkdir(parents=True, exist_ok=True)
        shutil.copy2(made, package / name)
        if not self.inplace:
            shutil.copytree(ROOT / "share", package / "share" / "taut", dirs_exist_ok=True)

    def compile_here(self):
        folder = pathlib.Path(self.build_temp).resolve() / "cmake"
        only = [f"-DTAUT_BUILD_{what}=OFF" for what in ("APPS", "TESTS", "WEB")]
        arguments = shlex.split(os.environ.get("CMAKE_ARGS", ""))
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        f"-DPython_EXECUTABLE={sys.executable}", "-DTAUT_WARNINGS_AS_ERRORS=OFF", *only, *arguments],
                       check=True)
        subprocess.run(["cmake", "--build", folder, "--target", "taut_python"], check=True)
        return folder


(ROOT / "build").mkdir(exist_ok=True)  # for files that pyproject.toml places there
setup(version=version(), ext_modules=[Extension("taut._core", [])], cmdclass={"build_ext": BuildWithCMake})
