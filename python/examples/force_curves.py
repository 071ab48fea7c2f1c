"""The work of adhesion from a folder of force curves. The curves are computed here, with noise, and written as files."""

from pathlib import Path

import numpy as np

import asperity as asp

radius, modulus, work = "7.5 µm", "1 MPa", 0.05
ball = {"form": asp.sphere(radius), "length": "24 µm", "numerics__points": 1024, "material": {"modulus": 1e6}}
folder, noise = Path("curves"), np.random.default_rng(1)
folder.mkdir(exist_ok=True)
body = asp.profile("24 µm", 4096, form=asp.sphere(radius))
for number in range(6):
    loop = asp.load(body, modulus=modulus, work=work, stages="2 µN, separation", samples=200)
    d = np.r_[np.linspace(-200e-9, -1e-9, 100), loop.indentation, np.linspace(0, -200e-9, 100) + loop.indentation[-1]]
    force = np.r_[np.zeros(100), loop.force, np.zeros(100)] + 2e-9 * noise.standard_normal(len(loop) + 200)
    shift = 1e-7 * noise.random()
    table = np.c_[d + shift, force]
    np.savetxt(folder / f"{number}.csv", table, delimiter=",", header="displacement (m),force (N)", comments="")

fits = asp.fit(sorted(folder.glob("*.csv")), "jkr-sphere", ["work", "offset"], **ball)
table = fits.to_pandas()
print(table[["file", "work", "work_low", "work_high", "described"]].to_string(index=False))
print(f"median {fits.described.median * 1e3:.2f} mJ/m²")
assert table.described.all() and abs(fits.described.median / work - 1) < 0.01
