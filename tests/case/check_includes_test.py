#!/usr/bin/python3
"""tools/check_includes.py finds what it is there to find."""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = "| room | may include |\n|---|---|\n| base | std |\n| dem | base |\n| app | all public headers |\n"

WRONG = {
    "base/up.hpp": ('#pragma once\n#include "dem/law.hpp"\n', "base must not include dem"),
    "dem/loop.cpp": ("#pragma omp parallel for\n", "parallel loops only"),
    "dem/quits.cpp": ("void f() { exit(1); }\n", "only app/ ends"),
    "dem/law.hpp": ("int law();\n", "starts with #pragma once"),
    "dem/opens.hpp": ("#pragma once\nusing namespace base;\n", "using namespace in a header"),
    "dem/cites.cpp": ("// as Nobody & Someone 1900\n", "no entry Nobody 1900"),
}
RIGHT = {
    "dem/fine.cpp": '#include "base/real.hpp"\n// exit(1) in a comment; as Known et al. 1950\nconst char* s = "exit(1)";\n',
    "base/real.hpp": "#pragma once\n",
    "app/main.cpp": '#include "dem/law.hpp"\nint main() { exit(0); }\n',
}


def check(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "ARCHITECTURE.md").write_text(TABLE)
        (root / "docs").mkdir()
        (root / "docs" / "references.bib").write_text("@article{known1950,\n  author={Known, A.}, year={1950}\n}\n")
        for room in ("base", "dem", "app"):
            (root / "src" / room).mkdir(parents=True)
        for name, text in files.items():
            (root / "src" / name).parent.mkdir(parents=True, exist_ok=True)
            (root / "src" / name).write_text(text)
        tool = subprocess.run(
            [sys.executable, ROOT / "tools" / "check_includes.py", root], capture_output=True, text=True
        )
        return tool.returncode, tool.stdout


code, text = check(RIGHT)
assert code == 0, text
circle = {
    "dem/law/a.hpp": '#pragma once\n#include "dem/shape/b.hpp"\n',
    "dem/shape/b.hpp": '#pragma once\n#include "dem/solve/c.hpp"\n',
    "dem/solve/c.hpp": '#pragma once\n#include "dem/law/a.hpp"\n',
}
code, text = check({**RIGHT, **circle})
assert code == 1 and text == "folders in a circle: dem/law -> dem/shape -> dem/solve -> dem/law\n", text
for name, (content, words) in WRONG.items():
    code, text = check({**RIGHT, name: content})
    assert code == 1 and words in text and name in text, (name, text)
