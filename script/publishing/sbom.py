"""Software bill of materials (SBOM) of a release, as CycloneDX 1.5: libraries in its files, versions, licenses.

Shared libraries that the Debian packages depend on are not listed: dpkg lists them.
"""

import json
import pathlib
import re
import subprocess

from .stage import Problem

# Source package of Debian: a package that the build installs, its license (SPDX), the files that contain it.
PORTABLE = "static library in archive and wheels"
HEADERS = "headers, compiled in"
LIBRARIES = {
    "hdf5": ("libhdf5-dev", "BSD-3-Clause", PORTABLE),
    "nlopt": ("libnlopt-dev", "MIT AND BSD-3-Clause", PORTABLE),  # without its LGPL part, see static_libraries.sh
    "yaml-cpp": ("libyaml-cpp-dev", "MIT", PORTABLE),
    "fmtlib": ("libfmt-dev", "MIT", PORTABLE),
    "tinyxml2": ("libtinyxml2-dev", "Zlib", PORTABLE),
    "zlib": ("zlib1g-dev", "Zlib", PORTABLE),
    "libpng1.6": ("libpng-dev", "libpng-2.0", PORTABLE),
    "sqlite3": ("libsqlite3-dev", "blessing", PORTABLE),
    "qr-code-generator": ("libqrcodegencpp-dev", "MIT", PORTABLE),
    "glibc": ("libc6-dev", "LGPL-2.1-or-later", "static library in the archive's command"),
    "gcc-12": ("libstdc++-12-dev", "GPL-3.0-or-later WITH GCC-exception-3.1", PORTABLE),
    "cli11": ("libcli11-dev", "BSD-3-Clause", HEADERS),
    "nlohmann-json3": ("nlohmann-json3-dev", "MIT", HEADERS),
    "eigen3": ("libeigen3-dev", "MPL-2.0", HEADERS),
    "boost1.74": ("libboost1.74-dev", "BSL-1.0", HEADERS),
    "pybind11": ("pybind11-dev", "BSD-3-Clause", "headers, compiled into the wheels"),
}


def installed_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${source:Version}", package], capture_output=True, text=True,
                          check=False)
    if done.returncode != 0 or not done.stdout:
        raise Problem(f"the version of {package} is unknown, because it is not installed (fix: script/setup)")
    return done.stdout


def debian_versions(portable):
    """Returns {source package: version}: the version that script/portable used, or else the installed one."""
    files = [pathlib.Path(portable) / folder / "versions" for folder in ("libraries", "pybind11")]
    text = "".join(path.read_text() for path in files if path.is_file())
    found = dict(line.split() for line in text.splitlines())
    return {name: found.get(name) or installed_version(package) for name, (package, _, _) in LIBRARIES.items()}


def npm_packages(lock):
    """Returns (name, version, license) of the npm packages in the viewer's pages."""
    for path, entry in json.loads(pathlib.Path(lock).read_text())["packages"].items():
        if path and not entry.get("dev"):
            yield path.removeprefix("node_modules/"), entry["version"], entry["license"]


def component(name, version, license_id, purl, where):
    licenses = [{"expression": license_id}] if " " in license_id else [{"license": {"id": license_id}}]
    return {"type": "library", "bom-ref": purl, "name": name, "version": version, "licenses": licenses, "purl": purl,
            "properties": [{"name": "taut:contained", "value": where}]}


def bill(version, versions, lock, time):
    """Returns the bill as text; the same for the same arguments. `time`: of the commit, ISO 8601."""
    parts = [component(name, versions[name], license_id,
                       f"pkg:deb/debian/{name}@{versions[name].replace('+', '%2B').replace(':', '%3A')}?arch=source", where)
             for name, (_, license_id, where) in LIBRARIES.items()]
    parts += [component(name, number, license_id, f"pkg:npm/{name.replace('@', '%40')}@{number}", "the viewer's pages")
              for name, number, license_id in npm_packages(lock)]
    parts.sort(key=lambda part: part["bom-ref"])
    own = f"pkg:generic/taut@{version}"
    document = {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        "metadata": {"timestamp": time, "component": {
            "type": "application", "bom-ref": own, "name": "taut", "version": version, "purl": own,
            "licenses": [{"license": {"id": "Apache-2.0"}}]}},
        "components": parts,
        "dependencies": [{"ref": own, "dependsOn": [part["bom-ref"] for part in parts]}],
    }
    return json.dumps(document, indent=1) + "\n"


def static_sources(root):
    """Returns the source packages that static_libraries.sh builds."""
    text = (pathlib.Path(root) / "script/publishing/static_libraries.sh").read_text()
    return re.search(r"^names=\((.*)\)$", text, re.MULTILINE)[1].split()
