"""Tools of a maintainer: the calibration of the settings, faults and mutants that the tests must notice."""
