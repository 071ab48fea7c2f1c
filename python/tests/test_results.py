"""Tests of results as objects: their attributes, copies, forms and types."""

import concurrent.futures
import copy
import json
import os
import pickle
import pydoc
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

import asperity as asp
from asperity._attributes import Attribute, Values, unit_of

FEW = {"numerics__points": 1024, "roughness__modes": (4, 200)}
SCENE = "pressure-sensitive"
LOAD = {"modulus": "1 MPa", "work": "50 mJ/m²", "stages": "100 µN, separation"}


def rough_map():
    return 1e-9 * np.random.default_rng(2).standard_normal((64, 64))


def curve_of(loop, seed=1):
    away = np.linspace(-1e-6, -1e-9, 100)
    d = np.r_[away, loop.indentation, loop.indentation[-1] + away[::-1]]
    force = np.r_[0 * away, loop.force, 0 * away]
    return d, force + 2e-8 * np.random.default_rng(seed).standard_normal(len(d))


def made():
    """Returns a result of each function, by its name."""
    ball = asp.profile("100 µm", 1024, form=asp.sphere("100 µm"))
    loop = asp.load(ball, **LOAD)
    curve, fields = curve_of(loop), {"numerics__points": 256, "modulus": 1e6, "form__radius": 1e-4}
    heights = asp.Profile(ball.heights, ball.spacing, nominal_form="curved")
    rough = {"length": "100 µm", "numerics__points": 1024, "roughness__modes": (1, 4)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {
            "loop": loop,
            "loop of heights": asp.load(heights, **LOAD),
            "run": asp.run(SCENE, profiles=3, **FEW),
            "run on one": asp.run("jkr-sphere", numerics__points=512),
            "ensemble": asp.ensemble(SCENE, profiles=3, **FEW),
            "find": asp.find("preload", SCENE, "F_a = 1 µN", profiles=3, **FEW),
            "preloads": asp.preloads(SCENE, (0, "10 µN"), count=3, profiles=2, **FEW),
            "reversals": asp.reversals(SCENE, count=5, **FEW),
            "reference": asp.reference("rough-sphere", grid=32, surfaces=2, profiles=3, **rough),
            "study": asp.study(SCENE, {"adhesion.kappa": [2, 6]}, profiles=3, **FEW),
            "preloads of one profile": asp.preloads(SCENE, (0, "10 µN"), count=3, **FEW),
            "spectrum": asp.spectrum([1e6, 1e7, 6e7], [1e-29, 1e-32, 1e-35]),
            "surface": asp.surface(rough_map(), spacing=1e-7, modulus="1 MPa", work=1e-3, profiles=2),
            "fit": asp.fit(curve, "jkr-sphere", ["work", "offset"], **fields),
            "fits": asp.fit([curve, curve_of(loop, 2)], "jkr-sphere", ["work", "offset"], **fields),
            "press": asp.press(-np.add.outer(*2 * [np.linspace(-1, 1, 32) ** 2]), side=1, modulus=1, force=1e-3),
        }


def task_of(load):
    """Loads a profile in another process."""
    return asp.load(load, **LOAD)


def all_classes(base=Values):
    for one in base.__subclasses__():
        yield one
        yield from all_classes(one)


class Objects(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = made()

    def test_attributes_are_the_keys_of_the_json_object(self):
        for name, found in self.made.items():
            names = {one.name for one in found._attributes()}
            self.assertLessEqual(found.to_dict().keys() - {"version"}, names, name)
            for attribute in found._attributes():
                if not (name == "fit" and attribute.unit and not hasattr(found, attribute.name)):
                    getattr(found, attribute.name)
            self.assertFalse(hasattr(found, "typo"), name)
            with self.assertRaises(AttributeError):
                found.warnings = []

    def test_copies_have_the_same_forms(self):
        for name, found in self.made.items():
            for other in [pickle.loads(pickle.dumps(found)), copy.deepcopy(found), copy.copy(found)]:
                self.assertEqual(repr(other), repr(found), name)
                for method in ["to_json", "_repr_svg_", "_repr_html_"]:
                    if hasattr(found, method):
                        self.assertEqual(getattr(other, method)(), getattr(found, method)(), f"{name} {method}")
        loop = pickle.loads(pickle.dumps(self.made["loop"]))
        self.assertEqual(loop.pull_off_force_error, self.made["loop"].pull_off_force_error)
        self.assertEqual(repr(list(loop.events)), repr(list(self.made["loop"].events)))
        with self.assertRaisesRegex(ValueError, "read-only"):
            loop.force[0] = 1
        with tempfile.TemporaryDirectory() as folder:
            again = pickle.loads(pickle.dumps(self.made["run"]))
            for ending in ["json", "csv", "npy", "txt", "svg", "png"]:
                written = []
                for number, outcome in enumerate([self.made["run"], again]):
                    outcome.save(Path(folder) / f"{number}.{ending}")
                    written.append((Path(folder) / f"{number}.{ending}").read_bytes())
                self.assertEqual(*written, ending)
            again.save(Path(folder) / "run.pdf")
            for ending in ["json", "csv", "npy", "svg", "png", "pdf"]:
                loop.save(Path(folder) / f"loop.{ending}")
            self.assertEqual(json.loads((Path(folder) / "loop.json").read_text())["force"], list(loop.force))
            np.testing.assert_array_equal(np.load(Path(folder) / "loop.npy")["force"], loop.force)
            np.testing.assert_array_equal(
                np.genfromtxt(Path(folder) / "loop.csv", delimiter=",", names=True)["force"], loop.force
            )

    def test_profiles_scenes_and_surfaces_are_copied_with_the_same_bits(self):
        rough = asp.self_affine(0.7, rms_height="50 nm", modes=(4, 100))
        surface = self.made["surface"]
        x = np.linspace(-1, 1, 64)
        bodies = [
            asp.profile("100 µm", 512, form=asp.sphere("1 mm"), roughness=rough),
            asp.profile("100 µm", form=asp.punch("10 µm"), roughness=1e-9 * x),
            asp.Profile(-1e-6 * x**2, "1 µm", nominal_form="curved"),
            surface.profile("6 µm", 256, seed=3),
        ]
        for body in bodies:
            for other in [pickle.loads(pickle.dumps(body)), copy.deepcopy(body)]:
                self.assertEqual(repr(other), repr(body))
                np.testing.assert_array_equal(other.gaps, body.gaps)
                np.testing.assert_array_equal(other.x, body.x)
        scene = surface.scene(modulus="1 MPa", work=1e-3, stages="1 µN, separation")
        copied = pickle.loads(pickle.dumps(scene))
        self.assertEqual(copied.text, scene.text)
        np.testing.assert_array_equal(asp.ensemble(copied, profiles=2).values(), asp.ensemble(scene, profiles=2).values())
        with tempfile.TemporaryDirectory() as folder:
            # The scene names a file beside it, and its copy is used elsewhere.
            np.savetxt(Path(folder) / "map.txt", rough_map())
            text = """(version: 1, material: (modulus: 1.0e6), length: 6.0e-6, adhesion: (work: 0.001),
                roughness: Measured(file: "map.txt", unit: "m", spacing: 1.0e-7, seed: 1), numerics: (points: 512))"""
            (Path(folder) / "scene.ron").write_text(text, encoding="utf-8")
            here = os.getcwd()
            os.chdir(folder)
            try:
                opened = asp.scene("scene.ron")
                sent = pickle.dumps(opened)
                expected = asp.ensemble(opened, profiles=2).values()
            finally:
                os.chdir(here)
            np.testing.assert_array_equal(asp.ensemble(pickle.loads(sent), profiles=2).values(), expected)
        form = pickle.loads(pickle.dumps(asp.sphere("1 mm")))
        self.assertEqual(repr(form), repr(asp.sphere("1 mm")))
        for error in [asp.FieldError("a", "b", "c", "d"), asp.LoadingError("a", 1, None)]:
            self.assertEqual(vars(pickle.loads(pickle.dumps(error))), vars(error))

    def test_curves_of_several_speeds_share_one_relaxation(self):
        fields = {"numerics__points": 128, "form__radius": 7.5e-6, "length": 2.4e-5, "loading_stiffness": 3}
        relaxing = {"modulus": 1.5e6, "work": 0.05, "material__relaxation": "(share: 0.3, time: 5.0)", **fields}
        curves = []
        for seed, speed in enumerate((1e-7, 1e-6)):
            stages = "displacement 2 µm, separation"
            loop = asp.run("jkr-sphere", stages=stages, loading_speed=speed, **relaxing).loop
            seconds = np.linspace(0, loop.time[-1], 150)
            step = seconds[1] * np.arange(1, 51)
            d, force = (np.interp(seconds, loop.time, column) for column in (loop.displacement, loop.force))
            d = np.r_[-speed * step[::-1], d, d[-1] - speed * step]
            force = np.r_[0 * step, force, 0 * step] + 2e-8 * np.random.default_rng(seed).standard_normal(len(d))
            curves.append((d, force, np.r_[-step[::-1], seconds, seconds[-1] + step]))
        free = ["work", "modulus", "offset", "relaxation_share", "relaxation_time"]
        fits = asp.fit(curves, "jkr-sphere", free, **fields)
        self.assertTrue(fits.together)
        first, second = fits.curves
        self.assertEqual(first.relaxation_time, second.relaxation_time)
        self.assertNotEqual(first.offset, second.offset)
        self.assertLess(abs(first.relaxation_time / 5 - 1), 0.2)
        self.assertLess(first.work_low, 0.05)
        self.assertLess(0.05, first.work_high)
        alone = asp.fit(curves[0], "jkr-sphere", free, **fields)
        in_list = asp.fit(curves[:1], "jkr-sphere", free, **fields)
        self.assertFalse(in_list.together)
        self.assertEqual(in_list.curves[0].work, alone.work.value)
        self.assertEqual(in_list.curves[0].relaxation_time_high, alone.relaxation_time.high)
        with self.assertRaisesRegex(ValueError, "fitted together"), concurrent.futures.ThreadPoolExecutor(1) as executor:
            asp.fit(curves, "jkr-sphere", free, executor=executor, **fields)
        with self.assertRaisesRegex(ValueError, "2 forces and 1 times|200 forces and 1 times|times"):
            asp.fit((curves[0][0], curves[0][1], [1.0]), "jkr-sphere", free, **fields)

    def test_a_pool_of_processes_computes_what_one_process_computes(self):
        balls = [asp.profile("100 µm", points, form=asp.sphere("100 µm")) for points in (256, 512)]
        with concurrent.futures.ProcessPoolExecutor(2) as executor:
            for ball, loop in zip(balls, executor.map(task_of, balls), strict=True):
                self.assertEqual(loop.to_json(), asp.load(ball, **LOAD).to_json())
            seen = []
            ensemble = asp.ensemble(SCENE, profiles=5, executor=executor, progress=lambda *done: seen.append(done), **FEW)
            self.assertEqual(ensemble.to_json(), asp.ensemble(SCENE, profiles=5, **FEW).to_json())
            self.assertEqual(seen[-1], (5, 5))
            axes = {"adhesion.kappa": [2, 6], "preload_in_N": ["1 µN", "2 µN"]}
            study = asp.study(SCENE, axes, profiles=3, executor=executor, **FEW)
            self.assertEqual(study.to_json(), asp.study(SCENE, axes, profiles=3, **FEW).to_json())
            curves = [curve_of(self.made["loop"], seed) for seed in range(3)]
            fields = {"numerics__points": 256, "modulus": 1e6, "form__radius": 1e-4}
            fits = asp.fit(curves, "jkr-sphere", ["work", "offset"], executor=executor, **fields)
            self.assertEqual(fits.to_json(), asp.fit(curves, "jkr-sphere", ["work", "offset"], **fields).to_json())
            scene = self.made["surface"].scene(modulus=1e6, work=1e-3, stages="1 µN, separation")
            in_memory = asp.ensemble(scene, profiles=2, executor=executor)
            self.assertEqual(in_memory.to_json(), asp.ensemble(scene, profiles=2).to_json())
            with self.assertRaisesRegex(ValueError, "profile of this scene is fixed"):
                asp.ensemble("jkr-sphere", profiles=20, executor=executor)
        with self.assertRaises(asp.FieldError) as raised:
            asp.ensemble(SCENE, executor="processes")
        self.assertEqual(raised.exception.field, "executor")

    def test_rows_have_the_columns_as_attributes(self):
        made, seen = self.made, set()
        preloads = made["preloads"].per_profile[0].preloads
        surface = made["surface"]
        for table in [
            made["loop"].events,
            made["run"].curve,
            made["run"].ensemble.per_profile,
            made["ensemble"].per_profile,
            preloads,
            made["reversals"].reversals,
            made["reversals"].preloads,
            made["study"].records,
            made["fits"].curves,
            surface.spectrum,
            surface.profile_spectra[0].bins,
            surface.adhesion.per_profile,
        ]:
            names = [one.name for one in table[0]._attributes()]
            # The value on an axis has the path of its field as its name.
            self.assertLessEqual({name for name in table.columns if "." not in name}, set(names), type(table[0]))
            seen.add(type(table[0]))
            for row in table:
                for name in table.columns:
                    value = getattr(row, name) if name in names else row[name]
                    self.assertTrue(value is None or value == row[name], name)
                    self.assertNotIn(type(value), (dict, list), name)
            self.assertIsInstance(repr(table[0]), str)
            self.assertFalse(hasattr(table[0], "typo"))
        self.assertEqual(seen, set(all_classes(asp.Row)))
        self.assertEqual(preloads[-1].pull_off_force, preloads["pull_off_force"][-1])
        record = made["study"].records[0]
        self.assertEqual((record["adhesion.kappa"], record.seed), (2, made["study"].records["seed"][0]))
        with self.assertRaisesRegex(AttributeError, "no column 'kappa'; columns: cell, adhesion.kappa"):
            record.kappa  # noqa: B018
        recorded = {name for name, *_ in asp._native.quantities()}
        self.assertLessEqual(recorded, {one.name for one in asp.StudyRecord._attributes()})
        loading = made["reference"].half_space.loading[-1]
        self.assertGreater(loading.stiffness.median, 0)
        self.assertEqual(made["reference"].ratio.loading[-1].force, loading.force)
        found = made["fit"].correlations[0]
        self.assertEqual((found.first, found.second), ("work", "offset"))
        self.assertLess(abs(found.value), 1)

    def test_tables_have_units(self):
        self.assertEqual(self.made["loop"].to_pandas().attrs["units"]["force"], "N")
        study = self.made["study"].to_pandas()
        self.assertEqual(study.attrs["units"], {"cell": "1", "adhesion.kappa": "1", "seed": "1", "pull_off_force": "N"})
        for name in ["run", "preloads", "reversals", "ensemble", "surface"]:
            frame = self.made[name].to_pandas()
            texts = {column for column in frame if frame[column].dtype.kind not in "fiu"}
            self.assertEqual(set(frame.columns) - texts, set(frame.attrs["units"]), name)
        fits = self.made["fits"].to_pandas()
        self.assertEqual((len(fits), fits.attrs["units"]["work_low"]), (2, "J/m²"))
        table = self.made["run"].ensemble.per_profile
        self.assertEqual(list(table["seed"]), [row.seed for row in table])
        with self.assertRaisesRegex(KeyError, "no column 'F'; columns: "):
            table[0]["F"]
        self.assertEqual(len(table[1:]), 2)
        with self.assertRaisesRegex(KeyError, "no column 'F'; columns: "):
            table["F"]

    def test_a_study_has_the_axes_of_a_dataset(self):
        try:
            import xarray  # noqa: F401
        except ImportError:
            self.skipTest("no xarray")
        axes = {"roughness.hurst": [0.5, 0.8], "preload_in_N": ["1 µN", "2 µN", "5 µN"]}
        study = asp.study(SCENE, axes, profiles=3, record=["pull_off_force", "regime"], **FEW)
        data = study.to_xarray()
        self.assertEqual(dict(data.sizes), {"preload_in_N": 3, "roughness.hurst": 2, "profile": 3})
        self.assertEqual((data.pull_off_force.attrs["units"], data["preload_in_N"].attrs["units"]), ("N", "N"))
        for row in study.records:
            place = {"roughness.hurst": row["roughness.hurst"], "preload_in_N": row["preload"]}
            one = data.pull_off_force.sel(place, method="nearest").values[list(data.seed.values).index(row["seed"])]
            self.assertEqual(one, row["pull_off_force"])

    def test_a_loop_is_drawn_on_axes(self):
        try:
            import matplotlib
        except ImportError:
            with self.assertRaisesRegex(ImportError, "pip install matplotlib"):
                self.made["loop"].plot()
            return
        matplotlib.use("Agg")
        axes = self.made["loop"].plot(label="one")
        self.assertIs(self.made["loop of heights"].plot(axes), axes)
        self.assertEqual(len(axes.lines), 2)
        np.testing.assert_array_equal(axes.lines[0].get_ydata(), self.made["loop"].force)

    def test_a_name_has_one_unit(self):
        units = {}
        # A ratio has the name of its quantity, and the residual of a solver is counted in rms heights.
        others = (asp.Ratios, asp.RatiosAtForce, asp.Pressed)
        for one in set(all_classes()) - set(others):
            for attribute in one._attributes():
                if attribute.unit not in ("", "=") and not isinstance(attribute.type, type(dict[str, int])):
                    units.setdefault(attribute.name, set()).add(attribute.unit)
        for name, found in units.items():
            if unit_of(name):
                found.add(unit_of(name))
        self.assertEqual({name: found for name, found in units.items() if len(found) > 1}, {})

    def test_help_has_types_units_and_meanings(self):
        text = pydoc.render_doc(asp.Outcome, renderer=pydoc.plaintext)
        self.assertIn("float | None, N: pull-off force F_a, minus the smallest force of the last unloading.", text)
        for one in all_classes():
            self.assertTrue(one.__doc__, one)
            for attribute in one._attributes():
                self.assertIsInstance(attribute, Attribute)
                self.assertNotIn("Any", attribute.type_in_words())
                self.assertRegex(attribute.meaning, r"^\S.*[^.]$")

    def test_notebooks_show_tables_and_figures(self):
        for name, found in self.made.items():
            self.assertIn("<table", found._repr_html_(), name)
            self.assertNotIn("object at 0x", repr(found), name)
            self.assertLess(len(repr(found)), 300, repr(found))
        self.assertIn("<svg", asp.profile("1 mm", 64, form=asp.cone("1°"))._repr_svg_())

    def test_a_misspelt_attribute_is_found_before_a_program_runs(self):
        functions = {
            "asp.load(body, modulus=1)": "Loop",
            "asp.run('x')": "Outcome",
            "asp.ensemble('x')": "Ensemble",
            "asp.find('x', 'x', 'x')": "Found",
            "asp.preloads('x', (0, 1))": "Preloads",
            "asp.reversals('x')": "Reversals",
            "asp.reference('x')": "Reference",
            "asp.study('x', {'a': [1]})": "Study",
            "asp.surface('x')": "Surface",
            "asp.criteria('x')[0]": "Criterion",
            "asp.press([[1.0]], side=1, modulus=1, force=1)": "Pressed",
            "asp.fit('x', 'x', 'work')": "Fit",
            "asp.fit(['x', 'y'], 'x', 'work')": "Fits",
            "asp.fit('x', 'x', 'work', profiles=8)": "EnsembleFit",
            "asp.run('x').profile": "ProfileFacts",
            "asp.fit('x', 'x', 'work').work": "FittedParameter",
            "body": "Profile",
            "asp.scene('x')": "Scene",
            "asp.load(body, modulus=1).events[0]": "Event",
            "asp.run('x').curve[0]": "CurvePoint",
            "asp.ensemble('x').per_profile[0]": "ProfileResults",
            "[one for one in asp.preloads('x', (0, 1)).per_profile[0].preloads][0]": "PreloadResults",
            "asp.preloads('x', (0, 1)).mean[0]": "PreloadStatistics",
            "asp.reversals('x').reversals[-1]": "TurningPoint",
            "asp.study('x', {'a': [1]}).records[1:][0]": "StudyRecord",
            "asp.reference('x').profile.loading[0]": "ModelAtForce",
            "asp.reference('x').ratio.loading[0]": "RatiosAtForce",
            "asp.reference('x').left_out[0]": "ForceLeftOut",
            "asp.surface('x').spectrum[0]": "SpectrumBin",
            "asp.surface('x').profile_spectra[0].bins[0]": "ProfileSpectrumBin",
            "asp.fit('x', 'x', 'work').correlations[0]": "Correlation",
            "asp.fit(['x', 'y'], 'x', 'work').curves[0]": "FittedCurve",
            "asp.fit('x', 'x', 'work', profiles=8).prospects[0]": "Prospect",
            "asp.fit('x', 'x', 'work', profiles=8).curves[0]": "CurveOfEnsemble",
            "asp.fit('x', 'x', 'work', profiles=8).deviations[0]": "SummaryDeviation",
        }
        program = ["import asperity as asp", "body = asp.profile(1)"]
        for expression in functions:
            program.append(f"{expression}.typo")
        program += ["x: float = asp.surface('x').equivalent_line.rms_height.value", "y = asp.load(body, modulus=1).force + 1.0"]
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "program.py"
            file.write_text("\n".join(program) + "\n")
            interpreter = ["--pythonpath", sys.executable]
            for checker in (["mypy", "--strict"], ["basedpyright", "--level", "error", *interpreter], ["pyright", *interpreter]):
                try:
                    command = [sys.executable, "-m", *checker, str(file)]
                    said = subprocess.run(command, capture_output=True, text=True, cwd=folder)
                except OSError:
                    continue
                if "No module named" in said.stderr:
                    self.assertNotEqual(checker[0], "mypy", "mypy is needed")
                    continue
                for line, (expression, name) in enumerate(functions.items(), 3):
                    self.assertRegex(said.stdout, rf'program\.py:{line}:.*"typo".*', f"{checker[0]}: {expression}")
                    self.assertRegex(said.stdout, rf'program\.py:{line}:.*"{name}', f"{checker[0]}: {expression}")
                self.assertNotRegex(said.stdout, rf"program\.py:({len(functions) + 3}|{len(functions) + 4}):", said.stdout)


if __name__ == "__main__":
    unittest.main()
