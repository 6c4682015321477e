"""The server of the workbench: serve_test.py PROGRAM SOURCE SCRATCH. What it refuses, and that runs outlive it."""

import http.client
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest
from pathlib import Path

program, source, scratch = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])

BALL = """[run]
end_time = "20 ms"
[flow]
solver = "none"
[[body]]   # the only one
name = "ball"
shape = "sphere"
diameter = "10 mm"
"""

STUDY = BALL + """[study]
quantities = ["/bodies/0/peak_speed_m_s"]
[[study.vary]]
key = "body.ball.diameter"
values = ["8 mm", "9 mm", "10 mm"]
"""

CORNERS = ("0 0 0", "20 0 0", "0 10 0", "0 0 5")
TETRAHEDRON = ("solid rock\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {CORNERS[n]}\n" for n in face) + "endloop\nendfacet\n"
    for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))) + "endsolid rock\n").encode()


# Seconds are held to limits on request alone: EJECTA_TIMED=1, on a machine that does nothing else.
TIMED = bool(os.environ.get("EJECTA_TIMED"))


class Server:
    def __init__(self, folder):
        self.folder = folder
        self.process = subprocess.Popen([program, "serve", folder], stdout=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        port, self.token = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{48})\n", line).groups()
        self.port = int(port)

    def ask(self, method, path, body=None, headers=None, token=True):
        """Status, headers and content of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        all_headers = {"Cookie": f"ejecta-{self.port}={self.token}"} if token else {}
        all_headers |= headers or {}
        if isinstance(body, dict):
            body = json.dumps(body)
        connection.request(method, path, body, all_headers)
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, answer.headers, content

    def get(self, path):
        status, _, content = self.ask("GET", path)
        assert status == 200, content
        return json.loads(content)

    def post(self, path, **body):
        status, _, content = self.ask("POST", path, body)
        return status, json.loads(content)

    def start(self, case, kind="run"):
        return self.post("/api/start", case=case, kind=kind)

    def run(self, name):
        return next((run for run in self.get("/api/jobs") if run["name"] == name), None)

    def wait(self, name, states, seconds=120):
        end = time.monotonic() + seconds
        while (run := self.run(name))["state"] not in states:
            assert time.monotonic() < end, run
            time.sleep(0.05)
        return run

    def end(self, how=signal.SIGINT):
        self.process.send_signal(how)
        self.process.wait(20)
        self.process.stdout.close()


class ServerCase(unittest.TestCase):
    def setUp(self):
        self.folder = scratch / self.id().split(".")[-1]
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        (self.folder / "ball.toml").write_text(BALL)
        (scratch / "secret.toml").write_text("[run]\ntitle = 'secret'\n")
        self.server = Server(self.folder)
        self.addCleanup(self.server.end)

    def assert_alive(self):
        self.assertEqual(self.server.ask("GET", "/api/cases")[0], 200)


class Refuses(ServerCase):
    def test_who_has_no_token(self):
        for path in ("/", "/api/cases", "/api/jobs", "/api/events", "/files/ball.toml", "/nothing"):
            self.assertEqual(self.server.ask("GET", path, token=False)[0], 403, path)
        for token in ("", "0" * 48, self.server.token[:-1], self.server.token + "0"):
            self.assertEqual(self.server.ask("GET", f"/api/cases?token={token}", token=False)[0], 403)
            self.assertEqual(self.server.ask("GET", "/", headers={"Cookie": f"ejecta-{self.server.port}={token}"}, token=False)[0], 403)
        self.assertEqual(self.server.ask("POST", "/api/start", {"case": "ball.toml"}, token=False)[0], 403)
        self.assertEqual(self.server.get("/api/jobs"), [])

    def test_other_hosts_and_origins(self):
        for host in ("evil.example", f"evil.example:{self.server.port}", "127.0.0.1", f"127.0.0.1.evil.example:{self.server.port}", ""):
            self.assertEqual(self.server.ask("GET", "/api/cases", headers={"Host": host})[0], 403, host)
        for origin in ("http://evil.example", "null", "https://127.0.0.1:" + str(self.server.port), "http://127.0.0.1:1"):
            self.assertEqual(self.server.ask("POST", "/api/start", {"case": "ball.toml"}, {"Origin": origin})[0], 403, origin)
        own = {"Host": f"localhost:{self.server.port}", "Origin": f"http://localhost:{self.server.port}"}
        self.assertEqual(self.server.ask("GET", "/api/cases", headers=own)[0], 200)

    def test_it_listens_on_this_machine_only(self):
        ports = [line.split()[1] for line in Path("/proc/net/tcp").read_text().splitlines()[1:] if line.split()[3] == "0A"]
        mine = [p for p in ports if int(p.split(":")[1], 16) == self.server.port]
        self.assertEqual(mine, [f"0100007F:{self.server.port:04X}"])

    def test_paths_out_of_the_folder(self):
        os.symlink(scratch / "secret.toml", self.folder / "link.toml")
        for name in ("../secret.toml", "a/../../secret.toml", str(scratch / "secret.toml"), "link.toml", "", "..", "\0", "/etc/passwd"):
            status, answer = self.server.post("/api/open", name=name)
            self.assertEqual(status, 400, name)
            self.assertNotIn("text", answer)
            for call, key in (("start", "case"), ("stop", "job"), ("resume", "job")):
                self.assertEqual(self.server.post(f"/api/{call}", **{key: name, "kind": "run"})[0], 400, (call, name))
        for path in ("/files/../secret.toml", "/files/%2e%2e/secret.toml", "/files/..%2fsecret.toml", "/files//etc/passwd", "/files/link.toml"):
            status, _, content = self.server.ask("GET", path)
            self.assertIn(status, (400, 404), path)
            self.assertNotIn(b"secret'", content)
        for name in ("../new.toml", "a/b.toml", ".toml", "x.sh", "x" * 300 + ".toml", "new\n.toml"):
            self.assertEqual(self.server.post("/api/new", name=name)[0], 400, name)
            self.assertEqual(self.server.ask("POST", f"/api/upload?case=ball.toml&name={name.strip()!a}", TETRAHEDRON)[0], 400)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["ball.toml", "link.toml"])

    def test_what_is_no_request(self):
        for body in ("", "{", "[]", "3", '{"name": 5}', '{"nam": "ball.toml"}', "\xff", '{"name":' * 2000):
            for path in ("open", "save", "check", "set", "start", "stop", "new", "copy", "resume", "at-once"):
                status, _, content = self.server.ask("POST", f"/api/{path}", body.encode("latin-1"))
                self.assertEqual(status, 400, (path, body[:20]))
                self.assertIn("error", json.loads(content))
        self.assert_alive()

    def test_oversized_and_truncated_bodies(self):
        large = json.dumps({"name": "ball.toml", "text": "#" * (2 << 20)})
        self.assertEqual(self.server.ask("POST", "/api/check", large)[0], 413)
        connection = socket.create_connection(("127.0.0.1", self.server.port))
        head = f"POST /api/check HTTP/1.1\r\nHost: 127.0.0.1:{self.server.port}\r\nCookie: ejecta-{self.server.port}={self.server.token}\r\n"
        connection.sendall(f"{head}Content-Length: 999999999999\r\n\r\n".encode())
        self.assertRegex(connection.recv(100).decode(), "413|400")
        connection.close()
        connection = socket.create_connection(("127.0.0.1", self.server.port))
        connection.sendall(f"{head}Content-Length: 100\r\n\r\n{{".encode())
        connection.close()  # in the middle
        self.assert_alive()

    def test_slow_clients_and_idle_streams(self):
        kept = []
        for _ in range(24):  # that say half a request and wait
            connection = socket.create_connection(("127.0.0.1", self.server.port))
            connection.sendall(b"GET /api/ca")
            kept.append(connection)
        streams = []
        for _ in range(64):
            connection = socket.create_connection(("127.0.0.1", self.server.port))
            connection.sendall(f"GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{self.server.port}\r\n"
                               f"Cookie: ejecta-{self.server.port}={self.server.token}\r\n\r\n".encode())
            streams.append(connection)
        start = time.monotonic()
        self.assert_alive()
        self.assertLess(time.monotonic() - start, 15)
        served = 0
        for connection in streams:
            connection.settimeout(15)
            served += b"200" in connection.recv(20)
        self.assertGreaterEqual(served, 16)
        for connection in kept + streams:
            connection.close()
        time.sleep(6)  # until closed pages are noticed
        self.assert_alive()

    def test_reports_cannot_ask_the_server(self):
        (self.folder / "page.html").write_text("<script>fetch('/api/jobs')</script>")
        _, headers, _ = self.server.ask("GET", "/files/page.html")
        self.assertIn("sandbox", headers["Content-Security-Policy"])
        self.assertNotIn("allow-same-origin", headers["Content-Security-Policy"])
        (self.folder / "script.sh").write_text("echo")
        self.assertEqual(self.server.ask("GET", "/files/script.sh")[0], 404)


class Cases(ServerCase):
    def test_the_page_with_its_token(self):
        status, headers, _ = self.server.ask("GET", f"/?token={self.server.token}", token=False)
        self.assertEqual((status, headers["Location"]), (303, "/"))
        self.assertIn("HttpOnly; SameSite=Strict", headers["Set-Cookie"])
        status, headers, _ = self.server.ask("GET", "/")
        self.assertIn(status, (200, 501))  # 501: built without npm

    def test_open_change_save(self):
        _, opened = self.server.post("/api/open", name="ball.toml")
        self.assertEqual(opened["text"], BALL)
        _, changed = self.server.post("/api/set", text=opened["text"], key="body.0.diameter", value='"12 mm"')
        self.assertEqual(changed["text"], BALL.replace("10 mm", "12 mm"))
        status, saved = self.server.post("/api/save", name="ball.toml", text=changed["text"], digest=opened["digest"])
        self.assertEqual((self.folder / "ball.toml").read_text(), changed["text"])
        status, answer = self.server.post("/api/save", name="ball.toml", text="x", digest=opened["digest"])
        self.assertEqual(status, 409)
        self.assertIn("changed elsewhere", answer["error"])
        _, back = self.server.post("/api/set", text=changed["text"], key="body.0.diameter", remove=True)
        self.assertNotIn("diameter", back["text"])
        self.assertEqual(self.server.post("/api/set", text="[run", key="run.title", value='"x"')[0], 400)

    def test_numbers_in_the_names_of_keys(self):
        for key in ("body.1.name", "body.0.name"):
            self.assertEqual(self.server.post("/api/set", text=BALL, key=key, value='"x"')[0], 200, key)
        for key in ("body.2.name", f"body.{2**32}.name", f"body.{2**64}.name", "body.-1.name"):
            status, answer = self.server.post("/api/set", text=BALL, key=key, value='"x"')
            self.assertEqual(status, 400, (key, answer))

    def test_new(self):
        self.assertEqual(self.server.post("/api/new", name="mine.toml")[0], 200)
        self.assertEqual(self.server.get("/api/cases")["cases"], ["ball.toml", "mine.toml"])
        self.assertEqual(self.server.post("/api/new", name="mine.toml")[0], 409)

    def test_check_says_what_the_program_says(self):
        bad = BALL.replace('"10 mm"', '"10 kg"').replace("[flow]", "[flow]\nsolvr = 1")
        _, judged = self.server.post("/api/check", name="ball.toml", text=bad)
        (self.folder / "bad.toml").write_text(bad)
        said = json.loads(subprocess.run([program, "check", "--json", self.folder / "bad.toml"], capture_output=True, text=True).stdout)
        strip = [{k: v for k, v in p.items() if k != "file"} for p in said[0]["problems"]]
        self.assertEqual([{k: v for k, v in p.items() if k != "file"} for p in judged["problems"]], strip)
        self.assertEqual(judged["values"]["body.0.shape"], {"text": '"sphere"', "given": True})
        self.assertNotIn("check", judged)
        _, judged = self.server.post("/api/check", name="ball.toml", text=BALL)
        self.assertEqual(judged["check"]["bodies"][0]["name"], "ball")
        self.assertEqual(len(judged["drawing"]["bodies"]), 1)
        for text in ("", "[", "\x00", "a = " + "[" * 5000):
            _, judged = self.server.post("/api/check", name="ball.toml", text=text)
            self.assertTrue(judged["problems"], text)

    def test_the_checker_keeps_up_with_typing(self):
        text = (source / "cases" / "tutorial.toml").read_text()
        times = []
        for n in range(20):
            start = time.monotonic()
            self.server.post("/api/check", name="ball.toml", text=text + f"# {n}\n")
            times.append(time.monotonic() - start)
        print(f"check: median {1e3 * sorted(times)[10]:.1f} ms")
        if TIMED:
            self.assertLess(sorted(times)[10], 0.1)

    def test_schema_has_every_section(self):
        names = {section["name"] for section in self.server.get("/api/schema")}
        self.assertTrue({"run", "valve", "body", "boundary.z_min.patch", "splitter"} <= names)

    def upload(self, name, content, case="ball.toml"):
        status, _, answer = self.server.ask("POST", f"/api/upload?case={case}&name={name}", content)
        return status, json.loads(answer)

    def test_shapes_are_taken(self):
        self.assertEqual(self.upload("rock.stl", TETRAHEDRON), (200, {"name": "rock.stl", "extent": [20, 10, 5]}))
        self.assertEqual(self.upload("rock.stl", TETRAHEDRON)[0], 200, "the same again")
        self.assertEqual(self.upload("rock.stl", TETRAHEDRON.replace(b"20", b"30"))[0], 409)
        self.assertEqual((self.folder / "rock.stl").read_bytes(), TETRAHEDRON)
        for content in (b"", b"solid rock\nendsolid\n", TETRAHEDRON[:100], b"PK\3\4" * 100):
            status, answer = self.upload("broken.stl", content)
            self.assertEqual((status, "broken.stl" in answer["error"]), (400, True), answer)
        (self.folder / "rocks").mkdir()
        (self.folder / "rocks" / "flat.toml").write_text(BALL)
        self.assertEqual(self.upload("flat.stl", TETRAHEDRON, "rocks/flat.toml")[0], 200)
        self.assertTrue((self.folder / "rocks" / "flat.stl").exists(), "beside its case")
        self.assertEqual(self.upload("out.stl", TETRAHEDRON, "../x.toml")[0], 400)

    def test_a_copy_lies_beside(self):
        self.assertEqual(self.server.post("/api/copy", name="ball.toml", copy="other.toml"), (200, {"name": "other.toml"}))
        self.assertEqual((self.folder / "other.toml").read_text(), BALL)
        self.assertEqual(self.server.post("/api/copy", name="ball.toml", copy="other.toml")[0], 409)
        for name in ("../other.toml", "a/b.toml", "x.sh"):
            self.assertEqual(self.server.post("/api/copy", name="ball.toml", copy=name)[0], 400)

    def test_what_a_case_is_for(self):
        for text, commands in ((BALL, ["run"]), (STUDY, ["run", "study"]), ((source / "cases" / "sorter" / "tutorial.toml").read_text(), ["sort"]),
                               ("[campaign]\n[[campaign.part]]\ncase = \"ball.toml\"\n", ["campaign"])):
            self.assertEqual(self.server.post("/api/check", name="ball.toml", text=text)[1]["commands"], commands)


class Runs(ServerCase):
    def setUp(self):
        super().setUp()
        text = (source / "tests" / "app" / "small-ejection.toml").read_text()
        (self.folder / "slow.toml").write_text(text.replace('"6 ms"', '"60 ms"', 1))

    def test_to_its_end(self):
        status, answer = self.server.start("ball.toml")
        self.assertEqual((status, answer), (200, {"job": "ball.run"}))
        run = self.server.wait("ball.run", ("done", "failed"))
        self.assertEqual((run["state"], run["case"]), ("done", "ball.toml"))
        self.assertTrue(run["report"])
        self.assertEqual(self.server.ask("GET", "/files/ball.run/report.html")[0], 200)
        self.assertEqual(self.server.start("ball.toml")[1], {"job": "ball-2.run"})
        self.server.wait("ball-2.run", ("done",))

    def test_results_together(self):
        self.server.start("ball.toml")
        self.server.wait("ball.run", ("done",))
        status, headers, page = self.server.ask("GET", "/runs/compare.html?run=ball.run&run=ball.run")
        self.assertEqual(status, 200)
        self.assertIn("sandbox", headers["Content-Security-Policy"])
        status, _, table = self.server.ask("GET", "/runs/results.csv?run=ball.run")
        self.assertEqual(len(table.decode().splitlines()), 2)
        status, _, book = self.server.ask("GET", "/runs/results.xlsx?run=ball.run")
        self.assertTrue((status, book[:2]) == (200, b"PK") or (status == 400 and b"built without" in book))
        for query in ("", "?run=../x", "?run=ball.toml"):
            self.assertEqual(self.server.ask("GET", "/runs/results.csv" + query)[0], 400)

    def test_names_that_begin_with_a_dash(self):
        folder = self.folder / "-rocks"
        folder.mkdir()
        (folder / "-ball.toml").write_text(BALL)
        (self.folder / "-f.toml").write_text(STUDY)
        for case, kind in (("-rocks/-ball.toml", "run"), ("-f.toml", "run"), ("-f.toml", "study")):
            job = self.server.start(case, kind)[1]["job"]
            self.assertEqual(job, case.replace("toml", kind))
            done = self.server.wait(job, ("done", "failed"))
            self.assertEqual((done["state"], done["case"]), ("done", case), done)
        (self.folder / "-slow.toml").write_text((self.folder / "slow.toml").read_text())
        self.server.start("-slow.toml")
        for call, state in (("stop", "running"), ("resume", "stopped"), ("stop", "running")):
            self.server.wait("-slow.run", (state,))
            self.assertEqual(self.server.post(f"/api/{call}", job="-slow.run")[0], 200)
        self.assertEqual(self.server.wait("-slow.run", ("stopped", "failed"))["state"], "stopped")

    def test_many_clicks_are_one_run(self):
        answers = []
        threads = [threading.Thread(target=lambda: answers.append(self.server.start("slow.toml")[0])) for _ in range(8)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual(sorted(answers), [200] + [400] * 7)
        self.assertEqual([run["name"] for run in self.server.get("/api/jobs")], ["slow.run"])
        self.server.post("/api/stop", job="slow.run")
        self.server.wait("slow.run", ("stopped", "failed"))

    def test_stop_and_resume(self):
        self.server.start("slow.toml")
        self.server.wait("slow.run", ("running",))
        self.assertEqual(self.server.post("/api/stop", job="slow.run")[0], 200)
        self.server.wait("slow.run", ("stopped",))
        self.assertEqual(self.server.post("/api/stop", job="slow.run")[0], 400)
        self.assertEqual(self.server.post("/api/resume", job="slow.run")[0], 200)
        self.assertEqual(self.server.post("/api/resume", job="slow.run")[0], 400, "it runs already")
        self.server.wait("slow.run", ("running",))
        self.server.post("/api/stop", job="slow.run")
        self.server.wait("slow.run", ("stopped",))

    def test_the_server_dies_and_comes_back(self):
        self.server.start("slow.toml")
        self.server.wait("slow.run", ("running",))
        self.server.end(signal.SIGKILL)
        self.server = Server(self.folder)
        self.addCleanup(lambda s=self.server: s.process.poll() is None and s.end())
        self.assertEqual(self.server.run("slow.run")["state"], "running")
        self.assertEqual(self.server.start("slow.toml")[0], 400, "it runs already")
        process = json.loads((self.folder / "slow.run" / "progress.json").read_text())["process"]
        os.kill(process, signal.SIGKILL)
        run = self.server.wait("slow.run", ("failed",), 10)  # a dead run is said to be dead
        self.assertEqual(self.server.post("/api/stop", job="slow.run")[0], 400)

    def test_one_that_cannot_start_says_why(self):
        (self.folder / "bad.toml").write_text(BALL.replace("10 mm", "10 kg"))
        self.server.start("bad.toml")
        run = self.server.wait("bad.run", ("failed",))
        self.assertIn("body.0.diameter", run["said"])

    def test_what_has_ended_can_be_put_away(self):
        self.server.start("slow.toml")
        self.server.wait("slow.run", ("running",))
        self.assertEqual(self.server.post("/api/remove", job="slow.run")[0], 400, "it runs")
        self.server.post("/api/stop", job="slow.run")
        self.server.wait("slow.run", ("stopped",))
        (self.folder / "bad.toml").write_text(BALL.replace("10 mm", "10 kg"))
        self.server.start("bad.toml")  # has a log and no directory
        self.server.wait("bad.run", ("failed",))
        for number, job in ((1, "slow.run"), (2, "bad.run")):
            self.assertEqual(self.server.post("/api/remove", job=job)[0], 200, job)
            self.assertIsNone(self.server.run(job))
            self.assertTrue((self.folder / ".removed" / str(number) / f"{job}.log").exists())
        self.assertTrue((self.folder / ".removed" / "1" / "slow.run" / "manifest.json").exists())
        for job in ("slow.run", "slow.toml", "..", "../x.run", ".removed/1/slow.run", "", "."):
            self.assertEqual(self.server.post("/api/remove", job=job)[0], 400, job)
        self.assertTrue((self.folder / "slow.toml").exists())

    def test_events(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=30)
        connection.request("GET", "/api/events", headers={"Cookie": f"ejecta-{self.server.port}={self.server.token}"})
        stream = connection.getresponse()
        self.server.start("ball.toml")
        end = time.monotonic() + 60
        while time.monotonic() < end:
            line = stream.readline().decode()
            if line.startswith("data: ") and any(run["state"] == "done" for run in json.loads(line[6:])["jobs"]):
                connection.close()
                return
        self.fail("no event told of the end")

    def test_a_thousand_runs(self):
        self.server.start("ball.toml")
        self.server.wait("ball.run", ("done",))
        for n in range(1000):
            copy = self.folder / f"copy-{n}.run"
            copy.mkdir()
            for name in ("manifest.json", "result.json", "progress.json"):
                shutil.copy(self.folder / "ball.run" / name, copy)
        self.server.get("/api/jobs")
        start = time.monotonic()
        self.assertEqual(len(self.server.get("/api/jobs")), 1001)
        seconds = time.monotonic() - start
        print(f"1001 runs listed in {1e3 * seconds:.0f} ms")
        if TIMED:
            self.assertLess(seconds, 1.0)


    def test_files_as_they_grow(self):
        self.server.start("ball.toml")
        self.server.wait("ball.run", ("done",))
        whole = (self.folder / "ball.run" / "result.json").read_bytes()
        for begin in (0, 1, 100, len(whole)):
            self.assertEqual(self.server.ask("GET", f"/files/ball.run/result.json?from={begin}")[2], whole[begin:])
        for begin in (len(whole) + 1, -1, "x", "1x", 2**70):
            self.assertEqual(self.server.ask("GET", f"/files/ball.run/result.json?from={begin}")[0], 400, begin)
        for span in ("bytes=0-5", "bytes=100000-", "bytes=5-1", "bytes=-99999999", "bytes=0-1,2-3", "bytes=18446744073709551615-"):
            for path in ("/files/ball.run/result.json", "/api/jobs"):
                self.assertIn(self.server.ask("GET", path, headers={"Range": span})[0], (400, 416), span)
        self.assert_alive()


class Queue(ServerCase):
    def setUp(self):
        super().setUp()
        text = (source / "tests" / "app" / "small-ejection.toml").read_text().replace('"6 ms"', '"60 ms"', 1)
        for name in "abc":
            (self.folder / f"{name}.toml").write_text(text)

    def states(self):
        return {job["name"]: job["state"] for job in self.server.get("/api/jobs")}

    def restart(self):
        self.server.end(signal.SIGKILL)
        self.server = Server(self.folder)
        self.addCleanup(lambda s=self.server: s.process.poll() is None and s.end())

    def stop(self, *names):
        for name in names:
            self.server.post("/api/stop", job=name)
        for name in names:
            if self.server.run(name):
                self.server.wait(name, ("stopped", "failed"))

    def test_one_after_the_other(self):
        for name in "abc":
            self.assertEqual(self.server.start(f"{name}.toml")[0], 200)
        self.server.wait("a.run", ("running",))
        self.assertEqual((self.states()["b.run"], self.states()["c.run"]), ("waiting", "waiting"))
        self.assertEqual(self.server.run("c.run")["before"], 1)
        self.assertEqual(self.server.start("b.toml")[0], 400, "it waits already")
        self.assertEqual(self.server.post("/api/stop", job="b.run")[0], 200)
        self.assertNotIn("b.run", self.states(), "cancelled")
        self.stop("a.run")
        self.server.wait("c.run", ("running",))
        self.stop("c.run")
        self.assertFalse((self.folder / "b.run").exists())

    def test_so_many_at_once(self):
        self.assertEqual(self.server.post("/api/at-once", count=2)[0], 200)
        for count in (0, -1, 1000, 2**32 + 1, 2**63, 2**64 + 1, -2**32 + 1, 10**400, "2", 1.5, True, None):
            status, answer = self.server.post("/api/at-once", count=count)
            self.assertEqual(status, 400, count)
            self.assertRegex(answer["error"], "at once cannot be|count|form that the page sends")
        self.assertEqual(json.loads((self.folder / ".ejecta" / "queue.json").read_text())["at_once"], 2)
        for name in "abc":
            self.server.start(f"{name}.toml")
        self.server.wait("b.run", ("running",))
        self.server.wait("a.run", ("running",))
        self.assertEqual(self.states()["c.run"], "waiting")
        self.restart()
        self.assertEqual(self.states()["c.run"], "waiting", "two at once still")
        self.stop("c.run", "a.run", "b.run")

    def test_servers_come_and_go(self):
        """Nothing is lost and nothing started twice, whenever a server dies."""
        self.server.start("a.toml")
        self.server.start("b.toml")
        for _ in range(3):
            self.restart()
        self.server.wait("a.run", ("running",))
        self.assertEqual(self.states()["b.run"], "waiting")
        self.stop("a.run")
        self.server.wait("b.run", ("running",))
        self.stop("b.run")
        self.assertEqual(set(self.states()), {"a.run", "b.run"})

    def test_a_server_that_died_before_it_could_say_that_it_had_started(self):
        self.server.start("a.toml")
        self.server.wait("a.run", ("running",))
        self.server.end(signal.SIGKILL)
        file = self.folder / ".ejecta" / "queue.json"
        queue = json.loads(file.read_text())
        queue["waiting"], queue["started"] = queue["started"], []
        file.write_text(json.dumps(queue))
        process = json.loads((self.folder / "a.run" / "progress.json").read_text())["process"]
        self.server = Server(self.folder)
        self.addCleanup(lambda s=self.server: s.process.poll() is None and s.end())
        end = time.monotonic() + 10
        while json.loads(file.read_text())["waiting"]:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        self.assertEqual(json.loads((self.folder / "a.run" / "progress.json").read_text())["process"], process)
        self.assertEqual(self.states(), {"a.run": "running"})
        self.stop("a.run")

    def test_two_servers_of_one_folder(self):
        other = Server(self.folder)
        self.addCleanup(other.end)
        answers = []
        threads = [threading.Thread(target=lambda s=s: answers.append(s.start("a.toml")[0])) for s in (self.server, other) * 4]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual(sorted(answers), [200] + [400] * 7)
        other.start("b.toml")
        self.server.wait("a.run", ("running",))
        self.assertEqual(self.states()["b.run"], "waiting")
        self.stop("b.run", "a.run")

    def test_a_case_that_was_changed_while_it_waited(self):
        (self.folder / "base.toml").write_text(BALL)
        for name in ("changed", "same"):
            (self.folder / f"{name}.toml").write_text('extends = "base.toml"\n')
        self.server.start("a.toml")
        for name in ("ball", "changed", "same"):
            self.server.start(f"{name}.toml")
        (self.folder / "ball.toml").write_text(BALL.replace("10 mm", "11 mm"))
        (self.folder / "same.toml").write_text('extends = "base.toml"   # a word more\n')
        self.stop("a.run")
        run = self.server.wait("ball.run", ("failed", "done"))
        self.assertEqual(run["state"], "failed")
        self.assertIn("was changed while ball.run waited", run["said"])
        self.assertEqual(self.server.wait("same.run", ("failed", "done"))["state"], "done")
        self.server.start("a.toml")
        self.server.start("changed.toml")
        (self.folder / "base.toml").write_text(BALL.replace("10 mm", "11 mm"))
        self.stop("a-2.run")
        self.assertEqual(self.server.wait("changed-2.run", ("failed", "done"))["state"], "failed", "what it extends was changed")

    def test_a_damaged_queue_is_said_to_be_damaged(self):
        (self.folder / ".ejecta").mkdir()
        for text in ("{", *(json.dumps({"at_once": n, "waiting": [], "started": []}) for n in (0, 2**32 + 1, "2"))):
            (self.folder / ".ejecta" / "queue.json").write_text(text)
            status, answer = self.server.start("a.toml")
            self.assertEqual((status, "damaged" in answer["error"]), (500, True), text)


class Others(ServerCase):
    """Studies, maps, sorters."""

    def test_a_study(self):
        (self.folder / "sizes.toml").write_text(STUDY)
        self.assertEqual(self.server.start("sizes.toml", "study"), (200, {"job": "sizes.study"}))
        job = self.server.wait("sizes.study", ("done", "failed"))
        self.assertEqual((job["state"], job["kind"], job["progress"]), ("done", "study", "3 of 3 runs done"))
        self.assertTrue(job["report"])
        study = self.server.get("/api/study?name=sizes.study")
        self.assertEqual([run["body.ball.diameter"] for run in study["runs"]], [0.008, 0.009, 0.01])
        for name in ("", "ball.toml", "../x", "nothing.study"):
            self.assertEqual(self.server.ask("GET", f"/api/study?name={name}")[0], 400, name)

    def test_a_study_that_dies_and_goes_on(self):
        slow = (source / "tests" / "app" / "small-ejection.toml").read_text().replace('"6 ms"', '"60 ms"', 1)
        (self.folder / "slow.toml").write_text(slow + STUDY[len(BALL):].replace("body.ball.diameter", "valve.duration").replace("mm", "ms"))
        self.server.start("slow.toml", "study")
        self.server.wait("slow.study", ("running",))
        log = str(self.folder.resolve() / "slow.study.log")
        holders = [int(p.name) for p in Path("/proc").iterdir() if p.name.isdigit() and os.access(p / "fd", os.R_OK)
                   and os.path.exists(p / "fd" / "1") and os.readlink(p / "fd" / "1") == log]
        os.kill(min(holders), signal.SIGKILL)
        self.assertEqual(self.server.wait("slow.study", ("failed", "stopped"))["state"], "failed", "a dead one is said to be dead")
        self.assertEqual(self.server.post("/api/resume", job="slow.study")[0], 200)
        self.server.wait("slow.study", ("running",))
        self.server.post("/api/stop", job="slow.study")
        self.server.wait("slow.study", ("stopped",))

    def test_a_sorter(self):
        for name in ("sorter/tutorial.toml", "paper/setup"):
            copy = self.folder / name
            copy.parent.mkdir(exist_ok=True)
            (shutil.copytree if copy.suffix == "" else shutil.copy)(source / "cases" / name, copy)
        self.server.start("sorter/tutorial.toml", "sort")
        self.server.post("/api/stop", job="sorter/tutorial.sort")
        job = self.server.wait("sorter/tutorial.sort", ("stopped", "done", "failed"))
        self.assertEqual((job["state"], job["kind"], job["case"]), ("stopped", "sort", "sorter/tutorial.toml"), job)

    def test_what_is_no_command(self):
        for kind in ("", "rm", "jet", "run --force", "serve"):
            self.assertEqual(self.server.start("ball.toml", kind)[0], 400, kind)


class Starting(unittest.TestCase):
    def test_without_a_folder(self):
        said = subprocess.run([program, "serve", "/no/such/folder"], capture_output=True, text=True)
        self.assertEqual(said.returncode, 2)
        self.assertIn("example:", said.stderr)

    def test_ends_on_a_signal(self):
        server = Server(scratch)
        server.end()
        self.assertEqual(server.process.returncode, 0)


if __name__ == "__main__":
    scratch.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=1)
