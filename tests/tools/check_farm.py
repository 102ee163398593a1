#!/usr/bin/python3
"""Films a clip by the job files of tools/farm, and compares the film with the one that is made in one go; encodes it in
parts by the lines of docs/how-to/farm.md, and compares what the joined capture exposes to.

    check_farm.py --program nutik-cl --farm tools/farm --work FOLDER --only slurm|parallel|flamenco|deadline

`slurm` starts a controller and two nodes on this machine (slurmctld, slurmd and munged, as the user who runs this, on
ports of their own), kills one of the nodes with all that runs on it in the middle of a task, and lets it come back.
`flamenco` and `deadline` run the commands that the files make of the frames; the farms' own programs are not there.
"""

import argparse
import getpass
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

from report import Report

FRAMES = 48
# Of a task, so that the film is not a multiple of it.
CHUNK = 10
PATIENCE_S = 240
# Frames of 720p, so that a task lasts long enough to be killed in it.
FILM = ["--out-fps", "24", "--out-angle", "180", "clip.tik"]


def need(*programs):
    for each in programs:
        if not shutil.which(each) and not Path("/usr/sbin", each).exists():
            print(f"SKIPPED: {each} is not installed")
            raise SystemExit(0)


def run(*command, **options):
    return subprocess.run([str(each) for each in command], check=True, text=True, **options)


def frames_of(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.png"))}


def has_files_without_names(folder):
    try:
        os.close(os.open(folder, os.O_TMPFILE | os.O_WRONLY))
    except OSError:
        return False
    return True


class Scene:
    """A capture, and its film made in one go."""

    def __init__(self, program, folder):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        self.folder = folder
        self.environment = os.environ | {"PATH": f"{Path(program).parent}:/usr/sbin:{os.environ['PATH']}"}
        run("ffmpeg", "-v", "error", "-f", "lavfi", "-i", "testsrc2=size=1280x720:rate=120:duration=2", "-c:v",
            "ffv1", folder / "clip.mkv")
        run("nutik-cl", "encode", "-q", "clip.mkv", "clip.tik", cwd=folder, env=self.environment)
        (folder / "whole").mkdir()
        run("nutik-cl", "video", "-q", *FILM, "whole/%05d.png", cwd=folder, env=self.environment)
        self.whole = frames_of(folder / "whole")

    def compare(self, report, kills=0):
        film = frames_of(self.folder / "film")
        other = [name for name, data in self.whole.items() if film.get(name) != data]
        report.hold(len(self.whole) == FRAMES and not other and len(film) == FRAMES,
                    f"{len(film)} frames of {FRAMES}, and {len(other)} of them not those of the film in one go")
        left = [path.name for path in (self.folder / "film").iterdir() if path.suffix != ".png"]
        # Where a file needs a name while it is written, a process that is killed leaves it.
        named = [name for name in left if re.fullmatch(r"\.\d{5}\.png\.nutik-[0-9a-f]{16}\.part", name)]
        may_stay = 0 if has_files_without_names(self.folder) else kills
        report.hold(len(left) == len(named) <= may_stay, f"files that are no frames: {left}")


def lines_of_page(farm, command, *more):
    """Those of the page that run `command` and have these words."""
    page = (farm.parent.parent / "docs/how-to/farm.md").read_text()
    lines = [line.strip() for line in page.splitlines() if line.startswith("    ")]
    return [line for line in lines if command in line and all(word in line for word in more)]


def replaced(line, report, *pairs):
    for shown, here in pairs:
        report.hold(shown in line, f"the page's line has {shown!r}")
        line = line.replace(shown, here)
    return line


def compare_capture(scene, report):
    """Of hour.tik, which was joined of parts of a second, with the capture that was encoded in one go."""
    expose = "nutik-cl -q --precision fixed --no-recipe --start 0.5s --exposure 1s".split()
    for capture, picture in ("clip.tik", "one.png"), ("hour.tik", "parts.png"):
        run(*expose, capture, picture, cwd=scene.folder, env=scene.environment)
    one, parts = ((scene.folder / name).read_bytes() for name in ("one.png", "parts.png"))
    report.hold(len(list(scene.folder.glob("part-*.tik"))) == 2 and one == parts,
                "two parts, and the capture joined of them exposes to the same")


class Cluster:
    """A controller and the nodes `one` and `two`, each of one task at a time, all on this machine."""

    def __init__(self, folder, environment):
        self.folder, self.daemons = folder, {}
        self.environment = environment | {"SLURM_CONF": str(folder / "slurm.conf")}
        (folder / "key").write_bytes(os.urandom(128))
        (folder / "key").chmod(0o400)
        controller, one, two = free_ports(3)
        me, host = getpass.getuser(), socket.gethostname().split(".")[0]
        nodes = "\n".join(f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1"
                          for name, port in (("one", one), ("two", two)))
        (folder / "slurm.conf").write_text(f"""\
ClusterName=farm
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmUser={me}
SlurmdUser={me}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/linear
MpiDefault=none
SlurmdTimeout=5
SchedulerParameters=bf_interval=1
ReturnToService=2
{nodes}
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        for each in "state", "spool.one", "spool.two":
            (folder / each).mkdir()

    def start(self, name, *command):
        log = open(self.folder / f"{name}.log", "ab")
        self.daemons[name] = subprocess.Popen(command, stdout=log, stderr=log, env=self.environment,
                                              start_new_session=True)

    def start_node(self, name):
        self.start(name, "slurmd", "-D", "-N", name)

    def start_all(self):
        self.start("munged", "munged", "--foreground", "--force", f"--socket={self.folder}/munge.socket",
                   f"--key-file={self.folder}/key", f"--pid-file={self.folder}/munge.pid",
                   f"--seed-file={self.folder}/munge.seed", f"--log-file={self.folder}/munge.log")
        wait_for(lambda: (self.folder / "munge.socket").exists(), "munged's socket")
        self.start("slurmctld", "slurmctld", "-D", "-c")
        for each in "one", "two":
            self.start_node(each)
        wait_for(self.has_two_idle_nodes, "two idle nodes")

    def has_two_idle_nodes(self):
        if ended := [name for name, daemon in self.daemons.items() if daemon.poll() is not None]:
            raise SystemExit(f"FAILED  {', '.join(ended)} ended")
        return self.ask("sinfo", "-h", "-t", "idle", "-o", "%D") == "2"

    def ask(self, *command):
        answer = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        return answer.stdout.strip()

    def kill_node(self, name):
        """The node is gone at once, with its job's steps and what they run."""
        doomed = [self.daemons.pop(name)]
        doomed[0].send_signal(signal.SIGSTOP)
        marked = [pid for pid in pids() if f"SLURMD_NODENAME={name}" in environment_of(pid, self.folder)]
        steps = {parent_of(pid) for pid in marked} - set(marked) - {os.getpid(), 1}
        for pid in [*steps, *marked]:
            os.kill(pid, signal.SIGKILL)
        doomed[0].kill()
        doomed[0].wait()

    def stop(self):
        for name in [name for name in self.daemons if name not in ("slurmctld", "munged")]:
            self.kill_node(name)
        for each in self.daemons.values():
            each.kill()
            each.wait()


def pids():
    return [int(each) for each in os.listdir("/proc") if each.isdigit()]


def environment_of(pid, folder):
    """The variables of a process of the cluster in `folder`; of any other, none."""
    try:
        words = Path(f"/proc/{pid}/environ").read_text(errors="replace").split("\0")
    except OSError:
        return []
    return words if f"SLURM_CONF={folder}/slurm.conf" in words else []


def parent_of(pid):
    try:
        return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 1


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def wait_for(condition, what, pause_s=0.2):
    end = time.monotonic() + PATIENCE_S
    while not (found := condition()):
        if time.monotonic() > end:
            raise SystemExit(f"FAILED  no {what} in {PATIENCE_S} s")
        time.sleep(pause_s)
    return found


@contextmanager
def cluster(environment):
    # Below /tmp, since a socket's path has at most 107 characters.
    folder = Path(tempfile.mkdtemp(prefix="nutik-farm-"))
    made = Cluster(folder, environment)
    try:
        made.start_all()
        yield made
    except BaseException:
        for each in sorted(folder.glob("*.log")):
            print(f"--- {each.name}\n{each.read_text(errors='replace')[-2000:]}")
        raise
    finally:
        made.stop()
        shutil.rmtree(folder)


def check_slurm(scene, farm, report):
    alone = subprocess.run(["bash", farm / "film.sbatch", *FILM, "none/%05d.png"], cwd=scene.folder, capture_output=True,
                           env=scene.environment, text=True)
    report.hold(alone.returncode != 0 and "sbatch --array=" in alone.stderr, "a job without --array makes no frames")
    need("slurmctld", "slurmd", "munged", "sbatch")
    if not os.path.ismount("/sys/fs/cgroup"):
        print("SKIPPED: no control groups are mounted on /sys/fs/cgroup, without which slurmd does not start")
        return
    with cluster(scene.environment) as slurm:
        tasks = -(-FRAMES // CHUNK)
        submit = ["sbatch", "--parsable", f"--array=0-{tasks - 1}", "--export", f"ALL,FRAMES={CHUNK}"]
        (scene.folder / "film").mkdir()
        job = run(*submit, farm / "film.sbatch", *FILM, "film/%05d.png", cwd=scene.folder, env=slurm.environment,
                  capture_output=True).stdout.strip()

        def begun():
            """1 more than the task on the node `two` whose first frame is there and those from its middle on are not."""
            for line in slurm.ask("squeue", "-h", "-r", "-j", job, "-t", "R", "-w", "two", "-o", "%K").split():
                made = {path.name for path in (scene.folder / "film").glob("*.png")}
                first = int(line) * CHUNK
                if f"{first:05}.png" in made and f"{first + CHUNK // 2:05}.png" not in made:
                    return int(line) + 1
            return None

        task = wait_for(begun, "task in the middle of its frames on the node to be killed", 0.02) - 1
        slurm.kill_node("two")
        last = min(task * CHUNK + CHUNK, FRAMES) - 1
        report.hold(not (scene.folder / f"film/{last:05}.png").exists(), f"task {task} was killed before its last frame")
        wait_for(lambda: "down" in slurm.ask("sinfo", "-h", "-n", "two", "-o", "%T"), "notice of the lost node")
        slurm.start_node("two")
        wait_for(lambda: not slurm.ask("squeue", "-h", "-j", job), "end of the film")
        log = (scene.folder / f"nutik-film-{job}-{task}.log").read_text()
        report.hold("frames there already" in log or "frame there already" in log,
                    f"task {task} came back and made what was missing:\n{log}")
        scene.compare(report, kills=1)

        # A setting that no other run mends fails at once; a device that is not there, after three more tries.
        failing = [(run("sbatch", "--parsable", "--array=0", "--export", "ALL", farm / "film.sbatch", *FILM, *words,
                        "film/again-%05d.png", cwd=scene.folder, env=slurm.environment | setting,
                        capture_output=True).stdout.strip(), exit_code, restarts)
                   for words, setting, exit_code, restarts in ((["--out-angle", "0"], {}, 2, 0),
                                                               ([], {"OCL_ICD_VENDORS": "/nowhere"}, 4, 3))]
        check_encoding_by_slurm(scene, farm, report, slurm)
        for job, exit_code, restarts in failing:
            state = wait_for(lambda: ended(slurm, job), "end of a film that fails")
            report.hold(f"ExitCode={exit_code}:0" in state and f"Restarts={restarts} " in state,
                        f"exit status {exit_code} after {restarts} restarts")


def check_encoding_by_slurm(scene, farm, report, slurm):
    encode, = lines_of_page(farm, "nutik-cl encode", "sbatch")
    join, = lines_of_page(farm, "nutik-cl join", "sbatch")
    encode = replaced(encode, report, ("0-56", "0-1"), ("SLURM_ARRAY_TASK_ID * 64", "SLURM_ARRAY_TASK_ID * 1"),
                      ("+ 64", "+ 1"), ("hour.mov", "clip.mkv"))
    run("bash", "-c", f"{encode}; {join}", cwd=scene.folder, env=slurm.environment, capture_output=True)
    wait_for(lambda: not slurm.ask("squeue", "-h"), "end of the encoding")
    compare_capture(scene, report)


def ended(slurm, job):
    state = slurm.ask("scontrol", "show", "job", job, "-o")
    return state if "JobState=FAILED" in state or "JobState=COMPLETED" in state else None


def check_parallel(scene, farm, report):
    need("parallel")
    film, encoding = (lines_of_page(farm, command, "| parallel") for command in ("nutik-cl video", "nutik-cl encode"))
    report.hold(len(film) == len(encoding) == 1, "the page has a line of GNU parallel for each of both")
    line = replaced(film[0], report, ("seq 0 100 86399", f"seq 0 {CHUNK} {FRAMES - 1}"), ("+ 99", f"+ {CHUNK - 1}"),
                    ("--out-fps 24 hour.tik", " ".join(FILM)))
    (scene.folder / "film").mkdir()
    run("bash", "-c", line, cwd=scene.folder, env=scene.environment)
    scene.compare(report)
    line = replaced(encoding[0], report, ("seq 0 64 3599", "seq 0 1 1"), ("+ 64", "+ 1"), ("hour.mov", "clip.mkv"))
    run("bash", "-c", line, cwd=scene.folder, env=scene.environment)
    run("bash", "-c", "nutik-cl join -q part-*.tik -o hour.tik", cwd=scene.folder, env=scene.environment)
    compare_capture(scene, report)


def check_deadline(scene, farm, report):
    job, plugin = (dict(line.split("=", 1) for line in (farm / name).read_text().splitlines())
                   for name in ("deadline-job.txt", "deadline-plugin.txt"))
    report.hold(job["Plugin"] == "CommandLine" and job["Frames"] == "0-86399" and job["ChunkSize"] == "100",
                f"an hour of frames, 100 a task: {job}")
    (scene.folder / "film").mkdir()
    for first in range(0, FRAMES, CHUNK):
        # Deadline ends the last task at the film's last frame.
        words = (plugin["Arguments"].replace("<STARTFRAME>", str(first))
                 .replace("<ENDFRAME>", str(min(first + CHUNK, FRAMES) - 1))
                 .replace("--out-fps 24 hour.tik", " ".join(FILM)))
        run(plugin["Executable"], *words.split(), cwd=scene.folder, env=scene.environment)
    scene.compare(report)


# What Flamenco's manager gives to a job type's script.
FLAMENCO = """
const tasks = [];
const author = {
    Task: (name, type) => ({ name, type, commands: [], addCommand(command) { this.commands.push(command); } }),
    Command: (name, parameters) => ({ name, parameters }),
};
function frameChunker(frames, size) {
    const [first, last] = frames.split("-").map(Number), chunks = [];
    for (let at = first; at <= last; at += size) chunks.push(`${at}-${Math.min(at + size - 1, last)}`);
    return chunks;
}
"""


def check_flamenco(scene, farm, report):
    need("node")
    settings = {"frames": f"0-{FRAMES - 1}", "chunk_size": CHUNK, "arguments": json.dumps([*FILM, "film/%05d.png"])}
    script = (FLAMENCO + (farm / "flamenco-film.js").read_text() +
              f"compileJob({{ settings: {json.dumps(settings)}, addTask: (task) => tasks.push(task) }});\n"
              "console.log(JSON.stringify({ tasks, keys: JOB_TYPE.settings.map((setting) => setting.key) }));")
    made = json.loads(run("node", "-e", script, capture_output=True).stdout)
    report.hold(made["keys"] == list(settings), f"the settings that it reads are those that it names: {made['keys']}")
    (scene.folder / "film").mkdir()
    for task in made["tasks"]:
        for command in task["commands"]:
            run(command["parameters"]["exe"], *command["parameters"]["args"], cwd=scene.folder, env=scene.environment)
    scene.compare(report)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    checks = {"slurm": check_slurm, "parallel": check_parallel, "flamenco": check_flamenco, "deadline": check_deadline}
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--farm", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--only", choices=checks, required=True)
    arguments = parser.parse_args()
    report = Report()
    scene = Scene(arguments.program.resolve(), arguments.work.resolve() / arguments.only)
    checks[arguments.only](scene, arguments.farm.resolve(), report)
    report.end(f"; see {arguments.work}")


if __name__ == "__main__":
    main()
