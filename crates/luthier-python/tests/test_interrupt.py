"""Ctrl-C in calls that take long. Each runs in a process of its own, which the system ends after two minutes of processor time: a call that is not
interrupted fails there."""

import os
import resource
import signal
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

MOST_SECONDS = 120

START = """
import os, signal, sys, threading, time
sys.path.insert(0, sys.argv[1])
import numpy as np
import luthier
from workshop import LACQUER, METAL, hemisphere
# A shell starts programs in its background without this signal.
signal.signal(signal.SIGINT, signal.default_int_handler)

def press_when(is_time):
    '''Presses Ctrl-C from another thread, once it is time.'''
    def wait():
        while not is_time():
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)
    threading.Thread(target=wait, daemon=True).start()

def is_interrupted(call):
    try:
        call()
    except KeyboardInterrupt:
        return True
    return False

def soon():
    '''Time for a call to begin.'''
    started = time.process_time()
    return lambda: time.process_time() > started + 0.5

lacquer, up = luthier.load(LACQUER), [0.0, 0.0, 1.0]
"""


def limited():
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS))


class Interrupts(unittest.TestCase):
    def runs(self, script, *arguments):
        command = [sys.executable, "-c", START + script, os.path.dirname(__file__), *arguments]
        done = subprocess.run(command, preexec_fn=limited, capture_output=True, text=True, check=False)
        self.assertNotIn(done.returncode, [-signal.SIGKILL, -signal.SIGXCPU], "the call went on")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.split()

    def test_evaluations(self):
        """Each call would take hours."""
        calls = ["slow.eval(wi, up)", "slow.eval_with_error(wi, up)", "slow.sample(up, u)", "slow.albedo(wi)", "lacquer.albedo(wi, 'elek')"]
        for call in calls:
            with self.subTest(call):
                script = (
                    "slow = lacquer.function('layered-mc', samples=100_000)\nwi, u = hemisphere(1_000_000), np.full((1_000_000, 3), 0.5)\n"
                    f"press_when(soon())\nprint(is_interrupted(lambda: {call}))"
                )
                self.assertEqual(self.runs(script), ["True"])

    def test_values_after_an_interrupt(self):
        script = (
            "expected, wi = lacquer.albedo(hemisphere(9), 'elek'), hemisphere(1_000_000)\npress_when(soon())\n"
            "print(is_interrupted(lambda: lacquer.albedo(wi, 'elek')))\n"
            "print(np.array_equal(lacquer.albedo(hemisphere(9), 'elek'), expected))"
        )
        self.assertEqual(self.runs(script), ["True", "True"])

    def test_a_handler_that_returns_does_not_end_a_call(self):
        script = (
            "called = []\nsignal.signal(signal.SIGALRM, lambda *_: called.append(1))\n"
            "signal.setitimer(signal.ITIMER_REAL, 0.05, 0.05)\n"
            "wi = hemisphere(300)\nfirst = lacquer.albedo(wi, 'elek')\n"
            "while not called: lacquer.albedo(wi, 'elek')\n"
            "signal.setitimer(signal.ITIMER_REAL, 0.0)\n"
            "print(np.array_equal(lacquer.albedo(wi, 'elek'), first))"
        )
        self.assertEqual(self.runs(script), ["True"])

    def test_a_bake_keeps_its_results(self):
        """Ctrl-C comes once the first result is in the store. The bake leaves few of its results there, which the next one finds, and no folder."""
        script = """
store, out = sys.argv[2:]
luthier.cache(store)
kept = lambda: sum(len(files) for _, _, files in os.walk(store))
glass, base = LACQUER["layer"]
many = [luthier.load({**LACQUER, "name": f"lacquer-{k}", "layer": [{**glass, "ior": 1.3 + k / 4000}, base]}) for k in range(1500)]
empty = kept()
press_when(lambda: kept() > empty)
print(is_interrupted(lambda: luthier.bake(many, out, model="elek")), empty < kept() < len(many), os.path.exists(out))
"""
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, {"RAYON_NUM_THREADS": "2"}):
            found = self.runs(script, os.path.join(folder, "store"), os.path.join(folder, "out"))
        self.assertEqual(found, ["True", "True", "False"])


if __name__ == "__main__":
    unittest.main()
