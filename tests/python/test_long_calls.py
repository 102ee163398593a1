"""All calls that take long, in a matrix: Ctrl-C is answered within half a second, who wants to be told of progress is,
threads side by side, daemon threads at the interpreter's end, spawned and forked processes. A call that is not here is
found."""

import inspect
import os
import re
import subprocess
import sys
import unittest

import nutik

import support

# What all scripts begin with. Each call takes a second or more on one core, but for those that are quick by nature.
SCENE = """
import os, signal, sys, tempfile, threading, time, warnings
import numpy as np, nutik

warnings.simplefilter("ignore")  # noise has no background
SIZE = {size}
folder = tempfile.mkdtemp(prefix="nutik-")
noise = np.random.default_rng(1).integers(0, 256, (64 * SIZE, 128, 192, 3), np.uint8)
box = np.broadcast_to(noise[0], (64, 128, 192, 3)).copy()
for k in range(64):
    box[k, 40:80, 2 * k:2 * k + 30] ^= 255
wild = nutik.Function.from_ns(range(0, 50_000_000, 2000), np.arange(25000) % 2)
regions = np.repeat(np.arange(8, dtype=np.uint8), 24)[None].repeat(128, 0)
soft = np.repeat(np.repeat(np.arange(64, dtype=np.uint8).reshape(8, 8), 40 * SIZE, 0), 40 * SIZE, 1)
shares = {{tag: (soft == tag) * 0.5 for tag in range(8)}}
# Opened where they are first needed: a forked process needs its own.
captures = {{}}
def noisy():
    if "noisy" not in captures:
        ramp = np.linspace(20, 230, 270 * 480 * SIZE * SIZE).astype(np.uint8).reshape(270 * SIZE, 480 * SIZE)
        grain = np.random.default_rng(3).integers(0, 8, (64, *ramp.shape), np.uint8)
        captures["noisy"] = np.tile(grain, (4, 1, 1)) + ramp
    return captures["noisy"]
def capture(name, pictures):
    if name not in captures:
        captures[name] = nutik.encode(pictures, folder + name, rate=960)
    return captures[name]
def of_noise(): return capture("/noise.tik", noise)
def of_box(): return capture("/box.tik", box)
WORKS = dict(
    encode=lambda told: nutik.encode(noise, rate=960, progress=told),
    encode_slowly=lambda told: nutik.encode(noise, folder + "/slow.tik", rate=960, codec="zstd:19", progress=told),
    encode_with_noise=lambda told: nutik.encode(noisy(), rate=960, noise="auto", progress=told),
    encode_an_iterable=lambda told: nutik.encode((each for each in noise), rate=960, progress=told),
    open=lambda told: nutik.open(folder + "/noise.tik", progress=told),
    join=lambda told: nutik.join([folder + "/noise.tik"] * 3, folder + "/joined.tik", progress=told),
    render=lambda told: of_noise().render({{k: wild for k in range(8)}}, regions, progress=told),
    render_many=lambda told: of_noise().render_many(starts=np.linspace(0, 0.03, 40), exposures=0.03, progress=told),
    trace=lambda told: of_noise().trace(tag=0, functions={{0: wild}}, mask=np.zeros((128, 192), np.uint8),
                                     progress=told),
    background=lambda told: of_noise().background(progress=told),
    activity=lambda told: of_noise().activity(progress=told),
    study=lambda told: of_box().study(progress=told),
    solve=lambda told: of_box().solve("M0{{[0:1], [30000000:1], [30000001:rest], [50000000:rest], [50000001:0]}}",
                                     ["all = 0.5 * plate"], free={{"rest": (-20, 20)}}, progress=told),
    records=lambda told: of_noise().records((0, 0, 64, 64), progress=told),
    codes=lambda told: of_noise()[:],
    feathered=lambda told: nutik.Mask(soft).feathered(12, progress=told),
    of_layers=lambda told: nutik.Mask.of_layers(shares, progress=told),
    batch=lambda told: nutik.batch(folder + "/list", folder + "/noise.tik", overwrite=True, progress=told),
    check=lambda told: nutik.check(folder + "/noise.tik", progress=told),
    contact=lambda told: nutik.contact(folder + "/noise.tik", folder + "/sheet.png", exposure=0.01, overwrite=True),
    noise=lambda told: nutik.noise(folder + "/still", transfer="linear", output=folder + "/camera.noise",
                                   overwrite=True),
    recover=lambda told: nutik.recover(folder + "/cut.tik", folder + "/whole.tik", overwrite=True),
    retime=lambda told: nutik.retime(folder + "/noise.tik", folder + "/slow.tik", rate=24, overwrite=True),
    validate=lambda told: nutik.validate(folder + "/noise.tik", start=0, exposure=0.03, runs=3, progress=told),
    video=lambda told: nutik.video(folder + "/noise.tik", folder + "/film.mp4", out_fps=960, overwrite=True,
                                   progress=told),
)
still = np.linspace(20, 230, 4096).reshape(64, 64) + np.random.default_rng(2).normal(0, 3, (96, 64, 64))
def prepare():
    of_noise()
    of_box()
    nutik.encode(box, folder + "/blocks.tik", rate=960, block_samples=16)
    with open(folder + "/blocks.tik", "rb") as whole, open(folder + "/cut.tik", "wb") as cut:
        cut.write(whole.read()[:-20_000])
    os.mkdir(folder + "/still")
    for k, picture in enumerate(np.clip(still, 0, 255).astype(np.uint8)):
        with open(f"{{folder}}/still/{{k:03}}.pgm", "wb") as file:
            file.write(b"P5 64 64 255 " + picture.tobytes())
    with open(folder + "/list", "w") as file:
        file.writelines(f"--start {{k}}ms --exposure 30ms {{folder}}/{{k}}.png\\n" for k in range(30))
"""
PARTS = {"study", "solve"}  # do several things one after another, each with steps of its own
# What is silent: [] has no argument, noise is measured before a sample is encoded, the rest are commands that tell
# nothing and take a moment here.
SILENT = {"codes", "contact", "noise", "recover", "retime", "check", "validate", "encode_with_noise"}

INTERRUPTED = SCENE + """
prepare()
for name, work in WORKS.items():
    begin = time.monotonic()
    told = [(begin, 0)]
    work(lambda *step: told.append((time.monotonic(), *step)))
    whole = time.monotonic() - begin
    told.append((begin + whole, told[-1][1]))
    silence = max(after[0] - before[0] for before, after in zip(told, told[1:]))
    if name not in {silent} and silence > SILENCE:
        print(f"{{name}} tells nothing for {{silence:.2f}} s of {{whole:.2f}}")
    if name not in {parts} and any(after[1] < before[1] for before, after in zip(told, told[1:])):
        print(name, "goes back")
    if FIGURES:
        print(f"{{name}}: {{whole:.2f}} s, silent {{silence:.2f}}, {{len(told) - 2}} told, last {{told[-2][1:]}}")
    worst = 0.0
    for share in (0.2, 0.6):
        sent = []
        def interrupt():
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)
        timer = threading.Timer(share * whole, interrupt)
        try:
            timer.start()
            work(None)
            timer.join()
            time.sleep(0.01)
        except KeyboardInterrupt:
            worst = max(worst, time.monotonic() - sent[0])
        except BaseException as error:
            print(name, "raised", repr(error))
    if FIGURES:
        print(f"    answered after {{worst:.2f}}")
    if worst > LIMIT:
        print(f"{{name}} answered Ctrl-C after {{worst:.2f}} s of {{whole:.2f}}")
"""
THREADED = SCENE + """
prepare()
failed = []
def work(name):
    try:
        WORKS[name](None)
    except BaseException as error:
        failed.append((name, repr(error)))
for name in WORKS:
    if name not in {programs}:  # processes of their own, which write to the same files
        threads = [threading.Thread(target=work, args=(name,)) for _ in range(2 if name not in {writing} else 1)]
        threads.append(threading.Thread(target=work, args=("codes",)))
        [each.start() for each in threads]
        [each.join() for each in threads]
print(failed or "all")
"""
DAEMON = SCENE + """
prepare()
def forever(name):
    while True:
        WORKS[name](None)
for name in WORKS:
    if child := os.fork():
        assert os.waitpid(child, 0)[1] == 0, name
        continue
    captures.update({{each: nutik.open(folder + each) for each in captures}})
    for _ in range(2):
        threading.Thread(target=forever, args=(name,), daemon=True).start()
    time.sleep(0.3)
    break  # to the interpreter's end
"""
CHILD = SCENE + """
import multiprocessing
prepare()
of_noise().render(exposure="1f")
captures.clear()
def work(name):
    try:
        WORKS[name](None)
        return "done"
    except nutik.DeviceError as error:
        return "spawn" if "spawn" in str(error) else str(error)
def answer(queue):
    for name in WORKS:
        queue.put((name, work(name)))
context = multiprocessing.get_context("fork")
queue = context.Queue()
child = context.Process(target=answer, args=(queue,), daemon=True)
child.start()
for _ in WORKS:
    print(*queue.get(timeout=60))
child.join(30)
"""
SPAWNED = SCENE + """
import multiprocessing
def work(name):
    WORKS[name](None)
    return name
if __name__ == "__main__":
    prepare()
    of_noise().render(exposure="1f")
    with multiprocessing.get_context("spawn").Pool(1, initializer=prepare) as pool:
        print(*pool.map(work, list(WORKS)))
"""
PROGRAMS = {"batch", "check", "contact", "noise", "recover", "retime", "validate", "video"}
WRITING = {"encode_slowly", "join"}
# What else is public, with more than is usual: all of them together take less than half a second of one core's time.
QUICK = SCENE + """
import io
ramp = nutik.Function.from_ns(range(20_000), np.arange(20_000) % 7)
mask = nutik.Mask(np.arange(1080 * 1920).reshape(1080, 1920) % 256)
small = nutik.encode(noise[:4, :64, :64, 0], rate=960)
picture = small.render(exposure="4f", codes=True)
picture.write(folder + "/mask.png")
many = small.render_many(starts=[0, "1f"], exposures="1f")
trace, activity = small.trace(1, 2, exposure="4f")[0], small.activity()
class Axes:
    set_xlabel = set_ylabel = plot = lambda *_, **named: None
    get_xlabel = get_ylabel = lambda *_: ""
CALLS = {{
    "boxcar": lambda: nutik.boxcar(0, 1), "shutter": lambda: nutik.shutter("gaussian", 0, 1, error=1e-4),
    "fit": lambda: nutik.fit(lambda t: np.sin(40 * t), 0, 1),
    "parse_functions": lambda: nutik.parse_functions(ramp.text()),
    "write_functions": lambda: nutik.write_functions(folder + "/ramp.fn", {{0: ramp}}),
    "read_functions": lambda: nutik.read_functions(folder + "/ramp.fn"), "devices": nutik.devices,
    "read_mask": lambda: nutik.read_mask(folder + "/mask.png"),
    "Function.from_ns": lambda: nutik.Function.from_ns(ramp.times_ns, ramp.gains),
    "Function.shifted": lambda: ramp.shifted(1),
    "Function.scaled": lambda: ramp.scaled(2), "Function.text": ramp.text, "Function.plot": lambda: ramp.plot(Axes()),
    "Trace.plot": lambda: trace.plot(Axes()), "Activity.plot": lambda: activity.plot(Axes()),
    "Mask.share": lambda: mask.share(3), "Picture.write": lambda: picture.write(io.BytesIO(), kind=".tif"),
    "Picture.to_xarray": picture.to_xarray, "Pictures.to_xarray": many.to_xarray, "Capture.to_xarray": small.to_xarray,
    "Capture.close": lambda: nutik.open(folder + "/small.tik").close(),
}}
nutik.encode(noise[:4], folder + "/small.tik", rate=960)
try:
    import xarray
except ImportError:
    CALLS = {{name: call for name, call in CALLS.items() if not name.endswith("to_xarray")}}
for call in CALLS.values():
    call()  # modules are imported, and files opened, once
for name, call in CALLS.items():
    begin = time.thread_time()
    call()
    print(name, time.thread_time() - begin)
"""


class LongCalls(support.TestCase):
    def run_script(self, text, size=1, timeout=280, **named):
        script = self.folder / "script.py"
        script.write_text(text.format(size=size, **named))
        done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=timeout,
                              env={**os.environ, "TMPDIR": str(self.folder)})
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout.splitlines()

    def works(self):
        names = {}
        exec(SCENE[SCENE.index("WORKS = dict("):SCENE.index("still = ")].replace("{{", "{").replace("}}", "}"), names)
        return set(names["WORKS"])

    def test_all_calls_are_here(self):
        """Every function that the package offers, and every method of its classes, is a row of the matrix or quick."""
        offered = {name for name in nutik.__all__ if inspect.isfunction(getattr(nutik, name))}
        for kind in filter(inspect.isclass, (getattr(nutik, name) for name in nutik.__all__)):
            for name, each in vars(kind).items():
                is_call = inspect.isroutine(each) or isinstance(each, classmethod)
                if is_call and not name.startswith("_") and each.__name__ == name:  # or a second name of one that is
                    offered.add(name if kind in (nutik.Capture, nutik.Mask) and name in self.works() else
                                f"{kind.__name__}.{name}")
        self.assertEqual(offered - self.works(), set(re.findall(r'"([\w.]+)": ', QUICK[len(SCENE):])))
        self.assertEqual(self.works() - offered, {"codes", "encode_slowly", "encode_an_iterable", "encode_with_noise"})

    def test_the_others_are_quick(self):
        took = dict(line.split() for line in self.run_script(QUICK))
        self.assertLess(sum(map(float, took.values())), 0.5, took)

    def test_ctrl_c_and_progress(self):
        """Half a second; the command line tells once a second."""
        text = INTERRUPTED.replace("LIMIT", "0.5").replace("SILENCE", "2.0").replace("FIGURES", "0")
        self.assertEqual(self.run_script(text, 2, silent=SILENT, parts=PARTS), [])

    def test_threads(self):
        self.assertEqual(self.run_script(THREADED, programs=PROGRAMS, writing=WRITING), ["all"])

    def test_daemon_threads_at_the_end(self):
        self.assertEqual(self.run_script(DAEMON), [])

    def test_forked_processes(self):
        """What needs a device says so; the rest works, and nothing hangs."""
        told = dict(line.split(maxsplit=1) for line in self.run_script(CHILD))
        self.assertEqual(set(told), self.works())
        self.assertEqual({name for name, each in told.items() if each not in ("done", "spawn")}, set(), told)
        self.assertLessEqual({"encode", "activity", "feathered", *PROGRAMS}, {name for name, each in told.items()
                                                                              if each == "done"})

    def test_spawned_processes(self):
        (told,) = self.run_script(SPAWNED)
        self.assertEqual(set(told.split()), self.works())


if __name__ == "__main__":
    unittest.main()
