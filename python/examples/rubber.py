"""Adhesion of rough rubber over the preload: median and quartiles of 16 random profiles."""

import asperity as asp

found = asp.preloads("pressure-sensitive", ("0 N", "20 µN"), count=11, profiles=16)
by_preload = found.to_pandas().groupby("preload").pull_off_force
table = by_preload.quantile([0.25, 0.5, 0.75]).unstack() * 1e6
print("pull-off force in µN by quartiles, over the preload in µN")
print(table.rename(index=lambda preload: round(1e6 * preload, 1)).round(2).to_string())
found.save("rubber.svg")
assert table[0.5].is_monotonic_increasing, "a larger preload brings more of the rubber into contact"
