"""taut as a wheel of an existing build: its contents, and its function in a virtual environment

wheel_test.py BUILD VERSION    77: this machine lacks pip or venv, or cannot download scikit-build-core from PyPI
"""

import email
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
OFFLINE = ["--no-index", "--no-deps", "--no-build-isolation", "--disable-pip-version-check", "--quiet"]
PROGRAM = """
import pathlib, sys, taut, taut.gym
assert pathlib.Path(taut.__file__).is_relative_to(sys.prefix), taut.__file__
assert pathlib.Path(taut.data_path()).is_relative_to(sys.prefix)
experiment = taut.load(taut.data_path("experiments", "hang.yaml"))
experiment.duration_s = 0.1
print(taut.__version__, f"{taut.run(experiment).state_hash:016x}")
"""


def files_below(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*")
            if path.is_file() and "__pycache__" not in path.parts}


def check(wheel, version):
    with zipfile.ZipFile(wheel) as file:
        names = set(file.namelist())
        info = next(name for name in names if name.endswith(".dist-info/METADATA")).removesuffix("METADATA")
        metadata = email.message_from_bytes(file.read(info + "METADATA"))
        tags = file.read(info + "WHEEL").decode()
    assert info == f"tautsim-{version}.dist-info/", info
    assert (metadata["Name"], metadata["Version"], metadata["License"]) == ("tautsim", version, "Apache-2.0"), metadata
    assert {info + "licenses/LICENSE", info + "licenses/NOTICE"} <= names
    assert "numpy" in metadata.get_all("Requires-Dist")[0]
    assert "Typing :: Typed" in metadata.get_all("Classifier")
    assert metadata.get_payload().startswith("# taut")
    code = {name.removeprefix("taut/") for name in names if name.startswith("taut/") and "/share/" not in name}
    core = [name for name in code if name.startswith("_core.") and name.endswith(".so")]
    assert len(core) == 1 and "cpython-" in core[0], core
    assert code - set(core) == files_below(ROOT / "python" / "taut"), code
    data = {name.removeprefix("taut/share/taut/") for name in names if name.startswith("taut/share/")}
    assert data == files_below(ROOT / "share"), data
    assert "Root-Is-Purelib: false" in tags and f"cp{sys.version_info.major}{sys.version_info.minor}" in tags, tags


def main():
    build, version = pathlib.Path(sys.argv[1]), sys.argv[2]
    for module in ("pip", "venv"):
        if importlib.util.find_spec(module) is None:
            print(f"skipped: no {module} (Debian: python3-{module})")
            return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        environment |= {"TAUT_BUILT": str(build), "PIP_NO_CACHE_DIR": "1", "PYTHONDONTWRITEBYTECODE": "1"}

        def run(*words, **how):
            return subprocess.run(words, check=True, cwd=folder, env=environment, **how)

        # Debian 12 has no scikit-build-core.
        run(sys.executable, "-m", "venv", "--system-site-packages", "builder")
        pip = [folder / "builder/bin/python3", "-m", "pip"]
        if subprocess.run([*pip, "install", "--quiet", "scikit-build-core>=0.10"], check=False).returncode != 0:
            print("skipped: no scikit-build-core (PyPI)")
            return 77
        run(*pip, "wheel", *OFFLINE, "-w", "wheels", ROOT)
        wheel, = (folder / "wheels").iterdir()
        check(wheel, version)
        run(sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", "own")
        python = folder / "own" / "bin" / "python3"
        run(python, "-m", "pip", "install", *OFFLINE, "--ignore-installed", wheel)
        said = run(python, "-c", PROGRAM, capture_output=True, text=True).stdout.split()
        run(build / "taut", "run", ROOT / "share/experiments" / "hang.yaml", "--duration_s", "0.1", "--quiet", "--out", "run")
        summary = json.loads((folder / "run" / "summary.json").read_text())
        assert said == [version, summary["state_hash"]], (said, summary["state_hash"])
        # Editable: the module runs from the tree.
        run(*pip, "install", *OFFLINE, "--ignore-installed", "--editable", ROOT)
        program = PROGRAM.replace("taut.__file__).is_relative_to(sys.prefix)", f"taut.__file__).is_relative_to({str(ROOT)!r})")
        said = run(pip[0], "-c", program, capture_output=True, text=True).stdout.split()
        assert said == [version, summary["state_hash"]], said
    print(f"{wheel.name}: good")
    return 0


if __name__ == "__main__":
    sys.exit(main())
