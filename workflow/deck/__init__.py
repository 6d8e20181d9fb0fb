"""A scene as LAMMPS text: bodies, effects, schedule; pure, nothing runs here."""
