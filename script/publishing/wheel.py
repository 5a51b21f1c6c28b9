"""Packs a linked module and the package's files as a wheel; checks its dependencies.

  PYTHONPATH=script python3 -m publishing.wheel MODULE WEB OUT

MODULE: shared library such as _core.cpython-39-x86_64-linux-gnu.so; WEB: folder of the viewer's pages; OUT: folder for
the wheel

The wheel is byte-identical for the same inputs; the environment variable SOURCE_DATE_EPOCH contains the time stamp of
its files [s since 1970]. The tag is manylinux_2_28. If the module needs a symbol of a later glibc than 2.28, or a
library that this policy does not allow, the script writes nothing and returns status 1.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import time
import zipfile

from .release import current

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
GLIBC = (2, 28)
ALLOWED = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "libgcc_s.so.1",
           "ld-linux-x86-64.so.2", "libutil.so.1"}


def problems(module):
    """Lists symbols and libraries that the policy does not allow."""
    text = subprocess.run(["objdump", "-T", "-p", module], check=True, capture_output=True, text=True).stdout
    for version in sorted(set(re.findall(r"GLIBC_([\d.]+)", text))):
        if tuple(map(int, version.split("."))) > GLIBC:
            names = sorted({line.split()[-1] for line in text.splitlines() if f"GLIBC_{version})" in line})
            yield f"needs glibc {version}: {' '.join(names)}"
    if "GLIBCXX" in text or "CXXABI" in text:
        yield "needs libstdc++"
    for library in re.findall(r"NEEDED\s+(\S+)", text):
        if library not in ALLOWED:
            yield f"needs the library {library}"


def entries(module, web, version):
    """Yields path in the wheel and contents."""
    yield f"taut/{module.name}", module.read_bytes()
    for path in sorted((ROOT / "python/taut").iterdir()):
        if path.suffix in (".py", ".pyi") or path.name == "py.typed":
            yield f"taut/{path.name}", path.read_bytes()
    for path in sorted((ROOT / "share").rglob("*")):
        if path.is_file():
            yield f"taut/share/taut/{path.relative_to(ROOT / 'share')}", path.read_bytes()
    for path in sorted(web.rglob("*")):
        if path.is_file():
            yield f"taut/share/taut/web/{path.relative_to(web)}", path.read_bytes()
    info = f"{NAME}-{version}.dist-info"
    for name in ("LICENSE", "NOTICE"):
        yield f"{info}/licenses/{name}", (ROOT / name).read_bytes()
    yield f"{info}/METADATA", metadata(version).encode()
    yield f"{info}/entry_points.txt", b"[console_scripts]\ntaut = taut.__main__:main\n"


NAME = "tautsim"


def metadata(version):
    import tomllib
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}", f"Summary: {project['description']}",
             f"License: {project['license']['text']}", f"Requires-Python: {project['requires-python']}",
             f"Keywords: {','.join(project['keywords'])}"]
    lines += [f"Classifier: {one}" for one in project["classifiers"]]
    lines += [f"Requires-Dist: {one}" for one in project["dependencies"]]
    for extra, packages in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f"Requires-Dist: {one}; extra == \"{extra}\"" for one in packages]
    lines += ["Description-Content-Type: text/markdown", "", (ROOT / "README.md").read_text()]
    return "\n".join(lines)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    module, web, out = (pathlib.Path(word) for word in sys.argv[1:])
    found = list(problems(module))
    if found:
        sys.exit("\n".join(f"{module.name}: {problem}" for problem in found))
    version = current(ROOT)
    python = re.search(r"cpython-(\d+)-", module.name)[1]
    tag = f"cp{python}-cp{python}-manylinux_2_28_x86_64"
    files = dict(entries(module, web, version))
    info = f"{NAME}-{version}.dist-info"
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: taut\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    rows = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}"
            for name, data in files.items()]
    files[f"{info}/RECORD"] = ("\n".join([*rows, f"{info}/RECORD,,"]) + "\n").encode()
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"{NAME}-{version}-{tag}.whl"
    moment = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, moment)
            entry.external_attr = (0o100755 if name.endswith(".so") else 0o100644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)
    print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
