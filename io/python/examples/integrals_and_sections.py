# %% [markdown]
# Volumes, integrals, sections and fits from Python, each beside its exact value.

# %%
import math

import numpy as np

import isorim

# %% A torus by the keys of case files
torus = isorim.load({"type": "torus", "major_radius": 2.0, "minor_radius": 0.5})
found = torus.properties(density=7850.0)
print("volume", found["volume"].value, "+-", found["volume"].error, "exact", math.pi**2)
assert abs(found["volume"].value - math.pi**2) < 1e-11

# %% Integrals of functions of numpy arrays, and of expressions
by_callable = torus.integrate(lambda x: np.hypot(x[:, 0], x[:, 1]) ** 2)
by_text = torus.integrate("x^2 + y^2")
exact = math.pi**2 * (4.0 + 0.75 * 0.25)
print("second moment", by_callable.value, by_text.value, "exact", exact)
assert abs(by_callable.value - exact) < 1e-10
assert abs(by_text.value - exact) < 1e-10

# %% Plane sections: two rings at every height
for section in torus.sections([0, 0, 1], np.linspace(-0.4, 0.4, 5)):
    half = math.sqrt(0.25 - section["offset"] ** 2)
    ring = math.pi * ((2 + half) ** 2 - (2 - half) ** 2)
    print("z =", section["offset"], "area", section["area"], "exact", ring, "loops", len(section["loops"]))
    assert abs(section["area"] - ring) < 1e-10

# %% A region bounded by a curve through points
angle = np.linspace(0.0, 2.0 * math.pi, 120, endpoint=False)
radius = 1.0 + 0.2 * np.cos(3.0 * angle)
fitted = isorim.fit(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), tolerance=1e-4)
leaf = isorim.load({"type": "region", "loops": [fitted.curve]})
print("area", leaf.properties()["area"].value, "exact", 1.02 * math.pi)
assert abs(leaf.properties()["area"].value - 1.02 * math.pi) < 1e-3
