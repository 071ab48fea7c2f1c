"""Tests of what the functions take, and of the words in which they refuse: `python -m unittest discover python/tests`."""

import inspect
import json
import os
import pickle
import subprocess
import sys
import tempfile
import unittest
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd

import asperity as asp

RADIUS, MODULUS, WORK = 1e-4, 1e6, 0.05
PULL_OFF = 1.5 * np.pi * WORK * RADIUS
BOWL = -np.add.outer(np.linspace(-1, 1, 64) ** 2, np.linspace(-1, 1, 64) ** 2)
RANDOM = np.random.default_rng(1)


def sphere():
    return asp.profile("100 µm", 2048, form=asp.sphere(RADIUS))


def rough_map(points=64):
    return 1e-9 * np.random.default_rng(2).standard_normal((points, points))


class InFolder(unittest.TestCase):
    """A test in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def refused(self, function, /, *arguments, field=None, says=".", **named):
        with self.assertRaises((ValueError, OSError)) as raised:
            function(*arguments, **named)
        error = raised.exception
        self.assertRegex(str(error), says)
        self.assertNotRegex(str(error), "--[a-z]")
        if field is not None:
            self.assertIs(type(error), asp.FieldError, str(error))
            self.assertEqual(error.field, field)
            self.assertTrue(error.allowed)
        return error


class EquivalentLines(InFolder):
    def test_heights_are_those_of_the_equivalent_line_and_no_cut(self):
        x = (np.arange(4096) - 2048) * 25e-9
        load = {"modulus": MODULUS, "work": WORK, "stages": "5 µN, separation"}
        line = asp.load(asp.Profile(-(x**2) / RADIUS, x[1] - x[0]), **load)
        cut = asp.load(asp.Profile(-(x**2) / (2 * RADIUS), x[1] - x[0]), **load)
        self.assertAlmostEqual(line.pull_off_force / PULL_OFF, 1, delta=1e-4)
        self.assertAlmostEqual(cut.pull_off_force / line.pull_off_force, 2, delta=1e-4)
        for word in ["cut", "twice"]:
            self.assertIn(word, asp.Profile.__doc__)

    def test_preloads_of_heights_are_those_of_their_loops(self):
        for points in [2, 3, 1000]:
            heights = asp.Profile(1e-7 * np.random.default_rng(points).random(points), 1e-7)
            contact = {"modulus": MODULUS, "work": 0.01}
            found = asp.preloads(heights, ("1 pN", "1 nN"), count=3, log=True, **contact).to_pandas()
            for preload, force in zip(found.preload, found.pull_off_force, strict=True):
                loop = asp.load(heights, stages=[preload, "separation"], **contact)
                self.assertAlmostEqual(force / loop.pull_off_force, 1, delta=1e-9)
        last = asp.reversals(heights, (0, "1 nN"), count=4, **contact).to_pandas().iloc[-1]
        loop = asp.load(heights, stages=[f"{last.turning_indentation} m", "separation"], **contact)
        self.assertAlmostEqual(last.pull_off_force / loop.pull_off_force, 1, delta=1e-9)
        self.refused(asp.preloads, asp.Profile([0.0], 1e-6), (0, "1 µN"), field="heights", **contact)
        for function in [asp.run, asp.ensemble, asp.criteria, asp.reference]:
            self.refused(function, heights, field="scene", says="form and roughness are not known", **contact)

    def test_an_array_is_the_roughness_of_a_form(self):
        rough = 1e-8 * np.random.default_rng(5).standard_normal(512)
        for form in [None, asp.sphere("1 mm"), asp.cone("10°")]:
            smooth = np.zeros(512) if form is None else asp.profile("50 µm", 512, form=form).heights
            body = asp.profile("50 µm", form=form, roughness=rough)
            expected = (rough + smooth).max() - (rough + smooth)
            np.testing.assert_allclose(body.gaps, expected, atol=1e-18, rtol=1e-12)
        self.assertEqual(len(asp.profile("50 µm", roughness=[0.0, 1e-9])), 2)
        self.refused(asp.profile, "50 µm", 513, roughness=rough, field="roughness", says="512 heights; allowed: 513")

    def test_a_form_of_two_arrays_is_that_of_a_file(self):
        radii = np.linspace(0, 60e-6, 200)
        depths = radii**2 / (2 * RADIUS)
        np.save("tip.npy", np.c_[radii, depths])
        given = asp.profile("100 µm", 1024, form=asp.revolve(radii, depths))
        saved = asp.profile("100 µm", 1024, form=asp.table("tip.npy"))
        np.testing.assert_array_equal(given.gaps, saved.gaps)
        contact = {"modulus": MODULUS, "work": WORK, "stages": "10 µN, separation"}
        self.assertAlmostEqual(asp.load(given, **contact).pull_off_force / PULL_OFF, 1, delta=1e-4)
        # The rows are in the text of the scene.
        again = asp.scene(asp.scene(given, **contact).text)
        self.assertEqual(asp.run(again).pull_off_force, asp.load(given, **contact).pull_off_force)
        study = asp.study(given, {"adhesion.work": [0.01, WORK]}, **contact)
        self.assertEqual(study.records["pull_off_force"][1], asp.load(given, **contact).pull_off_force)
        Path("form.ron").write_text(again.text, encoding="utf-8")
        self.assertEqual(asp.run("form.ron").pull_off_force, asp.run(again).pull_off_force)
        for radii, depths, field in [([0, 1, 1], [0, 1, 2], "radii"), ([1, 2], [0, 1], "radii"), ([0], [0], "radii"), ([0, 1], [0], "depths")]:
            self.refused(asp.revolve, radii, depths, field=field)
        self.refused(asp.profile, "1 mm", form=asp.revolve([0, 1e-6], [0, 1e-7]), field="form", says="the table ends")

    def test_heights_with_their_spacing_are_a_measured_surface(self):
        heights = rough_map()
        for form in [None, asp.sphere("1 mm")]:
            pair = asp.profile("6 µm", 512, form=form, roughness=(heights, "0.1 µm"), seed=3)
            surface = asp.profile("6 µm", 512, form=form, roughness=asp.surface(heights, spacing=1e-7), seed=3)
            np.testing.assert_array_equal(pair.gaps, surface.gaps)
        self.refused(asp.profile, "6 µm", roughness=(heights, "1 N"), field="spacing")

    def test_a_surface_is_the_roughness_of_a_form(self):
        heights = rough_map()
        np.save("map.npy", heights)
        array = asp.surface(heights, spacing="0.1 µm")
        file = asp.surface("map.npy", unit="m", spacing=1e-7)
        contact = {"modulus": MODULUS, "work": 1e-3, "stages": "1 µN, separation"}
        for form in [None, asp.sphere("1 mm")]:
            bodies = [asp.profile("6 µm", 512, form=form, roughness=surface, seed=3) for surface in (array, file)]
            bodies.append(array.profile("6 µm", 512, form=form, seed=3))
            named = asp.measured("map.npy", unit="m", spacing="0.1 µm")
            bodies.append(asp.profile("6 µm", 512, form=form, roughness=named, seed=3))
            loops = [asp.load(body, **contact) for body in bodies]
            for body, loop in zip(bodies[1:], loops[1:], strict=True):
                np.testing.assert_array_equal(body.gaps, bodies[0].gaps)
                self.assertEqual((loop.kappa, loop.regime, loop.pull_off_force), (loops[0].kappa, loops[0].regime, loops[0].pull_off_force))
            found = [asp.ensemble(body, profiles=3, **contact).values() for body in bodies]
            for values in found[1:]:
                np.testing.assert_array_equal(values, found[0])
        outcome = asp.run(bodies[0], profiles=2, **contact)
        self.assertIsNotNone(outcome.regime)
        # No text holds a scene in memory, so tables and figures state none.
        self.assertIn("<svg", outcome._repr_svg_())
        outcome.save("run.csv")
        heights = asp.Profile(np.r_[bodies[0].heights], bodies[0].spacing)
        found = asp.preloads(heights, (0, "1 µN"), count=3, modulus=MODULUS, work=1e-3)
        self.assertIn("<svg", found._repr_svg_())
        body = bodies[0]
        self.assertNotEqual(asp.scene(body, roughness__seed=9, modulus=1e6).text, asp.scene(body, modulus=1e6).text)
        self.refused(asp.run, body, roughness__detrend="Mean", field="roughness", says="another seed alone", **contact)

    def test_studies_of_surfaces_and_heights_in_memory_are_those_of_loops(self):
        works = [1e-3, 2e-3]
        surface = asp.surface(rough_map(), spacing="0.1 µm").profile("6 µm", 512, form=asp.sphere("1 mm"), seed=3)
        heights = asp.Profile(surface.heights, surface.spacing)
        contact = {"modulus": MODULUS, "stages": "1 µN, separation"}
        for body in [surface, heights]:
            found = asp.study(body, {"adhesion.work": works}, profiles=1, work=1e-3, **contact).to_pandas()
            for work, force in zip(works, found.pull_off_force, strict=True):
                loop = asp.load(body, work=work, **contact)
                self.assertAlmostEqual(force / loop.pull_off_force, 1, delta=1e-9)
        self.refused(asp.study, surface, {"roughness.rows": [1]}, profiles=1, work=1e-3, **contact)

    def test_surfaces_and_heights_in_memory_are_fitted(self):
        surface = asp.surface(rough_map(), spacing="0.1 µm").profile("6 µm", 512, form=asp.sphere("1 mm"), seed=3)
        heights = asp.Profile(surface.heights, surface.spacing)
        contact = {"modulus": MODULUS, "stages": "1 µN, separation"}
        loop = asp.load(surface, work=2e-3, **contact)
        free = np.linspace(-1e-7, -1e-9, 100)
        after = loop.indentation[-1] - np.linspace(1e-9, 1e-7, 50)
        displacement, force = np.r_[free, loop.indentation, after], np.r_[np.zeros(100), loop.force, np.zeros(50)]
        options = {"noise": "1 nN"}
        found = [
            asp.fit((displacement, force), body, ["work"], work=1e-3, options=options, **contact).work.value
            for body in (surface, heights)
        ]
        self.assertAlmostEqual(found[0] / 2e-3, 1, delta=0.1)
        self.assertAlmostEqual(found[1] / found[0], 1, delta=0.01)


class Contacts(InFolder):
    def test_a_profile_has_no_modulus_of_its_own(self):
        body, heights = sphere(), asp.Profile([0, 1e-9, 0], 1e-7)
        for given in [body, heights]:
            for function, further in [
                (asp.run, ()),
                (asp.ensemble, ()),
                (asp.criteria, ()),
                (asp.reference, ()),
                (asp.reversals, ()),
                (asp.scene, ()),
                (asp.preloads, (("1 µN", "2 µN"),)),
                (asp.study, ({"adhesion.work": [0.1]},)),
            ]:
                self.refused(function, given, *further, field="modulus")
            self.refused(asp.find, "preload", given, "F_a = 1 µN", field="modulus")
            self.refused(asp.fit, ([0, 1], [0, 1]), given, ["work"], field="modulus")
        self.assertFalse(hasattr(body, "scene"))

    def test_all_functions_of_scenes_name_the_arguments_of_a_contact(self):
        for name in ["scene", "run", "ensemble", "find", "preloads", "reversals", "reference", "criteria", "study", "fit", "load"]:
            parameters = inspect.signature(getattr(asp, name)).parameters
            for argument in ["modulus", "work", "closing_work", "stages"]:
                self.assertIs(parameters[argument].kind, inspect.Parameter.KEYWORD_ONLY, name)

    def test_all_functions_take_the_contact_of_load(self):
        body = sphere()
        contact = {"modulus": "1 MPa", "work": "50 mJ/m²", "closing_work": "40 mJ/m²", "stages": "100 µN, separation"}
        loop = asp.load(body, **contact)
        fields = {"material__modulus": 1e6, "adhesion": {"work": 0.05, "closing_work": 0.04}, "loading": contact["stages"]}
        for given in [contact, fields, {**contact, "stages": [1e-4, "separation"]}]:
            self.assertEqual(asp.run(body, profiles=1, **given).pull_off_force, loop.pull_off_force)
        self.assertEqual(asp.scene(body, **contact).text, asp.scene(body, **fields).text)
        preloads = asp.preloads(body, ("50 µN", "100 µN"), count=2, modulus="1 MPa", work=0.05, closing_work=0.04)
        self.assertAlmostEqual(preloads.to_pandas().pull_off_force.iloc[-1] / loop.pull_off_force, 1, delta=1e-12)
        # A work replaces κ, and the range of the attraction stays.
        near = asp.scene("pressure-sensitive", adhesion__range="1 nm")
        self.assertIn("adhesion: (work: 0.1, range: 1.0e-9)", asp.scene(near, work=0.1).text)
        self.assertIn("adhesion: None", asp.scene(near, work=0).text)
        self.refused(asp.run, body, modulus=1e6, material__modulus=2e6, field="modulus", says="not both")
        self.refused(asp.run, "jkr-sphere", work=1, adhesion__kappa=2, field="work", says="not both")
        self.refused(asp.run, "jkr-sphere", modulus="1 J", field="modulus", says="not a unit of pressure")
        self.refused(asp.run, "jkr-sphere", work=-1, field="work")


class Surfaces(InFolder):
    def test_adhesion_is_that_of_the_command(self):
        np.save("map.npy", rough_map())
        words = ["map.npy", "--unit", "m", "--spacing", "1e-7", "--detrend", "curvature", "--tip-radius", "10nm"]
        for contact, options in [
            ([], {}),
            (["--modulus", "1MPa"], {"modulus": "1 MPa"}),
            (["--modulus", "1MPa", "--work", "1mJ/m^2"], {"modulus": "1 MPa", "work": "1 mJ/m²"}),
            (
                ["--modulus", "1MPa", "--work", "1mJ/m^2", "--preload", "1uN", "--profiles", "3"],
                {"modulus": 1e6, "work": 1e-3, "preload": "1 µN", "profiles": 3, "jobs": 2},
            ),
        ]:
            command = [sys.executable, "-m", "asperity", "surface", *words, *contact, "--format", "json"]
            printed = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
            found = asp.surface("map.npy", unit="m", spacing="0.1 µm", detrend="Curvature", tip_radius="10 nm", **options).to_dict()
            # The command names the fields of a scene, the function its arguments.
            printed["warnings"] = [text.replace("roughness.", "") for text in printed["warnings"]]
            for key in printed.keys() - {"program", "command"}:
                self.assertEqual(json.dumps(found[key]), json.dumps(printed[key]), key)
            self.assertEqual(found["adhesion"] is None, "work" not in options)
        array = asp.surface(rough_map(), spacing=1e-7, detrend="curvature", **options)
        file = asp.surface("map.npy", unit="m", spacing=1e-7, detrend="curvature", **options)
        self.assertEqual(array.adhesion.to_dict(), file.adhesion.to_dict())

    def test_a_spectrum_is_a_roughness(self):
        q = np.geomspace(2e5, 5e7, 60)
        c2d = 3e-6 * q**-3.8
        spectrum = asp.spectrum(q, c2d)
        height = np.sqrt(np.trapezoid(q**2 * c2d, np.log(q)) / (2 * np.pi))
        self.assertAlmostEqual(spectrum.rms_height / height, 1, delta=2e-3)
        form = asp.sphere("1 mm")
        body = asp.profile("60 µm", 4096, form=form, roughness=spectrum, seed=3)
        flat = [asp.profile("60 µm", 4096, roughness=spectrum, seed=seed).heights for seed in range(1, 17)]
        self.assertAlmostEqual(np.std(flat) / height, 1, delta=0.2)
        # The amplitude of each wave of the line is that of its spectrum, q C2D/2 in m³.
        waves = np.abs(np.fft.rfft(flat[0])) / 4096
        numbers = np.arange(2, 400)
        of_line = 0.5 * (2 * np.pi * numbers / 60e-6) * 3e-6 * (2 * np.pi * numbers / 60e-6) ** -3.8
        np.testing.assert_allclose(2 * waves[numbers], np.sqrt(4 * of_line / 60e-6), rtol=2e-3)
        contact = {"modulus": "1 MPa", "work": "5 mJ/m²", "stages": "10 µN, separation"}
        self.assertEqual(len(asp.ensemble(body, profiles=3, **contact).values()), 3)
        self.assertEqual(repr(pickle.loads(pickle.dumps(spectrum))), repr(spectrum))
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(body)).heights, body.heights)
        # The spectrum that a surface has found.
        surface = asp.surface(rough_map(), spacing=1e-7)
        again = asp.spectrum(surface.spectrum["wave_number"], surface.spectrum["c2d"])
        self.assertAlmostEqual(again.rms_gradient / surface.equivalent_line.rms_gradient.value, 1, delta=1e-3)
        np.testing.assert_allclose(
            again.c2d, asp.spectrum(again.wave_number, again.c2d).c2d, rtol=1e-12
        )
        for given, field in [
            (([1e5], [1e-30]), "wave_numbers"),
            (([0, 1e5], [1e-30, 1e-30]), "wave_numbers"),
            (([2e5, 1e5], [1e-30, 1e-30]), "wave_numbers"),
            (([1e5, 2e5], [1e-30]), "c2d"),
            (([1e5, 2e5], [1e-30, 0]), "c2d"),
            (([1e5, 2e5], [1e-30, -1e-30]), "c2d"),
            (([1e5, 2e5], ["a", "b"]), "c2d"),
        ]:
            self.refused(asp.spectrum, *given, field=field)

    def test_an_adhesion_needs_all_its_values(self):
        heights = rough_map()
        for options, field in [
            ({"work": 0.05}, "modulus"),
            ({"preload": 1e-6}, "modulus"),
            ({"modulus": 1e6, "profiles": 4}, "work"),
            ({"modulus": 1e6, "work": 1e-3, "profiles": 1}, "profiles"),
            ({"modulus": 0}, "modulus"),
            ({"modulus": "1 J"}, "modulus"),
            ({"modulus": 1e6, "work": -1}, "work"),
            ({"tip_radius": float("nan")}, "tip_radius"),
            ({"pixel": 1}, "pixel"),
            ({"scene": "a.ron"}, "scene"),
            ({"unit": "um"}, "unit"),
            ({"channel": 1}, "channel"),
            ({"detrend": "slope"}, "detrend"),
            ({"interpolate": "yes"}, "interpolate"),
            ({"row": 0}, "row"),
            ({"opposite": 3}, "opposite"),
        ]:
            with self.subTest(options):
                self.refused(asp.surface, heights, spacing=1e-7, field=field, **options)
        for spacing in [None, (1, 2, 3), "1 N", True, ()]:
            self.refused(asp.surface, heights, spacing=spacing, field="spacing")
        self.refused(asp.surface, b"x", field="files")
        np.save("map.npy", heights)
        self.refused(asp.surface, "map.npy", says='unit="um"$')
        self.refused(asp.surface, "no.npy", says="no.npy: cannot be read")

    def test_masked_points_are_missing_points(self):
        whole = rough_map()
        spiked = whole.copy()
        spiked[5, 7] = 1e-6
        masked = np.ma.masked_greater(spiked, 1e-7)
        holed = np.where(spiked > 1e-7, np.nan, whole)
        np.save("holed.npy", holed)
        self.refused(asp.surface, masked, spacing=1e-7, says=r"^point 328: 1 of 4096 points are missing.*interpolate=True")
        file = asp.surface("holed.npy", unit="m", spacing=1e-7, interpolate=True)
        for array in [masked, holed, np.ma.masked_invalid(holed), masked.astype(np.float32).astype(np.float64)]:
            found = asp.surface(array, spacing=1e-7, interpolate=True)
            self.assertAlmostEqual(found.rms_height / file.rms_height, 1, delta=1e-6)
        self.assertLess(file.rms_height, 1.1e-9)
        # A mask without masked points changes nothing, and whole numbers may be masked.
        unmasked = asp.surface(np.ma.asarray(whole), spacing=1e-7)
        self.assertEqual(unmasked.rms_height, asp.surface(whole, spacing=1e-7).rms_height)
        counts = np.ma.masked_equal(np.arange(4096).reshape(64, 64) % 7, 3)
        self.assertGreater(asp.surface(counts, spacing=1, interpolate=True).rms_height, 1)
        self.assertEqual(list(asp.Profile(np.ma.asarray([0.0, 1.0]), 1).gaps), [1, 0])
        for function in [asp.Profile, lambda heights, spacing: asp.profile("1 µm", roughness=heights)]:
            error = self.refused(function, np.ma.masked_greater([0, 1, 5.0], 2), 1)
            self.assertIn("an array with 1 masked points", str(error))
        self.refused(asp.press, masked, side=1, modulus=1, force=1, field="heights")

    def test_an_array_has_the_corrections_of_a_file(self):
        heights = rough_map()
        heights[9, 9] += 1e-7
        np.save("map.npy", heights)
        for options in [{"align_rows": True}, {"robust": True}, {"row": 2}, {"column": 64}, {"detrend": "none"}, {"periodic": True}]:
            array, file = asp.surface(heights, spacing=1e-7, **options), asp.surface("map.npy", unit="m", spacing=1e-7, **options)
            self.assertEqual(array.equivalent_line.to_dict(), file.equivalent_line.to_dict(), options)
        opposite = {"opposite": "map.npy"}
        # The opposite file states no unit, which an array cannot have.
        self.refused(asp.surface, heights, spacing=1e-7, says="map.npy", **opposite)
        np.savetxt("map.txt", heights[0], header="z [m]")
        flat = asp.surface(heights, spacing=1e-7)
        self.assertIsNone(flat.opposite)


class Texts(InFolder):
    def test_a_text_with_a_unit_is_a_number(self):
        texts = asp.study("jkr-sphere", {"adhesion.work": ["10 mJ/m²", 0.02, np.float32(0.5)]}, profiles=1).to_pandas()
        np.testing.assert_allclose(texts["adhesion.work"], [0.01, 0.02, 0.5])
        forces = asp.study("pressure-sensitive", {"preload_in_N": ["1 µN", "2 µN"]}, profiles=1).to_pandas()
        np.testing.assert_allclose(forces["preload"], [1e-6, 2e-6])
        one = asp.study("pressure-sensitive", {"adhesion__kappa": 2}, record="kappa", profiles=1).to_pandas()
        self.assertEqual(list(one["adhesion.kappa"]), [2])
        # The scene states its adhesion by κ, which an axis or a field replaces.
        by_work = asp.scene("pressure-sensitive", adhesion__work="10 mJ/m²", adhesion__range="1 nm")
        self.assertIn("adhesion: (work: 0.01, range: 1.0e-9)", by_work.text)
        self.assertIn("adhesion: (kappa: 3", asp.scene("rough-sphere", adhesion__kappa=3).text)
        self.refused(asp.scene, "rough-sphere", adhesion__kappa=3, adhesion__work=1, field="adhesion")
        works = asp.study("pressure-sensitive", {"adhesion.work": ["5 mJ/m²", "20 mJ/m²"]}, record="work", profiles=1, adhesion__range="1 nm")
        np.testing.assert_allclose(works.records["work"], [5e-3, 20e-3])
        self.refused(asp.study, "pressure-sensitive", {"preload": ["1 µN"]}, field="preload", says="preload_in_N takes forces")
        self.refused(asp.study, "jkr-sphere", {"adhesion.work": ["1 N"]}, field="adhesion.work", says="not a unit")
        self.refused(asp.study, "jkr-sphere", {"adhesion.work": [True]}, field="adhesion.work")
        self.refused(asp.study, "jkr-sphere", ["adhesion.work"], field="axes")
        self.refused(asp.study, "jkr-sphere", {"adhesion.work": [1]}, record=[1], field="record")

    def test_texts_of_a_measured_roughness_are_quoted(self):
        np.savetxt("line.txt", np.c_[np.arange(256), RANDOM.standard_normal(256)])
        numbers = asp.measured("line.txt", unit="um", height_unit="nm", detrend="tilt", continue_to="500 nm")
        typed = asp.measured(Path("line.txt"), unit="um", height_unit="nm", detrend="Tilt", continue_to=5e-7)
        self.assertEqual(repr(numbers), repr(typed))
        several = asp.measured("line.txt", unit="um", further_files=Path("line.txt"))
        self.assertEqual(several.values["further_files"], [str(Path("line.txt").absolute())])
        self.assertEqual(asp.measured('a"b\\c.txt').values["file"], str(Path('a"b\\c.txt').absolute()))
        channels = [asp.measured("line.txt", channel=channel).values for channel in (2, "height")]
        self.assertEqual((channels[0]["channel"], channels[1]["surface_name"]), (2, "height"))
        rough = asp.self_affine(0.7, rms_height="10 nm", modes=(4, 64))
        self.assertIn("seed: 1", asp.scene("pressure-sensitive", roughness=rough).text)
        self.assertIn('unit: "um"', asp.scene(asp.profile("100 µm", 1024, roughness=numbers), modulus=1e6).text)
        for options, field in [({"unit": "apples"}, "unit"), ({"unit": 3}, "unit"), ({"spacing": "1 N"}, "spacing"), ({"as_line": 1}, "as_line"), ({"column": True}, "column"), ({"row": 1, "column": 1}, "row")]:
            with self.subTest(options):
                self.refused(asp.measured, "line.txt", field=field if field != "row" else None, **options)

    def test_units_and_ranges_are_checked_at_once(self):
        for function, arguments, field in [
            (asp.sphere, ["5 N"], "radius"),
            (asp.sphere, ["5 apples"], "radius"),
            (asp.sphere, [0], "radius"),
            (asp.sphere, [10**400], "radius"),
            (asp.sphere, [None], "radius"),
            (asp.cone, ["1 N"], "angle"),
            (asp.cone, [2], "angle"),
            (asp.punch, [-1], "radius"),
            (asp.power, [1, "2 m"], "exponent"),
            (asp.wavy_sphere, [1, "1 Pa", 1], "amplitude"),
            (asp.rounded_cone, [1, 2], "angle"),
            (asp.rounded_cone, [0, 1], "radius"),
            (asp.spheres, [[1, (1, -1)]], "spheres[1]"),
            (asp.spheres, [[(1, 0), "1 N"]], "spheres[1]"),
            (asp.spheres, [[(1, 0, 0)]], "spheres[0]"),
            (asp.spheres, ["1 mm"], "spheres"),
            (asp.spheres, [[]], "form"),
            (asp.spheres, [[(1, 1)]], "form"),
            (asp.table, [[[0, 1], [0, 2]]], "file"),
            (asp.self_affine, [1.4], "hurst"),
            (asp.profile, ["1 N"], "length"),
            (asp.profile, [1e-4, asp.sphere(1)], "points"),
            (asp.profile, [1e-4, 1], "points"),
        ]:
            with self.subTest(field=field, arguments=arguments):
                self.refused(function, *arguments, field=field)
        self.assertEqual(repr(asp.cone("45°")), f"Cone(angle: {np.pi / 4!r})")
        for waves, field in [({"rms_height": "1 N"}, "rms_height"), ({"modes": 3}, "modes"), ({"modes": (1, 2.5)}, "modes"), ({"wavelengths": ("1 m", "1 N")}, "wavelengths")]:
            self.refused(asp.self_affine, 0.7, field=field, **waves)
        for options, field in [({"form": 1.0}, "form"), ({"form": asp.self_affine(0.5)}, "form"), ({"roughness": asp.sphere(1)}, "roughness"), ({"seed": -1}, "seed")]:
            self.refused(asp.profile, 1e-4, field=field, **options)

    def test_foreign_texts_neither_control_a_terminal_nor_flood_it(self):
        wild = "\x1b[2J\u202e" + "9" * 5000
        for function, arguments, named in [
            (asp.ensemble, ["pressure-sensitive"], {"profiles": wild}),
            (asp.ensemble, ["pressure-sensitive"], {"profiles": 10**5000}),
            (asp.ensemble, ["pressure-sensitive"], {"adhesion__kappa": wild}),
            (asp.ensemble, ["pressure-sensitive"], {wild: 1}),
            (asp.ensemble, [wild], {}),
            (asp.sphere, [wild], {}),
            (asp.load, [sphere()], {"modulus": 1e6, "stages": wild}),
            (asp.load, [sphere()], {"modulus": 1e6, "edges": wild}),
            (asp.study, ["jkr-sphere", {wild: [1]}], {}),
            (asp.study, ["jkr-sphere", {"adhesion.work": [wild]}], {}),
            (asp.study, ["jkr-sphere", {"adhesion.work": [1]}], {"record": [wild]}),
            (asp.find, ["preload", "pressure-sensitive", wild], {}),
            (asp.find, [wild, "pressure-sensitive", "F_a = 1 N"], {}),
            (asp.preloads, ["pressure-sensitive", wild], {}),
            (asp.measured, ["a.txt"], {"unit": wild}),
            (asp.fit, [([1], [1]), "jkr-sphere", [wild]], {}),
            (asp.fit, [([1], [1]), "jkr-sphere", ["work"]], {"options": {wild: 1}}),
            (asp.fit, [wild, "jkr-sphere", ["work"]], {}),
        ]:
            with self.subTest(function=function.__name__, named=list(named)):
                message = str(self.refused(function, *arguments, **named))
                self.assertNotRegex(message, "[\x1b\u202e]")
                self.assertLess(len(message), 1200, message[:200])


class Premises(InFolder):
    def warned(self, function, /, *arguments, **named):
        """Returns the result of a function, and its warnings, which point at this file."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = function(*arguments, **named)
        self.assertTrue(all(one.category is asp.PremiseWarning and one.filename == __file__ for one in caught))
        return found, [str(one.message) for one in caught]

    def test_a_contact_at_the_ends_of_the_profile_is_a_warning(self):
        contact = {"modulus": "1 MPa", "work": "50 mJ/m²", "stages": "100 µN, separation"}
        for length, is_short in [("20 µm", True), ("30 µm", True), ("100 µm", False)]:
            body = asp.profile(length, 2048, form=asp.sphere(RADIUS))
            heights = asp.Profile(body.heights, body.spacing, nominal_form="curved")
            for given in [body, heights]:
                loop, said = self.warned(asp.load, given, **contact)
                self.assertEqual(said, loop.warnings)
                self.assertEqual([text.startswith("The contact reaches an end") for text in said], [True] if is_short else [])
            outcome, said = self.warned(asp.run, body, profiles=1, **contact)
            self.assertEqual((said, outcome.warnings), (loop.warnings, loop.warnings))
            self.assertEqual(self.warned(asp.criteria, body, **contact)[1], [])

    def test_a_premise_of_all_profiles_of_preloads_has_no_count(self):
        heights = asp.Profile(1e-9 * np.random.default_rng(1).standard_normal(1024), 1e-7)
        contact = {"modulus": MODULUS, "work": WORK, "count": 2}
        found, said = self.warned(asp.preloads, heights, ("1 µN", "5 µN"), **contact)
        self.assertTrue(said and said == found._premises())
        self.assertFalse([text for text in said if text.startswith("On ")])

    def test_heights_of_which_nothing_is_stated_are_a_warning(self):
        x = (np.arange(1024) - 512) * 1e-7
        contact = {"modulus": MODULUS, "work": WORK, "stages": "5 µN, separation"}
        for heights, form, word in [
            (-(x**2) / 2e-4, None, "R = 100 µm"),
            (-(x**2) / 2e-4, "curved", None),
            (1e-9 * np.random.default_rng(1).standard_normal(1024), None, "29 %"),
            (1e-9 * np.random.default_rng(1).standard_normal(1024), "flat", None),
            (np.zeros(16), None, None),
        ]:
            said = self.warned(asp.load, asp.Profile(heights, 1e-7, nominal_form=form), **contact)[1]
            self.assertEqual([word in text for text in said], [True] if word else [], said)
        self.refused(asp.Profile, [0, 1], 1, nominal_form="round", field="nominal_form")

    def test_premises_of_random_profiles_have_their_number(self):
        steep = {"roughness__rms_height": "20 µm", "adhesion": None}
        found, said = self.warned(asp.ensemble, "pressure-sensitive", profiles=3, **steep)
        self.assertTrue(any("The rms gradient" in text for text in said), said)
        self.assertEqual(found.warnings, said)
        self.assertFalse([text for text in said if text.startswith("On ")])
        outcome, said = self.warned(asp.run, "pressure-sensitive", profiles=3, **steep)
        self.assertEqual(said[: len(outcome.warnings)], outcome.warnings)
        self.assertEqual(len(said), len(set(said)))

    def test_doubts_about_a_surface_name_the_arguments(self):
        tilted = rough_map() + 1e-9 * np.arange(64)
        surface, said = self.warned(asp.surface, tilted, spacing=1e-7, detrend="none")
        self.assertTrue(any('detrend="tilt" removes it' in text for text in said), said)
        steep, more = self.warned(asp.surface, 1e3 * rough_map(), spacing=1e-7)
        self.assertTrue(any("unit and height_unit state" in text for text in more), more)
        self.assertNotIn("roughness.", surface.to_json() + steep.to_json())

    def test_doubts_about_heights_point_at_the_caller(self):
        _, said = self.warned(asp.profile, "6 µm", 512, roughness=(1e3 * rough_map(), 1e-7))
        self.assertTrue(any("rms gradient" in text for text in said), said)

    def test_doubts_about_a_surface_are_warnings(self):
        surface, said = self.warned(asp.surface, 1e-3 * rough_map(), spacing=1e-15)
        self.assertEqual(said, surface.warnings)
        self.assertTrue(any("rms gradient" in text for text in said), said)


class Words(InFolder):
    def test_wrong_types_are_refused_by_their_argument(self):
        body = sphere()
        for function, arguments, named, field in [
            (asp.load, ["jkr-sphere"], {"modulus": 1e6}, "profile"),
            (asp.load, [np.zeros(100)], {"modulus": 1e6}, "profile"),
            (asp.load, [asp.scene("jkr-sphere")], {"modulus": 1e6}, "profile"),
            (asp.load, [body], {"modulus": 10**400}, "modulus"),
            (asp.load, [body], {"modulus": [1]}, "modulus"),
            (asp.load, [body], {"modulus": 1e6, "edges": []}, "edges"),
            (asp.load, [body], {"modulus": 1e6, "stages": None}, "stages"),
            (asp.load, [body], {"modulus": 1e6, "progress": 5}, "progress"),
            (asp.run, [1.0], {}, "scene"),
            (asp.run, [b"jkr-sphere"], {}, "scene"),
            (asp.run, ["jkr-sphere"], {"form__radius": 10**400}, "form.radius"),
            (asp.find, ["preload", "pressure-sensitive", 0.2], {}, "where"),
            (asp.find, [1, "pressure-sensitive", "F_a = 1 N"], {}, "field"),
            (asp.find, ["preload", "pressure-sensitive", "F_a = 1 N"], {"range": 3}, "range"),
            (asp.preloads, ["pressure-sensitive", np.geomspace(1e-6, 1e-3, 5)], {}, "between"),
            (asp.preloads, ["pressure-sensitive", 1e-6], {}, "between"),
            (asp.preloads, ["pressure-sensitive", (0, 1)], {"count": 1}, "count"),
            (asp.preloads, ["pressure-sensitive", (0, 1)], {"log": "yes"}, "log"),
            (asp.fit, [5, "jkr-sphere", ["work"]], {}, "curves"),
            (asp.fit, [[5], "jkr-sphere", ["work"]], {}, "curves"),
            (asp.fit, [np.zeros((3, 3)), "jkr-sphere", ["work"]], {}, "curves"),
            (asp.fit, [([1], [1]), "jkr-sphere", 5], {}, "free"),
            (asp.fit, [([1], [1]), "jkr-sphere", ["work"]], {"options": 5}, "options"),
            (asp.fit, [([1], [1]), "jkr-sphere", ["work"]], {"options": {"nosuch": 5}}, "options"),
            (asp.fit, [([1], [1]), "jkr-sphere", ["work"]], {"options": {"set": "form.radius=1"}}, "options"),
            (asp.fit, [([1], [1]), "jkr-sphere", ["work"]], {"options": {"scene": "a.ron"}}, "options"),
            (asp.fit, [pd.DataFrame(np.zeros((5, 3))), "jkr-sphere", ["work"]], {}, "curves"),
            (asp.measured, ["a\x1b.txt"], {}, "file"),
            (asp.fit, [([1], [1]), "jkr-sphere", ["work"]], {"options": {"noise": "x"}}, "noise"),
            (asp.fit, [([1], [1]), "jkr-sphere", ["work"]], {"options": {"negate": "x"}}, "negate"),
            (asp.press, [np.zeros((32, 32))], {"side": 1, "modulus": 1, "force": 1e40}, "force"),
            (asp.press, [np.zeros((32, 32))], {"side": "1 N", "modulus": 1, "force": 1}, "side"),
            (asp.press, [BOWL], {"side": 1, "modulus": 1, "force": 1e17}, "residual"),
        ]:
            with self.subTest(field=field, arguments=arguments):
                self.refused(function, *arguments, field=field, **named)

    def test_stages_are_counted_from_0(self):
        body = sphere()
        for stages, stage in [("10 µN, -1 N", 1), ("2 loops 0 N to 10 µN, -1 N", 5)]:
            with self.assertRaisesRegex(asp.LoadingError, f"^stage {stage}, counted from 0: ") as raised:
                asp.load(body, modulus=1e6, work=WORK, stages=stages)
            self.assertEqual(raised.exception.stage, stage)
        loop = asp.load(body, modulus=1e6, work=WORK, stages="10 µN, separation")
        self.assertEqual(sorted(set(loop.stage)), [0, 1])
        self.assertEqual(loop.force[loop.stage == 1].min(), -loop.pull_off_force)
        one = asp.load(body, modulus=1e6, work=WORK, stages=1e-5)
        self.assertEqual((one.preload, max(one.stage)), (loop.preload, 0))

    def test_positions_begin_in_the_middle_of_a_cell(self):
        body = sphere()
        self.assertEqual(body.x[0], body.spacing / 2)
        self.assertIn("half of the spacing", asp.Profile.x.__doc__)

    def test_a_key_hides_the_method_of_a_dictionary(self):
        found = asp.find("preload", "pressure-sensitive", "F_a/F_a,max = 20 %", profiles=4)
        self.assertEqual(found.values, found.to_dict()["values"])
        self.assertEqual(len(found.values), 4)
        self.assertLessEqual(found.quartiles[0], found.value)
        self.assertEqual(found.target, 0.2)
        for name in ["items", "keys", "pop", "get", "update"]:
            self.assertFalse(hasattr(found, name))

    def test_a_curve_is_given_in_many_ways(self):
        loop = asp.load(sphere(), modulus=1e6, work=WORK, stages="100 µN, separation", samples=40)
        away = np.linspace(-1e-6, 0, 100)
        d = np.r_[away[:-1], loop.indentation, loop.indentation[-1] + away[::-1]]
        force = np.r_[0 * away[:-1], loop.force, 0 * away] + 20e-9 * np.random.default_rng(1).standard_normal(len(d))
        frame = pd.DataFrame({"d": d, "F": force})
        fields = {"form__radius": RADIUS, "modulus": MODULUS, "numerics__points": 256}
        expected = asp.fit((d, force), "jkr-sphere", "work", **fields)
        self.assertAlmostEqual(expected.work.value / WORK, 1, delta=0.05)
        for curve in [[list(d), list(force)], [d, force], np.array([d, force]), np.c_[d, force], frame]:
            found = asp.fit(curve, "jkr-sphere", ["work"], **fields)
            self.assertIs(type(found), asp.Fit)
            self.assertEqual(found.work.value, expected.work.value)
        both = asp.fit([np.array([d, force]), (d, force), frame], "jkr-sphere", ["work"], **fields)
        self.assertEqual((type(both), list(both.curves["work"])), (asp.Fits, 3 * [expected.work.value]))

    def test_files_with_several_curves_and_folders_give_all_their_curves(self):
        loop = asp.load(sphere(), modulus=1e6, work=WORK, stages="100 µN, separation", samples=40)
        away = np.linspace(-1e-6, 0, 100)
        d = np.r_[away[:-1], loop.indentation, loop.indentation[-1] + away[::-1]]
        force = np.r_[0 * away[:-1], loop.force, 0 * away]
        fields = {"form__radius": RADIUS, "modulus": MODULUS, "numerics__points": 256}
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder, "map.txt")
            lines = ["displacement [m],force [N]"]
            for x in range(3):
                noise = 20e-9 * np.random.default_rng(x).standard_normal(len(d))
                lines += [f"# x: {x} um, y: 2 um"] + [f"{a:.9e},{b:.9e}" for a, b in zip(d, force + noise, strict=True)]
            place.write_text("\n".join(lines) + "\n", encoding="utf-8")
            found = asp.fit([place], "jkr-sphere", ["work"], **fields)
            np.testing.assert_allclose(found.curves["position_x"], [0, 1e-6, 2e-6], atol=1e-15)
            self.assertEqual([row.file for row in found.curves], [f"{place}#{number}" for number in (1, 2, 3)])
            second = asp.fit(f"{place}#2", "jkr-sphere", ["work"], **fields)
            self.assertEqual(second.work.value, found.curves[1].work)
            steps = []
            with ThreadPoolExecutor(2) as executor:
                divided = asp.fit(
                    [place, (d, force), place], "jkr-sphere", ["work"], executor=executor, progress=lambda *step: steps.append(step), **fields
                )
            self.assertEqual(steps[-1], (7, 7))
            self.assertEqual(list(divided.curves["work"])[:3], list(found.curves["work"]))
            self.assertEqual(list(divided.curves["work"])[4:], list(found.curves["work"]))
            in_folder = asp.fit([folder], "jkr-sphere", ["work"], **fields)
            self.assertEqual(list(in_folder.curves["work"]), list(found.curves["work"]))
            self.refused(asp.fit, place, "jkr-sphere", ["work"], says="3 curves in one file; allowed: one of them")
            self.refused(asp.fit, f"{place}#4", "jkr-sphere", ["work"], says="no curve 4; allowed: one of them")

    def test_a_fit_of_which_every_curve_fails_is_an_error(self):
        with self.assertRaisesRegex(OSError, "none of 2 curves is fitted; the first one: no1.csv: cannot be read"):
            asp.fit(["no1.csv", "no2.csv"], "jkr-sphere", ["work"])
        self.refused(asp.fit, [([1], [1]), ([2], [2])], "jkr-sphere", ["work"], says="none of 2 curves is fitted; the first one: ")


if __name__ == "__main__":
    unittest.main()
