"""Closed forms for comparison with the results: contact with adhesion, other shapes, friction, the map of adhesion.

`indenters` (Hertz, JKR and other shapes), `adhesion` (DMT, Maugis-Dugdale, the map of adhesion), `mindlin`, `relaxing`
(a viscoelastic half-space).
"""
