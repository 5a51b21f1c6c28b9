#!/usr/bin/env python3
"""Checks every #include and every taut_layer(... USES ...) against layers.txt.

Usage: script/check_layers.py [ROOT]. Prints `file:line: error: ...`; exit status 1 if there is an error.
"""

import fnmatch
import pathlib
import re
import sys

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')
USES = re.compile(r"taut_layer\(\s*(\w+)(.*?)\)", re.DOTALL)


class Rules:
    """Content of layers.txt."""

    def __init__(self, path):
        self.uses, self.layer_of_header, self.folders = {}, {}, {}
        self.only, self.system, self.rooms, self.errors = [], {}, {}, []
        for number, line in enumerate(path.read_text().splitlines(), 1):
            line = line.split("#")[0].strip()
            if not line:
                continue
            match = re.fullmatch(r"(layer|room|headers|folder|only|system) ([\w/]+):(.*)", line)
            if not match:
                self.errors.append(f"{path.name}:{number}: error: cannot read this line")
                continue
            kind, name, words = match[1], match[2], match[3].split()
            if kind == "layer":
                self.uses[name] = {name, *words}
            elif kind == "room":
                layer, room = name.split("/")
                self.rooms.setdefault(layer, {})[room] = {room, *words}
            elif kind == "headers":
                self.layer_of_header.update({word: name for word in words})
            elif kind == "folder":
                self.folders[name] = {name, *words}
            elif kind == "only":
                self.only += [(pattern, name) for pattern in words]
            else:
                self.system[name] = words


def check_outside(rules, where, layer, header, errors):
    """Checks an include of a header of another project."""
    owners = [owner for pattern, owner in rules.only if fnmatch.fnmatch(header, pattern)]
    if owners and layer not in (*owners, "tests"):
        errors.append(f"{where}: error: <{header}> belongs in {' and '.join(owners)} only")
    allowed = rules.system.get(layer)
    if allowed is not None and header not in allowed:
        errors.append(f"{where}: error: {layer} may include only {', '.join(allowed)}, not <{header}>")


def check_room(rules, where, layer, path, header, errors):
    """Checks an include of a header of the same layer, between its folders (rooms)."""
    rooms = rules.rooms.get(layer)
    if not rooms or header.split("/")[0] != layer:
        return
    room, other = path.parent.name, header.split("/")[1]
    if room not in rooms:
        errors.append(f"{where}: error: {layer}/{room} is no room of layers.txt")
    elif other not in rooms[room]:
        errors.append(f"{where}: error: {layer}/{room} may not include {header}")


def folder_of(rules, header):
    """Returns the folder of layers.txt that contains a header: apps/viewer for apps/viewer/server.h."""
    return max((folder for folder in rules.folders if header.startswith(folder + "/")), key=len, default=None)


def check_file(rules, root, path, layer, allowed, private, errors):
    """Checks the includes of a file of `layer`, which may include the layers `allowed`."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        where, header = f"{path.relative_to(root)}:{number}", match[2]
        if match[1] == "<":
            check_outside(rules, where, layer, header, errors)
        elif header.startswith("taut/"):
            owner = rules.layer_of_header.get(header[len("taut/") :])
            if owner is None:
                errors.append(f"{where}: error: {header} is in no layer of layers.txt")
            elif owner not in allowed:
                errors.append(f"{where}: error: {layer} may not include {header} of {owner}")
        elif (root / "src" / header).exists():
            owner = header.split("/")[0]
            if not private:
                errors.append(f"{where}: error: {layer} may include public headers only, not {header}")
            elif owner not in allowed:
                errors.append(f"{where}: error: {layer} may not include {header} of {owner}")
            check_room(rules, where, layer, path, header, errors)
        elif folder_of(rules, header) and (root / header).exists():
            owner = folder_of(rules, header)
            if owner not in (layer, *allowed):
                errors.append(f"{where}: error: {layer} may not include {header} of {owner}")
        elif not (path.parent / header).exists() and not (root / layer / header).exists():
            errors.append(f"{where}: error: no file {header}")


def sources(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in (".h", ".cpp", ".inl"))


def check(root):
    rules = Rules(root / "layers.txt")
    errors = list(rules.errors)

    public = root / "include" / "taut"
    for name in rules.layer_of_header:
        if not (public / name).exists():
            errors.append(f"layers.txt:1: error: no header include/taut/{name}")
    for path in sources(public):
        name = str(path.relative_to(public))
        if name == "taut.h":  # includes all of them; script/check_headers compares the list
            continue
        layer = rules.layer_of_header.get(name)
        if layer is None:
            errors.append(f"include/taut/{name}:1: error: in no layer of layers.txt")
        else:
            allowed = rules.uses.get(layer) or rules.folders[layer]
            check_file(rules, root, path, layer, allowed, False, errors)

    for folder in sorted(p for p in (root / "src").iterdir() if p.is_dir() and sources(p)):
        layer = folder.name
        if layer not in rules.uses:
            errors.append(f"src/{layer}: error: no such layer in layers.txt")
            continue
        for path in sources(folder):
            check_file(rules, root, path, layer, rules.uses[layer], True, errors)
        text = (folder / "CMakeLists.txt").read_text() if (folder / "CMakeLists.txt").exists() else ""
        for name, arguments in USES.findall(text):
            used = re.search(r"USES\s+((?:(?!SOURCES|LIBRARIES)\S+\s*)+)", arguments)
            for other in used[1].split() if used else []:
                if other not in rules.uses[layer]:
                    errors.append(f"src/{layer}/CMakeLists.txt:1: error: {name} may not use {other}")

    for folder, allowed in rules.folders.items():
        for path in sources(root / folder):
            if folder_of(rules, str(path.relative_to(root))) != folder:
                continue  # a subfolder with separate rules
            check_file(rules, root, path, folder, allowed, "src" in allowed, errors)
    return errors


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    errors = check(root)
    print("\n".join(errors), end="\n" if errors else "")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
