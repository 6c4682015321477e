#!/usr/bin/python3
"""The command line as a user meets it: help, exit codes, first steps. Usage: cli_test.py EJECTA"""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile

EJECTA = os.path.abspath(sys.argv.pop())
COMMANDS = "run check plan explain new jet validate bench report cache study map sort table paraview serve".split()
BOUNCE = """[run]
end_time = "1 ms"
[flow]
solver = "none"
[[body]]
name = "ball"
diameter = "10 mm"
"""
STREAM = """[run]
end_time = "3 ms"
time_step = "0.5 ms"
[flow]
solver = "incompressible"
[grid.x]
points = ["0 mm", "20 mm"]
cells = [10]
[grid.y]
points = ["0 mm", "1 mm"]
cells = [1]
[grid.z]
points = ["0 mm", "20 mm"]
cells = [10]
[boundary.x_min]
type = "velocity"
velocity = ["2 m/s", "0 m/s", "0 m/s"]
[boundary.x_max]
type = "pressure-outlet"
[boundary.z_min]
type = "slip"
[boundary.z_max]
type = "slip"
[[initial]]
velocity = ["2 m/s", "0 m/s", "0 m/s"]
[[line]]
name = "along"
from = ["1 mm", "0.5 mm", "10 mm"]
to = ["19 mm", "0.5 mm", "10 mm"]
points = 4
[[slice]]
name = "side"
axis = "y"
position = "0.5 mm"
[output]
slices_interval = "1 ms"
fields_interval = "3 ms"
fields = ["velocity"]
report = false
"""


def ejecta(*arguments, **environment):
    return subprocess.run(
        [EJECTA, *arguments], capture_output=True, text=True, timeout=240, env={**os.environ, **environment}
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
        answer = ejecta()
        self.assertEqual(answer.returncode, 2)
        self.assertIn("ejecta new", answer.stderr)
        self.assertEqual(ejecta("run").returncode, 2)
        answer = ejecta("run", self.case(), "--thread", "2")
        self.assertEqual(answer.returncode, 2)
        self.assertIn('no option "--thread", nearest is "--threads"', answer.stderr)
        answer = ejecta("run", self.case(), "two.toml")
        self.assertEqual(answer.returncode, 2)
        self.assertIn('"two.toml" is one word too many', answer.stderr)
        self.assertIn("ejecta run --help", answer.stderr)
        self.assertEqual(ejecta("run", self.case(), "--resume", "--force").returncode, 2)
        self.assertEqual(ejecta("report", "nowhere").returncode, 2)
        self.assertIn("is a file", ejecta("report", self.case()).stderr)
        self.assertEqual(ejecta("run", self.case(), "--threads", "0").returncode, 2)

    def test_what_people_type_first(self):
        self.assertEqual(ejecta("help").stdout, ejecta("--help").stdout)
        self.assertEqual(ejecta("help", "run").stdout, ejecta("run", "--help").stdout)
        self.assertEqual(ejecta("-v").stdout, ejecta("--version").stdout)
        self.assertEqual(ejecta("help", "nothing").returncode, 2)
        self.assertEqual(ejecta("check", self.case(), "--threads", "1").returncode, 0)
        refused = ejecta("check", self.case(), "--set", "body.0.diametr=1").stderr
        self.assertIn("--set body.0.diametr=1: error:", refused, "it is no line of a file")
        for word in ("margin", "clearance", "ejected", "purity"):
            self.assertRegex(ejecta("explain", word).stdout, rf"(?m)^Words of results(.|\n)*{word}")

    def test_files_whose_names_begin_with_a_dash(self):
        """Behind "--", or as ./-x; what such a run leaves and says can be used as it stands."""
        name = pathlib.Path(self.case(BOUNCE)).rename("-ball.toml").name
        refused = ejecta("run", name)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("example:  ./-ball.toml", refused.stderr)
        self.assertEqual(ejecta("run", "-q", "--", name).returncode, 0)
        command = json.loads(pathlib.Path("-ball.run/manifest.json").read_text())["command"]
        self.assertEqual(command, "ejecta run ./-ball.toml")
        self.assertEqual(ejecta(*command.split()[1:], "-q", "--force").returncode, 0)
        study = '[study]\nquantities = ["/bodies/0/peak_speed_m_s"]\n[[study.vary]]\nkey = "run.end_time"\nvalues = ["1 ms", "2 ms"]\n'
        pathlib.Path("-many.toml").write_text(BOUNCE + study)
        pathlib.Path("-all.toml").write_text('[campaign]\n[[campaign.part]]\nkind = "study"\ncase = "-many.toml"\n')
        for command in ("study", "campaign"):
            done = ejecta(command, "-q", "--", "-many.toml" if command == "study" else "-all.toml")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(json.loads(pathlib.Path("-many.study/result.json").read_text())["runs"]), 2)
        self.assertTrue(json.loads(pathlib.Path("-all.campaign/result.json").read_text())["parts"][0]["done"])

    def test_check_says_where_a_prescribed_body_goes(self):
        swing = BOUNCE.replace("1 ms", "100 ms") + (
            'motion = "prescribed"\nvelocity = ["= 0.2 * cos(100 * t)", "0 m/s", "0 m/s"]\n'
        )
        answer = ejecta("check", self.case(swing))
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("10 x 10 x 10 mm, 0.524 cm3, 1.41 g", answer.stdout)
        self.assertIn("goes its way in x -2 to 2, y 0, z 0 mm, up to 0.2 m/s, to (-1.088, 0, 0) mm", answer.stdout)
        self.assertEqual(ejecta("run", self.case(swing), "--quiet", "--out", "swing.run").returncode, 0)
        body = json.loads(pathlib.Path("swing.run/result.json").read_text())["bodies"][0]
        self.assertAlmostEqual(body["final_position_m"][0], -1.0880422e-3, 9)

    def test_a_body_that_sticks_into_an_inflow_is_refused_by_check_and_run_alike(self):
        inside = STREAM.replace("cells = [10]", "cells = [40]") + (
            '[[body]]\nname = "ball"\ndiameter = "6 mm"\nposition = ["2 mm", "0.5 mm", "10 mm"]\n'
        )
        for command in ("check", "run"):
            answer = ejecta(command, self.case(inside))
            self.assertEqual(answer.returncode, 2, command)
            self.assertRegex(answer.stderr, r"case.toml:4\d: error: body.0.position: the body sticks 1 mm out of the box")
            self.assertIn("^", answer.stderr)

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
        self.assertTrue(answer.stderr.startswith("error: nowhere.toml"))
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
        self.assertIn("valve.opens_at", ejecta("explain", "valve", "opens").stdout)
        self.assertNotIn("splitter.height", ejecta("explain", "turb").stdout, "undisturbed is no turbulence")
        json.loads(ejecta("explain", "--json-schema").stdout)

    def test_every_shipped_case_passes_check(self):
        source = pathlib.Path(__file__).parents[2]
        cases = [
            str(p)
            for folder in ("cases", "verification", "validation")
            for p in (source / folder).rglob("*.toml")
            if p.parent.name != "setup"  # what cases extend need not be whole
        ]
        self.assertGreater(len(cases), 20)
        answer = ejecta("check", *cases)
        self.assertEqual(answer.returncode, 0, answer.stderr)

    def test_set_changes_a_key(self):
        self.assertIn("up to 2 ms", ejecta("check", self.case(), "--set", "run.end_time=2 ms").stdout)
        answer = ejecta("check", self.case(), "--set", "run.end_time=2")
        self.assertEqual(answer.returncode, 2)
        self.assertIn("--set run.end_time=2", answer.stderr)

    def test_a_wrong_set_tells_what_would_be_right(self):
        """In every command that has it, in the words of a wrong line of a file."""
        said = {
            "run.end_tim=2 ms": "nearest:  end_time",
            "run.end_time=2 mm": 'nearest is "ms"',
            "flow.solver=nothing": '"none"',
            "body.bal.diameter=2 mm": "nearest:  body.ball.diameter",
            "body.diameter=2 mm": "example:  --set body.ball.diameter=\"2 mm\"",
            "valv.duration=2 ms": "nearest:  valve.duration",
            "run.end_time=[2 ms": "example:  end_time",
        }
        commands = (["check"], ["run", "-q"], ["run", "--dry-run"], ["plan"], ["jet", "-q"], ["study", "-q"], ["map", "-q"], ["sort", "-q"])
        for command in commands:
            for word, help in said.items():
                answer = ejecta(*command, self.case(), "--set", word)
                self.assertEqual(answer.returncode, 2, (command, word))
                self.assertIn(f"--set {word}: ", answer.stderr, command)
                self.assertIn(help, answer.stderr, (command, word))

    def test_cache_lists_and_clears_its_own_files_only(self):
        store = pathlib.Path("store")
        store.mkdir()
        (store / "jet-1.h5").write_bytes(b"0" * 1000)
        (store / "kept").mkdir()
        (store / "thesis.txt").write_text("not ours")
        self.assertIn("jet-1.h5", ejecta("cache", EJECTA_CACHE=str(store)).stdout)
        self.assertIn("jets removed: 1", ejecta("cache", "--clear", EJECTA_CACHE=str(store)).stdout)
        self.assertEqual(sorted(p.name for p in store.iterdir()), ["kept", "thesis.txt"])

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

    def test_a_case_that_cannot_start_neither_clears_a_run_nor_leaves_a_folder(self):
        self.assertEqual(ejecta("run", self.case(), "--quiet").returncode, 0)
        before = pathlib.Path("case.run/result.json").read_text()
        # Overlaps are found where the bodies are put in their places.
        wall = '[[wall]]\nname = "floor"\nmaterial = "stone"\n'
        broken = self.case(BOUNCE + 'material = "stone"\n[[material]]\nname = "stone"\n' + wall)
        self.assertEqual(ejecta("run", broken, "--quiet", "--force").returncode, 2)
        self.assertEqual(pathlib.Path("case.run/result.json").read_text(), before)
        self.assertEqual(ejecta("run", broken, "--quiet", "--out", "new.run").returncode, 2)
        self.assertFalse(pathlib.Path("new.run").exists())

    def test_at_rest_is_what_something_bears(self):
        text = BOUNCE.replace("end_time", 'until = "rest"\nend_time', 1) + 'position = ["0 mm", "0 mm", "50 mm"]\n'
        floor = '[[wall]]\nname = "floor"\n'
        # Held at its place for a moment, thrown up to its highest point, not yet released: none of them rests.
        for more in ("", 'velocity = ["0 m/s", "0 m/s", "0.3 m/s"]\n', 'release_at = "0.05 s"\n'):
            case = self.case(re.sub(r'end_time = "[^"]*"', 'end_time = "2 s"', text) + more + floor)
            self.assertEqual(ejecta("run", case, "--quiet", "--force", "--set", "output.report=false").returncode, 0)
            result = json.loads(pathlib.Path("case.run/result.json").read_text())
            self.assertAlmostEqual(result["bodies"][0]["final_position_m"][2], 0.005, delta=1e-4)
            self.assertLess(result["simulated_time_s"], 1.0)

    def test_check_looks_at_the_runs_of_a_study(self):
        study = '[study]\n[[study.vary]]\nkey = "body.0.diameeter"\nvalues = ["5 mm", "10 mm"]\n'
        answer = ejecta("check", self.case(BOUNCE + study))
        self.assertEqual(answer.returncode, 2, answer.stdout)
        self.assertIn("diameeter", answer.stderr)

    def test_the_resolved_case_of_a_run_can_be_run_again(self):
        self.assertEqual(ejecta("run", self.case(), "--quiet").returncode, 0)
        self.assertEqual(ejecta("run", "case.run/case.toml", "--quiet", "--out", "again.run").returncode, 0)
        self.assertEqual(
            pathlib.Path("case.run/case.toml").read_text(), pathlib.Path("again.run/case.toml").read_text()
        )

    def test_warnings_show_their_line_and_quiet_hides_them(self):
        case = self.case(BOUNCE + 'release_at = "2 ms"\n')
        answer = ejecta("run", case)
        self.assertIn("case.toml:8: warning: body.0.release_at: the body is never released", answer.stderr)
        self.assertEqual(ejecta("run", case, "--quiet", "--force").stderr, "")

    def test_no_color_and_a_log_have_no_escapes(self):
        for environment in ({}, {"NO_COLOR": "1"}):
            answer = ejecta("run", self.case(), "--force", **environment)
            self.assertNotIn("\x1b", answer.stdout + answer.stderr)

    def test_verbose_is_a_line_every_step(self):
        quiet, verbose = (ejecta("run", self.case(), "--force", *more).stderr.splitlines() for more in ([], ["-v"]))
        steps = json.loads(pathlib.Path("case.run/result.json").read_text())["steps"]
        self.assertGreaterEqual(len(verbose), steps)
        self.assertLess(len(quiet), 6)

    def test_lines_and_slices_are_recorded_at_the_slice_interval_also_without_a_report(self):
        answer = ejecta("run", self.case(STREAM), "--quiet")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        lines = pathlib.Path("case.run/history/line-along.csv").read_text().splitlines()
        self.assertRegex(lines[0], r"^# ejecta \d")
        rows = [line for line in lines if not line.startswith("#")]
        self.assertEqual(
            rows[0],
            "time [s],position [m],velocity_x [m/s],velocity_y [m/s],velocity_z [m/s],pressure [Pa],total_pressure [Pa]",
        )
        values = [[float(cell) for cell in row.split(",")] for row in rows[1:]]
        self.assertEqual([row[0] for row in values], [t * 1e-3 for t in range(4) for _ in range(4)])
        for row, position in zip(values, [0, 6e-3, 12e-3, 18e-3] * 4):
            self.assertAlmostEqual(row[1], position)
            self.assertAlmostEqual(row[2], 2.0, places=5)
        self.assertEqual(len(list(pathlib.Path("case.run/fields").glob("slice-side-*.vtr"))), 4)
        fields = pathlib.Path("case.run/fields/air-000000.vtr").read_bytes()
        self.assertIn(b'Name="velocity"', fields)
        self.assertNotIn(b'Name="pressure"', fields)
        self.assertFalse(pathlib.Path("case.run/replay.jsonl").exists())

    def test_resume_refuses_another_case(self):
        case = self.case(BOUNCE + "[checkpoint]\nevery_steps = 1\n")
        self.assertEqual(ejecta("run", case, "--quiet").returncode, 0)
        answer = ejecta("run", case, "--resume", "--set", "body.0.diameter=9 mm")
        self.assertEqual(answer.returncode, 2)
        self.assertIn("another case: body.0.diameter changed", answer.stderr)
        self.assertEqual(ejecta("run", case, "--resume", "--set", "run.end_time=2 ms").returncode, 0)
        self.assertEqual(json.loads(pathlib.Path("case.run/result.json").read_text())["simulated_time_s"], 0.002)

    def flight(self, *bodies, end="200 ms"):
        """Balls that fly over or under a plate at x, z = 250, -10 mm, without air."""
        text = f'[run]\nuntil = "verdict"\nend_time = "{end}"\n[flow]\nsolver = "none"\n'
        text += '[splitter]\nedge = ["250 mm", "-10 mm"]\nsolid = false\n'
        for n, (height, wanted) in enumerate(bodies):
            text += f'[[body]]\nname = "ball{n}"\ndiameter = "5 mm"\nposition = ["0 m", "{20 * n} mm", "{height} mm"]\n'
            text += f'velocity = ["3 m/s", "0 m/s", "0 m/s"]\nwanted = {wanted}\n'
        return self.case(text)

    def test_the_verdict_says_what_was_wanted(self):
        # 250 mm at 3 m/s are 83 ms, in which a body falls 34 mm.
        case = self.flight((40, "true"), (40, "false"), (0, "true"), (0, "false"))
        answer = ejecta("run", case)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("Of 4 bodies 2 right (ball0, ball3), 1 by-catch (ball1), 1 missed (ball2).", answer.stdout)
        result = json.loads(pathlib.Path("case.run/result.json").read_text())
        self.assertEqual([b["judgement"] for b in result["bodies"]], ["right", "by-catch", "missed", "right"])
        self.assertEqual(result["plate"]["edge_from_nozzle_m"], [0.25, -0.01])

    def test_only_a_verdict_is_exit_code_zero_and_the_run_can_go_on(self):
        case = self.flight((40, "true"), end="30 ms")
        self.assertIn("run.end_time: the run ends at 30 ms, before any body comes to the plate", ejecta("check", case).stdout)
        answer = ejecta("run", case)
        self.assertEqual(answer.returncode, 6)
        self.assertIn("ball0 is undecided: the time limit of 30 ms came before it reached the plate.", answer.stdout)
        advice = [line for line in answer.stderr.splitlines() if "--resume" in line][-1].strip()
        self.assertRegex(advice, r"^ejecta run case.toml --set 'run.end_time=\d+ ms' --out case.run --resume$")
        answer = subprocess.run(advice.replace("ejecta", EJECTA, 1), shell=True, capture_output=True, text=True)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("ball0 is right", answer.stdout)

    def test_resume_of_a_finished_run_computes_nothing(self):
        case = self.flight((40, "true"))
        self.assertEqual(ejecta("run", case, "--quiet").returncode, 0)
        before = {p: p.read_bytes() for p in pathlib.Path("case.run").rglob("*") if p.is_file()}
        answer = ejecta("run", case, "--resume")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("case.run is finished: nothing to compute", answer.stdout)
        self.assertIn("ball0 is right", answer.stdout)
        self.assertEqual({p: p.read_bytes() for p in pathlib.Path("case.run").rglob("*") if p.is_file()}, before)
        self.assertEqual(ejecta("run", case, "--resume", "--set", "body.0.diameter=4 mm").returncode, 2)

    def test_what_set_changed_stands_in_everything_the_run_leaves(self):
        self.assertEqual(ejecta("run", self.case(), "--quiet", "--set", "run.end_time=2 ms", "--set", "body.ball.mass=1 g").returncode, 0)
        manifest = json.loads(pathlib.Path("case.run/manifest.json").read_text())
        self.assertEqual(manifest["command"], "ejecta run case.toml --set 'run.end_time=2 ms' --set 'body.ball.mass=1 g'")
        self.assertEqual(manifest["set"], ["run.end_time=2 ms", "body.ball.mass=1 g"])
        self.assertIn("# set run.end_time=2 ms\n", pathlib.Path("case.run/history/body-ball.csv").read_text())
        self.assertIn("run.end_time=2 ms", pathlib.Path("case.run/report.html").read_text())

    def test_results_as_a_table(self):
        case = self.case()
        for time in ("1 ms", "2 ms"):
            ejecta("run", case, "--set", f"run.end_time={time}", "--out", f"{time[0]}.run", "-q")
        answer = ejecta("table", "1.run", "2.run")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        rows = list(csv.DictReader(pathlib.Path("results.csv").read_text().splitlines()))
        self.assertEqual([row["run"] for row in rows], ["1.run", "2.run"])
        self.assertEqual([row["run.end_time"] for row in rows], ["1 ms", "2 ms"])
        result = json.loads(pathlib.Path("2.run/result.json").read_text())["bodies"][0]
        self.assertEqual(float(rows[1]["final_position_z [m]"]), result["final_position_m"][2])
        self.assertEqual(float(rows[1]["mass [kg]"]), result["mass_kg"])
        for words in (["1.run", "--out", "x.txt"], ["nothing.run"]):
            answer = ejecta("table", *words)
            self.assertEqual(answer.returncode, 2)
            self.assertIn("expected:", answer.stderr)
        answer = ejecta("table", "1.run", "--out", "one.xlsx")
        if "built without" in answer.stderr:
            return
        self.assertEqual(answer.returncode, 0, answer.stderr)
        with zipfile.ZipFile("one.xlsx") as book:
            sheets = re.findall(r'<sheet name="([^"]+)"', book.read("xl/workbook.xml").decode())
            history = book.read("xl/worksheets/sheet2.xml").decode()
        self.assertEqual(sheets, ["results", "body-ball", "ledger"])
        written = [float(row.split(",")[3]) for row in pathlib.Path("1.run/history/body-ball.csv").read_text().splitlines() if row[0].isdigit()]
        numbers = [float(cell) for cell in re.findall(r'<c r="D\d+"><v>([^<]+)</v>', history)]
        self.assertEqual(len(numbers), len(written))
        self.assertTrue(all(abs(a - b) <= 1e-15 * abs(b) for a, b in zip(numbers, written)))

    def test_a_case_in_doubtful_units_is_asked_about(self):
        for key, value, words in (
            ("body.0.density", "3.400 kg/m3", "less than a foam's"),
            ("body.0.density", "2700 g/cm3", "more than any metal's"),
            ("body.0.diameter", "1 m", "grams rather than tonnes?"),
        ):
            answer = ejecta("check", self.case(), "--set", f"{key}={value}")
            self.assertEqual(answer.returncode, 0, answer.stderr)
            self.assertIn(words, answer.stdout)

    def test_a_printed_page_that_cannot_be_written_is_a_failure(self):
        with open("/dev/full", "w") as full:
            answer = subprocess.run([EJECTA, "explain"], stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(answer.returncode, 1)
        self.assertIn("No space left", answer.stderr)

    def test_validate_adds_the_comparison_to_the_result(self):
        ejecta("validate", self.case(BOUNCE + '[[expect]]\nquantity = "/steps"\nat_least = 1\n'))
        result = json.loads(pathlib.Path("validation.runs/case.run/result.json").read_text())
        self.assertTrue(result["expectations"][0]["pass"])


if __name__ == "__main__":
    unittest.main()
