#!/usr/bin/python3
"""The command line as a user meets it: help, exit codes, first steps. Usage: cli_test.py EJECTA"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EJECTA = os.path.abspath(sys.argv.pop())
COMMANDS = "run check plan explain new jet validate bench report cache".split()
BOUNCE = """[run]
end_time = "1 ms"
[flow]
solver = "none"
[[body]]
name = "ball"
diameter = "10 mm"
"""


def ejecta(*arguments, **environment):
    return subprocess.run(
        [EJECTA, *arguments], capture_output=True, text=True, timeout=60, env={**os.environ, **environment}
    )


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)

    def case(self, text=BOUNCE):
        pathlib.Path("case.toml").write_text(text)
        return "case.toml"

    def test_every_command_has_help_with_an_example(self):
        for command in COMMANDS:
            with self.subTest(command):
                answer = ejecta(command, "--help")
                self.assertEqual(answer.returncode, 0)
                self.assertIn("Example", answer.stdout)
                self.assertIn(f"ejecta {command}", answer.stdout)
        everything = ejecta("--help").stdout
        for command in COMMANDS:
            self.assertIn(f"\n  {command} ", everything)

    def test_version(self):
        self.assertRegex(ejecta("--version").stdout, r"^\d+\.\d+\.\d+")

    def test_wrong_use_is_bad_input_and_names_the_nearest(self):
        answer = ejecta("chekc")
        self.assertEqual(answer.returncode, 2)
        self.assertIn('nearest is "check"', answer.stderr)
        self.assertEqual(ejecta().returncode, 2)
        self.assertEqual(ejecta("run").returncode, 2)
        self.assertEqual(ejecta("run", self.case(), "--thread", "2").returncode, 2)
        self.assertEqual(ejecta("run", self.case(), "--threads", "0").returncode, 2)

    def test_a_wrong_case_is_bad_input_with_the_line(self):
        for command in ("run", "check", "plan"):
            with self.subTest(command):
                answer = ejecta(command, self.case(BOUNCE.replace("10 mm", "10")))
                self.assertEqual(answer.returncode, 2)
                self.assertIn("case.toml:7: error: body.0.diameter", answer.stderr)
        self.assertEqual(ejecta("check", "nowhere.toml").returncode, 2)

    def test_check_looks_at_all_cases_even_after_a_wrong_one(self):
        answer = ejecta("check", "nowhere.toml", self.case())
        self.assertEqual(answer.returncode, 2)
        self.assertIn('"ball"', answer.stdout)

    def test_every_new_case_passes_check(self):
        kinds = "ejection jet stream settling cavity shock-tube collision".split()
        for kind in kinds:
            with self.subTest(kind):
                self.assertIn(kind, ejecta("new", "--help").stdout)
                answer = ejecta("check", self.case(ejecta("new", kind).stdout))
                self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(ejecta("new", "ejektion").returncode, 2)

    def test_explain(self):
        self.assertIn("rise_time", ejecta("explain").stdout)
        self.assertIn("example", ejecta("explain", "valve.rise_time").stdout)
        self.assertEqual(ejecta("explain", "no such thing").returncode, 2)
        json.loads(ejecta("explain", "--json-schema").stdout)

    def test_set_changes_a_key(self):
        self.assertIn("up to 2 ms", ejecta("check", self.case(), "--set", "run.end_time=2 ms").stdout)
        answer = ejecta("check", self.case(), "--set", "run.end_time=2")
        self.assertEqual(answer.returncode, 2)
        self.assertIn("--set run.end_time=2", answer.stderr)

    def test_cache_lists_and_clears_its_own_files_only(self):
        store = pathlib.Path("store")
        store.mkdir()
        (store / "jet-1.h5").write_bytes(b"0" * 1000)
        (store / "kept").mkdir()
        self.assertIn("jet-1.h5", ejecta("cache", EJECTA_CACHE=str(store)).stdout)
        self.assertIn("1 files removed", ejecta("cache", "--clear", EJECTA_CACHE=str(store)).stdout)
        self.assertEqual([p.name for p in store.iterdir()], ["kept"])

    def test_validate_passes_and_fails_with_its_own_code(self):
        passing = BOUNCE + '[[expect]]\nquantity = "/steps"\nat_least = 1\n'
        failing = BOUNCE + '[[expect]]\nquantity = "/steps"\nat_most = 0\n'
        answer = ejecta("validate", self.case(passing))
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertIn("1 of 1 cases pass", answer.stdout)
        answer = ejecta("validate", self.case(failing))
        self.assertEqual(answer.returncode, 5)
        self.assertIn("NO", answer.stdout)
        self.assertEqual(ejecta("validate", "no-such-case-anywhere").returncode, 2)

    def test_an_existing_run_is_not_overwritten(self):
        case = self.case()
        self.assertEqual(ejecta("run", case, "--quiet").returncode, 0)
        before = pathlib.Path("case.run/result.json").read_text()
        self.assertEqual(ejecta("run", case, "--quiet").returncode, 2)
        self.assertEqual(pathlib.Path("case.run/result.json").read_text(), before)
        self.assertEqual(ejecta("run", case, "--quiet", "--force").returncode, 0)

    def test_the_resolved_case_of_a_run_can_be_run_again(self):
        self.assertEqual(ejecta("run", self.case(), "--quiet").returncode, 0)
        self.assertEqual(ejecta("run", "case.run/case.toml", "--quiet", "--out", "again.run").returncode, 0)
        self.assertEqual(
            pathlib.Path("case.run/case.toml").read_text(), pathlib.Path("again.run/case.toml").read_text()
        )


if __name__ == "__main__":
    unittest.main()
