"""The one unit system: length LU, force FU, mass MU, time TU = √(MU·LU/FU), temperature as energy k_BT in FU·LU."""

LENGTH = "LU"
FORCE = "FU"
MEAN_PRESSURE = "FU/LU²"
