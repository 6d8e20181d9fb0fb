# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # From Hertz through adhesion to a sweep
#
# This page is a notebook: it was run when the page was built, and what stands under the cells is what came out.
# A scene is a TOML text, or a file of it; `contact1d.run` turns it into a LAMMPS deck, runs it and hands back the results.

# %%
import tempfile
from pathlib import Path

import contact1d

folder = Path(tempfile.mkdtemp())

# %% [markdown]
# ## A steel ball on glass
#
# One chain on a rigid plane: the exact reduction of an axisymmetric contact. Quantities carry their units; what the scene leaves open
# (the number of particles, the springs, the displacement's steps) is chosen by the program from the tolerance.

# %%
steel = contact1d.read_scene("""
title = "A steel ball on glass"

[bodies]
particles = "auto"
spacing = "2 um"
profile = { kind = "parabola", radius = "10 mm" }
lower = "rigid_plane"

[material]
upper = { youngs_modulus = "210 GPa", poisson_ratio = 0.3 }
lower = { youngs_modulus = "70 GPa", poisson_ratio = 0.22 }

[experiment]
kind = "load"
force = "10 N"
""")
hertz = contact1d.run(steel, folder / "hertz", figures=False)
hertz

# %% [markdown]
# Hertz says a = (3FR/4E\*)^(1/3):

# %%
modulus = 1 / ((1 - 0.3**2) / 210e9 + (1 - 0.22**2) / 70e9)
radius = (3 * 10 * 0.01 / (4 * modulus)) ** (1 / 3)
found = hertz.results.contact_radius.si.value
print(f"Hertz {radius * 1e6:.3f} µm, the run {found * 1e6:.3f} µm")
assert abs(found / radius - 1) < 1e-3

# %%
hertz.plot("pressure")

# %% [markdown]
# ## Adhesion: two chains that attract each other
#
# In the paper's model particles of opposite bodies attract and repel each other; neighbours are tied by springs. `pull_off` presses the
# bodies together, draws them apart and finds the largest tension that they hold.

# %%
paper = contact1d.read_scene("""
title = "Pull-off, R = 1000"

[bodies]
particles = "auto"
spacing = 1.0
profile = { kind = "parabola", radius = 1000.0 }
reduction = "geike_popov"
bulk_stiffness = 0.83

[interaction]
repulsion  = { amplitude = 0.18, range = 0.13 }
attraction = { amplitude = 0.09, range = 0.26 }

[neighbours]
stiffness = 0.3

[experiment]
kind = "pull_off"
preload = 1.0
""")
pull_off = contact1d.run(paper, folder / "pull_off", figures=False)
pull_off

# %%
pull_off.plot()

# %% [markdown]
# The curve is there as numpy arrays, and so are the profiles of pressure:

# %%
curve = pull_off.curve
row = curve.force.argmin()
print(f"{-curve.force[row]:.4f} FU at d = {curve.displacement[row]:.4f} LU")
list(pull_off.profiles)

# %% [markdown]
# ## A sweep
#
# How does the pull-off force grow with the radius? The paper says as √R (Eq. 7). A sweep runs every point and writes one table.

# %%
sweep = contact1d.sweep(
    {
        "title": "Pull-off force over radius",
        "base": paper.model_dump(by_alias=True, exclude_none=True),
        "axes": [
            {
                "key": "bodies.profile.radius",
                "from": 500.0,
                "to": 4000.0,
                "steps": 3,
                "scale": "log",
            }
        ],
    },
    folder / "sweep",
)
sweep.counts

# %%
import csv
import math

with (sweep.folder / "results.csv").open() as file:
    rows = list(csv.DictReader(file))
radii = [float(row["bodies.profile.radius"]) for row in rows]
forces = [float(row["adhesion_force"]) for row in rows]
growth, wider = forces[-1] / forces[0], radii[-1] / radii[0]
exponent = math.log(growth) / math.log(wider)
print(f"F_A grows as R^{exponent:.3f}")
assert abs(exponent - 0.5) < 0.01

# %% [markdown]
# `contact1d report` makes a page of a run or of a sweep that you can send to a colleague; `contact1d animate` a moving picture.
