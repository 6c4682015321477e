#!/usr/bin/python3
"""Campaigns as a user meets them. Usage: campaign_test.py EJECTA"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

EJECTA = os.path.abspath(sys.argv[1])

FALL = """[run]
title = "a ball falls on a floor"
end_time = "{end}"
[flow]
solver = "none"
[[body]]
name = "ball"
diameter = "10 mm"
[[wall]]
name = "floor"
point = ["0 mm", "0 mm", "-20 mm"]
"""
STUDY = """
[study]
keep_runs = false
quantities = ["/bodies/0/final_velocity_m_s/2"]
[[study.vary]]
key = "body.ball.diameter"
values = ["8 mm", "9 mm"]
"""
CAMPAIGN = """[campaign]
title = "Balls"
[[campaign.part]]
case = "fall.toml"
figures = "Figure 1"
[[campaign.part]]
kind = "study"
case = "many.toml"
title = "Two sizes"
[[campaign.part]]
case = "fall.toml"
title = "A heavier one"
set = ["body.ball.density=8000 kg/m3"]
"""


class Campaign(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ejecta-campaign-"))
        (self.folder / "fall.toml").write_text(FALL.format(end="50 ms"))
        (self.folder / "many.toml").write_text(FALL.format(end="20 ms") + STUDY)
        (self.folder / "balls.toml").write_text(CAMPAIGN)

    def tearDown(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def ejecta(self, *words, code=0):
        done = subprocess.run([EJECTA, *words], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, code, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def result(self):
        return json.loads((self.folder / "balls.campaign/result.json").read_text())

    def times(self):
        return {p: p.stat().st_mtime_ns for p in (self.folder / "balls.campaign").rglob("*") if p.parent.name != "balls.campaign"}

    def test_every_part_is_run_once_and_reported(self):
        self.assertIn("balls.toml", self.ejecta("check", "balls.toml"))
        lines = self.ejecta("campaign", "balls.toml", "--print-commands").splitlines()
        self.assertEqual(len(lines), 3)
        self.assertIn("ejecta study", lines[1])
        self.assertIn("'body.ball.density=8000 kg/m3'", lines[2])
        self.assertFalse((self.folder / "balls.campaign").exists())

        self.ejecta("campaign", "balls.toml")
        parts = self.result()["parts"]
        self.assertEqual([p["done"] for p in parts], [True] * 3)
        self.assertEqual([p["title"] for p in parts], ["a ball falls on a floor", "Two sizes", "A heavier one"])
        self.assertEqual(len(parts[1]["result"]["runs"]), 2)
        for p in parts:
            self.assertTrue((self.folder / "balls.campaign" / p["directory"] / "report.html").exists())
        page = (self.folder / "balls.campaign/report.html").read_text()
        for text in ("Balls", "Two sizes", "A heavier one", "Figure 1"):
            self.assertIn(text, page)
        heavier = json.loads((self.folder / "balls.campaign/03-fall/result.json").read_text())
        plain = json.loads((self.folder / "balls.campaign/01-fall/result.json").read_text())
        self.assertGreater(heavier["bodies"][0]["mass_kg"], 2 * plain["bodies"][0]["mass_kg"])

        before = self.times()
        self.ejecta("campaign", "balls.toml")
        self.assertEqual(self.times(), before)

    def test_a_sorter_is_a_part_and_can_be_studied(self):
        tutorial = pathlib.Path(__file__).resolve().parents[2] / "cases/sorter/tutorial.toml"
        sorter = f'extends = "{tutorial}"\n[sorter]\nparticles = 200\n'
        loads = '[study]\n[[study.vary]]\nkey = "sorter.throughput"\nvalues = ["4 t/h", "16 t/h"]\n'
        (self.folder / "sorter.toml").write_text(sorter)
        (self.folder / "loads.toml").write_text(sorter + loads)
        (self.folder / "machines.toml").write_text(
            '[campaign]\n[[campaign.part]]\nkind = "sort"\ncase = "sorter.toml"\n'
            '[[campaign.part]]\nkind = "study"\ncase = "loads.toml"\n')
        self.ejecta("campaign", "machines.toml")
        one, many = json.loads((self.folder / "machines.campaign/result.json").read_text())["parts"]
        self.assertIn("recovery", one["summary"])
        few, more = many["result"]["runs"]
        self.assertGreater(few["/purity"], more["/purity"])
        self.assertIn("purity", (self.folder / "machines.campaign/report.html").read_text())
        self.assertIn("ejecta sort", self.ejecta("run", "sorter.toml", code=2))
        (self.folder / "wrong.toml").write_text('[campaign]\n[[campaign.part]]\ncase = "sorter.toml"\n')
        self.assertIn("is a whole sorter", self.ejecta("campaign", "wrong.toml", code=2))

    def test_stopped_it_goes_on(self):
        (self.folder / "fall.toml").write_text(FALL.format(end="30 s"))
        work = subprocess.Popen([EJECTA, "campaign", "balls.toml", "--quiet"], cwd=self.folder, stderr=subprocess.DEVNULL)
        limit = time.time() + 60
        while not list((self.folder / "balls.campaign").glob("01-fall/history/*.csv")) and time.time() < limit:
            time.sleep(0.02)
        time.sleep(0.3)
        work.send_signal(signal.SIGTERM)
        self.assertEqual(work.wait(60), 4)
        self.assertFalse((self.folder / "balls.campaign/01-fall/result.json").exists())
        command = self.ejecta("campaign", "balls.toml", "--print-commands").splitlines()[0]
        self.assertTrue(command.endswith("--resume"), command)

    def test_what_cannot_work_is_refused_before_the_first_part(self):
        def refused(text, *said):
            (self.folder / "bad.toml").write_text(text)
            answer = self.ejecta("campaign", "bad.toml", code=2)
            for one in said:
                self.assertIn(one, answer)
            self.assertFalse((self.folder / "bad.campaign").exists())

        refused("[campaign]\ntitle = 'x'\n", "[[campaign.part]]")
        refused(CAMPAIGN.replace("many.toml", "none.toml"), "bad.toml:8", "none.toml")
        refused(CAMPAIGN.replace('kind = "study"', 'kind = "map"'), "part 2", "no [map]")
        refused(CAMPAIGN.replace("density=8000 kg/m3", "density=8000 kg"), "density")
        refused(CAMPAIGN + "[run]\nend_time = '1 s'\n", "run.end_time", "does nothing here")
        refused(FALL.format(end="1 ms"), "has no [campaign]")
        self.assertIn("ejecta campaign", self.ejecta("run", "balls.toml", code=2))

    def test_a_part_that_fails_is_named_and_the_others_go_on(self):
        (self.folder / "balls.campaign").mkdir()
        (self.folder / "balls.campaign/01-fall").write_text("in the way")
        self.ejecta("campaign", "balls.toml", code=2)
        parts = self.result()["parts"]
        self.assertEqual([p["done"] for p in parts], [False, True, True])
        self.assertIn("exit code 2", parts[0]["problem"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
