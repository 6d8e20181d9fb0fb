"""References that a run is checked against: closed forms, and an independent solver of the particle model.

Solver (energy minimisation, no molecular dynamics): `interaction` and `model` say what is solved, `energy` and
`newton` how, `solver` gives equilibria, `pull_off` the adhesion force, `tension_radius` the contact radius,
`rigid_plane` one chain on a plane. Closed forms: `hertz`, `jkr`, `winkler`, `line_adhesion`, `independent_pairs`.
"""
