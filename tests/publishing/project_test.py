"""Files that GitHub, package managers, container tools and a journal read.

Usage: project_test.py Project.TEST. TEST is the name of a function of this file.
"""

import json
import re
import shutil
import sys

sys.dont_write_bytecode = True
from harness import ROOT, Skipped, build_packages, main, run  # noqa: E402
from publishing import release  # noqa: E402


def WhatGitHubReadsCanBeRead():
    try:
        import yaml
    except ImportError:
        raise Skipped("there is no python3-yaml") from None
    files = [*sorted((ROOT / ".github").rglob("*.yml")), ROOT / "CITATION.cff"]
    read = {str(path.relative_to(ROOT)): yaml.safe_load(path.read_text()) for path in files}
    job = read[".github/workflows/ci.yml"]["jobs"]["debian12"]
    assert job["container"] == "debian:12" and {"run": "script/setup"} in job["steps"], job
    parts = {each["part"]: each["command"] for each in job["strategy"]["matrix"]["include"]}
    known = re.search(r"case \$part in ([a-z0-9| ]+)\)", (ROOT / "script/test").read_text())[1].split(" | ")
    known.remove("long")  # nightly only
    assert parts == {"lint": "script/lint --recent", **{part: f"script/test --part {part}" for part in known}}, parts
    job = read[".github/workflows/nightly.yml"]["jobs"]["debian12"]
    nightly = re.search(r"^all=\((.*)\)", (ROOT / "script/nightly").read_text(), re.MULTILINE)[1].split()
    assert job["strategy"]["matrix"]["part"] == nightly, nightly
    jobs = {name: read[f".github/workflows/{name}.yml"]["jobs"]["debian12"] for name in ("release", "measurements")}
    made = {each["part"]: each for each in jobs["release"]["strategy"]["matrix"]["include"]}
    assert made.keys() == {"portable", "browser", "packages", "website"}, made.keys()
    groups = set(re.search(r"case \$group in\n +([a-z| ]+)\)", (ROOT / "script/setup").read_text())[1].split(" | "))
    for each in made.values():
        assert set(each["setup"].split()) <= groups, each
        assert all((ROOT / word).exists() for word in each["command"].split() if word.startswith("script/")), each
    parts = {each["part"]: each["command"] for each in jobs["measurements"]["strategy"]["matrix"]["include"]}
    pages = set(re.findall(r'"(\w+)": \w+\.page\b', (ROOT / "script/validate").read_text()))
    named = set(parts["validation"].split(" && ")[0].split()[1:])
    assert len(pages) > 20 and named == pages - {"t3_prism"}, named ^ pages  # its data may not be distributed
    for name, form in read.items():
        if "ISSUE_TEMPLATE" in name and not name.endswith("config.yml"):
            assert {"name", "description", "body"} <= form.keys(), name
            assert all(part["type"] in ("textarea", "input", "markdown") for part in form["body"]), name
    citation = read["CITATION.cff"]
    assert {"cff-version", "message", "title", "authors"} <= citation.keys(), citation
    assert "version" not in citation, "it stands in one place"


def ThePaperCitesItsBibliography():
    """The paper has the form that the Journal of Open Source Software requires: header, sections, all citations."""
    text, bib = ((ROOT / "docs/paper" / name).read_text() for name in ("paper.md", "paper.bib"))
    header, body = text.split("---\n", 2)[1:]
    for key in ("title", "tags", "authors", "affiliations", "date", "bibliography: paper.bib"):
        assert re.search(rf"^{key}", header, re.MULTILINE), key
    sections = re.findall(r"^# (.*)$", body, re.MULTILINE)
    assert {"Summary", "Statement of need", "State of the field", "References"} <= set(sections), sections
    cited = set(re.findall(r"@([a-z]+\d{4})", body))
    entries = re.findall(r"^@\w+\{(\w+),$", bib, re.MULTILINE)
    assert cited == set(entries) and len(entries) == len(set(entries)) > 5, cited ^ set(entries)
    for entry in bib.split("\n@"):
        assert all(f" {key} = {{" in entry for key in ("author", "title", "year")), entry
        assert entry.count("{") == entry.count("}"), entry
    assert 250 < len(body.split()) < 1000, len(body.split())


# Names in conda and vcpkg of the packages of script/packages.txt (group build). None: the recipe provides the package
# by other means, such as its compiler, or does without.
CONDA_NAMES = {"g++": None, "cmake": "cmake", "ninja-build": "ninja", "libcli11-dev": "cli11", "libfmt-dev": "fmt",
               "libyaml-cpp-dev": "yaml-cpp", "libtinyxml2-dev": "tinyxml2", "libhdf5-dev": "hdf5",
               "pkgconf": "pkg-config", "zlib1g-dev": "zlib", "libpng-dev": "libpng",
               "nlohmann-json3-dev": "nlohmann_json", "libsqlite3-dev": "sqlite", "libnlopt-dev": "nlopt",
               "libeigen3-dev": "eigen", "libboost-dev": "libboost-headers",
               "libqrcodegencpp-dev": None}  # optional: taut view then draws no QR codes
VCPKG_NAMES = CONDA_NAMES | {"cmake": "vcpkg-cmake", "ninja-build": None, "pkgconf": None,
                             "nlohmann-json3-dev": "nlohmann-json", "libsqlite3-dev": "sqlite3",
                             "libeigen3-dev": "eigen3", "libboost-dev": "boost-beast"}


def RecipesHaveTheLibrariesOfTheBuild():
    try:
        import yaml
    except ImportError:
        raise Skipped("there is no python3-yaml") from None
    packages = build_packages()
    assert packages.keys() == CONDA_NAMES.keys() == VCPKG_NAMES.keys(), packages.keys() ^ CONDA_NAMES.keys()
    # conda: Jinja expressions insert the version and the compiler.
    text = (ROOT / "packaging/conda/meta.yaml").read_text()
    file, pattern = re.search(r'load_file="(.*?)", regex_pattern=\'(.*?)\'', text).groups()
    version = re.search(pattern, (ROOT / "packaging/conda" / file).read_text())[1]
    assert version == release.current(ROOT), version
    text = re.sub(r"{%.*?%}", "", text).replace("{{ version }}", version).replace('{{ compiler("cxx") }}', "cxx")
    recipe = yaml.safe_load(text)
    assert recipe["package"] == {"name": "tautsim", "version": version}, recipe["package"]
    requirements = recipe["requirements"]
    conda = {each.split()[0] for each in requirements["build"] + requirements["host"]}
    assert set(filter(None, CONDA_NAMES.values())) <= conda, set(CONDA_NAMES.values()) - conda
    assert (ROOT / "packaging/conda" / recipe["source"]["path"]).resolve() == ROOT
    assert all((ROOT / name).is_file() for name in recipe["about"]["license_file"])
    # vcpkg
    manifest = json.loads((ROOT / "packaging/vcpkg/taut/vcpkg.json").read_text())
    assert manifest["name"] == "taut" and manifest["license"] == recipe["about"]["license"] == "Apache-2.0"
    depends = manifest["dependencies"] + manifest["features"]["command"]["dependencies"]
    vcpkg = {each if isinstance(each, str) else each["name"] for each in depends}
    assert set(filter(None, VCPKG_NAMES.values())) <= vcpkg, set(VCPKG_NAMES.values()) - vcpkg
    port = (ROOT / "packaging/vcpkg/taut/portfile.cmake").read_text()
    assert "vcpkg_cmake_install()" in port and "vcpkg_install_copyright" in port
    # Debian
    control = (ROOT / "debian/control").read_text()
    needs = re.search(r"^Build-Depends:(.*?)^\S", control, re.MULTILINE | re.DOTALL)[1]
    assert packages.keys() - set(re.findall(r"[\w+.-]+", needs)) == {"g++"}, needs
    # CMake options of all recipes exist
    cmake = "".join(path.read_text() for path in [ROOT / "CMakeLists.txt", *ROOT.glob("cmake/*.cmake"),
                                                  ROOT / "python/CMakeLists.txt"])
    for path in (ROOT / "packaging").rglob("*"):
        for option in re.findall(r"\bTAUT_[A-Z_]+\b", path.read_text()) if path.is_file() else []:
            assert re.search(rf"(option|set)\({option} ", cmake), f"{path.name}: {option}"


def ImagesHaveTheLibrariesThatTheCommandLoads():
    shared = [name for name, reason in build_packages().items()
              if name.endswith("-dev") and "headers only" not in reason and name != "libboost-dev"]
    stems = [name.removesuffix("-dev").replace("libsqlite3", "libsqlite3-0") for name in shared] + ["libopenmpi"]
    assert len(stems) > 6, stems
    images = {}
    for name, begin in (("Containerfile", "FROM debian:12-slim"), ("taut.def", "Stage: final")):
        text = (ROOT / "packaging" / name).read_text()
        assert "script/setup build" in text and "include/taut/version.h" not in text
        installed = text.split(begin)[1].split("apt-get install -y --no-install-recommends")[1].split("rm -rf")[0]
        images[name] = set(re.findall(r"[a-z0-9][a-z0-9.+-]+", installed.replace("&&", "")))
        lacking = [stem for stem in stems if not any(each.startswith(stem) for each in images[name])]
        assert not lacking, (name, lacking)
    assert images["Containerfile"] == images["taut.def"], images
    lint = shutil.which("hadolint")
    if lint:
        run(lint, "packaging/Containerfile", cwd=ROOT)


if __name__ == "__main__":
    main(globals())
