"""References that a run is checked against: closed forms, and an independent solver of the particle model.

Solver (energy minimisation, no molecular dynamics): `interaction` and `model` say what is solved, `energy` and
`newton` how, `solver` gives equilibria, `thermal_chain` those under noise, `pull_off` the adhesion force,
`tension_radius` the contact radius, `rigid_plane` one chain on a plane, `spring_sliders` with friction. Closed forms
of the model: `independent_pairs`, `folded_pairs` (pairs that snap), `boltzmann_pairs` (with noise). Theory: `hertz`,
`indenters` (JKR and other shapes), `mindlin`, `mdr` (any profile, with the adhesion rule of Heß), `axisymmetric` (with
kinks). Under Dugdale's law: `maugis` (a paraboloid), `dugdale` (any body), `dugdale_elements` (in three dimensions).
Motion: `grains` (impact), `slide`, `prandtl_tomlinson`, `thermal_friction`, `detachment`, `langevin_ensemble`.
"""
