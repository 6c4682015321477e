"""The module `ejecta`: module_test.py PROGRAM SOURCE SCRATCH, with the built package on PYTHONPATH. Under Debian's python3."""

import ctypes
import inspect
import io
import json
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest
import unittest.mock
import urllib.request
from pathlib import Path

import numpy

program, source, scratch = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
small = source / "tests" / "app" / "small-ejection.toml"

# What a host has before the import, for HostIsUntouched.
SMALLEST = numpy.float32(1e-38)


def host():
    return {
        "signals": [signal.getsignal(s) for s in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1)],
        "denormals": float(SMALLEST * numpy.float32(0.01)),
        "rounding": ctypes.CDLL(None).fegetround(),
        "threads": len(os.listdir("/proc/self/task")),
        "environment": dict(os.environ),
        "folder": os.getcwd(),
    }


before = host()
import ejecta  # noqa: E402

after = host()

BALL = {
    "run": {"end_time": "20 ms", "title": "a ball falls"},
    "flow": {"solver": "none"},
    "material": [{"name": "ore", "density": 2700}],
    "body": [{"name": "ball", "shape": "sphere", "diameter": 0.01, "material": "ore", "position": [0, 0, 0.02]}],
    "output": {"report": False},
}
COSTS = ("wall_time_s", "cell_steps_per_s", "operators", "threads")  # of a result: differ from run to run


def physics(quantities):
    """Without what it cost, and how the case was written."""
    return {name: value for name, value in quantities.items() if name not in (*COSTS, "inputs")}


def place(name):
    path = scratch / name
    shutil.rmtree(path, ignore_errors=True)
    return path


def short(end="1 ms"):
    case = ejecta.Case.load(small)
    case.update({"run.end_time": end, "output.report": False})
    return case


class HostIsUntouched(unittest.TestCase):
    def test_import(self):
        self.assertEqual(before, after)

    def test_run(self):
        ejecta.run(short(), threads=2)
        now = host()
        now["threads"] = before["threads"]  # those of the run wait for the next
        self.assertEqual(before, now)
        self.assertGreater(now["denormals"], 0.0)


class BodiesThatComeLater(unittest.TestCase):
    """A body that enters after the start has shorter histories, and none before it came."""

    def test_with_and_without_files(self):
        case = json.loads(json.dumps(BALL))
        later = {**case["body"][0], "name": "later", "position": [0.05, 0, 0.02], "enters_at": "10 ms"}
        case["body"].append(later)
        directory = place("later.run")
        result = ejecta.run(ejecta.Case(case), out=directory)
        kept = ejecta.run(ejecta.Case(case))
        run = ejecta.Run(directory)
        self.assertEqual(run.histories(), kept.histories())
        early, late = run.history("body-ball"), run.history("body-later")
        self.assertAlmostEqual(early["time"][0], 0.0)
        self.assertTrue(numpy.isfinite(late["z"]).all())
        self.assertAlmostEqual(late["z"][-1], 0.02 - 0.5 * 9.81 * 0.01**2, delta=1e-5)
        numpy.testing.assert_array_equal(late["z"], kept.history("body-later")["z"])
        self.assertEqual(len(result.quantities["bodies"]), 2)


class SameBits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = place("command.run")
        subprocess.run([program, "run", small, "--set", "run.end_time=3 ms", "--out", cls.directory, "-q"], check=False)
        cls.command = json.loads((cls.directory / "result.json").read_text())

    def test_without_files(self):
        result = ejecta.run(short("3 ms"), threads=1)
        self.assertEqual(physics(result.quantities), physics(self.command))
        run = ejecta.Run(self.directory)
        self.assertEqual(result.histories(), run.histories())
        for name in run.histories():
            mine, files = result.history(name), run.history(name)
            self.assertEqual(mine.units, files.units)
            for column in files:
                numpy.testing.assert_array_equal(mine[column], files[column], f"{name} {column}")

    def test_with_files(self):
        directory = place("module.run")
        case = short("3 ms")
        del case["output.report"]
        result = ejecta.run(case, out=directory, threads=2)
        said = ejecta.Job(directory).progress()
        self.assertEqual((said["state"], said["process"]), ("done", 0))  # nobody may end this process for it
        self.assertEqual(physics(result.quantities), physics(self.command))
        self.assertEqual((directory / "case.toml").read_text(), (self.directory / "case.toml").read_text())
        for file in (self.directory / "history").iterdir():
            mine = (directory / "history" / file.name).read_text()
            data = [line for line in mine.splitlines() if not line.startswith("#")]
            self.assertEqual(data, [line for line in file.read_text().splitlines() if not line.startswith("#")])
        command = json.loads((directory / "manifest.json").read_text())["command"]
        self.assertIn("run.end_time", command)
        again = ejecta.run(case, out=directory, resume=True)
        self.assertEqual(again.quantities, result.quantities, "a finished run is not computed again")
        with self.assertRaisesRegex(ejecta.InputError, "already holds a run"):
            ejecta.run(case, out=directory)

    def test_fields_are_those_of_the_files(self):
        result = ejecta.run(short("3 ms"), fields=True)
        air = ejecta.Run(self.directory).field("air", -1)  # written at 3 ms
        for name, field in result.fields.items():
            numpy.testing.assert_array_equal(field, air[name], name)
        self.assertEqual(result.fields["velocity"].shape, (30, 24, 30, 3))
        self.assertEqual(result.fields["velocity"].unit, "m/s")
        self.assertEqual([len(c) for c in result.centres], [30, 24, 30])
        self.assertIsNotNone(numpy.asarray(result.fields["velocity"]).base, "a view, not a copy")

    def test_the_saved_case_is_the_same_case(self):
        file = scratch / "saved.toml"
        short("0.5 ms").save(file)
        self.assertEqual(physics(ejecta.run(file).quantities), physics(ejecta.run(short("0.5 ms")).quantities))


class Errors(unittest.TestCase):
    def raised(self, act):
        with self.assertRaises(ejecta.CaseError) as caught:
            act()
        return caught.exception

    def test_words_of_the_command_line(self):
        bad = scratch / "bad.toml"
        bad.write_text(small.read_text().replace('duration = "8 ms"', 'duration = "8 mm"').replace("[valve]", "[valve]\nrise = 3"))
        said = subprocess.run([program, "check", bad], capture_output=True, text=True)
        error = self.raised(lambda: ejecta.check(bad))
        self.assertEqual(str(error).strip(), said.stderr.strip())
        self.assertEqual(said.returncode, 2)
        keys = {problem["key"]: problem for problem in error.problems}
        self.assertEqual(set(keys), {"valve.rise", "valve.duration"})
        line = bad.read_text().splitlines().index('duration = "8 mm"') + 1
        self.assertEqual(keys["valve.duration"]["line"], line)
        self.assertIn("a time", keys["valve.duration"]["expected"])
        self.assertEqual(keys["valve.rise"]["nearest"], "rise_time")

    def test_setting(self):
        case = short()
        pressure = case["valve.supply_pressure"]
        for value in ("6 bar", "six", -1.0, float("nan"), [1, 2], {"a": 1}, True, ""):
            error = self.raised(lambda: case.__setitem__("valve.supply_pressure", value))
            self.assertEqual(error.key, "valve.supply_pressure")
            self.assertIn("a pressure", error.expected)
            self.assertIn("valve.supply_pressure", str(error))
        self.assertEqual(case["valve.supply_pressure"], pressure, "nothing has changed")
        self.assertIn("supply_pressure", str(self.raised(lambda: case.__setitem__("valve.suply_pressure", 1.0))))
        self.assertIn("valve.duration", str(self.raised(lambda: case["valve.duratio"])))
        self.assertIn("body", str(self.raised(lambda: case.__setitem__("body.nobody.density", 1.0))))
        with self.assertRaisesRegex(TypeError, "has no place in a case"):
            case["valve.duration"] = object()

    def test_several_at_once_are_all_or_none(self):
        case = short()
        duration = case["valve.duration"]
        self.raised(lambda: case.update({"valve.duration": "5 ms", "valve.rise_time": "soon"}))
        self.assertEqual(case["valve.duration"], duration)

    def test_what_contradicts_is_said_when_it_is_used(self):
        case = short()
        case["launch.stand_off"] = "200 mm"  # outside the box
        self.raised(lambda: ejecta.check(case))
        self.raised(lambda: ejecta.run(case))
        self.raised(lambda: ejecta.submit(case, out=place("never.run")))

    def test_files(self):
        with self.assertRaises(ejecta.InputError):
            ejecta.Case.load("no-such-case.toml")
        with self.assertRaisesRegex(ejecta.InputError, "checkpoint|directory"):
            ejecta.run(short(), out=place("nothing.run"), resume=True)

    def test_survive_pickling(self):
        error = self.raised(lambda: short().__setitem__("valve.duration", "8 mm"))
        back = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(back), back.key, back.problems), (str(error), error.key, error.problems))

    def test_diverging_is_an_arithmetic_error(self):
        case = short()
        case["fluid.viscosity"] = "1e6 Pa s"  # single precision does not bear what turbulence makes of it
        with self.assertRaises(ejecta.DivergedError):
            ejecta.run(case)


class Cases(unittest.TestCase):
    def test_units(self):
        case = short()
        case["valve.supply_pressure"] = "650 kPa gauge"
        self.assertEqual(case["valve.supply_pressure"], 751325.0)
        self.assertEqual(case["valve.supply_pressure"].unit, "Pa absolute")
        case["valve.duration"] = 0.006
        self.assertEqual(repr(case["valve.duration"]), "0.006 s")
        case["body.particle.density"] = numpy.float64(2650.0)
        self.assertEqual(case["body.0.density"], 2650.0)
        case["body.particle.size"] = numpy.array([0.01, 0.008, "12 mm"], dtype=object)
        self.assertEqual(list(case["body.particle.size"]), [0.01, 0.008, 0.012])
        self.assertEqual(case["body.particle.size"].unit, "m")
        self.assertEqual(case["flow.turbulence"], "k-epsilon")
        self.assertIs(case["body.particle.on_belt"], True)
        del case["valve.duration"]
        with self.assertRaises(ejecta.CaseError):
            del case["valve.durattion"]
        self.assertEqual(case["valve.duration"], ejecta.Case.load(small)["valve.duration"])

    def test_none_is_the_default(self):
        case = short()
        case.update({"body.particle.shape": "sphere", "body.particle.diameter": "12 mm", "body.particle.size": None,
                     "body.particle.cluster": None})
        self.assertEqual(ejecta.check(case)["bodies"][0]["shape"], "sphere")
        duration = case["valve.duration"]
        for wrong in ({"valve.duration": None, "valve.duratoin": None}, {"valve.duration": None, "valve.rise_time": "soon"}):
            with self.assertRaises(ejecta.CaseError):
                case.update(wrong)
            self.assertEqual(case["valve.duration"], duration, "all or none")

    def test_bits_of_numbers(self):
        case = short()
        for value in (1 / 3, 0.1 + 0.2, 1e-3 * 7, 5e-12 / 3):
            case["valve.duration"] = value
            self.assertEqual(float(case["valve.duration"]), value)

    def test_dict_is_the_same_as_text(self):
        text = scratch / "ball.toml"
        text.write_text('[run]\nend_time = "20 ms"\ntitle = "a ball falls"\n[flow]\nsolver = "none"\n[[material]]\n'
                        'name = "ore"\ndensity = "2700 kg/m3"\n[[body]]\nname = "ball"\nshape = "sphere"\ndiameter = "10 mm"\n'
                        'material = "ore"\nposition = ["0 m", "0 m", "20 mm"]\n[output]\nreport = false\n')
        self.assertEqual(ejecta.Case(BALL).toml(), ejecta.Case.load(text).toml())

    def test_copies_are_their_own(self):
        case = short()
        other = case.copy()
        other["valve.duration"] = "3 ms"
        self.assertNotEqual(case["valve.duration"], other["valve.duration"])

    def test_keys(self):
        key = ejecta.keys.valve.supply_pressure
        self.assertEqual(key, "valve.supply_pressure")
        case = short()
        self.assertEqual(case[key], case["valve.supply_pressure"])
        said = subprocess.run([program, "explain", key], capture_output=True, text=True, check=True).stdout
        self.assertIn(key.help, said)
        self.assertIn("rise_time", ejecta.keys.valve.__doc__)
        self.assertEqual(ejecta.keys.boundary.z_min.patch.radius, "boundary.z_min.patch.radius")
        page = io.StringIO()
        import pydoc
        pydoc.Helper(output=page)(ejecta.keys.valve)
        self.assertIn(key.help, page.getvalue())

    def test_stub_has_every_key(self):
        stub = (Path(ejecta.__file__).parent / "keys.pyi").read_text()
        compile(stub, "keys.pyi", "exec")
        for section in ejecta._core.schema("incompressible"):
            for entry in section["keys"]:
                self.assertIn(f"    {ejecta.keys.attribute_name(entry['name'])}: ClassVar[Key]", stub)
        self.assertEqual(ejecta.keys.sorter.class_.density, "sorter.class.density")
        self.assertEqual(ejecta.keys.study.vary.from_, "study.vary.from")

    def test_check(self):
        check = ejecta.check(short())
        self.assertEqual(check["cells"], 21600)
        self.assertIn("cells", repr(check))
        self.assertEqual(check["bodies"][0]["name"], "particle")


class Running(unittest.TestCase):
    def test_what_is_unlikely_to_be_meant_is_told_once(self):
        case = ejecta.Case(dict(BALL, launch={"belt_speed": "2.75 m/s"}))
        with self.assertLogs("ejecta", "WARNING") as told:
            ejecta.run(case)
        self.assertIn("no body comes from the belt", told.output[0])
        with self.assertNoLogs("ejecta", "WARNING"):
            ejecta.run(case)

    def test_callback(self):
        seen = []
        result = ejecta.run(BALL, callback=lambda p: seen.append((p.time, p.step)))
        self.assertEqual(len(seen), result.steps + 1)
        self.assertEqual(seen[0], (0.0, 0))
        self.assertEqual(seen[-1], (result.time, result.steps))

    def test_true_from_the_callback_stops(self):
        result = ejecta.run(short(), callback=lambda p: p.step == 3)
        self.assertEqual((result.end, result.steps), ("stopped", 3))
        self.assertIsNone(result.quantities)
        self.assertEqual(len(result.history("body-particle")["time"]), 4)

    def test_exceptions_of_the_callback_arrive(self):
        def fail(p):
            if p.step == 2:
                raise KeyError("mine")

        directory = place("failed.run")
        with self.assertRaises(KeyError):
            ejecta.run(short(), out=directory, callback=fail)
        result = ejecta.run(short(), out=directory, resume=True)
        self.assertEqual(physics(result.quantities), physics(ejecta.run(short()).quantities))

    def test_other_threads_go_on(self):
        counted, over = [0], threading.Event()

        def count():
            while not over.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        start = time.monotonic()
        ejecta.run(short("2 ms"), threads=1)
        seconds = time.monotonic() - start
        over.set()
        thread.join()
        self.assertGreater(counted[0], 50 * seconds)

    def test_two_at_once(self):
        results = {}

        def one(name):
            results[name] = ejecta.run(short(), threads=1)

        threads = [threading.Thread(target=one, args=(n,)) for n in range(2)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual(physics(results[0].quantities), physics(results[1].quantities))

    def test_interrupt(self):
        directory = place("interrupted.run")
        script = f"""
import ejecta, sys
case = ejecta.Case.load({str(small)!r})
case.update({{"run.end_time": "3 ms", "output.report": False}})
try:
    ejecta.run(case, out={str(directory)!r}, threads=1, callback=lambda p: print(p.step, flush=True))
    sys.exit("it was not interrupted")
except KeyboardInterrupt:
    result = ejecta.run(case, out={str(directory)!r}, resume=True)
    print("resumed", result.end, result.steps)
"""
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        for line in process.stdout:
            if int(line) >= 3:
                break
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=300)[0]
        self.assertEqual(process.returncode, 0, said)
        whole = ejecta.run(short("3 ms"))
        self.assertIn(f"resumed {whole.end} {whole.steps}", said)
        resumed = json.loads((directory / "result.json").read_text())
        self.assertEqual(physics(resumed), physics(whole.quantities))

    def test_jet_without_files(self):
        case = ejecta.Case.load("paper/jet-700kPa")
        result = ejecta.jet(case, callback=lambda p: p.step == 5)
        self.assertEqual((result.end, result.steps), ("stopped", 5))
        self.assertIn("orifice", result.histories())

    def test_memory_is_flat(self):
        def resident():
            return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

        case = short("0.2 ms")
        sizes = []
        for _ in range(int(os.environ.get("EJECTA_PYTHON_RUNS", "40"))):
            ejecta.run(case, fields=True)
            ejecta.run(BALL)
            sizes.append(resident())
        half = len(sizes) // 2
        self.assertLess(max(sizes[half:]) - max(sizes[:half]), 1 << 20, sizes)  # from run to run it wavers by some MB

    def test_pandas(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("pandas is not installed")
        frame = ejecta.run(BALL).history("body-ball").to_pandas()
        self.assertEqual(frame.attrs["units"]["force_z"], "N")
        self.assertLess(frame["z"].iloc[-1], 0.02)


SMALL_JET = {
    "run": {"end_time": "9 ms"},
    "flow": {"solver": "compressible"},
    "valve": {"orifice_diameter": "1.8 mm"},
    "launch": {"stand_off": "10 mm"},
    "grid": {"geometry": "axisymmetric", "x": {"points": ["0 mm", "0.9 mm", "10 mm"], "cells": [4, 16], "grading": [1, 6]},
             "y": {"points": ["0 mm", "1 mm"], "cells": [1]}, "z": {"points": ["0 mm", "12 mm"], "cells": [40]}},
    "boundary": {"x_max": {"type": "free-stream"}, "y_min": {"type": "symmetry"}, "y_max": {"type": "symmetry"},
                 "z_min": {"type": "wall", "patch": [{"type": "jet", "centre": ["0 mm", "0 mm", "0 mm"], "radius": "0.9 mm"}]},
                 "z_max": {"type": "wave-transmissive"}},
    "output": {"report": False},
}

# Where Python has what an option of the command line does; None: it is about the terminal or the shell.
OPTIONS = {
    "--set": "Case", "--quiet": None, "--verbose": None, "--help": None, "--dry-run": "plan", "--sweep": "sweep",
    "--json": "Check", "--list": "validation_cases", "--clear": "clear_cache", "--print-commands": "commands",
    "--markdown": None, "--json-schema": None, "--man": None, "--completion": None, "--force": "overwrite",
}


class CommandLine(unittest.TestCase):
    """What the command line has, in its words."""

    def said(self, *words, code=0):
        answer = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
        self.assertEqual(answer.returncode, code, answer.stderr)
        return answer.stdout if code == 0 else answer.stderr

    def refused(self, act, *words):
        """The same words as the command's."""
        with self.assertRaises(ejecta.InputError) as caught:
            act()
        self.assertEqual(self.said(*words, code=2).strip().removeprefix("error: "), str(caught.exception).strip())
        return caught.exception

    def test_every_command_and_option_is_there(self):
        commands = re.findall(r"(?m)^  ([a-z]+)  ", self.said("help").split("Commands:")[1])
        self.assertGreater(len(commands), 15)
        for command in commands:
            takes = inspect.signature(getattr(ejecta, command)).parameters
            for option in re.findall(r"(?m)^  (?:-\w,)?(--[a-z-]+)", self.said("help", command)):
                name = OPTIONS.get(option, option[2:].replace("-", "_"))
                self.assertTrue(name is None or name in takes or hasattr(ejecta, name), f"{command} {option}")

    def test_everything_has_help(self):
        for name, thing in vars(ejecta).items():
            if not name.startswith("_") and callable(thing):
                self.assertTrue(thing.__doc__, name)

    def test_plan(self):
        self.assertEqual(repr(ejecta.plan(small)) + "\n", self.said("plan", small))
        names = [one.name for one in ejecta.plan(small)]
        self.assertLess(names.index("map.bodies"), names.index("loads.collect"))
        self.refused(lambda: ejecta.plan("no-such-case"), "plan", "no-such-case")

    def test_new(self):
        for kind in ejecta._core.new_kinds():
            self.assertEqual(ejecta.new(kind), self.said("new", kind))
            self.assertIn(f"    {kind} ", ejecta.new.__doc__)
            ejecta.check(ejecta.Case.parse(ejecta.new(kind)))
        self.refused(lambda: ejecta.new("ejektion"), "new", "ejektion")
        with self.assertRaises(ejecta.CaseError) as caught:
            ejecta.Case.parse("[run\nend_time = 3", "mine.toml")
        self.assertIn("mine.toml:1: error: ", str(caught.exception))

    def test_explain(self):
        for topic in ("", "valve", "valve.rise_time", "margin", "purity"):
            self.assertEqual(ejecta.explain(topic), self.said("explain", *topic.split()))
        self.refused(lambda: ejecta.explain("no such thing"), "explain", "no", "such", "thing")

    def test_validate(self):
        folder = place("to-validate")
        folder.mkdir(parents=True)
        for name, least in (("holds", 1), ("fails", 1000000)):
            ejecta.Case({**BALL, "expect": [{"quantity": "/steps", "at_least": least}]}).save(folder / f"{name}.toml")
        cases = [folder / "holds.toml", folder / "fails.toml"]
        self.assertEqual(ejecta.validation_cases(folder), sorted(cases))
        done = ejecta.validate(*cases, out=folder / "mine")
        self.assertFalse(done.passed)
        self.assertEqual([validation.passed for validation in done], [True, False])
        self.assertEqual(done[1].comparisons[0]["quantity"], "/steps")
        command = subprocess.run([program, "validate", *cases, "--out", folder / "theirs"], capture_output=True, text=True)
        self.assertEqual((command.returncode, command.stdout), (5, repr(done)))
        self.assertTrue(ejecta.validate(cases[0], out=folder / "mine").passed)
        self.assertIn("0 of 1 met", repr(done[1]))
        self.refused(lambda: ejecta.validate("no-such-case"), "validate", "no-such-case")

    def test_sweep(self):
        case = ejecta.Case(SMALL_JET)
        file = scratch / "small-jet.toml"
        case.save(file)
        with self.assertRaises(ejecta.InputError) as caught:
            ejecta.sweep(file)
        self.assertIn(f"error: {caught.exception}", self.said("jet", file, "--sweep", code=2))
        case = ejecta.Case.load(file)
        case["jet.sweep_pressures"] = ["300 kPa gauge", "500 kPa gauge"]
        sweep = ejecta.sweep(case, out=place("sweep.run"), threads=1)
        said = json.loads(self.said("jet", file, "--sweep", "--out", place("command.run"), "--set",
                                    'jet.sweep_pressures=["300 kPa gauge", "500 kPa gauge"]'))
        for one, other in zip(sweep.compressible, said["compressible"], strict=True):
            self.assertEqual(one, other)
        self.assertLess(sweep.compressible[0]["thrust_N"], sweep.compressible[1]["thrust_N"])
        manifest = json.loads((sweep.directory / "manifest.json").read_text())
        self.assertIn("ejecta jet --sweep", manifest["command"])
        self.assertEqual(sweep.result, json.loads((sweep.directory / "result.json").read_text()))

    def test_cache(self):
        store = place("store")
        (store / "kept").mkdir(parents=True)
        (store / "jet-1.h5").write_bytes(b"0" * 1000)
        (store / "thesis.txt").write_text("not ours")
        with unittest.mock.patch.dict(os.environ, EJECTA_CACHE=str(store)):
            self.assertEqual(ejecta.cache(), [store / "jet-1.h5"])
            self.assertEqual(ejecta.clear_cache(), 1)
        self.assertEqual(sorted(file.name for file in store.iterdir()), ["kept", "thesis.txt"])

    def test_check_looks_at_the_runs_of_a_study_and_the_parts_of_a_campaign(self):
        study = {"quantities": ["/bodies/0/peak_speed_m_s"], "vary": [{"key": "body.ball.diamter", "values": ["1 mm"]}]}
        file = scratch / "wrong-study.toml"
        ejecta.Case({**BALL, "study": {**study, "vary": [{"key": "body.ball.diameter", "values": ["1 mm"]}]}}).save(file)
        file.write_text(file.read_text().replace("body.ball.diameter", "body.ball.diamter"))
        error = self.refused(lambda: ejecta.check(file), "check", file)
        self.assertEqual((error.key, error.problems[0]["nearest"]), ("study.vary.0.key", "body.ball.diameter"))
        for act in (ejecta.study, ejecta.commands):
            with self.assertRaises(ejecta.CaseError) as caught:
                act(file, out=place("wrong.study"))
            self.assertEqual(caught.exception.problems, error.problems)
        both = scratch / "wrong-campaign.toml"
        both.write_text('[campaign]\n[[campaign.part]]\nkind = "run"\ncase = "not-there.toml"\n')
        self.refused(lambda: ejecta.check(both), "check", both)

    def test_bench(self):
        self.assertIn("10,000 spheres settled", ejecta.bench(only="settled", steps=1, threads=1))
        for wrong in ({"only": "fluid"}, {"steps": 0}, {"threads": -1}):
            with self.assertRaisesRegex(ValueError, "expected: "):
                ejecta.bench(**wrong)

    def test_serve(self):
        if not any((Path(ejecta.running.program()).parent / place).exists()
                   for place in ("ejecta-serve", "../libexec/ejecta/ejecta-serve")):
            self.skipTest("the server is not built")
        folder = place("served")
        folder.mkdir(parents=True)
        with ejecta.serve(folder) as server:
            browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
            self.assertIn(b"<html", browser.open(server.address).read().lower())
        with self.assertRaises(OSError):
            browser.open(server.address)
        with self.assertRaises(ejecta.InputError):
            ejecta.serve(folder / "not-there")


class HandedOn(unittest.TestCase):
    """What the commands report, table and paraview write."""

    def test_the_same_files(self):
        runs = [ejecta.run(short(end), out=place(f"{end}.run")) for end in ("0.2 ms", "0.4 ms")]
        directories = [str(run.directory) for run in runs]
        for name, act in (("report", ejecta.report), ("table", ejecta.table)):
            for ending in ("html",) if name == "report" else ("csv",):
                mine, theirs = scratch / f"mine.{ending}", scratch / f"theirs.{ending}"
                self.assertEqual(act(runs[0], directories[1], out=mine), mine)
                subprocess.run([program, name, *directories, "--out", theirs], check=True, capture_output=True)
                self.assertEqual(mine.read_text(), theirs.read_text())
        self.assertEqual(ejecta.report(runs[0].run), runs[0].directory / "report.html")
        with self.assertRaisesRegex(ejecta.InputError, r"is no table\n  expected: .*\.xlsx"):
            ejecta.table(runs[0], out=scratch / "results.txt")
        with self.assertRaisesRegex(ejecta.InputError, "fields"):
            ejecta.paraview(ejecta.run(BALL, out=place("no-air.run")))
        with self.assertRaisesRegex(ValueError, "have written files"):
            ejecta.report(ejecta.run(BALL))

    def test_a_view(self):
        case = short("0.2 ms")
        case["output.fields_interval"] = "0.1 ms"
        file = ejecta.paraview(ejecta.run(case, out=place("fields.run")))
        compile(file.read_text(), str(file), "exec")


class Jobs(unittest.TestCase):
    def test_submit_to_its_end(self):
        directory = place("job.run")
        job = ejecta.submit(short(), out=directory, threads=1)
        result = job.wait()
        self.assertEqual(job.progress()["state"], "done")
        self.assertEqual(physics(result.quantities), physics(ejecta.run(short()).quantities))
        self.assertGreater(len(result.history("body-particle")["time"]), 3)

    def test_stop_and_resume(self):
        directory = place("stopped-job.run")
        case = short("6 ms")
        job = ejecta.submit(case, out=directory, threads=1)
        while job.progress().get("step", 0) < 2:
            self.assertTrue(job.running)
            time.sleep(0.02)
        with self.assertRaisesRegex(ejecta.InputError, "a run goes on in"):
            ejecta.run(case, out=directory, overwrite=True)
        found = ejecta.Job(directory)  # as a new session would find it
        self.assertTrue(found.running)
        found.stop()
        self.assertEqual(found.progress()["state"], "stopped")
        self.assertEqual(found.result().end, "stopped")
        self.assertEqual(job.wait().end, "stopped")

    def test_a_killed_one_is_said_to_be_dead(self):
        directory = place("killed-job.run")
        job = ejecta.submit(short("6 ms"), out=directory, threads=1)
        while job.progress().get("step", 0) < 1:
            time.sleep(0.02)
        os.kill(job.progress()["process"], signal.SIGKILL)
        job._process.wait()
        self.assertEqual(ejecta.Job(directory).progress()["state"], "failed")

    def test_of_a_dict(self):
        directory = place("dict-job.run")
        result = ejecta.submit(BALL, out=directory).wait()
        self.assertEqual(physics(result.quantities), physics(ejecta.run(BALL).quantities))

    def test_names_that_begin_with_a_dash(self):
        folder = place("dashes")
        folder.mkdir(parents=True)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder)
        ejecta.Case(BALL).save("-ball.toml")
        for case in ("-ball.toml", BALL):
            self.assertEqual(ejecta.submit(case, out="-ball.run", overwrite=True).wait().end, "decided")
        ejecta.Case(dict(BALL, study={"quantities": ["/bodies/0/peak_speed_m_s"],
                                      "vary": [{"key": "run.end_time", "values": [0.001, 0.002]}]})).save("-many.toml")
        self.assertEqual(len(ejecta.study("-many.toml").runs), 2)
        self.assertTrue(Path("-many.study/result.json").exists())

    def test_numbers_that_cannot_be(self):
        for options in ({"at_once": -1}, {"at_once": 2**32 + 1}):
            with self.assertRaises((ValueError, ejecta.InputError)):
                ejecta.study(BALL, out=place("none.study"), **options)
        for threads in (-1, 2**32 + 1):
            for act in (ejecta.run, ejecta.submit, ejecta.sort):
                with self.assertRaises((ValueError, TypeError, ejecta.InputError), msg=f"{act} {threads}"):
                    act(BALL, out=place("none.run"), threads=threads)
                self.assertFalse((scratch / "none.run").exists())

    def test_study(self):
        case = ejecta.Case(dict(BALL, study={"quantities": ["/bodies/0/final_position_m/2"], "keep_runs": False},
                                splitter={"edge": [0.1, 0.01]}))
        case["study.vary"] = [{"key": "body.ball.position", "values": [[0, 0, 0.01], [0, 0, 0.03]]}]
        directory = place("ball.study")
        left = ejecta.commands(case, out=directory)
        self.assertEqual([line.split()[-1] for line in left], ["0", "1"])
        found = ejecta.Study(directory)
        self.assertEqual((found.status()["waiting"], found.status()["done"]), (2, 0))
        subprocess.run([program, *left[0].split()[1:]], check=True)
        self.assertEqual(ejecta.commands(case, out=directory), left[1:])
        self.assertEqual([run["state"] for run in found.collect().runs], ["done", "waiting"])
        with self.assertLogs("ejecta", "INFO") as told:
            study = ejecta.study(case, out=directory, at_once=1)
        self.assertIn("2 of 2 runs done", "".join(told.output))
        self.assertEqual(len(study.runs), 2)
        self.assertIn("2 of 2 runs done", repr(found))
        self.assertEqual(ejecta.commands(case, out=directory), [])

    def test_sorter(self):
        case = ejecta.Case.load("sorter/tutorial")
        case["sorter.particles"] = 300
        directory = place("machine.sort")
        sorting = ejecta.sort(case, out=directory, threads=1)
        self.assertEqual(sorting.result, json.loads((directory / "result.json").read_text()))
        self.assertTrue(sorting.recovery.low <= sorting.recovery <= sorting.recovery.high, sorting.recovery)
        self.assertEqual(sum(fate["number"] for fate in sorting.fates), sorting["particles"])
        self.assertIn("recovery", repr(sorting))
        again = ejecta.sort(case, out=directory)
        self.assertEqual(again["particles"], sorting["particles"], "it is done already")
        case["sorter.throughput"] = "4 t/h"
        with self.assertRaisesRegex(ejecta.InputError, "another case"):
            ejecta.sort(case, out=directory)
        with self.assertRaisesRegex(ejecta.InputError, "has no \\[sorter\\]"):
            ejecta.sort(BALL, out=place("no.sort"))

    def test_campaign(self):
        folder = place("campaign")
        folder.mkdir(parents=True)
        ejecta.Case(BALL).save(folder / "ball.toml")
        (folder / "both.toml").write_text('[campaign]\ntitle = "two"\n[[campaign.part]]\nkind = "run"\ncase = "ball.toml"\n'
                                          '[[campaign.part]]\nkind = "run"\ncase = "ball.toml"\nset = ["run.end_time=10 ms"]\n')
        campaign = ejecta.campaign(folder / "both.toml", out=folder / "both.campaign")
        self.assertEqual([part["done"] for part in campaign.parts], [True, True])
        ends = [campaign.part(n).history("body-ball")["time"][-1] for n in range(2)]
        numpy.testing.assert_allclose(ends, [0.02, 0.01], rtol=0.01)
        self.assertIn("2 of 2 parts done", repr(campaign))

    def test_margin(self):
        margin = ejecta.Margin("tutorial", ["body.particle.size"])
        margin.case.update({"run.end_time": "100 us", "output.report": False})
        self.assertTrue(numpy.isnan(margin(["8 mm", "8 mm", "8 mm"])), "it has not reached the plate")
        with self.assertRaises(TypeError):
            margin()


class Shapes(unittest.TestCase):
    def test_sphere(self):
        ball = ejecta.shape(shape="sphere", diameter="10 mm")
        distance = ball.signed_distance([[0, 0, 0], [0.01, 0, 0]])
        numpy.testing.assert_allclose(distance, [-0.005, 0.005])
        properties = ball.mass_properties(2700)
        self.assertAlmostEqual(properties["mass"], 2700 * numpy.pi / 6 * 1e-6)
        numpy.testing.assert_allclose(properties["inertia"], 0.1 * properties["mass"] * 0.01**2)
        vertices, triangles = ball.surface()
        self.assertEqual(triangles.max() + 1, len(vertices))
        self.assertLess(abs(ball.signed_distance(vertices)).max(), 1e-4)
        self.assertAlmostEqual(ball.projected_area([1, 2, 3]), numpy.pi / 4 * 1e-4)
        self.assertEqual(ball.signed_distance(numpy.zeros((4, 5, 3))).shape, (4, 5))
        with self.assertRaisesRegex(ValueError, "three coordinates"):
            ball.signed_distance([1.0, 2.0])

    def test_of_a_case(self):
        box = short().shape("particle")
        self.assertAlmostEqual(box.smallest_feature, 0.01)
        with self.assertRaisesRegex(ejecta.InputError, "it has particle"):
            short().shape("stone")
        with self.assertRaises(ejecta.CaseError):
            ejecta.shape(shape="sphere", diameter="10 kg")


class WithoutTheCompiledPart(unittest.TestCase):
    def test_files_can_be_read(self):
        directory = place("read.run")
        ejecta.run(BALL, out=directory)
        script = f"""
import ejecta
run = ejecta.Run({str(directory)!r})
assert run.history("body-ball")["z"].unit == "m"
try:
    ejecta.Case
except ImportError as e:
    assert "pybind11" in str(e)
else:
    raise SystemExit("there is a compiled part")
"""
        environment = dict(os.environ, PYTHONPATH=str(source / "python"))
        subprocess.run([sys.executable, "-B", "-c", script], check=True, env=environment)


if __name__ == "__main__":
    scratch.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=1)
