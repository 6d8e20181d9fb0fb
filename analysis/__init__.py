"""Arrays in, results out: pressure, radii, friction, and the references that a run is checked against."""
