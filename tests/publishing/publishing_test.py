"""The website and a release are made by command; impossible requests fail with an error.

Usage: publishing_test.py AREA.TEST [TAUT BUILD_FOLDER]. TEST is the name of a function of this file.
"""

import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

sys.dont_write_bytecode = True
from harness import ROOT, Skipped, build_packages, main, run  # noqa: E402
from publishing import contents, deb, release, sbom, stage  # noqa: E402


def problem(function, *arguments):
    """Returns the message of the Problem that the call raises; fails if it raises none."""
    try:
        function(*arguments)
    except stage.Problem as found:
        return str(found)
    raise AssertionError("no Problem")


def write(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)


def copied(place):
    """Copies the working tree into a new git repository, with changes to release. Returns it and its environment."""
    root = pathlib.Path(place) / "tree"
    listed = run("git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", cwd=ROOT)
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, root / name)
    text = (root / "CHANGELOG.md").read_text()
    if "(not yet released)" not in text:  # directly after a release
        write(root, {"CHANGELOG.md": text.replace("\n## ", "\n## Next (not yet released)\n\n- New.\n\n## ", 1)})
    (pathlib.Path(place) / "gitconfig").write_text("[user]\n\tname = somebody\n\temail = somebody@example.org\n")
    env = dict(os.environ, GIT_CONFIG_GLOBAL=f"{place}/gitconfig")
    for words in (["init", "--quiet", "--initial-branch", "main"], ["add", "--all"],
                  ["commit", "--quiet", "--message", "A tree"]):
        run("git", *words, cwd=root, env=env)
    return root, env


def next_version(root):
    first, second, _ = release.numbers(release.current(root))
    return f"{first}.{second + 1}.0"


# Website


def ALinkToCodeLeadsToAPageOfIt():
    with tempfile.TemporaryDirectory() as place:
        root, to = pathlib.Path(place) / "root", pathlib.Path(place) / "to"
        write(root, {"docs/a.md": "# A\n[code](../src/x.cpp), [b](b.md#b), `[no](link)`, [web](https://example.org)\n"
                                  "```\n[no](link)\n```\n", "docs/b.md": "# B\n[start](../README.md), [all](../src/)\n",
                     "src/x.cpp": "int x;\n", "README.md": "# R\n"})
        pages = stage.Stage(root, to).pages(["docs/a.md"])
        assert {"docs/a.md", "docs/b.md", "README.md"} <= pages, pages
        a, b = (to / "docs/a.md").read_text(), (to / "docs/b.md").read_text()
        assert "[code](../src/x.cpp.md), [b](b.md#b), `[no](link)`, [web](https://example.org)" in a, a
        assert "```\n[no](link)\n```" in a, a
        assert "[start](../index.md), [all](../src/index.md)" in b, b
        assert ":language: cpp" in (to / "src/x.cpp.md").read_text() and (to / "src/x.cpp").exists()
        assert "[x.cpp](x.cpp.md)" in (to / "src/index.md").read_text()


def ALinkThatLeadsNowhereIsAnError():
    with tempfile.TemporaryDirectory() as place:
        root = pathlib.Path(place) / "root"
        write(root, {"a.md": "# A\n[x](x.md)\n", "b.md": "# B\n[x](../x.md)\n"})
        assert problem(stage.Stage(root, place).pages, ["a.md"]) == "a.md: there is no x.md"
        assert "leads out of the project" in problem(stage.Stage(root, place).pages, ["b.md"])


def EveryPageHasItsPlace():
    pages = {str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md")} | {"docs/new.md"}
    placed = [page for _, some in contents.parts(pages) for page in some]
    assert sorted(placed) == sorted(pages), set(placed) ^ pages
    assert contents.parts(pages)[-1] == (contents.REST, ["docs/new.md"]), contents.parts(pages)[-1]


def TheGalleryHasEveryModel():
    run(ROOT / "script/gallery", "--check")


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attrs):
        self.found += [value for name, value in attrs if name in ("href", "src") and value]


def IsBuiltWithoutAWarning():
    with tempfile.TemporaryDirectory() as place:
        site = pathlib.Path(place) / "site"
        done = subprocess.run([ROOT / "script/website", "--taut", sys.argv[2], "--out", site], capture_output=True,
                              text=True)
        if done.returncode == 2:
            raise Skipped(re.sub(".*this machine has", "there is", done.stderr.strip()))
        assert done.returncode == 0, done.stdout + done.stderr
        count = 0
        for page in site.rglob("*.html"):
            if page.name == "report.html" and page.parent.name == "_static":
                continue
            links = Links()
            links.feed(page.read_text())
            for target in links.found:
                parts = urllib.parse.urlsplit(target)
                if parts.scheme or parts.netloc:
                    assert parts.scheme != "http", f"{page.name}: {target}"
                elif parts.path:
                    count += 1
                    assert (page.parent / urllib.parse.unquote(parts.path)).exists(), f"{page}: {target}"
        assert count > 1000, count
        for name in ("index.html", "docs/gallery.html", "api/batch.html", "searchindex.js", "_static/report.html"):
            assert (site / name).is_file(), name
        assert "WorldBatchOptions" in (site / "api/world_batch.html").read_text()


# Releases


def AVersionComesAfterTheLast():
    now = release.current(ROOT)
    assert problem(release.check, ROOT, now) == f"{now} does not come after {now}"
    for wrong in ("1", "0.2", "v0.2.0", "0.02.0", "0.2.0-rc1", ""):
        assert "is no version" in problem(release.check, ROOT, wrong)
    assert release.numbers("0.10.0") > release.numbers("0.9.9")


def ThereMustBeChanges():
    with tempfile.TemporaryDirectory() as place:
        root = pathlib.Path(place)
        begin = "# Changes\n\n"
        write(root, {"CHANGELOG.md": begin + "## 0.3.0 (2026-01-01)\n\n- Old.\n"})
        assert "no section at its top" in problem(release.unreleased, root)
        write(root, {"CHANGELOG.md": begin + "## Next (not yet released)\n\n## 0.3.0 (2026-01-01)\n\n- Old.\n"})
        assert "says nothing" in problem(release.unreleased, root)
        write(root, {"CHANGELOG.md": begin + "## Next (not yet released)\n\n- New.\n\n## 0.3.0 (x)\n\n- Old.\n"})
        assert release.unreleased(root) == ("## Next (not yet released)", "- New.")


def TheVersionGoesWhereItStands():
    with tempfile.TemporaryDirectory() as place:
        root, env = copied(place)
        now, version = release.current(root), next_version(root)
        changes = release.write(root, version, "2030-01-02")
        assert release.current(root) == version and changes
        changed = set(run("git", "diff", "--name-only", cwd=root, env=env).split())
        assert changed == {release.HEADER, release.CHANGELOG, *release.SHOWN_IN}, changed
        log = (root / "CHANGELOG.md").read_text()
        assert f"\n## {version} (2030-01-02)\n\n{changes[:20]}" in log and "not yet released" not in log
        for page in release.SHOWN_IN:
            assert f"taut {version}" in (root / page).read_text() and f"taut {now}" not in (root / page).read_text()


def TheVersionStandsInOnePlace():
    now = release.current(ROOT)
    listed = run("git", "ls-files", "--cached", "--others", "--exclude-standard", cwd=ROOT).split("\n")
    places = re.compile(r"(README\.md|CITATION\.cff|(.*/)?CMakeLists\.txt|(.*/)?package\.json|cmake/.*|debian/.*"
                        r"|script/.*|\.github/.*)")
    files = [name for name in listed if places.fullmatch(name) and not name.startswith("tests/")]
    assert len(files) > 30, files
    found = [name for name in files if re.search(rf"\b{re.escape(now)}\b", (ROOT / name).read_text())]
    assert not found, found


def WhatIsNotCommittedIsNotReleased():
    if lacking := deb.missing():
        raise Skipped(f"there is no {', '.join(lacking)}")
    with tempfile.TemporaryDirectory() as place:
        root, env = copied(place)
        (root / "share/models/new.yaml").write_text("taut: 1\n")
        said = run(root / "script/release", next_version(root), "--dry_run", env=env, status=1)
        assert "changes that are not committed" in said, said


def ATagIsNotMovedEver():
    if lacking := deb.missing():
        raise Skipped(f"there is no {', '.join(lacking)}")
    with tempfile.TemporaryDirectory() as place:
        root, env = copied(place)
        version = next_version(root)
        run("git", "tag", f"v{version}", cwd=root, env=env)
        assert "there is a tag" in run(root / "script/release", version, env=env, status=1)


def ADryRunLeavesNothingButFiles():
    """Packages the existing build, with the previous version set to 0.0.1."""
    if lacking := deb.missing():
        raise Skipped(f"there is no {', '.join(lacking)}")
    taut, built = pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    if not (taut.parent / "web/index.html").exists():
        raise Skipped("the viewer's pages are not built")
    with tempfile.TemporaryDirectory() as place:
        root, env = copied(place)
        version = release.current(root)
        for name in (release.HEADER, *release.SHOWN_IN):
            text = (root / name).read_text()
            write(root, {name: text.replace(f'"{version}"', '"0.0.1"').replace(f"taut {version}", "taut 0.0.1")})
        log = re.sub(r"\n## .*\n", "\n## Next (not yet released)\n", (root / "CHANGELOG.md").read_text(), count=1)
        write(root, {"CHANGELOG.md": log})
        run("git", "commit", "--quiet", "--all", "--message", "Before", cwd=root, env=env)
        before = run("git", "rev-parse", "HEAD", cwd=root, env=env)
        said = run(root / "script/release", version, "--dry_run", "--tested", "--built", built, env=env)
        assert before == run("git", "rev-parse", "HEAD", cwd=root, env=env), "the branch has moved"
        assert not run("git", "tag", "--list", cwd=root, env=env), "there is a tag"
        assert not run("git", "status", "--porcelain", cwd=root, env=env), "the tree has changed"
        folder = root / "build" / f"release_{version}"
        names = sorted(path.name.split("_")[0] for path in folder.iterdir())
        assert names == ["SHA256SUMS", "changes.md", "libtaut-dev", "taut", f"taut-{version}.cdx.json",
                         f"taut-{version}.tar.gz"], (names, said)
        assert json.loads((folder / f"taut-{version}.cdx.json").read_text())["metadata"]["component"]["version"] == version
        assert f"taut-{version}.cdx.json" in (folder / "SHA256SUMS").read_text()
        run("sha256sum", "--check", "--quiet", "SHA256SUMS", cwd=folder)
        held = run("tar", "-tzf", folder / f"taut-{version}.tar.gz").split()
        assert f"taut-{version}/CMakeLists.txt" in held and not [name for name in held if "node_modules" in name]


def TheBillOfMaterialsListsWhatTheFilesContain():
    versions = {name: f"1.{number}+x" for number, name in enumerate(sbom.LIBRARIES)}
    lock = ROOT / "web/package-lock.json"
    text = sbom.bill("1.2.3", versions, lock, "2030-01-02T03:04:05+00:00")
    assert text == sbom.bill("1.2.3", versions, lock, "2030-01-02T03:04:05+00:00"), "not reproducible"
    bill = json.loads(text)
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.5")
    assert bill["metadata"]["component"]["version"] == "1.2.3"
    parts = {part["name"]: part for part in bill["components"]}
    # every static library of script/portable, every linked or compiled library of the build, every npm package
    assert set(sbom.static_sources(ROOT)) <= parts.keys(), set(sbom.static_sources(ROOT)) - parts.keys()
    sources = {package for package, _, _ in sbom.LIBRARIES.values()}
    libraries = {name for name in build_packages() if name.endswith("-dev")} - {"libboost-dev"}
    assert libraries <= sources, libraries - sources
    npm = json.loads((ROOT / "web/package.json").read_text())["dependencies"]
    assert npm and npm.keys() <= parts.keys(), npm.keys() - parts.keys()
    assert parts["hdf5"]["version"] == versions["hdf5"] and "%2B" in parts["hdf5"]["purl"]
    assert parts["hdf5"]["licenses"] == [{"license": {"id": "BSD-3-Clause"}}]
    for part in parts.values():
        assert part["version"] and part["licenses"] and part["purl"].startswith("pkg:"), part
    refs = {part["bom-ref"] for part in parts.values()}
    assert len(refs) == len(bill["components"]) and set(bill["dependencies"][0]["dependsOn"]) == refs
    with tempfile.TemporaryDirectory() as place:  # versions of script/portable take precedence
        write(pathlib.Path(place), {"libraries/versions": "".join(f"{name} 9.9\n" for name in sbom.LIBRARIES)})
        assert set(sbom.debian_versions(place).values()) == {"9.9"}


def IsCompiledInstalledAndRuns():
    if lacking := deb.missing():
        raise Skipped(f"there is no {', '.join(lacking)}")
    with tempfile.TemporaryDirectory() as place:
        run(ROOT / "script/deb", "--out", f"{place}/packages")
        assert len(list(pathlib.Path(place, "packages").glob("*.deb"))) == 2


if __name__ == "__main__":
    main(globals())
