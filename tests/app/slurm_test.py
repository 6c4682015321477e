#!/usr/bin/python3
"""A study on a real SLURM of one node, on this machine: job arrays, a killed task, requeue, the bits of the local run.

Usage: slurm_test.py EJECTA. Ends with 77 (skipped) where slurmctld and slurmd are absent or cannot be started
(root is needed). It takes no munge: auth/none is SLURM's own plugin for tests.
"""

import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

EJECTA = os.path.abspath(sys.argv[1])
FALL = """[run]
title = "a ball falls on a floor"
end_time = "4 s"
[flow]
solver = "none"
[output]
report = false
[checkpoint]
every_wall_time = "0.2 s"
[[body]]
name = "ball"
diameter = "10 mm"
[[wall]]
name = "floor"
point = ["0 mm", "0 mm", "-20 mm"]
[study]
quantities = ["/bodies/0/final_velocity_m_s", "/bodies/0/max_contact_force_N"]
[[study.vary]]
key = "environment.gravity"
from = ["0 m/s2", "0 m/s2", "-1 m/s2"]
to = ["0 m/s2", "0 m/s2", "-20 m/s2"]
steps = 8
"""


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def configuration(folder):
    host = socket.gethostname().split(".")[0]
    cpus = os.cpu_count()
    for name in ("state", "spool"):
        (folder / name).mkdir()
    return f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
MpiDefault=none
ReturnToService=2
MaxArraySize=6
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
InactiveLimit=0
KillWait=5
MinJobAge=300
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def main():
    programs = {name: shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")
                for name in ("slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel")}
    if missing := [name for name, path in programs.items() if not path]:
        skip(f"no {', '.join(missing)} (Debian: slurm-wlm)")
    if os.geteuid() != 0:
        skip("slurmd of a test is started by root")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="ejecta-slurm-"))
    (folder / "slurm.conf").write_text(configuration(folder))
    environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"))
    daemons = []
    try:
        for name in ("slurmctld", "slurmd"):
            daemons.append(subprocess.Popen([programs[name], "-D", "-f", str(folder / "slurm.conf")], env=environment,
                                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
            time.sleep(1.0)
        for _ in range(60):
            state = subprocess.run(["sinfo", "-h", "-o", "%T"], env=environment, capture_output=True, text=True).stdout
            if "idle" in state:
                break
            time.sleep(0.5)
        else:
            log = "".join((folder / f"{n}.log").read_text()[-1500:] for n in ("slurmctld", "slurmd") if (folder / f"{n}.log").exists())
            skip(f"SLURM does not start here:\n{log}")
        run_study(folder, environment)
    finally:
        for daemon in daemons:
            daemon.send_signal(signal.SIGTERM)
        for daemon in daemons:
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
        shutil.rmtree(folder, ignore_errors=True)


def run_study(folder, environment):
    case = folder / "fall.toml"
    case.write_text(FALL)
    local = subprocess.run([EJECTA, "study", case, "--out", folder / "local", "-q"], capture_output=True, text=True)
    assert local.returncode == 0, local.stderr
    driver = subprocess.Popen([EJECTA, "study", case, "--out", folder / "cluster", "--slurm"], env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    killed = False
    deadline = time.time() + 240
    while driver.poll() is None and time.time() < deadline:
        # One task is killed as it runs: its job fails, and another one goes on from its checkpoint.
        for one in (folder / "cluster/running").glob("*.json") if not killed else ():
            try:
                life = json.loads(one.read_text())
                if life["fraction"] > 0.02:
                    os.kill(life["process"], signal.SIGKILL)
                    killed = True
                    break
            except (ValueError, KeyError, FileNotFoundError, ProcessLookupError):
                pass
        time.sleep(0.02)
    out = driver.communicate(timeout=10)[0] if driver.poll() is not None else "did not end"
    assert driver.returncode == 0, out
    assert killed, "no task was seen running"
    same = (folder / "local/result.json").read_text() == (folder / "cluster/result.json").read_text()
    assert same, "the cluster's results are not the local ones"
    arrays = len(list((folder / "cluster/slurm").glob("array-*.sh")))
    assert arrays >= 3, f"{arrays} arrays: 8 tasks in arrays of at most 5, and the killed one again"
    print(f"8 tasks in {arrays} job arrays, one killed and run again: the local bits")


if __name__ == "__main__":
    main()
