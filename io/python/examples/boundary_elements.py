# %% [markdown]
# Heat conduction in an elliptic bar by boundary elements, beside its exact solution x^2 - y^2.

# %%
import numpy as np

import isorim

# %% The case, as in a case file
case = {
    "title": "Elliptic bar",
    "geometry": {"type": "ellipse", "radii": [2.0, 1.0]},
    "analysis": {"equation": "laplace"},
    "boundary_condition": [{"kind": "value", "value": "x^2 - y^2"}],
    "discretisation": {"degree": 4, "refine": 3},
    "probe": [{"name": "axis", "from": [-1.5, 0.0], "to": [1.5, 0.0], "count": 7}],
}
bar = isorim.load(case)
results = bar.run()

# %% Probes are arrays
probe = results["analysis"]["probes"]["axis"]
error = np.abs(np.ravel(probe["value"]) - probe["points"][:, 0] ** 2).max()
print("unknowns", results["analysis"]["unknowns"], "largest error at the probe", error)
assert error < 1e-5

# %% Any other points later
points = np.random.default_rng(1).uniform([-1.0, -0.5], [1.0, 0.5], size=(20, 2))
found = bar.evaluate(points)
assert (found.location == 1).all()
assert np.abs(found.value[:, 0] - points[:, 0] ** 2 + points[:, 1] ** 2).max() < 1e-5
