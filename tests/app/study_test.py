#!/usr/bin/python3
"""Studies as a user meets them: tasks, kills, failures. Usage: study_test.py EJECTA [KILLS [TASKS]]

KILLS (default 6): SIGKILLs of the driver and of tasks at random moments; TASKS (default 200): of a trivial case,
for the time a task costs.
"""

import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

EJECTA = os.path.abspath(sys.argv[1])
KILLS = int(sys.argv[2]) if len(sys.argv) > 2 else 6
TASKS = int(sys.argv[3]) if len(sys.argv) > 3 else 200

FALL = """[run]
title = "a ball falls on a floor"
end_time = "{end}"
[flow]
solver = "none"
[output]
report = false
[[body]]
name = "ball"
diameter = "10 mm"
[[wall]]
name = "floor"
point = ["0 mm", "0 mm", "-20 mm"]
"""
VARY = """
[study]
quantities = ["/bodies/0/final_velocity_m_s/2", "/bodies/0/max_contact_force_N"]
keep_runs = {keep}
[[study.vary]]
key = "environment.gravity"
from = ["0 m/s2", "0 m/s2", "-1 m/s2"]
to = ["0 m/s2", "0 m/s2", "-20 m/s2"]
steps = {count}
"""


class Study(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ejecta-study-"))

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def case(self, count=12, end="200 ms", keep="false", more=""):
        path = self.folder / "fall.toml"
        path.write_text(FALL.format(end=end) + VARY.format(count=count, keep=keep) + more)
        return str(path)

    def ejecta(self, *words, code=0, **how):
        done = subprocess.run([EJECTA, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=1200, **how)
        self.assertEqual(done.returncode, code, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def result(self, name):
        return (self.folder / name / "result.json").read_text()

    def test_runs_every_task_and_makes_a_table(self):
        self.ejecta("study", self.case(keep="true"), "--out", "s")
        result = json.loads(self.result("s"))
        self.assertEqual([run["state"] for run in result["runs"]], ["done"] * 12)
        self.assertEqual(result["runs"][11]["environment.gravity.z"], -20)
        speeds = [run["/bodies/0/final_velocity_m_s/2"] for run in result["runs"]]
        self.assertTrue(all(isinstance(v, float) for v in speeds))
        table = (self.folder / "s/runs.csv").read_text().splitlines()
        self.assertEqual(len(table), 13)
        self.assertTrue(table[0].startswith("run,state,environment.gravity.x [m/s2],"))
        run = self.folder / "s" / result["runs"][3]["directory"]
        self.assertTrue((run / "result.json").exists())
        self.assertIn("12 of 12 runs done", self.ejecta("study", "status", "s"))
        # A second call has nothing to do; the index of results can be made again from the folders.
        before = self.result("s")
        (self.folder / "s/result.json").unlink()
        (self.folder / "s/runs.csv").unlink()
        self.ejecta("study", "collect", "s")
        self.assertEqual(self.result("s"), before)

    def test_a_quantity_that_no_run_has_is_told(self):
        case = self.case(count=2)
        said = self.ejecta("study", case, "--out", "s", "--set", 'study.quantities=["/bodies/0/max_contact_force"]')
        self.assertIn('no run has the quantity "/bodies/0/max_contact_force"', said)
        self.assertIn('did you mean "/bodies/0/max_contact_force_N"?', said)

    def test_any_launcher_can_run_the_tasks(self):
        case = self.case()
        self.ejecta("study", case, "--out", "whole")
        commands = self.ejecta("study", case, "--out", "parts", "--print-commands").splitlines()
        self.assertEqual(len(commands), 12)
        for command in reversed(commands[:9]):
            words = command.split()
            self.assertEqual(words[:3], ["ejecta", "study", "run-task"])
            self.ejecta(*words[1:])
        self.ejecta("study", case, "--out", "parts")  # fills the holes
        self.assertEqual(self.result("parts"), self.result("whole"))

    def test_kills_lose_nothing(self):
        self.kill_at_random(0.4, count=16, end="2 s", keep="true")

    def test_kills_lose_nothing_of_many(self):
        self.kill_at_random(0.0004 * TASKS, count=TASKS, end="10 ms")

    def kill_at_random(self, longest, **study):
        case = self.case(**study)
        self.ejecta("study", case, "--out", "whole")
        draw = random.Random(5)
        for _ in range(KILLS):
            driver = subprocess.Popen([EJECTA, "study", case, "--out", "killed", "-q"], cwd=self.folder,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(draw.uniform(0.0, longest))
            children = subprocess.run(["pgrep", "-P", str(driver.pid)], capture_output=True, text=True).stdout.split()
            victim = driver.pid if draw.random() < 0.6 or not children else int(draw.choice(children))
            try:
                os.kill(victim, signal.SIGKILL)
            except ProcessLookupError:
                pass
            if victim != driver.pid:
                time.sleep(0.05)
                driver.send_signal(signal.SIGTERM)
            driver.wait(timeout=60)
            if draw.random() < 0.5:
                for name in ("result.json", "runs.csv"):
                    (self.folder / "killed" / name).unlink(missing_ok=True)
        self.ejecta("study", case, "--out", "killed")
        self.assertEqual(self.result("killed"), self.result("whole"))
        for one in (self.folder / "killed/results").iterdir():
            a, b = (json.loads((self.folder / name / "results" / one.name).read_text())["result"] for name in ("killed", "whole"))
            for timing in ("wall_time_s", "operators", "cell_steps_per_s"):
                a.pop(timing), b.pop(timing)
            self.assertEqual(a, b)

    def test_a_task_that_fails_is_told_and_the_rest_goes_on(self):
        case = self.case()
        self.ejecta("study", case, "--out", "s", "--print-commands")
        tasks = [json.loads(line)["hash"] for line in (self.folder / "s/tasks.jsonl").read_text().splitlines()]
        with open(self.folder / f"s/cases/{tasks[4]}.toml", "a") as file:
            file.write("\n[domain]\nx = [\"-1 m\", \"1 m\"]\n")
        text = self.ejecta("study", case, "--out", "s", code=1)
        self.assertIn("11 of 12 runs done, 1 failed", text)
        self.assertIn("run 5 refused", text)
        self.assertEqual(json.loads(self.result("s"))["runs"][4]["state"], "refused")

    def test_a_crash_is_told_and_tried_again(self):
        case = self.case(count=4, end="500 s")
        self.ejecta("study", case, "--out", "s", "--print-commands")
        driver = subprocess.Popen([EJECTA, "study", case, "--out", "s", "-q", "--at-once", "1"], cwd=self.folder,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        def child():
            for _ in range(200):
                found = subprocess.run(["pgrep", "-P", str(driver.pid)], capture_output=True, text=True).stdout.split()
                if found:
                    return int(found[0])
                time.sleep(0.02)
            self.fail("no task was started")
        first = child()
        time.sleep(0.5)
        self.assertIn("1 running", self.ejecta("study", "status", "s"))
        os.kill(first, signal.SIGKILL)
        time.sleep(0.5)
        self.assertIn("crashed: ended by signal 9", self.ejecta("study", "status", "s"))
        self.assertNotEqual(child(), first)  # the next one
        self.ejecta("study", "stop", "s")
        self.assertEqual(driver.wait(timeout=30), 4)

    def test_a_full_disk_loses_nothing(self):
        case = self.case(end="20 ms", more="", keep="false")
        self.ejecta("study", case, "--out", "whole")
        self.ejecta("study", case, "--out", "full", "--print-commands")
        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        done = subprocess.run([EJECTA, "study", case, "--out", "full"], cwd=self.folder, capture_output=True, text=True,
                              preexec_fn=small_files)
        self.assertNotEqual(done.returncode, 0)
        self.ejecta("study", case, "--out", "full")
        self.assertEqual(self.result("full"), self.result("whole"))

    def test_refusals_come_before_the_first_run(self):
        bad = self.case(more="[[study.vary]]\nkey = \"body.ball.diameter\"\nvalues = [\"10 mm\", \"-3 mm\"]\n")
        text = self.ejecta("study", bad, "--out", "s", code=2)
        self.assertIn("\"-3 mm\" is out of range", text)
        self.assertIn("^", text)
        self.assertFalse((self.folder / "s").exists())
        plain = self.folder / "plain.toml"
        plain.write_text(FALL.format(end="1 ms"))
        self.assertIn("no [study]", self.ejecta("study", plain, code=2))
        self.assertIn("no [map]", self.ejecta("map", plain, code=2))
        self.ejecta("study", self.case(), "--out", "s")
        self.assertIn("another study", self.ejecta("study", self.case(count=5), "--out", "s", code=2))
        self.assertIn("there is no task 12", self.ejecta("study", "run-task", "s", "12", code=2))
        self.assertIn("no study.json", self.ejecta("study", "status", ".", code=2))
        self.ejecta("study", code=2)

    def test_time_of_a_task_and_of_a_status(self):
        case = self.case(count=TASKS, end="1 ms")
        start = time.time()
        self.ejecta("study", case, "--out", "s", "--print-commands")
        setup = time.time() - start
        start = time.time()
        self.ejecta("study", case, "--out", "s", "--at-once", "1", "-q")
        task = (time.time() - start - setup) / TASKS
        start = time.time()
        self.assertIn(f"{TASKS} of {TASKS} runs done", self.ejecta("study", "status", "s"))
        status = time.time() - start
        print(f"{TASKS} tasks: {1e3 * setup / TASKS:.2f} ms to set up, {1e3 * task:.1f} ms to run one after the other; "
              f"status {1e3 * status:.0f} ms")
        self.assertLess(status, 1.0)
        self.assertLess(task, 0.1)  # 20 ms on a machine that has nothing else to do


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
