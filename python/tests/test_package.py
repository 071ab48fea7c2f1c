"""Tests of the installed package: `python -m unittest discover python/tests`."""

import doctest
import inspect
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import numpy as np
import reference

import asperity as asp

HERE = Path(__file__).parent.parent
#: A scene of which each profile takes a hundredth of a second.
SCENE = "pressure-sensitive"
ROUGH = asp.self_affine(0.7, rms_height="50 nm", modes=(4, 100))
LOAD = {"modulus": "1 MPa", "work": "50 mJ/m²", "stages": "100 µN, separation"}


def sphere(points=4096):
    return asp.profile("100 µm", points, form=asp.sphere("100 µm"))


class Loops(unittest.TestCase):
    def test_a_sphere_is_that_of_johnson_kendall_and_roberts(self):
        loop = asp.load(sphere(), **LOAD)
        self.assertAlmostEqual(loop.pull_off_force / (1.5 * np.pi * 0.05 * 1e-4), 1, delta=1e-5)
        self.assertLess(loop.pull_off_force_error, 1e-5 * loop.pull_off_force)
        self.assertEqual(loop.regime, "pressure-insensitive")
        self.assertGreater(loop.tabor_number, 5)
        self.assertAlmostEqual(sum(loop.released_energy), loop.dissipated_energy, delta=1e-12 * loop.dissipated_energy)
        events = loop.events
        self.assertEqual([str(event["mark"]) for event in events], ["jump-in", "preload", "pull-off", "jump-out"])
        self.assertEqual([str(name) for name in events["event"]], ["touches", "", "", "detaches"])
        self.assertLess(abs(events["energy"][0] + loop.released_energy[0]), abs(loop.released_energy[0]))
        self.assertTrue(np.isnan(events["energy"][1]) and events["force_after"][3] == 0)

    def test_heights_are_loaded_as_the_body_they_come_from(self):
        body = sphere()
        heights = asp.Profile(body.heights, body.spacing)
        for stages in ["100 µN, separation", ["200 nm", "10 µN", "touch", "separation"], "zero force, separation"]:
            load = {**LOAD, "stages": stages, "loading_stiffness": "1 kN/m"}
            one, other = asp.load(body, **load), asp.load(heights, **load)
            for name in ["indentation", "force", "displacement", "stage", "contact_length", "patches", "stored_energy", "released_energy"]:
                np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)
            self.assertEqual((one.pull_off_force, one.dissipated_energy, one.preload), (other.pull_off_force, other.dissipated_energy, other.preload))
            known = (other.regime, other.tabor_number, other.kappa, other.adhesion_share, other.pull_off_force_error)
            self.assertEqual(known, (None,) * 5)

    def test_any_array_of_real_numbers_is_taken(self):
        heights = np.sin(np.arange(64.0)) * 1e-7
        expected = asp.Profile(heights, 1e-7).gaps
        frozen = heights.copy()
        frozen.flags.writeable = False
        spread = np.zeros(128)
        spread[::2] = heights
        for same in [list(heights), frozen, spread[::2], heights[::-1][::-1], heights.astype(">f8")]:
            np.testing.assert_array_equal(asp.Profile(same, "100 nm").gaps, expected)
        np.testing.assert_array_equal(asp.Profile([0, 3, 1], 1).gaps, [3, 0, 2])

    def test_heights_in_a_file_are_loaded_as_those_of_an_array(self):
        with tempfile.TemporaryDirectory() as folder:
            file, body = Path(folder) / "line.npy", asp.profile("100 µm", 1024, roughness=ROUGH)
            np.save(file, np.c_[body.x, body.heights])
            saved = asp.profile("100 µm", 1024, roughness=asp.measured(file, as_line=True))
            np.testing.assert_array_equal(saved.gaps, body.gaps)
            fields = {"material__modulus": LOAD["modulus"], "adhesion": {"work": LOAD["work"]}}
            found = asp.preloads(saved, ("1 µN", "100 µN"), count=2, **fields).to_pandas()
        for preload, force in zip(["1 µN", "100 µN"], found.pull_off_force, strict=True):
            loop = asp.load(asp.Profile(body.heights, body.spacing), **{**LOAD, "stages": f"{preload}, separation"})
            self.assertAlmostEqual(force / loop.pull_off_force, 1, delta=1e-9)

    def test_an_array_of_a_result_cannot_be_changed(self):
        with self.assertRaisesRegex(ValueError, "read-only"):
            asp.load(sphere(), **LOAD).force[0] = 1

    def test_a_loop_is_a_table_and_a_picture(self):
        loop = asp.load(sphere(256), **LOAD)
        self.assertTrue(loop._repr_svg_().startswith("<svg"))
        self.assertNotIn(">scene<", loop._repr_svg_())
        self.assertRegex(repr(loop), r"^<Loop: pull_off_force 23\.\d+ µN, preload 100 µN, dissipated_energy .* pJ>$")


class Refusals(unittest.TestCase):
    def refused(self, error, sentence, function, /, *arguments, **named):
        with self.assertRaises(error) as raised:
            function(*arguments, **named)
        self.assertRegex(str(raised.exception), sentence)
        self.assertIs(type(raised.exception), error)
        return raised.exception

    def test_arrays(self):
        for heights, found in [
            ([], r"the shape \(0,\)"),
            ([1, np.nan], "nan with the index 1"),
            ([-np.inf], "-inf with the index 0"),
            (np.zeros((2, 2)), r"the shape \(2, 2\)"),
            (None, r"the shape \(\)"),
            (["a"], "the type <U1"),
            (np.zeros(3, complex), "complex128"),
            (np.zeros(3, bool), "bool"),
            ([[1], [2, 3]], "rows of different lengths"),
        ]:
            error = self.refused(asp.FieldError, f"^heights = .*{found}.*; allowed: a one-dim", asp.Profile, heights, 1)
            self.assertEqual(error.field, "heights")
        for spacing in [0, -1, "-1 m", np.inf, 1e60]:
            error = self.refused(asp.FieldError, "allowed: from 1e-50 to 1e50 m|not a number", asp.Profile, [1, 2], spacing)
            self.assertEqual(error.field, "spacing")
        self.refused(asp.FieldError, 'spacing = "3 kg": kg is not a unit of length', asp.Profile, [1, 2], "3 kg")
        self.refused(asp.FieldError, "spacing = .*bool; allowed: a number in m", asp.Profile, [1, 2], True)

    def test_loadings(self):
        body = sphere(64)
        for body in [body, asp.Profile(body.heights, body.spacing)]:
            out_of_reach = {**LOAD, "stages": "10 µN, -1 N"}
            error = self.refused(asp.LoadingError, "^stage 1, counted from 0: the contact detaches before -1 N", asp.load, body, **out_of_reach)
            self.assertEqual(error.stage, 1)
            self.assertAlmostEqual(error.smallest_force, -23.56e-6, delta=1e-7)
            for name, value in [("modulus", -1), ("modulus", "2 kg"), ("work", -1), ("work", np.nan), ("edges", "x")]:
                self.refused(asp.FieldError, "=|:", asp.load, body, **{**LOAD, name: value})
            for name, value in [("stages", "up"), ("stages", []), ("stages", ["1 m"] * 100_001), ("samples", -1)]:
                self.refused(asp.FieldError, "=|:", asp.load, body, **{**LOAD, name: value})
            for name, value in [("closing_work", "60 mJ/m²"), ("loading_stiffness", 0), ("samples", 1.5)]:
                self.refused(asp.FieldError, "=|:", asp.load, body, **{**LOAD, name: value})

    def test_scenes(self):
        self.refused(asp.FieldError, "^nosuch: there is no such file, no such built-in scene", asp.run, "nosuch")
        self.refused(OSError, "^nosuch.ron: cannot be read", asp.run, "nosuch.ron")
        self.refused(asp.FieldError, "no such field; did you mean adhesion.work", asp.run, SCENE, adhesion__wrk=1)
        error = self.refused(asp.FieldError, "roughness.hurst = 1.4: allowed", asp.run, SCENE, roughness__hurst=1.4)
        self.assertEqual((error.field, error.value), ("roughness.hurst", "1.4"))
        self.assertIn("above 0 and below 1", error.allowed)
        for name in ["profiles", "jobs"]:
            self.refused(asp.FieldError, f"^{name} = 0; allowed: a whole number from 1", asp.run, SCENE, **{name: 0})
        self.refused(asp.FieldError, "object; allowed: a number", asp.run, SCENE, roughness__hurst=object())
        self.refused(asp.FieldError, "no such number", asp.find, "x", SCENE, "F_a = 1 N")
        self.refused(asp.FieldError, "allowed: a quantity", asp.find, "preload", SCENE, "much")


class Computations(unittest.TestCase):
    def test_a_scene_has_the_bits_of_the_program(self):
        for name in asp.presets():
            printed = subprocess.run(
                [sys.executable, "-m", "asperity", "run", name, "--format", "json"], capture_output=True, check=True
            )
            expected = json.loads(printed.stdout)
            for jobs in [1, 2]:
                found = asp.run(name, jobs=jobs).to_dict()
                for key in expected.keys() - {"program", "command", "timings"}:
                    # As texts, which have all digits.
                    self.assertEqual(json.dumps(found[key]), json.dumps(expected[key]), f"{name}: {key}")
                self.assertEqual(expected.keys() - found.keys(), {"program", "command"})

    def test_the_profile_and_the_loop_are_those_of_the_outcome(self):
        outcome = asp.run(SCENE, profiles=1)
        self.assertEqual(list(outcome.curve["force"]), list(outcome.loop.force))
        self.assertEqual(outcome.profile.points, len(outcome.body))
        self.assertEqual(outcome.loop.pull_off_force, outcome.pull_off_force)
        again = asp.Profile(outcome.body.heights, outcome.body.spacing)
        loop = asp.load(again, modulus=outcome.modulus, work=outcome.work, stages="10 µN, separation")
        self.assertAlmostEqual(loop.pull_off_force / outcome.pull_off_force, 1, delta=1e-9)

    def test_a_sphere_in_three_dimensions_is_that_of_hertz(self):
        at = (np.arange(128) + 0.5) / 128 - 0.5
        heights = -(at[:, None] ** 2 + at**2) / 2
        found = asp.press(heights, side=1, modulus=1, force=4 / 3 * 0.2**3, residual=1e-6)
        self.assertAlmostEqual(found.indentation / 0.2**2, 1, delta=2e-3)
        self.assertAlmostEqual(found.pressure.sum() / 128**2 / found.force, 1, delta=1e-9)
        self.assertEqual(found.gap.shape, (128, 128))

    def test_what_cannot_be_measured_is_refused(self):
        for wrong, sentence in [
            (lambda: asp.surface("no.txt"), "no.txt: cannot be read"),
            (lambda: asp.surface([1, 2, np.inf], spacing=1), "heights = inf with the index 2"),
            (lambda: asp.surface([1, 2, 3]), "spacing = None; allowed: the distance between the points"),
            (lambda: asp.surface([[1, 2], [3]], spacing=1), "heights = rows of different lengths"),
            (lambda: asp.surface("no.txt", nosuch=1), "nosuch = 1; allowed: one of the arguments spacing, unit"),
            (lambda: asp.fit("no.csv", SCENE, ["work"]), "no.csv: cannot be read"),
            (lambda: asp.fit([], SCENE, ["work"]), r"curves = \[\]; allowed"),
            (lambda: asp.fit(([1], [1, 2]), SCENE, ["work"]), "1 displacements and 2 forces"),
            (lambda: asp.fit(([1], [1]), SCENE, ["wrk"]), "did you mean work"),
            (lambda: asp.fit(([1], [1]), SCENE, ["work"], options={"noise": "-5 nN"}), "allowed: a standard deviation above 0"),
            (lambda: asp.study(SCENE, {"adhesion.kappa": []}), "no values; allowed: at least one"),
            (lambda: asp.table([[0, 1], [0, 2]]), r"asperity\.revolve\(radii, depths\) takes arrays"),
            (lambda: asp.run(asp.Profile([0, 1], 1), modulus=1e6), r"asperity\.measured\('line\.npy', as_line=True\)"),
            (lambda: asp.press(np.zeros((32, 33)), side=1, modulus=1, force=1), "a square map"),
            (lambda: asp.press(np.zeros((31, 31)), side=1, modulus=1, force=1), "31"),
        ]:
            with self.assertRaisesRegex((ValueError, OSError), sentence):
                wrong()

    def test_progress_is_reported(self):
        seen = []
        asp.ensemble(SCENE, profiles=5, jobs=1, progress=lambda done, of: seen.append((done, of)))
        self.assertEqual(seen, [(done, 5) for done in range(1, 6)])

    def test_an_exception_of_the_callback_stops_the_computation(self):
        def fail(done, of):
            raise KeyError("enough")

        before = threads()
        with self.assertRaisesRegex(KeyError, "enough"):
            asp.ensemble(SCENE, profiles=20_000, progress=fail)
        # The system may list a thread that has ended for a moment.
        end = time.monotonic() + 5
        while threads() > before and time.monotonic() < end:
            time.sleep(0.01)
        self.assertEqual(threads(), before)

    def test_an_interrupt_does_not_wait_for_a_step_that_takes_long(self):
        cases = [
            "asp.profile('1 mm', 20_000_000, roughness=asp.self_affine(0.7, rms_height='1 nm', modes=(4, 5_000_000)))",
            "asp.surface(1e-9 * np.random.default_rng(1).standard_normal((1024, 1024)), spacing=1e-7, robust=True)",
            "asp.press(1e-9 * np.random.default_rng(1).standard_normal((1024, 1024)), side=1e-3, modulus=1e6, force=1e-2)",
        ]
        for case in cases:
            code = f"""if True:
                import asperity as asp, numpy as np
                print("begin", flush=True)
                try:
                    {case}
                except KeyboardInterrupt:
                    print("stopped", flush=True)
                """
            child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
            self.addCleanup(child.kill)
            self.assertEqual(child.stdout.readline(), "begin\n")
            time.sleep(0.4)
            clock = time.monotonic()
            child.send_signal(signal.SIGINT)
            self.assertEqual(child.communicate(timeout=60)[0], "stopped\n", case)
            # The limit leaves room for a busy machine.
            self.assertLess(time.monotonic() - clock, 1.0, case)
            self.assertEqual(child.returncode, 0)

    def test_other_threads_run_meanwhile(self):
        counted, ended = [0], threading.Event()

        def count():
            while not ended.is_set():
                counted[0] += 1
                time.sleep(0.001)

        other = threading.Thread(target=count)
        other.start()
        asp.ensemble(SCENE, profiles=40, jobs=1)
        ended.set()
        other.join()
        self.assertGreater(counted[0], 5)

    def test_an_interrupt_stops_at_once_and_leaves_nothing(self):
        code = f"""if True:
            import os, time, asperity as asp
            for work in [
                lambda: asp.ensemble("{SCENE}", profiles=20_000),
                lambda: asp.reference("rough-sphere", grid=128, surfaces=300),
                lambda: asp.find("preload", "{SCENE}", "F_a/F_a,max = 20 %", profiles=100_000),
            ]:
                print("begin", flush=True)
                try:
                    work()
                except KeyboardInterrupt:
                    print("stopped", flush=True)
            time.sleep(0.5)
            print(len(os.listdir("/proc/self/task")))
            """
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        limit = threading.Timer(60, child.kill)
        limit.start()
        self.addCleanup(limit.cancel)
        for _ in range(3):
            self.assertEqual(child.stdout.readline(), "begin\n")
            time.sleep(0.3)
            clock = time.monotonic()
            child.send_signal(signal.SIGINT)
            self.assertEqual(child.stdout.readline(), "stopped\n")
            self.assertLess(time.monotonic() - clock, 10)
        rest = child.communicate()[0]
        self.assertEqual((child.returncode, rest), (0, "1\n"))


def threads():
    return len(os.listdir("/proc/self/task"))


class Program(unittest.TestCase):
    def test_the_program_is_the_command(self):
        def run(*words, **options):
            return subprocess.run([sys.executable, "-m", "asperity", *words], capture_output=True, text=True, **options)

        self.assertEqual(run("--version").stdout, f"asperity {asp.__version__}\n")
        wrong = run("run", "nosuch")
        self.assertEqual((wrong.returncode, wrong.stdout), (1, ""))
        self.assertEqual(run("--nosuch").returncode, 2)
        table = run("run", "jkr-sphere", "--format", "csv").stdout
        self.assertIn("# command: asperity run jkr-sphere\n", table)

    def test_an_interrupt_ends_a_command(self):
        command = [sys.executable, "-m", "asperity", "run", SCENE, "--profiles", "20000"]
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(1)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.wait(timeout=10), 128 + signal.SIGINT)


class Documentation(unittest.TestCase):
    def test_the_code_of_the_readme_prints_what_it_says(self):
        text = (HERE / "README.md").read_text(encoding="utf-8")
        # The index of packages shows this page, where links to files of the repository lead nowhere.
        self.assertNotRegex(text, r"\]\((?!http)")
        blocks = "\n".join(re.findall(r"```pycon\n(.*?)```", text, re.DOTALL))
        with tempfile.TemporaryDirectory() as folder:
            here = os.getcwd()
            os.chdir(folder)
            try:
                test = doctest.DocTestParser().get_doctest(blocks, {}, "README.md", "README.md", 0)
                failed = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test).failed
            finally:
                os.chdir(here)
        self.assertGreater(len(test.examples), 10)
        self.assertEqual(failed, 0)

    def test_the_examples_of_the_functions_print_what_they_say(self):
        finder, count = doctest.DocTestFinder(recurse=False), 0
        functions = {name: getattr(asp, name) for name in asp.__all__ if inspect.isfunction(getattr(asp, name))}
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            here = os.getcwd()
            os.chdir(folder)
            try:
                for name, function in functions.items():
                    for test in finder.find(function, name, globs={"asp": asp, "np": np}):
                        result = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test)
                        self.assertEqual((result.failed, result.attempted > 0), (0, True), name)
                        count += 1
            finally:
                os.chdir(here)
        self.assertEqual(count, len(functions))

    def test_the_reference_is_that_of_the_package(self):
        page = HERE.parent / "docs" / "python.md"
        expected = reference.page()
        if os.environ.get("UPDATE_DOCS"):
            page.write_text(expected, encoding="utf-8")
        self.assertEqual(page.read_text(encoding="utf-8"), expected, "UPDATE_DOCS=1 renews the page")
        listed = {name for names in reference.FUNCTIONS.values() for name in names}
        self.assertEqual(listed, {name for name in asp.__all__ if inspect.isfunction(getattr(asp, name))})

    def test_the_code_of_the_root_readme_runs(self):
        text = (HERE.parent / "README.md").read_text(encoding="utf-8")
        code = re.search(r"```python\n(.*?)```", text, re.DOTALL)
        done = subprocess.run([sys.executable, "-c", code[1]], capture_output=True, text=True)
        self.assertRegex(done.stdout, r"^2\.356\d+e-05 N \{'pressure-sensitive': \d+")

    def test_examples_run(self):
        scripts = sorted((HERE / "examples").glob("*.py"))
        self.assertGreaterEqual(len(scripts), 5)
        for script in scripts:
            with tempfile.TemporaryDirectory() as folder:
                done = subprocess.run([sys.executable, script], cwd=folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, f"{script.name}: {done.stderr}")
                self.assertNotEqual(done.stdout, "", script.name)


if __name__ == "__main__":
    unittest.main()
