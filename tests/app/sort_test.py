#!/usr/bin/python3
"""A whole sorter as a user runs it: the same bits on one and two threads and after kills; nothing is lost; what is wrong
is refused. Usage: sort_test.py EJECTA [KILLS]"""

import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

KILLS = int(sys.argv.pop()) if len(sys.argv) > 2 else 3
EJECTA = os.path.abspath(sys.argv.pop())
CASE = pathlib.Path(__file__).resolve().parents[2] / "cases" / "sorter" / "tutorial.toml"


def sort(directory, *more):
    return subprocess.run([EJECTA, "sort", str(CASE), "--out", str(directory), "-q", *more], capture_output=True, text=True)


def result_of(directory):
    result = json.loads((directory / "result.json").read_text())
    del result["wall_time_s"], result["particles_per_s"]
    return result


class Sort(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.dir = pathlib.Path(self.place.name)

    def test_threads_give_the_same_bits(self):
        for threads in "12":
            done = sort(self.dir / threads, "--threads", threads)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(result_of(self.dir / "1"), result_of(self.dir / "2"))

    def test_every_particle_is_in_one_product(self):
        self.assertEqual(sort(self.dir / "a").returncode, 0)
        r = result_of(self.dir / "a")
        products = r["products"]
        self.assertEqual(products["ejected"]["particles"] + products["kept"]["particles"], r["particles"])
        self.assertAlmostEqual(products["ejected"]["mass_kg"] + products["kept"]["mass_kg"], r["fed_kg"], delta=1e-9 * r["fed_kg"])
        self.assertEqual(sum(f["number"] for f in r["fates"]), r["particles"])
        self.assertEqual(sum(c["particles"] for c in r["classes"]), r["particles"])
        for share in ("recovery", "purity", "loss", "recovery_mass", "purity_mass", "loss_mass", "standing_alone"):
            self.assertTrue(r[share + "_low"] <= r[share] <= r[share + "_high"], share)

    def test_kills_change_nothing(self):
        long = ("--set", "sorter.particles=30000")
        self.assertEqual(sort(self.dir / "whole", *long).returncode, 0)
        chance = random.Random(1)
        for n in range(KILLS):
            run = subprocess.Popen([EJECTA, "sort", str(CASE), "--out", str(self.dir / "killed"), "-q", *long])
            time.sleep(chance.uniform(0.05, 0.6))
            run.send_signal(chance.choice([signal.SIGKILL, signal.SIGTERM]))
            run.wait()
        done = sort(self.dir / "killed", *long)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(result_of(self.dir / "whole"), result_of(self.dir / "killed"))

    def test_a_feeder_gives_the_same_bits_on_any_threads_and_after_kills(self):
        feeder = ("--set", 'sorter.feed.presentation="feeder"', "--set", 'sorter.throughput="0.3 t/h"', "--set", "sorter.particles=60")
        self.assertEqual(sort(self.dir / "whole", *feeder, "--threads", "1").returncode, 0)
        chance = random.Random(2)
        for n in range(KILLS):
            run = subprocess.Popen([EJECTA, "sort", str(CASE), "--out", str(self.dir / "killed"), "-q", *feeder])
            time.sleep(chance.uniform(0.05, 2.0))
            run.send_signal(chance.choice([signal.SIGKILL, signal.SIGTERM]))
            run.wait()
        done = sort(self.dir / "killed", *feeder, "--threads", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(result_of(self.dir / "whole"), result_of(self.dir / "killed"))
        self.assertGreater(result_of(self.dir / "whole")["particles"], 30)

    def test_another_case_is_refused_without_force(self):
        self.assertEqual(sort(self.dir / "a").returncode, 0)
        other = sort(self.dir / "a", "--set", "sorter.seed=5")
        self.assertEqual(other.returncode, 2)
        self.assertIn("--force", other.stderr)
        self.assertEqual(sort(self.dir / "a", "--set", "sorter.seed=5", "--force").returncode, 0)

    def test_a_case_without_sorter_is_refused(self):
        case = CASE.parents[1] / "paper" / "10mm-cubic.toml"
        done = subprocess.run([EJECTA, "sort", str(case), "--out", str(self.dir / "a")], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("[sorter]", done.stderr)


if __name__ == "__main__":
    unittest.main()
