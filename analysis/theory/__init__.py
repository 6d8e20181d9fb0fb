"""Closed forms that users see beside the results: contact with adhesion, other shapes, friction, and Tabor's map.

`sneddon` (Hertz and other shapes), `winkler` (one layer of springs), `jkr`, `dmt`, `maugis_dugdale` (between the two),
`tabor` (which of them is valid), `adhesive_power`, `line_adhesion`, `mindlin`.
"""
