"""The notebooks as a user has them: notebooks_test.py BUILD SOURCE executes those that were installed, outside the source
and with an empty home, once by an installation in a folder of its own and once by an environment of pip. Nothing of the
source is in use."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

build, source = (pathlib.Path(p).resolve() for p in sys.argv[1:])
scratch = pathlib.Path(tempfile.mkdtemp()).resolve()
python = "/usr/bin/python3"


def run(*command, **options):
    print("+", *command, flush=True)
    return subprocess.run([str(word) for word in command], check=True, **options)


prefix, elsewhere, home = (scratch / name for name in ("prefix", "elsewhere", "home"))
for folder in (elsewhere, home):
    folder.mkdir(parents=True)
run("cmake", "--install", build, "--prefix", prefix, stdout=subprocess.DEVNULL)
notebooks = elsewhere / "notebooks"
shutil.copytree(prefix / "share" / "ejecta" / "notebooks", notebooks)
runner = shutil.copy(source / "tests" / "python" / "notebooks_test.py", elsewhere)

# What a process that has run a case has in use lies below these folders.
where = """
import ejecta, pathlib, sys
ejecta.run("bodies/drop", threads=1, callback=lambda p: p.step == 1)
used = {line.split()[-1] for line in open("/proc/self/maps") if "ejecta" in line}
used |= {ejecta.__file__, ejecta.running.program()}
source, roots = sys.argv[1], {pathlib.Path(root) for root in sys.argv[2:]}
strangers = [file for file in used if not roots & set(pathlib.Path(file).resolve().parents)]
assert not strangers, strangers
assert not [folder for folder in sys.path if source in folder], sys.path
"""


def executed(interpreter, roots, **environment):
    clean = {name: os.environ[name] for name in ("PATH", "LANG") if name in os.environ}
    clean |= {"HOME": str(home), **environment}
    run(interpreter, "-B", "-c", where, source, *roots, cwd=elsewhere, env=clean)
    run(interpreter, "-B", runner, notebooks, cwd=elsewhere, env=clean)


executed(python, [prefix], PYTHONPATH=str(prefix / "lib" / "python3" / "dist-packages"))

# `pip install build/release/python`, as docs/python.md says: the module is copied, the library is that of the build.
package = shutil.copytree(build / "python", scratch / "package")
environment = scratch / "environment"
run(python, "-m", "venv", "--system-site-packages", environment)
run(environment / "bin" / "pip", "install", "--quiet", "--no-index", "--no-build-isolation", package)
executed(environment / "bin" / "python", [environment, build])
shutil.rmtree(scratch)
