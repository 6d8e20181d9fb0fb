"""Hard cases of which each has a bound from theory or an independent solver: no wrong number may pass in silence."""
