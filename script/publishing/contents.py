"""Structure of the website: parts of the sidebar, and the order of their pages."""

PARTS = {
    "Begin": ["docs/tutorial.md", "docs/tutorial_ground.md", "docs/tutorial_joints.md", "docs/tutorial_cables.md",
              "docs/tutorial_python.md", "docs/gallery.md", "report.md", "demo.md"],
    "Use": ["docs/cli.md", "docs/viewer.md", "docs/browser.md", "docs/analyze.md", "docs/export.md", "docs/learning.md", "docs/environments.md",
            "docs/compare.md", "docs/fit.md", "docs/python.md", "docs/limits.md", "docs/glossary.md"],
    "Coming from": ["docs/from_gymnasium.md", "docs/from_ntrt.md", "docs/from_mujoco.md", "docs/from_matlab.md"],
    "Files": ["docs/formats/model.md", "docs/formats/experiment.md", "docs/formats/gait.md", "docs/formats/study.md",
              "docs/formats/"],
    "In C++": ["api/index.rst", "docs/plant.md"],
    "Hardware": ["docs/hardware/firmware.md", "docs/hardware/protocol.md", "docs/hardware/driver.md",
                 "docs/hardware/virtual_robot.md", "docs/hardware/building.md", "docs/hardware/"],
    "Theory": ["docs/theory/integrator.md", "docs/theory/cables.md", "docs/theory/contact.md", "docs/theory/"],
    "How good it is": ["docs/validation/README.md", "docs/validation/", "docs/performance.md", "docs/determinism.md",
                       "docs/robustness.md"],
    "The project": ["docs/README.md", "ARCHITECTURE.md", "docs/extending.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md"],
}
REST = "More"  # part for all pages that no other part lists, such as new ones


def parts(pages):
    """Returns [(part, [page, ...]), ...] of the existing pages."""
    left, found = sorted(pages), []
    for part, names in PARTS.items():
        chosen = []
        for name in names:
            chosen += [page for page in left if page not in chosen and
                       (page == name or (name.endswith("/") and page.startswith(name)
                                         and not any(page in other for other in PARTS.values())))]
        found.append((part, chosen))
        left = [page for page in left if page not in chosen]
    return found + ([(REST, left)] if left else [])


def toctrees(pages):
    """Returns the sidebar, as hidden lists for the end of the first page."""
    lines = []
    for part, chosen in parts(pages):
        lines += ["", "```{toctree}", ":hidden:", f":caption: {part}", ""]
        lines += [page.rsplit(".", 1)[0] for page in chosen] + ["```"]
    return "\n".join(lines) + "\n"
