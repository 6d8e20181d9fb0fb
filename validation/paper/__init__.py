"""The paper's statements, in its order."""

from validation.paper import (
    adhesive,
    detachment,
    fig4,
    fig6,
    fig7,
    fig8,
    fig9,
    heat,
    jkr_plane,
    pressure,
    section2,
    table1,
    tangential,
)
from validation.study import Study

STUDIES: tuple[Study, ...] = (
    section2.STUDY_EQ3, fig4.STUDY, fig4.NEIGHBOURS_STUDY, fig4.FIG5, fig6.STUDY, fig7.FIG7, fig7.EXPONENTS, fig8.FIG8A,
    fig8.FIG8B, fig8.JKR_OR_BARQUINS, table1.TABLE1, pressure.MEAN_PRESSURE_STUDY, adhesive.STUDY, jkr_plane.STUDY,
    tangential.STUDY, heat.STUDY, detachment.STUDY, fig9.STUDY,
)  # fmt: skip
