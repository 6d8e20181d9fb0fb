"""LAMMPS's granular contact models beside exact answers: `python -m validation grains`."""

from validation.grains.studies import STUDIES as STUDIES
