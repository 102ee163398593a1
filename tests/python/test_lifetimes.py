"""What lives how long: views of pictures, arrays that are read, work that Ctrl-C ends, Python's lock, memory."""

import contextvars
import gc
import itertools
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import weakref

import nutik
import numpy as np

import support


class Views(support.TestCase):
    def test_they_keep_their_picture(self):
        pictures = support.moving_box()
        capture = nutik.encode(pictures, rate=960)
        picture = capture.render(start=0, exposure="10ms")
        values = picture.array.copy()
        views = [picture.array, np.asarray(picture), picture.array[3:9, ::2]]
        wanted = [values, values, values[3:9, ::2]]
        self.assertTrue(all(np.shares_memory(each, views[0]) for each in views), "it was copied")
        tags = nutik.Mask(support.tags()).tags
        del picture, capture
        gc.collect()
        churn = [np.full(values.shape, 7, values.dtype) for _ in range(50)]  # takes memory that was given back
        for view, value in zip(views, wanted):
            self.assert_same(np.ascontiguousarray(view), value)
        self.assert_same(tags, support.tags())
        del churn

    def test_nobody_writes_to_them(self):
        capture = nutik.encode(support.moving_box(), rate=960)
        picture = capture.render(start=0, exposure="10ms")
        for view in (picture.array, np.asarray(picture), nutik.Mask(support.tags()).tags,
                     capture.background().uncertain, capture.activity().changes,
                     capture.trace(1, 2, exposure="10ms")[0].light):
            with self.assertRaises(ValueError):
                view[...] = 0
        with self.assertRaises(ValueError):
            picture.array.flags.writeable = True

    def test_an_array_is_let_go_once_it_is_read(self):
        class Pictures(np.ndarray):  # which can be referred to weakly
            pass

        array = support.moving_box().view(Pictures)
        alive = weakref.ref(array)
        capture = nutik.encode(array, rate=960)
        del array
        gc.collect()
        self.assertIsNone(alive())
        self.assertEqual(capture.render(exposure="1f").shape, (45, 80, 3))


class Iterables(support.TestCase):
    def test_few_of_their_pictures_are_held(self):
        alive = most = 0

        def gone():
            nonlocal alive
            alive -= 1

        def camera():
            nonlocal alive, most
            for k in range(300):
                picture = np.full((64, 64), k % 251, np.uint8)
                weakref.finalize(picture, gone)
                alive += 1
                most = max(most, alive)
                yield picture

        for output in (None, self.path("clip.tik")):
            nutik.encode(camera(), output, rate=960)
            self.assertLessEqual(most, 3)


class Interruptions(support.TestCase):
    """Ctrl-C is a signal to this process; the work itself sends it, so that it surely has begun."""

    def test_encoding_ends(self):
        def endless():
            for k in itertools.count():
                if k == 200:
                    os.kill(os.getpid(), signal.SIGINT)
                yield np.full((32, 32), k % 251, np.uint8)

        for output in (None, self.path("clip.tik")):
            with self.assertRaises(KeyboardInterrupt):
                nutik.encode(endless(), output, rate=1e5)
        self.assertEqual(list(self.folder.iterdir()), [], "it left a file behind")
        nutik.encode(support.moving_box(), rate=1).render(exposure="1f")  # and all works on

    def test_an_iterable_that_waits_is_left(self):
        def waiting():
            yield np.zeros((8, 8), np.uint8)
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            threading.Event().wait(30)
            yield np.zeros((8, 8), np.uint8)

        before = signal.signal(signal.SIGALRM, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            nutik.encode(waiting(), rate=1)
        self.assertLess(time.monotonic() - begin, 10)

    def test_a_rendering_ends_while_other_threads_go_on(self):
        """The scalar reference would take minutes for this. Another thread ends it, which waits for Python's lock;
        nobody is made to give that up for 1000 s, so that it runs only where the work gives it up by itself."""
        pictures = np.random.default_rng(1).integers(0, 256, (128, 384, 512, 3), np.uint8)
        capture = nutik.encode(pictures, rate=960, renderer="reference")
        tags = np.arange(384 * 512).reshape(384, 512) % 256
        times = np.arange(0, capture.duration_ns, 2000)
        zigzag = nutik.Function.from_ns(times, np.arange(len(times)) % 2)
        go = threading.Event()

        def interrupt():
            go.wait()
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        self.addCleanup(sys.setswitchinterval, sys.getswitchinterval())
        sys.setswitchinterval(1000)
        go.set()
        with self.assertRaises(KeyboardInterrupt):
            capture.render({tag: zigzag for tag in range(256)}, tags)
        thread.join()
        small = capture.render(start=0, exposure="1f", region=(0, 0, 8, 8))
        self.assertEqual(small.shape, (8, 8, 3))

    def test_a_trace_ends(self):
        """Of a region of noise, block by block: the whole takes some seconds."""
        pictures = np.random.default_rng(1).integers(0, 256, (512, 192, 256, 3), np.uint8)
        capture = nutik.encode(pictures, rate=960)
        times = np.arange(0, capture.duration_ns, 20000)
        zigzag = nutik.Function.from_ns(times, np.arange(len(times)) % 2)
        timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        self.addCleanup(timer.cancel)
        with self.assertRaises(KeyboardInterrupt):
            capture.trace(tag=0, functions={0: zigzag}, mask=np.zeros((192, 256), np.uint8))

    def test_a_picture_that_is_written_is_given_up(self):
        """Light of noise, which OpenEXR packs for a second or more."""
        noise = np.random.default_rng(1).integers(0, 256, (1, 1080, 1920, 3), np.uint8)
        picture = nutik.encode(noise, rate=1).render(exposure=1)
        timer = threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGINT))
        self.addCleanup(timer.cancel)
        with self.assertRaises(KeyboardInterrupt):
            timer.start()
            picture.write(self.path("light.exr"))
        self.assertEqual(list(self.folder.iterdir()), [], "it left a file behind")

    def test_a_handlers_own_exception_comes_through(self):
        class Enough(Exception):
            pass

        def raise_enough(*_):
            raise Enough

        def endless():
            for k in itertools.count():
                if k == 100:
                    os.kill(os.getpid(), signal.SIGUSR1)
                yield np.zeros((8, 8), np.uint8)

        before = signal.signal(signal.SIGUSR1, raise_enough)
        self.addCleanup(signal.signal, signal.SIGUSR1, before)
        with self.assertRaises(Enough):
            nutik.encode(endless(), rate=1e5)


class Progress(support.TestCase):
    def test_it_is_told(self):
        pictures = support.moving_box()
        for work in (lambda told: nutik.encode(pictures, rate=960, progress=told),
                     lambda told: nutik.encode(iter(pictures), self.path("clip.tik"), rate=960, progress=told),
                     lambda told: nutik.encode(pictures, rate=960).activity(progress=told)):
            steps, threads = [], set()

            def told(done, total):
                steps.append((done, total))
                threads.add(threading.get_ident())

            work(told)
            self.assertTrue(steps)
            self.assertEqual(threads, {threading.get_ident()}, "somebody else's thread")
            for done, total in steps:
                self.assertTrue(0 < done and (total == 0 or done <= total), (done, total))

    def test_long_calls_tell_and_answer(self):
        """All rows of a plate fit into memory at once, and a block is a third of the capture; of rows of tiles activity
        is too quick to tell much, so it has records. Whoever ends a call at its
        first report does not wait for the rest."""
        class Enough(Exception):
            pass

        pictures = np.random.default_rng(1).integers(0, 256, (192, 384, 512, 3), np.uint8)
        def end(done, total):
            raise Enough

        for work in (nutik.encode(pictures, rate=960).plate,
                     nutik.encode(pictures, rate=960, tiles="records").activity):
            with self.subTest(work=work.__name__):
                times = [time.monotonic()]
                work(progress=lambda done, total: times.append(time.monotonic()))
                whole = time.monotonic() - times[0]
                self.assertGreater(len(times), 4, whole)
                begin = time.monotonic()
                with self.assertRaises(Enough):
                    work(progress=end)
                self.assertLess(time.monotonic() - begin, 0.6 * whole)

    def test_what_it_raises_ends_the_work(self):
        class Enough(Exception):
            pass

        def endless():
            for k in itertools.count():
                yield np.full((32, 32), k % 251, np.uint8)

        def told(done, total):
            raise Enough

        with self.assertRaises(Enough):
            nutik.encode(endless(), self.path("clip.tik"), rate=1e5, progress=told)
        self.assertEqual(list(self.folder.iterdir()), [], "it left a file behind")


class Threads(support.TestCase):
    def test_an_iterable_is_asked_by_the_caller(self):
        place, seen = contextvars.ContextVar("place"), []

        def pictures():
            for k in range(5):
                seen.append((threading.get_ident(), place.get("lost")))
                yield np.full((8, 8), k, np.uint8)

        place.set("here")
        nutik.encode(pictures(), rate=1)
        self.assertEqual(seen, [(threading.get_ident(), "here")] * 5)

    def test_an_iterable_may_wait_for_another_thread(self):
        first, second = threading.Event(), threading.Event()

        def answer():
            first.wait()
            second.set()

        def pictures():
            first.set()
            second.wait()
            yield np.zeros((8, 8), np.uint8)

        thread = threading.Thread(target=answer)
        thread.start()
        self.assertEqual(len(nutik.encode(itertools.chain([np.ones((8, 8), np.uint8)], pictures()), rate=1)), 2)
        thread.join()

    def test_many_may_ask(self):
        capture = nutik.encode(support.moving_box(), rate=960)
        wanted = [capture.render(start=f"{k}f", exposure="3f").array.tobytes() for k in range(8)]
        found = [None] * 8

        def ask(k):
            found[k] = capture.render(start=f"{k}f", exposure="3f").array.tobytes()

        threads = [threading.Thread(target=ask, args=(k,)) for k in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, wanted)


# Prints what encoding and exposing took beside the array, as a share of it.
MEASURED = """
import numpy as np, nutik, sys

def memory(line):
    with open("/proc/self/status") as status:
        return next(int(each.split()[1]) * 1024 for each in status if each.startswith(line))

random = np.random.default_rng(1)
pictures = np.empty((360, 480, 640, 3), np.uint8)
for picture in pictures:
    picture[...] = np.frombuffer(random.bytes(picture.nbytes), np.uint8).reshape(picture.shape)
nutik.encode(pictures[:2], rate=1).render(exposure="1f")  # starts the device
with open("/proc/self/clear_refs", "w") as peak:
    peak.write("5")  # the peak is what is there now
before = memory("VmRSS")
capture = nutik.encode(pictures, rate=960)
capture.render(exposure="360f")
print((memory("VmHWM") - before) / pictures.nbytes)
"""


class Memory(support.TestCase):
    def test_a_large_array(self):
        """332 MB of noise, of which nothing can be left out. The temporary capture's pages count, too, which the system
        can take back at any time."""
        done = subprocess.run([sys.executable, "-c", MEASURED], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLessEqual(float(done.stdout), 1.2)


# A capture that is cut off while it is open.
CUT_OFF = """
import numpy as np, nutik, os, sys
pictures = np.random.default_rng(1).integers(0, 256, (64, 128, 128, 3), np.uint8)
capture = nutik.encode(pictures, sys.argv[1], rate=960, codec="none")
os.truncate(sys.argv[1], 100_000)
try:
    capture.render(exposure="64f")
except nutik.InputError as error:
    print(error)
"""

# A capture that was written to, what has nothing to do with it, and the capture as it is now.
WRITTEN_TO = """
import numpy as np, nutik, os, sys
pictures = np.random.default_rng(1).integers(0, 256, (8, 16, 16, 3), np.uint8)
one, other = (nutik.encode(pictures, name, rate=960, codec="none") for name in sys.argv[1:])
os.utime(sys.argv[1], (1, 1))
for again in range(2):
    other.render(exposure="8f")
    try:
        one.render(exposure="8f")
    except nutik.InputError as error:
        print(error)
    nutik.encode(pictures, sys.argv[2].replace(".tik", f"-{again}.tik"), rate=960)
nutik.open(sys.argv[1]).render(exposure="8f")
"""

# Who asked for the signal before this package came.
OF_OTHERS = """
import os, signal
signal.signal(signal.SIGBUS, lambda number, frame: print("asked"))
import nutik
os.kill(os.getpid(), signal.SIGBUS)
"""


class Files(support.TestCase):
    def test_a_capture_that_somebody_writes_to(self):
        """Is an error of that capture alone, until it is opened again."""
        done = subprocess.run([sys.executable, "-c", WRITTEN_TO, self.path("one.tik"), self.path("other.tik")],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("one.tik changed or could not be read any more"), 2, done.stdout)

    def test_the_signal_of_others(self):
        done = subprocess.run([sys.executable, "-c", OF_OTHERS], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, "asked\n"), done.stderr)

    def test_a_capture_that_somebody_cuts_off(self):
        """Is an error, and not the interpreter's end."""
        done = subprocess.run([sys.executable, "-c", CUT_OFF, self.path("clip.tik")], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("clip.tik changed or could not be read any more", done.stdout)


if __name__ == "__main__":
    unittest.main()
