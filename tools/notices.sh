#!/bin/sh
# notices.sh [check]: write packaging/THIRD-PARTY.md, the licences of all code that is linked into the archive, the command and the Python
# package, from the crates of Cargo.lock; or check that it is up to date.
set -eu

cd "$(dirname "$0")/.."
: "${CARGO:=cargo}"
export CARGO

python3 - "${1:-write}" << 'END'
import json, os, re, subprocess, sys, textwrap
from pathlib import Path

# What Rust itself links into a program on Linux. Its sources are not among the crates of Cargo.lock.
RUST = [
    ("Rust's core, alloc and std", "Copyright (c) The Rust Project Contributors"),
    ("compiler-builtins; parts are those of libm, see there", "Copyright (c) The Rust Project Contributors"),
    ("gimli, addr2line, object (in std)", "Copyright (c) 2015 The Rust Project Developers"),
    ("hashbrown (in std)", "Copyright (c) 2016 Amanieu d'Antras"),
    ("rustc-demangle, cfg-if (in std)", "Copyright (c) 2014 Alex Crichton"),
]
PARTS = {"microslip": "archive", "microslip-cli": "command", "microslip-python": "Python"}
TARGETS = ("x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu")
# In order of preference: what is offered under several licences is used under the first of these.
PREFERRED = ("MIT", "ZLIB", "")


def cargo(*arguments):
    return subprocess.run([os.environ["CARGO"], *arguments, "--locked"], check=True, capture_output=True, text=True).stdout


def linked(package):
    for target in TARGETS:
        listed = cargo("tree", "-p", package, "-e", "normal,no-proc-macro", "--prefix", "none", "--target", target, "-f", "{p}")
        for line in listed.splitlines():
            name, version = line.split()[:2]
            yield name, version.removeprefix("v")


def licence(directory):
    files = [file for file in directory.iterdir() if re.match("LICEN[CS]E|COPYING", file.name, re.I)]
    for preferred in PREFERRED:
        for file in sorted(files):
            if preferred in file.name.upper():
                return file.read_text()
    sys.exit(f"{directory} has no licence text")


packages = {(p["name"], p["version"]): p for p in json.loads(cargo("metadata", "--format-version=1"))["packages"]}
parts = {}
for package, part in PARTS.items():
    for crate in linked(package):
        parts.setdefault(crate, set()).add(part)

# Crates by the text of their licence, which is the same for many, apart from the lines of copyright.
groups = {}


def add(title, text):
    paragraphs = re.split(r"\n\s*\n", text.strip("\n"))
    head = r"\W*copyright (\(c\)|©|\d)|#|(the )?(\w+ )?licen[cs]e[^.]*$|=="
    rights = []
    while paragraphs and re.match(head, " ".join(paragraphs[0].split()).strip("* "), re.I):
        rights += [line.strip() for line in paragraphs.pop(0).splitlines() if "opyright" in line]
    key = re.sub(r"\W+", "", "".join(paragraphs)).lower()
    groups.setdefault(key, ("\n\n".join(paragraphs), []))[1].append((title, rights))


for crate, where in sorted(parts.items()):
    package = packages[crate]
    if package["source"] is None:
        continue
    directory = Path(package["manifest_path"]).parent
    title = "{} {} ({})".format(*crate, ", ".join(sorted(where)))
    add(title, licence(directory))
    for font in directory.glob("assets/*/LICENSE"):
        add(f"fonts of {title}", font.read_text())
mit = next(key for key in groups if key.startswith("permissionisherebygrantedfreeofchargetoanyperson"))
groups[mit][1][:0] = [(name, [rights]) for name, rights in RUST]

out = ["# Licences of third parties", ""]
out += textwrap.wrap(
    "microslip itself is under the MIT licence or the Apache Licence 2.0, as its user chooses: LICENSE-MIT, LICENSE-APACHE. Its "
    "compiled library (archive), command and Python package contain the code below, each under one of the licences that its "
    "authors offer. This file is written by tools/notices.sh.", 130)
for text, crates in sorted(groups.values(), key=lambda group: -len(group[1])):
    out += ["", f"## {crates[0][0].split(' (')[0] if len(crates) == 1 else f'{len(crates)} packages'}", ""]
    for title, rights in crates:
        out.append(f"- {title}" + "".join(f"; {right}" for right in rights))
    out += ["", "```text", *(line.rstrip() for line in text.splitlines()), "```"]
text = "\n".join(out) + "\n"

file = Path("packaging/THIRD-PARTY.md")
if sys.argv[1] == "check":
    if not file.exists() or file.read_text() != text:
        sys.exit("THIRD-PARTY.md is not that of Cargo.lock: run tools/notices.sh")
else:
    file.write_text(text)
END
