"""Tests of one hundred wrong calls: each raises an exception of the package, in the words of Python."""

import os
import tempfile
import unittest
import warnings

import numpy as np

import asperity as asp

SCENE = "pressure-sensitive"


class WrongCalls(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ball = asp.profile("100 µm", 512, form=asp.sphere("100 µm"))
        cls.loop = asp.load(cls.ball, modulus=1e6, work=0.05, stages="100 µN, separation")
        cls.outcome = asp.run("jkr-sphere", numerics__points=256)

    def calls(self):
        """Returns wrong calls, each with the field that the exception names, or with the name of the exception."""
        z = 1e-9 * np.random.default_rng(1).standard_normal((32, 32))
        d = np.linspace(0, 1e-6, 50)
        F = 0 * d
        return [
            ("modulus", lambda: asp.load(self.ball, modulus="1 mm")),
            ("modulus", lambda: asp.load(self.ball, modulus=-1)),
            ("work", lambda: asp.load(self.ball, modulus=1e6, work="50 mN")),
            ("stages", lambda: asp.load(self.ball, modulus=1e6, stages="10")),
            ("stages", lambda: asp.load(self.ball, modulus=1e6, stages=["up"])),
            ("stages", lambda: asp.load(self.ball, modulus=1e6, stages=[None])),
            ("closing_work", lambda: asp.load(self.ball, modulus=1e6, work=0.05, closing_work=0.1)),
            ("samples", lambda: asp.load(self.ball, modulus=1e6, samples="many")),
            ("edges", lambda: asp.load(self.ball, modulus=1e6, edges="grid2")),
            ("loading_stiffness", lambda: asp.load(self.ball, modulus=1e6, loading_stiffness=-5)),
            ("modulus", lambda: asp.load(self.ball, modulus=complex(1, 2))),
            ("modulus", lambda: asp.load(self.ball, modulus=np.array([1e6, 2e6]))),
            ("profile", lambda: asp.load("ball", modulus=1e6)),
            ("points", lambda: asp.profile("100 µm", points=1.5)),
            ("form", lambda: asp.profile("100 µm", form="sphere")),
            ("roughness", lambda: asp.profile("100 µm", roughness="rough")),
            ("form", lambda: asp.profile("100 µm", form=asp.sphere)),
            ("roughness", lambda: asp.profile("100 µm", roughness=asp.self_affine(0.7))),
            (
                "roughness.modes",
                lambda: asp.profile("100 µm", 64, roughness=asp.self_affine(0.7, rms_height="1 nm", modes=(1, 64))),
            ),
            ("length", lambda: asp.profile(-1)),
            ("length", lambda: asp.profile(None)),
            ("roughness", lambda: asp.profile("100 µm", roughness=z)),
            ("roughness", lambda: asp.profile("100 µm", roughness=(z,))),
            ("hurst", lambda: asp.self_affine("rough")),
            (
                "roughness",
                lambda: (
                    asp.self_affine(0.7, rms_height="1 nm", rms_gradient=0.1, modes=(1, 4))
                    and asp.profile(1e-4, roughness=asp.self_affine(0.7, rms_height="1 nm", rms_gradient=0.1, modes=(1, 4)))
                ),
            ),
            ("radius", lambda: asp.sphere("big")),
            ("radius", lambda: asp.sphere([1])),
            ("scene", lambda: asp.run("no-such-scene")),
            ("OSError", lambda: asp.run("no.ron")),
            ("profiles", lambda: asp.run(SCENE, profiles=-3)),
            ("profiles", lambda: asp.run(SCENE, profiles="many")),
            ("jobs", lambda: asp.run(SCENE, jobs=0)),
            ("hurst", lambda: asp.run(SCENE, hurst=0.5)),
            ("roughness.hurst", lambda: asp.run(SCENE, roughness__hurst="a")),
            ("roughness.hurst", lambda: asp.run(SCENE, roughness__hurst=[1, 2])),
            ("profiles", lambda: asp.run("jkr-sphere", profiles=20)),
            ("modulus", lambda: asp.run(SCENE, modulus={})),
            ("executor", lambda: asp.ensemble(SCENE, executor=3)),
            ("quantity", lambda: asp.ensemble(SCENE, profiles=3).values("typo")),
            ("field", lambda: asp.find("typo", SCENE, "F_a = 1 µN")),
            ("where", lambda: asp.find("preload", SCENE, "F_a > 1 µN")),
            ("where", lambda: asp.find("preload", SCENE, "F_a = 1 µm")),
            ("range", lambda: asp.find("preload", SCENE, "F_a = 1 µN", range=(1,))),
            ("range", lambda: asp.find("preload", SCENE, "F_a = 1 µN", range=("1 µm", "2 µm"))),
            ("between", lambda: asp.preloads(SCENE, ("1 µN",))),
            ("between", lambda: asp.preloads(SCENE, ("5 µN", "1 µN"))),
            ("between", lambda: asp.preloads(SCENE, (0, "1 µN"), log=True)),
            ("count", lambda: asp.reversals(SCENE, count=1)),
            ("grid", lambda: asp.reference(SCENE, grid=33)),
            ("surfaces", lambda: asp.reference("jkr-sphere", surfaces="x")),
            ("axes", lambda: asp.study(SCENE, {"adhesion.kapa": [1]})),
            ("adhesion.kappa", lambda: asp.study(SCENE, {"adhesion.kappa": ["x"]})),
            ("record", lambda: asp.study(SCENE, {"adhesion.kappa": [1]}, record="typo")),
            ("axes", lambda: asp.study(SCENE, [("adhesion.kappa", [1])])),
            ("record", lambda: asp.study(SCENE, {"adhesion.kappa": [1]}, record=5)),
            ("OSError", lambda: asp.surface("no.txt")),
            ("spacing", lambda: asp.surface(z)),
            ("spacing", lambda: asp.surface(z, spacing=0)),
            ("heights", lambda: asp.surface(z * 0, spacing=1e-6)),
            ("heights", lambda: asp.surface(z[:2, :2], spacing=1e-6)),
            ("modulus", lambda: asp.surface(z, spacing=1e-6, modulus="soft")),
            ("heights", lambda: asp.surface(None, spacing=1)),
            ("heights", lambda: asp.surface([], spacing=1)),
            ("free", lambda: asp.fit((d, F), "jkr-sphere", ["typo"])),
            ("free", lambda: asp.fit((d, F), "jkr-sphere", [])),
            ("curves", lambda: asp.fit((d, F), "jkr-sphere", ["work"])),
            ("curves", lambda: asp.fit((d, F[:3]), "jkr-sphere", ["work"])),
            ("work", lambda: asp.fit((d, F), "jkr-sphere", {"work": (1,)})),
            ("free", lambda: asp.fit((d, F), "jkr-sphere", {"work": ("1 N", "2 N")})),
            ("curves", lambda: asp.fit((d, F), SCENE, ["radius"])),
            ("OSError", lambda: asp.fit("no.csv", "jkr-sphere", "work")),
            ("curves", lambda: asp.fit(None, "jkr-sphere", "work")),
            ("options", lambda: asp.fit((d, F), "jkr-sphere", "work", options={"nois": 1})),
            ("profiles", lambda: asp.fit((d, F), "jkr-sphere", "work", profiles=0)),
            ("force", lambda: asp.press(z, side=1e-6, modulus=1e6, force="1 Pa")),
            ("force", lambda: asp.press(z, side=1e-6, modulus=1e6, force=-1)),
            ("heights", lambda: asp.press(z[:31], side=1e-6, modulus=1e6, force=1)),
            ("heights", lambda: asp.Profile([1, 2, "a"], 1)),
            ("heights", lambda: asp.Profile([[1, 2]], 1)),
            ("path", lambda: self.loop.save("loop.xyz")),
            ("path", lambda: self.loop.save(5)),
            ("path", lambda: self.outcome.save("run.xyz")),
            ("OSError", lambda: self.outcome.save("nodir/run.svg")),
            ("axes", lambda: asp.study(SCENE, {"adhesion.kappa": []})),
            ("OSError", lambda: asp.measured("no.txt") and asp.profile(1e-4, roughness=asp.measured("no.txt"))),
            ("OSError", lambda: asp.table("no.csv") and asp.profile(1e-4, form=asp.table("no.csv"))),
            ("scene", lambda: asp.scene("(version: 1")),
            ("scene", lambda: asp.scene(5)),
            ("adhesion", lambda: asp.scene("jkr-sphere", form=None, adhesion=3)),
            ("work", lambda: asp.criteria("jkr-sphere", work=[1, 2])),
            ("LoadingError", lambda: asp.load(self.ball, modulus=1e6, work=0.05, stages="10 µN, -1 N")),
            ("progress", lambda: asp.run(SCENE, progress=3)),
            ("length", lambda: asp.surface(z, spacing=1e-6).profile("1 N")),
            ("modulus", lambda: asp.surface(z, spacing=1e-6).scene(modulus=None)),
            ("modulus", lambda: asp.run(self.ball)),
            ("modulus", lambda: asp.load(self.ball, modulus=10**400)),
            ("form", lambda: asp.profile(1e-3, form=asp.revolve([0, 1e-6], [0, 1e-7]))),
            ("profiles", lambda: asp.fit((d, F), "jkr-sphere", "work", profiles=4)),
            ("numerics.solver", lambda: asp.run(SCENE, numerics__solver="Stepwise")),
            ("scene", lambda: asp.ensemble("docs")),
        ]

    def test_each_call_is_refused_by_its_field(self):
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            here = os.getcwd()
            os.chdir(folder)
            try:
                for number, (expected, call) in enumerate(self.calls()):
                    with self.subTest(number=number, expected=expected):
                        with self.assertRaises((asp.FieldError, asp.LoadingError, OSError)) as raised:
                            call()
                        error = raised.exception
                        self.assertNotRegex(str(error), "--[a-z]")
                        if isinstance(error, asp.FieldError):
                            self.assertEqual(error.field, expected)
                            self.assertTrue(error.allowed, str(error))
                        else:
                            self.assertTrue(
                                type(error).__name__ == expected or expected == "OSError" and isinstance(error, OSError)
                            )
            finally:
                os.chdir(here)


if __name__ == "__main__":
    unittest.main()
