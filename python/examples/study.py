"""A parameter study into a table of pandas: adhesion over κ and the Hurst exponent, on 8 random profiles of each."""

import asperity as asp

axes = {"adhesion.kappa": [1, 4, 16], "roughness.hurst": [0.2, 0.5, 0.8]}
study = asp.study("pressure-sensitive", axes, record=["adhesion_share", "regime"], profiles=8)
records = study.to_pandas()
medians = records.pivot_table("adhesion_share", "adhesion.kappa", "roughness.hurst", "median")
print("median of F_a/F_a,max over κ (rows) and the Hurst exponent (columns)")
print(medians.round(4).to_string())
assert len(records) == 72 and (medians.loc[1] > medians.loc[16]).all()
