"""The same Hertz and the same JKR contact with other people's solvers, with this model and with closed forms."""
