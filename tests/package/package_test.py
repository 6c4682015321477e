"""The installation as others use it: package_test.py BUILD SOURCE SCRATCH installs the build into SCRATCH, compiles a
program against it, runs both from elsewhere, and looks for paths of the source tree in what was installed."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys

build, source, scratch = (pathlib.Path(p) for p in sys.argv[1:])


def run(*command, **options):
    print("+", *command, flush=True)
    return subprocess.run([str(word) for word in command], check=True, **options)


shutil.rmtree(scratch, ignore_errors=True)
prefix, elsewhere = scratch / "prefix", scratch / "elsewhere"
elsewhere.mkdir(parents=True)
run("cmake", "--install", build, "--prefix", prefix, stdout=subprocess.DEVNULL)
ejecta = prefix / "bin" / "ejecta"

# Another program: the case is one that the package does not ship.
run("cmake", "-S", source / "tests" / "package", "-B", scratch / "outside", f"-DCMAKE_PREFIX_PATH={prefix}",
    "-DCMAKE_BUILD_TYPE=Debug", stdout=subprocess.DEVNULL)
run("cmake", "--build", scratch / "outside", stdout=subprocess.DEVNULL)
run(scratch / "outside" / "outside", source / "tests" / "app" / "small-ejection.toml", cwd=elsewhere)

# Shipped cases by name, from a folder without them.
plan = run(ejecta, "plan", "tutorial", cwd=elsewhere, capture_output=True, text=True).stdout
assert str(prefix / "share" / "ejecta" / "cases" / "tutorial.toml") in plan, plan
listed = run(ejecta, "validate", "--list", cwd=elsewhere, capture_output=True, text=True).stdout.split()
assert listed and all(case.startswith(str(prefix)) for case in listed), listed

# What goes with the program.
assert ".SH ejecta run" in (prefix / "share" / "man" / "man1" / "ejecta.1").read_text()
completion = prefix / "share" / "bash-completion" / "completions" / "ejecta"
complete = '. "$0"; COMP_WORDS=(ejecta "$@"); COMP_CWORD=$#; _ejecta; echo "${COMPREPLY[@]}"'
for words, expected in (("val", "validate"), ("explain valve.rise", "valve.rise_time"), ("run --res", "--resume")):
    answer = run("bash", "-c", complete, completion, *words.split(), capture_output=True, text=True).stdout.split()
    assert expected in answer, (words, answer)

# The Python module and the server, where they were built.
packages = prefix / "lib" / "python3" / "dist-packages"
if (packages / "ejecta").is_dir():
    script = f"import ejecta; assert ejecta.check('tutorial')['cells'] > 0; assert ejecta.running.program() == {str(ejecta)!r}"
    run("/usr/bin/python3", "-B", "-c", script, cwd=elsewhere, env=dict(os.environ, PYTHONPATH=str(packages)))
if (prefix / "libexec" / "ejecta" / "ejecta-serve").exists():
    server = subprocess.Popen([ejecta, "serve", elsewhere], stdout=subprocess.PIPE, text=True)
    assert server.stdout.readline().startswith("http://127.0.0.1:")
    server.send_signal(signal.SIGINT)
    assert server.wait(20) == 0

held = [p for p in prefix.rglob("*") if p.is_file() and os.fsencode(source) + b"/" in p.read_bytes()]
assert not held, f"paths of the source tree in {held}"
shutil.rmtree(scratch)
