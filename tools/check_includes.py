#!/usr/bin/python3
"""Checks that the house is built as ARCHITECTURE.md says.

* A file of a room includes only the rooms that the table of ARCHITECTURE.md allows it.
* No folders include each other in a circle.
* No header says "using namespace" at its top level.
* No OpenMP, MPI or GPU word stands outside src/base.
* Only src/app ends the program or prints.
* Works cited as "Issa 1986" or "Clift, Grace & Weber 1978" are in docs/references.bib.
* Headers start with #pragma once.

Usage: tools/check_includes.py [ROOT]; prints what is wrong and exits 1 if anything is.
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
TABLE_ROW = re.compile(r"^\|([^|]+)\|([^|]+)\|\s*$", re.M)
PARALLEL = re.compile(r"#\s*pragma\s+omp|\bomp_\w+\(|\bMPI_\w+|\bcuda\w+\(")
ENDS_OR_PRINTS = re.compile(r"\b(?:std::)?(?:exit|abort|_Exit|quick_exit)\s*\(|\bstd::c(?:out|err)\b|\bfmt::print\s*\(|\bprintf\s*\(")
CITATION = re.compile(
    r"([A-Z][a-z]+)(?:,? (?:&|and) (?:van )?[A-Z][a-z]+|, (?:van )?[A-Z][a-z]+,? & (?:van )?[A-Z][a-z]+| et al\.)? "
    r"((?:19|20)\d\d)\b"
)
ENTRY = re.compile(r"author\s*=\s*\{([^}]*)\}.*?year\s*=\s*\{?(\d{4})", re.S)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
STRING = re.compile(r'R"(\w*)\((?:.|\n)*?\)\1"|"(?:\\.|[^"\\\n])*"')


def allowed_rooms(root):
    """Room -> rooms it may include, from the table of ARCHITECTURE.md."""
    text = (root / "ARCHITECTURE.md").read_text()
    rooms = sorted(p.name for p in (root / "src").iterdir() if p.is_dir())
    allowed = {}
    for left, right in TABLE_ROW.findall(text):
        for room in (name.strip() for name in left.split(",")):
            if room in rooms:
                words = set(re.findall(r"[a-z]+", right))
                allowed[room] = set(rooms) if "all" in words else words & set(rooms)
    missing = [room for room in rooms if room not in allowed]
    if missing:
        raise SystemExit(f"ARCHITECTURE.md: no row for {', '.join(missing)}")
    return allowed


def circles(root, sources):
    """Folders below src/ that include one another, each circle once."""
    src = root / "src"
    knows = {}
    for path in sources:
        folder = path.parent.relative_to(src)
        for other in INCLUDE.findall(path.read_text()):
            if (src / other).exists() and (into := pathlib.Path(other).parent) != folder:
                knows.setdefault(folder, set()).add(into)

    def walk(folder, way):
        for other in sorted(knows.get(folder, ())):
            if other == way[0]:
                yield way
            elif other > way[0] and other not in way:
                yield from walk(other, way + [other])

    for folder in sorted(knows):
        yield from walk(folder, [folder])


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def complaints(root):
    allowed = allowed_rooms(root)
    sources = [p for p in sorted((root / "src").rglob("*")) if p.suffix in (".cpp", ".hpp")]
    for path in sources:
        room = path.relative_to(root / "src").parts[0]
        text = path.read_text()
        name = path.relative_to(root)
        for match in INCLUDE.finditer(text):
            other = match.group(1).split("/")[0]
            if other == room or not (root / "src" / other).is_dir():
                continue
            if other not in allowed[room]:
                yield f"{name}:{line_of(text, match.start())}: {room} must not include {other} ({match.group(1)})"
        if path.suffix == ".hpp" and (match := re.search(r"^using namespace", text, re.M)):
            yield f"{name}:{line_of(text, match.start())}: using namespace in a header"
        if path.suffix == ".hpp" and not text.startswith("#pragma once"):
            yield f"{name}:1: a header starts with #pragma once"
        code = STRING.sub('""', COMMENT.sub("", text))
        if room != "base" and (match := PARALLEL.search(code)):
            yield f"{name}: {match.group(0)!r}: parallel loops only through base/parallel.hpp"
        if room != "app" and (match := ENDS_OR_PRINTS.search(code)):
            yield f"{name}: {match.group(0)!r}: only app/ ends the program or prints"

    for way in circles(root, sources):
        yield "folders in a circle: " + " -> ".join(str(folder) for folder in way + way[:1])

    bibliography = root / "docs" / "references.bib"
    works = ENTRY.findall(bibliography.read_text()) if bibliography.exists() else []
    theory = [p for folder in ("theory", "decisions") for p in sorted((root / "docs" / folder).glob("*.md"))]
    for path in sources + theory:
        text = re.sub(r"\n\s*///? ?", " ", path.read_text())  # a comment goes on in the next line
        for author, year in CITATION.findall(text):
            if not any(author in authors and year == of for authors, of in works):
                yield f"{path.relative_to(root)}: no entry {author} {year} in docs/references.bib"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
    found = list(complaints(root))
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
