"""Compares Asperity with the packages of the field, in one run:

    python3 benches/peers.py [WHEEL]

makes a virtual environment in target/peers with the wheel (or the package that pip builds of the sources) and the peers, and prints
the rows of docs/accuracy.md. All times are CPU times of one thread, the smallest of three runs.
"""

import os
import subprocess
import sys
import time
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PEERS = ["tamaas==2.9.*", "ContactMechanics==1.8.*", "Adhesion==0.93", "SurfaceTopography==1.27.*"]
TOLERANCE = 1e-8
SHARES = [0.04, 0.19, 0.37]


def prepare():
    """Makes the environment, and runs this script in it."""
    place = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "peers"
    venv.create(place, with_pip=True, clear=True)
    python = place / "bin" / "python"
    wheel = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "python")
    subprocess.run([python, "-m", "pip", "install", "--quiet", wheel, *PEERS], check=True)
    one_thread = dict.fromkeys(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"], "1")
    environment = {**os.environ, **one_thread, "IN_PEERS": "1", "PATH": f"{place / 'bin'}:{os.environ['PATH']}"}
    sys.exit(subprocess.run([python, __file__], env=environment).returncode)


def cpu_time(work, runs=3):
    """Smallest CPU time of several runs in s, and the result of the last."""
    times = []
    for _ in range(runs):
        start = time.process_time()
        result = work()
        times.append(time.process_time() - start)
    return min(times), result


def random_map(np, cells, hurst):
    """Isotropic self-affine heights of waves from 1 to a quarter of the cells along a side of 1, with an rms height of 0.01."""
    wave = np.fft.fftfreq(cells, 1 / cells)
    number = np.hypot(*np.meshgrid(wave, wave))
    amplitude = np.where((number >= 1) & (number <= cells / 8), np.maximum(number, 1) ** (-1 - hurst), 0)
    heights = np.fft.ifft2(amplitude * np.exp(2j * np.pi * np.random.default_rng(1).random((cells, cells)))).real
    return 0.01 * heights / heights.std()


def residual(np, heights, pressure):
    """Largest violation of the conditions of contact, over the rms height, for an effective modulus of 1 and a side of 1."""
    cells = len(heights)
    wave = 2 * np.pi * np.fft.fftfreq(cells, 1 / cells)
    number = np.hypot(*np.meshgrid(wave, wave))
    number[0, 0] = np.inf
    gap = np.fft.ifft2(2 / number * np.fft.fft2(pressure)).real - heights
    in_contact = pressure > 0
    gap -= gap[in_contact].mean()
    return max(np.abs(gap[in_contact]).max(), -gap[~in_contact].min(initial=0)) / heights.std()


def pressed(np, cells):
    """Rows: a periodic map pressed without adhesion, by three solvers, to the same residual."""
    import asperity as asp
    import tamaas
    from ContactMechanics import PeriodicFFTElasticHalfSpace
    from ContactMechanics.Systems import NonSmoothContactSystem
    from SurfaceTopography import Topography

    tamaas.set_log_level(tamaas.LogLevel.error)
    heights = random_map(np, cells, 0.8)

    def by_asperity(force):
        return asp.press(heights, side=1, modulus=1, force=force, periodic=True, residual=TOLERANCE).pressure

    def by_contact_mechanics(force):
        substrate = PeriodicFFTElasticHalfSpace((cells, cells), 1.0, (1.0, 1.0))
        system = NonSmoothContactSystem(substrate, Topography(heights, (1.0, 1.0), periodic=True))
        system.minimize_proxy(external_force=force, pentol=TOLERANCE * heights.std(), maxiter=10000)
        found = np.asarray(substrate.force) * cells**2
        return found * np.sign(found.sum())

    def by_tamaas(force):
        model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [cells, cells])
        model.E, model.nu = 1.0, 0.0
        solver = tamaas.PolonskyKeerRey(model, heights, TOLERANCE)
        solver.max_iter = 10000
        solver.solve(force)
        return np.array(model.traction)

    solvers = [("Asperity", by_asperity), ("ContactMechanics", by_contact_mechanics), ("tamaas", by_tamaas)]
    # Forces at which these shares of the cells are in contact.
    slope = np.sqrt((np.gradient(heights, 1 / cells, axis=0) ** 2 + np.gradient(heights, 1 / cells, axis=1) ** 2).mean())
    for share in SHARES:
        force = share / 2 * slope * (1 + share)
        cells_in_row, reference = [], None
        for name, solver in solvers:
            seconds, pressure = cpu_time(lambda: solver(force))
            pressure = pressure.reshape(cells, cells)
            reference = pressure if reference is None else reference
            difference = np.abs(pressure - reference).max() / reference.max()
            cells_in_row.append(f"{1e3 * seconds:.0f} ({residual(np, heights, pressure):.0e})")
            assert difference < 1e-3, f"{name}: another pressure"
        yield f"| {cells}² | {100 * (reference > 0).mean():.0f} % | " + " | ".join(cells_in_row) + " |"


def pulled_off(np):
    """Rows: the pull-off of a sphere, exact in the theory of Johnson, Kendall and Roberts, by two models."""
    import asperity as asp
    from Adhesion.Interactions import Exponential
    from Adhesion.System import BoundedSmoothContactSystem
    from ContactMechanics import FreeFFTElasticHalfSpace
    from SurfaceTopography import make_sphere

    radius, modulus, work, cells, side, tabor = 1.0, 1.0, 0.01, 64, 1.2, 3.0
    exact = 1.5 * np.pi * work * radius

    def by_asperity():
        ball = asp.profile(side, 4096, form=asp.sphere(radius))
        loop = asp.load(ball, modulus=modulus, work=work, stages=["50 mm", "separation"])
        return loop.pull_off_force

    def by_adhesion():
        attraction = (radius * work**2 / (modulus**2 * tabor**3)) ** (1 / 3)
        substrate = FreeFFTElasticHalfSpace((cells, cells), modulus, (side, side))
        interaction = Exponential(work, attraction)
        system = BoundedSmoothContactSystem(substrate, interaction, make_sphere(radius, (cells, cells), (side, side)))
        forces, displacements = [], None
        for offset in np.linspace(0.05, -0.08, 14):
            found = system.minimize_proxy(
                offset=offset, initial_displacements=displacements, options={"gtol": 1e-6, "ftol": 0, "maxiter": 1000}
            )
            displacements = found.x
            forces.append(system.compute_normal_force())
        return -min(forces)

    for name, work_of in [
        ("Asperity, 4 096 springs, whole loop", by_asperity),
        (f"Adhesion, {cells}² cells, 14 steps, range of attraction by μ = 3", by_adhesion),
    ]:
        seconds, force = cpu_time(work_of, runs=1 if work_of is by_adhesion else 3)
        yield f"| {name} | {1e3 * seconds:.1f} | {100 * (force / exact - 1):+.3f} % |"


def main():
    from importlib.metadata import version

    import numpy as np

    packages = ["asperity", *(peer.split("==")[0] for peer in PEERS)]
    print("Versions: " + ", ".join(f"{name} {version(name)}" for name in packages), time.strftime("(%B %Y)"))
    print("\n| map | contact | Asperity | ContactMechanics | tamaas |\n| --- | --- | --- | --- | --- |")
    for cells in [256, 512]:
        for row in pressed(np, cells):
            print(row, flush=True)
    print("\n| pull-off of a sphere | CPU, ms | against the exact force |\n| --- | --- | --- |")
    for row in pulled_off(np):
        print(row, flush=True)
    program = Path(sys.executable).with_name("asperity")
    print("\nMeasured maps against SurfaceTopography:", flush=True)
    subprocess.run([sys.executable, ROOT / "tests" / "surface_topography.py", program], check=True)


if __name__ == "__main__":
    main() if "IN_PEERS" in os.environ else prepare()
