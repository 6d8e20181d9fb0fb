"""References that a run is checked against: closed forms, and an independent solver of the particle model.

Solver (energy minimisation, no molecular dynamics): `interaction` and `model` say what is solved, `energy` and
`newton` how, `solver` gives equilibria, `thermal_chain` those under noise, `pull_off` the adhesion force,
`tension_radius` the contact radius, `rigid_plane` one chain on a plane. Closed forms of the model: `winkler`,
`independent_pairs`, `folded_pairs` and `pair_lattice` (pairs that snap), `boltzmann_pairs` (with noise),
`line_adhesion`. Theory: `hertz`, `sneddon` (other shapes), `jkr`, `dmt`, `maugis_dugdale` (between the two), `tabor`
(which of them is valid), `mdr` (any profile, with the adhesion rule of Heß). The paper's setup with momentum:
`released_plate`.
"""
