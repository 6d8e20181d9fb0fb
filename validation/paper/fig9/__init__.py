"""Fig. 9, the set-up of the friction experiment, and what the program makes of it: an outlook, held against theory."""

from validation.paper.fig9.study import STUDY as STUDY
