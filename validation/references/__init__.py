"""References that a run is checked against: closed forms, and an independent solver of the particle model.

All take roots, quadratures and largest values from `numerics`. Solver (energy minimisation, no molecular dynamics):
`interaction` and `model` say what is solved, `energy` and `newton` how, `solver` gives equilibria, `thermal_chain`
those under noise, `pull_off` the adhesion force, `tension_radius` the contact radius, `rigid_plane` one chain on a
plane, `spring_sliders` with friction. Closed forms of the model: `independent_pairs`, `folded_pairs` (pairs that
snap), `boltzmann_pairs` (with noise). Theory: `hertz`, `indenters` (JKR and other shapes), `mindlin`, `axisymmetric`
(any body, with kinks and the adhesion rule of Heß), `mdr` (the same by a slope alone). Under Dugdale's law: `maugis`
(a paraboloid), `force_curves` (its curves as measured), `dugdale` (any body), `dugdale_elements` (in three
dimensions). In time: `relaxing`, `creeping`, `dashpots`, `recovering`, `line_load`, `rings` (in three dimensions),
`impact`, `oblique`, `grains`, `zunker_kamrin`, `receding_edge`. Friction: `slide`, `prandtl_tomlinson`,
`incommensurate`, `flat_chain`, `thermal_friction`, `langevin_ensemble`, `detachment`.
"""
