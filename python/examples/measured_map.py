"""From a measured map to the adhesion that it predicts, with the spread over profiles. The map is made here and written as a file."""

import numpy as np

import asperity as asp

# An isotropic self-affine map of 20 µm × 20 µm with a Hurst exponent of 0.8 and an rms height of 20 nm.
points, length = 256, 20e-6
wave = np.fft.fftfreq(points, 1 / points)
number = np.hypot(*np.meshgrid(wave, wave))
amplitude = np.where((number >= 1) & (number <= points / 4), np.maximum(number, 4) ** -1.8, 0)
phases = np.random.default_rng(1).random((points, points))
heights = np.fft.ifft2(amplitude * np.exp(2j * np.pi * phases)).real
np.save("map.npy", 20e-9 * heights / heights.std())

surface = asp.surface("map.npy", unit="m", spacing=length / points, periodic=True)
height = surface.equivalent_line.rms_height
print(f"rms height {height.value * 1e9:.1f} nm ± {height.error * 1e9:.1f} nm")
assert abs(height.value / 20e-9 - 1) < 0.05
for work in [0.01, 0.03, 0.1]:
    scene = surface.scene(modulus="10 MPa", work=work, loading="20 µN, separation")
    predicted = asp.ensemble(scene, profiles=16)
    low, high = predicted.quartiles
    print(f"work {work * 1e3:5.0f} mJ/m²: F_a {predicted.median * 1e6:8.3f} µN, quartiles {low * 1e6:.3f} to {high * 1e6:.3f} µN")
