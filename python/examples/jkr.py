"""The loop of a sphere against the closed form of Johnson, Kendall and Roberts, with more and more springs."""

import numpy as np

import asperity as asp

radius, modulus, work = 1e-4, 1e6, 0.05
pull_off = 1.5 * np.pi * work * radius

print("springs   error of the pull-off force   largest error of the curve F(a)")
errors = []
for points in [256, 1024, 4096, 16384]:
    ball = asp.profile(radius, points, form=asp.sphere(radius))
    loop = asp.load(ball, modulus=modulus, work=work, stages="100 µN, separation")
    # F(a) of the unloading, in which the contact radius a is half of the length in contact.
    a = loop.contact_length[loop.stage == 1] / 2
    exact = 4 / 3 * modulus * a**3 / radius - np.sqrt(8 * np.pi * modulus * work * a**3)
    curve = np.abs(loop.force[loop.stage == 1] - exact)[a > 0].max() / pull_off
    errors.append(abs(loop.pull_off_force / pull_off - 1))
    print(f"{points:7}   {errors[-1]:27.1e}   {curve:31.1e}")
assert errors[-1] < 1e-6
