"""Forks, spawned processes, daemon threads and the interpreter's end, while work is done."""

import subprocess
import sys
import unittest

import support

# A parent that has exposed a picture; what its child does follows.
PARENT = """
import multiprocessing, sys
import numpy as np, nutik

pictures = np.random.default_rng(1).integers(0, 256, (20, 16, 16), np.uint8)

def expose(capture=None):
    return (capture or nutik.encode(pictures, rate=100)).render(exposure="20f").array.tobytes()

if __name__ == "__main__":
    kept = nutik.encode(pictures, rate=100)
    wanted = expose(kept)
"""
FORKED = PARENT + """
    def answer(queue):
        for capture in (kept, None):
            try:
                queue.put(expose(capture) == wanted)
            except nutik.DeviceError as error:
                queue.put(str(error))
        queue.put(expose(nutik.encode(pictures, rate=100, renderer="reference")) is not None)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=answer, args=(queue,), daemon=True)
    child.start()
    print([queue.get(timeout=30) for _ in range(3)])
    child.join(30)
    print(child.exitcode, expose(kept) == wanted)
"""
SPAWNED = PARENT + """
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        print(pool.map(expose, [None, None]) == [wanted] * 2)
"""
# A viewer's thread that asks for pictures, or does something else that takes long, when the interpreter ends.
DAEMON = """
import threading, time, warnings
import numpy as np, nutik

warnings.simplefilter("ignore")  # noise has no background
pictures = np.random.default_rng(1).integers(0, 256, (40, 128, 128, 3), np.uint8)
capture = nutik.encode(pictures, rate=100)
blocks = nutik.encode(pictures, rate=100, block_samples=2)  # more than one step, which are told at the end
started = threading.Event()

def busy(*_):
    end = time.monotonic() + 0.15  # longer than a thread between two calls is waited for
    while time.monotonic() < end:
        pass

def view():
    while True:
        started.set()
        {work}

for _ in range(3):
    threading.Thread(target=view, daemon=True).start()
started.wait()
time.sleep(0.2)
"""
WORKS = ['capture.render(exposure="40f")', 'nutik.encode(pictures, rate=100)', 'capture.activity()',
         'capture.background()',
         'capture.trace(tag=0, functions=[(0, 1), (0.4, 1)], mask=np.zeros((128, 128), np.uint8))',
         'capture.trace(3, 4, start=0, exposure="40f", progress=busy)',
         'blocks.trace(3, 4, start=0, exposure="40f", progress=busy)',
         'capture.trace(3, 4, start=0, exposure="40f"); busy()',
         'nutik.encode((each for each in pictures), rate=100)',
         'nutik.Mask(np.arange(128 * 128).reshape(128, 128) % 200).feathered(20)']


class Processes(support.TestCase):
    def run_script(self, text):
        script = self.folder / "script.py"
        script.write_text(text)
        done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=100)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.splitlines()

    def test_a_fork_after_use_is_told(self):
        answers, rest = self.run_script(FORKED)
        self.assertEqual(answers.count("forked"), 2, answers)
        self.assertEqual(answers.count("spawn"), 2, answers)
        self.assertTrue(answers.endswith(", True]"), answers)
        self.assertEqual(rest, "0 True")

    def test_spawned_processes_expose(self):
        self.assertEqual(self.run_script(SPAWNED), ["True"])

    def test_an_interpreter_ends_under_daemon_threads(self):
        for work in WORKS:
            with self.subTest(work=work):
                self.run_script(DAEMON.format(work=work))


if __name__ == "__main__":
    unittest.main()
