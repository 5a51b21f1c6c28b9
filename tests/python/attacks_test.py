"""Attacks on the Python module. It must raise an exception or return a result, and never hang, abort or crash.

attacks_test.py TAUT [unittest's arguments]
"""

import multiprocessing.pool
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest

import numpy as np

import taut
import taut.gym
from helpers import GAIT, PUSH, ROOT, interrupted, main

SPINE = str(ROOT / "share/experiments" / "learn_spine.yaml")
TOO_LONG_S = 60  # for programs that need a second or two, on a busy machine
HEAD = """
import os, resource, sys, threading, time, taut, taut.gym, numpy as np

def limit_memory(bytes):
    used = int(open("/proc/self/statm").read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    resource.setrlimit(resource.RLIMIT_AS, 2 * (used + bytes,))
"""


def program(text, *arguments):
    """Runs a Python program in which taut, PUSH and SPINE are defined. Returns its exit status and its output and
    errors."""
    names = f"PUSH, SPINE = {PUSH!r}, {SPINE!r}\n"
    ran = subprocess.run([sys.executable, "-c", HEAD + names + textwrap.dedent(text), *arguments], stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True, timeout=TOO_LONG_S)
    return ran.returncode, ran.stdout


class Attack(unittest.TestCase):
    def expect(self, text, status=0, output=""):
        code, said = program(text)
        self.assertEqual(code, status, said)
        if output:
            self.assertRegex(said, output)


class Callbacks(Attack):
    def test_may_read_their_environment(self):
        self.expect("""
            seen = []
            def look(*_):
                seen.append((env.time_s(0), env.hash(1), env.experiment(0).seed, env._core.episodes()[1][0]))
            env = taut.gym.make_vec(SPINE, 2, threads=2, observe=look, judge=look)
            env.reset(seed=3)
            env.step(np.zeros(env.action_space.shape))
            assert [s[0] for s in seen] == [0, 0.01, 0.01], seen
            assert seen[-1][1] == env.hash(1) and seen[-1][2] == 3, seen
            print("done")""", output="done")

    def test_that_change_their_environment_raise(self):
        self.expect("""
            env = taut.gym.make_vec(SPINE, 2, judge=lambda *_: change())
            zero = np.zeros(env.action_space.shape)
            snapshot = env.save()
            for change in (lambda: env.step(zero), lambda: env.reset(), lambda: env.save(), lambda: env.restore(snapshot)):
                try:
                    env.step(zero)
                except RuntimeError as error:
                    assert "from within a step" in str(error), error
                    print("raised")""", output="(raised\n){4}")

    def test_that_wait_for_another_thread_of_the_environment_end_by_control_c(self):
        self.expect("""
            import signal
            def judge(*_):
                thread = threading.Thread(target=env.time_s, args=(0,))
                thread.start()
                thread.join()
            env = taut.gym.make_vec(SPINE, 2, judge=judge)
            threading.Timer(1, os.kill, (os.getpid(), signal.SIGINT)).start()
            try:
                env.step(np.zeros(env.action_space.shape))
            except KeyboardInterrupt:
                print("ended")""", output="ended")

    def test_keep_arrays_that_never_change(self):
        for copy in (True, False):
            for mode in taut.gym.AutoresetMode:
                kept = []

                def keep(*arrays):
                    kept.append([(a, a.copy()) for a in arrays])

                experiment = taut.load(SPINE)
                experiment.duration_s = 0.03  # episodes end during the loop
                env = taut.gym.make_vec(experiment, 64, judge=keep, observe=keep, copy=copy, autoreset_mode=mode)
                env.reset(seed=0)
                actions = np.zeros(env.action_space.shape, np.float32)
                for i in range(8):
                    actions[:] = 0.1 * i
                    env.step(actions)
                del env
                self.assertGreater(len(kept), 15)
                for arrays in kept:
                    for now, then in arrays:
                        np.testing.assert_array_equal(now, then)

    def test_that_deform_their_arrays_raise(self):
        def judge(rows, observations, actions, rewards, terminated):
            rewards.resize(1, refcheck=False)

        env = taut.gym.make_vec(SPINE, 8, judge=judge)
        with self.assertRaisesRegex(ValueError, "rewards.*shape"):
            env.step(np.zeros(env.action_space.shape))

    def test_that_fork_get_an_exception_in_the_child(self):
        self.expect("""
            child = None
            def judge(*_):
                global child
                child = os.fork()
            env = taut.gym.make_vec(SPINE, 16, threads=2, judge=judge)
            try:
                env.step(np.zeros(env.action_space.shape))
            except RuntimeError as error:
                os._exit(7 if "fork" in str(error) else 1)
            assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7""")


class Processes(Attack):
    def test_forked_children_end(self):
        self.expect("""
            env = taut.gym.make_vec(SPINE, 32, threads=2)
            batch = taut.Batch(taut.load(PUSH).robot, worlds=32, threads=2)
            for i in range(20):
                env.step(np.zeros(env.action_space.shape))
                batch.step(1e-3)
                child = os.fork()
                if child == 0:
                    sys.exit(0)
                assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0""")

    def test_the_program_ends_while_daemon_threads_work(self):
        # Four at once: on a busy machine the threads are still running when static variables are destroyed.
        for work in ("batch.step(1e-3, 10**8)", "taut.run(endless)", "env.step(zero)", "taut.rollout(endless, 'distance', 8)",
                     "taut.run(endless, progress=lambda *_: time.sleep(1e-3))", "batch.time_s()"):
            text = f"""
                endless = taut.load(PUSH)
                endless.duration_s = 1e6
                batch = taut.Batch(endless.robot, worlds=8, threads=2)
                env = taut.gym.make_vec(SPINE, 8, judge=lambda *_: None)
                zero = np.zeros(env.action_space.shape)
                def work():
                    while True:
                        {work}
                for _ in range(2):
                    threading.Thread(target=work, daemon=True).start()
                time.sleep(0.3)
                print("end")"""
            with multiprocessing.pool.ThreadPool(4) as pool:
                for ended in pool.map(program, 4 * [text]):
                    self.assertEqual(ended, (0, "end\n"), work)

    def test_functions_that_run_at_the_end_may_use_taut(self):
        text = f"""
            import atexit
            def at_the_end():  # registered before taut's function, so it runs after that
                batch.step(1e-3, 5)
                print(round(batch.time_s()[0], 6), len(taut.run(push).trace.time_s) > 3)
            atexit.register(at_the_end)
            import taut
            push = taut.load({PUSH!r})
            push.duration_s = 0.1
            batch = taut.Batch(push.robot, worlds=2, threads=2)"""
        ran = subprocess.run([sys.executable, "-c", textwrap.dedent(text)], capture_output=True, text=True,
                             timeout=TOO_LONG_S)
        self.assertEqual((ran.returncode, ran.stdout), (0, "0.005 True\n"), ran.stderr)


class Resources(Attack):
    def test_thread_counts_have_a_limit(self):
        push = taut.load(PUSH)
        for call in (lambda n: taut.Batch(push.robot, threads=n), lambda n: taut.gym.make_vec(SPINE, 1, threads=n),
                     lambda n: taut.run(push, threads=n), lambda n: taut.rollout(push, "distance", 1, threads=n),
                     lambda n: taut.learn(str(ROOT / "share/studies" / "sidewinder3.yaml"), "/nowhere", threads=n),
                     lambda n: taut.fit(str(ROOT / "share/fits" / "tetraspine3_push.yaml"), threads=n)):
            for n in (-1, 1025, 10**6):
                with self.assertRaisesRegex(ValueError, f"threads: {n}; expected 0.* to 1024"):
                    call(n)

    def test_world_counts_have_a_limit(self):
        for n in (0, 10**9 + 1, 2**31 - 1):
            for make in (lambda: taut.Batch(taut.load(PUSH).robot, worlds=n), lambda: taut.gym.make_vec(SPINE, n)):
                with self.assertRaisesRegex(ValueError, f"worlds: {n}; expected 1 to 1000000000"):
                    make()

    def test_threads_that_the_system_refuses_are_an_exception(self):
        self.expect("""
            push = taut.load(PUSH)
            limit_memory(1 << 30)
            for make in (lambda: taut.Batch(push.robot, threads=1024), lambda: taut.gym.make_vec(SPINE, 1, threads=1024)):
                try:
                    make()
                except (RuntimeError, MemoryError) as error:
                    print("refused:", error)""", output="(refused: cannot start thread .*\n){2}")

    def test_no_memory_is_a_memory_error_with_any_number_of_threads(self):
        for threads in (1, 2):
            self.expect(f"""
                push = taut.load(PUSH)
                limit_memory(900 << 20)
                for make in (lambda n: taut.gym.make_vec(SPINE, n, threads={threads}),
                             lambda n: taut.Batch(push.robot, worlds=n, threads={threads})):
                    for n in (30_000, 100_000, 10**6, 10**9):
                        try:
                            made = make(n)
                        except (MemoryError, RuntimeError) as error:
                            # a thread's stack is memory, too
                            assert isinstance(error, MemoryError) or "cannot start thread" in str(error), error
                            print("no memory")
                print("end")""", output="no memory\n[^$]*end\n$")

    def test_bases_of_subclasses_learn_of_them(self):
        made = []

        class Named:
            def __init_subclass__(cls, name="", **more):
                super().__init_subclass__(**more)
                made.append((cls.__name__, name))

        class Mine(taut.Batch, Named, name="mine"):
            pass

        self.assertEqual(made, [("Mine", "mine")])
        with self.assertRaises(TypeError):
            type("Wrong", (taut.Batch,), {}, name="wrong")

    def test_objects_without_init_raise(self):
        self.expect("""
            classes = [c for c in vars(taut._core).values() if isinstance(c, type)]
            assert len(classes) > 10
            refused = 0
            for c in classes:
                thing = c.__new__(c)
                for name in dir(c):
                    if name.startswith("_") and name not in ("__len__", "__repr__"):
                        continue
                    try:
                        member = getattr(thing, name)
                        if callable(member):
                            member()
                    except (TypeError, RuntimeError) as error:
                        refused += "not initialized" in str(error) or "non-held" in str(error)
                del thing
            assert refused > 50, refused

            class Early(taut.Batch):
                def __init__(self, *arguments):
                    self.step(1e-3)
                    super().__init__(*arguments)
            for call in (lambda: Early(taut.load(PUSH)), lambda: taut.Batch.__new__(taut.Batch).step(1e-3)):
                try:
                    call()
                except TypeError as error:
                    print(error)""", output="(.*__init__.*\n){2}")


class Interrupts(unittest.TestCase):
    def test_control_c_ends_steps(self):
        batch = taut.Batch(taut.load(GAIT).robot, worlds=3)
        before = time.monotonic()
        interrupted(self, lambda: batch.step(1e-3, 2 * 10**9))
        self.assertLess(time.monotonic() - before, 30)
        batch.step(1e-3, 5)  # still usable
        steps = batch.time_s() / 1e-3
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-3)
        targets = np.tile(batch.rest_length_target_m()[:, None], (1, 1, 1))
        interrupted(self, lambda: batch.rollout(targets, 1e-3, 2 * 10**9))

    def test_control_c_ends_a_step_of_environments(self):
        text = pathlib.Path(SPINE).read_text().replace("../models", str(ROOT / "share/models"))
        text = text[:text.index("  randomise:")].replace("max_tension_n: 300", "")
        text = text.replace("duration_s: 10", "duration_s: 4e5").replace("period_s: 0.01", "period_s: 2e5")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "long.yaml")
            path.write_text(text)
            for make in (lambda: taut.gym.Env(str(path)), lambda: taut.gym.make_vec(str(path), 20, threads=2)):
                env = make()
                env.reset(seed=1)
                start = env.hash()
                before = time.monotonic()
                interrupted(self, lambda: env.step(np.zeros(env.action_space.shape)))
                self.assertLess(time.monotonic() - before, 10)
                for call in (lambda: env.step(np.zeros(env.action_space.shape)), env.save):
                    with self.assertRaisesRegex(RuntimeError, "the last step was interrupted; reset all worlds"):
                        call()
                env.reset(seed=1)
                self.assertEqual(env.hash(), start)
                env.save()

    def test_control_c_ends_waiting_for_another_thread(self):
        batch = taut.Batch(taut.load(GAIT).robot, worlds=3)
        stop = threading.Event()

        def step():
            while not stop.is_set():
                batch.step(1e-3, 200_000)

        thread = threading.Thread(target=step)
        thread.start()
        try:
            time.sleep(0.2)
            interrupted(self, lambda: [batch.time_s() for _ in range(10**9)])
        finally:
            stop.set()
            thread.join()

    def test_pieces_between_which_signals_are_seen_change_no_bits(self):
        at_once, singly = (taut.Batch(taut.load(GAIT).robot, worlds=4096) for _ in range(2))
        targets = 0.95 * at_once.rest_length_target_m()
        at_once.step(1e-3, 7, targets)
        singly.step(1e-3, 1, targets)
        for _ in range(6):
            singly.step(1e-3)
        self.assertEqual([at_once.hash(w) for w in range(0, 4096, 500)], [singly.hash(w) for w in range(0, 4096, 500)])

    def test_signal_handlers_may_read_the_batch_that_steps(self):
        batch, seen = taut.Batch(taut.load(GAIT).robot, worlds=2), []

        def handler(*_):
            seen.append(batch.time_s()[0])
            batch.step(1e-3)

        before = signal.signal(signal.SIGALRM, handler)
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.5)
            with self.assertRaisesRegex(RuntimeError, "from within a step"):
                batch.step(1e-3, 2 * 10**9)
        finally:
            signal.signal(signal.SIGALRM, before)
        self.assertEqual(len(seen), 1)


if __name__ == "__main__":
    main()
