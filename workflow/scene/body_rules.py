"""Rules of bodies: the lower one, the spacing, a punch, materials, the reduction, periodic chains."""

from __future__ import annotations

import math
from fractions import Fraction

from contact1d.digits import apart
from contact1d.workflow.scene.draft import (
    DIGITS,
    ELASTICITY,
    GIVE_SPACING,
    PARTICLES,
    PLANE,
    WHOLE_NUMBER_ERROR,
    Draft,
    Rows,
    Rule,
    limit,
)
from contact1d.workflow.scene.tables import (
    ALIKE,
    SPHERES,
    default_reduction,
    wider_than_body,
)

# fmt: off


def punch(d: Draft) -> Rows:
    """Yield the rules of a flat or capped punch, whose edge is half a spacing beyond its last particle.

    The radius over the spacing is finite; of a flat punch a whole number of halves and at least 1.5, of a capped one a
    whole number and at least 2; a number of particles that is given is twice that. A rule is (dotted key, whether it is
    broken, what is wrong, suggested fix); unbroken ones are yielded, too. No rule for another profile, or where radius
    or spacing is unknown or "auto"; only the first where it is broken.
    """
    radius, spacing = d["bodies.profile.radius"], d["bodies.spacing"]
    if d.profile not in ("flat_punch", "capped_punch") or radius is None or spacing in (None, "auto"):
        return
    step, steps = 1, "1.5 spacings and a whole number of half spacings"
    if d.profile == "capped_punch":  # no particle is at the apex, so that a half and a quarter of the spacing fit, too
        step, steps = 2, "2 spacings and a whole number of spacings"
    width = 2.0 * (radius / spacing)
    yield ("bodies.profile.radius", width == math.inf,
           "is too large compared with the spacing", "make it smaller, or bodies.spacing larger")
    if width == math.inf:
        return
    count = step * max(math.ceil(3 / step), round(width / step))
    between = abs(width - count) > WHOLE_NUMBER_ERROR * count
    yield ("bodies.profile.radius", between,
           f"must be at least {steps}",
           f"the nearest is {0.5 * count * spacing:g} (LU)")
    yield ("bodies.particles", not between and d["bodies.particles"] not in (None, "auto", count),
           f"must be {count}, the radius times 2 over the spacing", f'write {count} or "auto"')


def counter_body(d: Draft) -> Rows:
    """Yield the rules of the curved lower body of a parabola, both of the key `bodies.profile.counter_radius`.

    The radius is positive for a convex body and negative for a concave one: the first rule is broken from −R to 0, R
    the radius of the upper body [LU]. The second one is broken with the reduction "geike_popov", given or by default. A
    rule is (dotted key, whether it is broken, what is wrong, suggested fix); unbroken ones are yielded, too. Nothing is
    yielded where one of the radii is absent or wrong by itself.
    """
    key = "bodies.profile.counter_radius"
    radius, counter = d["bodies.profile.radius"], d[key]
    if None in (radius, counter):
        return
    yield (key, -radius <= counter <= 0.0,
           f"must be greater than 0 (convex), or less than {limit(counter, -radius)} (LU) (concave), else the "
           "bodies conform",
           "a cup is wider than the ball in it; leave it out for a plane")
    chosen = d["bodies.reduction"] or default_reduction("material" in d, d.lower or "", "parabola")
    yield (key, chosen == "geike_popov",
           'not with reduction = "geike_popov", whose bodies are two spheres of the one radius', 'write "mdr"')


def reduction(d: Draft) -> Rows:
    """Yield the rule that excludes the paper's reduction for a body for which it was not derived.

    A rule is (dotted key, whether it is broken, what is wrong, suggested fix). It is broken with "geike_popov" in a
    scene with a material, and yielded in any case but for a parabola, a circle or an unknown profile.
    """
    profile = d["bodies.profile"]
    if profile is None or profile["kind"] in SPHERES:
        return
    off = "half of this body's force at the same displacement" if d.profile in ALIKE else "the contact of another body"
    if (factor := wider_than_body(profile)) is not None:
        radius = f"{factor:.4g} times this body's contact radius under the same force"
        off = f"{radius}, {factor**-2:.4g} of its mean pressure"
    yield ("bodies.reduction", d["bodies.reduction"] == "geike_popov" and "material" in d,
           f"was derived for two equal spheres; with this profile it has {off}",
           'write "mdr", which has force, displacement and radius of any axisymmetric body, or leave it out')


def periodic_lengths(d: Draft) -> Rows:
    """Yield the rules of two periodic chains: the tangential stiffness is at most the normal one, lengths are equal.

    A rule is (dotted key, whether it is broken, what is wrong, suggested fix); unbroken ones are yielded, too. No rule
    for other bodies; none of springs unless both stiffnesses are given; none of lengths where numbers of particles or
    spacings are unknown or automatic, or the upper body has one particle.
    """
    if not d["bodies.periodic"]:
        return
    normal, tangential = d["bodies.bulk_stiffness"], d["bodies.bulk_stiffness_tangential"]
    if normal not in (None, "auto") and tangential is not None:
        yield ("bodies.bulk_stiffness_tangential", tangential > normal,
               f"must be at most bulk_stiffness, {limit(tangential, normal)} (FU/LU), with bodies.periodic",
               "lower it: a larger one needs distant anchors along x, which a periodic body cannot have")
    count, spacing = d["bodies.particles"], d["bodies.spacing"]
    upper, pitch = (
        d[path] if path in d else default  # noqa: SIM401 (a draft is no dict)
        for path, default in (("bodies.upper_particles", count), ("bodies.upper_spacing", spacing))
    )
    if {None, "auto"} & {count, spacing, upper, pitch} or upper == 1:
        return
    longest = 1000  # particles in the period of a pair of chains that is suggested
    ratio = Fraction(pitch / spacing).limit_denominator(longest)
    nearest = f"upper_spacing = {count * spacing / upper:.10g} with these numbers of particles"
    if 0 < ratio.numerator <= longest:
        cells = max(1, round(upper / ratio.denominator))
        nearest += (
            f", or particles = {cells * ratio.numerator} and upper_particles = {cells * ratio.denominator} with "
            f"upper_spacing = {ratio.numerator / ratio.denominator * spacing:.10g}"
        )
    below, above = apart(spacing, pitch, DIGITS)
    yield ("bodies.upper_spacing", abs(count * spacing - upper * pitch) > WHOLE_NUMBER_ERROR * count * spacing,
           f"the periodic chains differ in length: {count} · {below} LU below and {upper} · {above} LU above",
           f"the nearest equal lengths: {nearest}")


OPEN = "bodies.spacing=auto !on_chain"
BODY_RULES: tuple[Rule, ...] = (
    # Where a rigid plane, a rigid chain or particles may be the lower body
    ("interaction", "on_chain",
     "missing, needed by a lower body of particles", f"add [interaction], or use {PLANE}"),
    ("interaction", "plane_contact",
     f"not with {PLANE}, which is touched directly", f"remove it, or use {PARTICLES}"),
    ("horizontal", "plane_contact horizontal",
     "has no effect on a rigid plane, which exerts no tangential force on a particle",
     f"remove it, or use {PARTICLES}"),
    ("bodies.lower", "on_plane motion_is_result",
     "a rigid plane cannot drag the upper body", 'use lower = "particles" and an [interaction]'),
    ("bodies.lower", "on_plane experiment.kind=pull_off !adhesion",
     "a rigid plane cannot hold the upper body",
     'add [adhesion] with work_of_adhesion, or use lower = "particles" and an [interaction]'),
    ("bodies.lower", "on_chain goes_along",
     'must be "rigid_plane" with kind = "tangential", whose friction is Coulomb\'s',
     'between two chains friction comes from the interaction: use kind = "slide"'),
    ("friction", "on_chain !goes_along",
     "not between two chains, whose friction comes from the interaction",
     f'remove it, or use {PLANE} and kind = "tangential"'),
    ("bodies.lower", "on_chain viscoelasticity",
     'must be "rigid_plane" with [viscoelasticity], whose springs are those of both bodies',
     f"use {PLANE}, with the contact modulus of both"),
    ("bodies.lower", "on_chain !viscoelasticity experiment.kind=history|experiment.kind=impact",
     'must be "rigid_plane" with kind = "{kind}", whose springs are those of both bodies',
     f"use {PLANE}, with the contact modulus of both"),
    ("adhesion", "on_chain",
     "not between two chains, which attract each other by the interaction",
     f"use interaction.attraction, or {PLANE}"),
    # A spacing that is left to the program
    ("bodies.spacing", "bodies.spacing=auto on_chain",
     "must be a length (LU) with a lower body of particles, whose forces belong to its particles",
     f'{GIVE_SPACING}; "auto" is for lower = "rigid_plane", where the results converge with the spacing'),
    ("bodies.particles", f"{OPEN} bodies.particles=* !bodies.particles=auto",
     'must be "auto" with spacing = "auto"', f"write it, or {GIVE_SPACING}"),
    ("bodies.bulk_stiffness", f"{OPEN} bodies.bulk_stiffness=* !bodies.bulk_stiffness=auto",
     'must be "auto" with spacing = "auto": the stiffness of a particle is E* times the spacing',
     f"write it, and {ELASTICITY}; or {GIVE_SPACING}"),
    ("bodies.bulk_stiffness_tangential", OPEN,
     'not with spacing = "auto": it is a property of one particle',
     f"remove it: it follows from ν of material.upper and lower; or {GIVE_SPACING}"),
    ("bodies.spacing", f"{OPEN} bodies.profile.kind=flat",
     "must be a length (LU) of a flat body without an edge", f'{GIVE_SPACING}, or use kind = "flat_punch"'),
    ("bodies.spacing", f"{OPEN} needs_spacing",
     "must be a length (LU) with {needs_spacing}: masses, drags and springs between particles belong to one spacing",
     f"{GIVE_SPACING}, or remove {{needs_spacing}}"),
    punch,
    # A body that ends within the contact or beyond it
    ("bodies.lower", "on_chain bodies.profile.kind=capped_punch",
     'must be "rigid_plane" with a capped punch, whose contact may end at its edge or before', f"use {PLANE}"),
    ("bodies.profile.kind", "experiment.kind=impact bodies.profile.kind=capped_punch",
     "not a capped punch in an impact, whose contact radius is not followed up to the edge", "use another profile"),
    ("adhesion.range adhesion.rate neighbours viscoelasticity friction noise", "bodies.profile.kind=capped_punch",
     "not with a capped punch, whose contact edge is that of linear springs or of JKR",
     "remove it, or use another profile"),
    # One elasticity, and units that are either given or follow from F_A and a₀ of the run with γ and E*
    ("bodies.bulk_stiffness", "bodies.bulk_stiffness=auto !elastic",
     "must be given (FU/LU): the scene has no elastic moduli from which it follows",
     f"give a number, or {ELASTICITY}"),
    ("material.contact_modulus", "material.upper|material.lower",
     "not together with upper or lower", "give E*, or E and ν of both bodies"),
    *((f"material.{body}", f"describes_bodies !material.contact_modulus {condition}",
       "missing", "write upper and lower, each with youngs_modulus and poisson_ratio, or contact_modulus")
      for body, condition in (("upper", ""), ("lower", "material.upper"))),
    ("material.upper", "material.upper=rigid material.lower=rigid",
     "one of the two bodies must be elastic", 'give its E and ν, or its name, "steel"'),
    ("material.length_unit material.force_unit", "describes_bodies material.surface_energy",
     "not together with surface_energy, with which both units follow from F_A and a₀ of the run",
     "remove one of the two"),
    ("material.length_unit", "describes_bodies !material.surface_energy",
     "missing", "give one LU in metres, or surface_energy, from which a pull_off finds both units"),
    ("material.force_unit",
     "describes_bodies !material.surface_energy bodies.bulk_stiffness !bodies.bulk_stiffness=auto",
     "not together with a given bulk_stiffness, from which it follows",
     'remove it, or write bodies.bulk_stiffness = "auto"'),
    ("material.force_unit", "describes_bodies !material.surface_energy bodies.bulk_stiffness=auto",
     'missing, needed by bulk_stiffness = "auto"', "give one FU in newtons"),
    ("bodies.bulk_stiffness", "describes_bodies material.surface_energy bodies.bulk_stiffness=auto",
     "must be a number: LU and FU are not known before the run",
     "give the stiffness (FU/LU), or length_unit and force_unit in place of surface_energy"),
    ("material.surface_energy", "describes_bodies kind !finds_pull_off",
     "not in this experiment, which finds no F_A and a₀",
     'use kind = "pull_off", whose results give length_unit and force_unit'),
    ("material.surface_energy", "describes_bodies material.surface_energy experiment.kind=path no_attraction",
     "has no effect without attraction: there is no F_A and no a₀",
     'use length_unit, or lower = "particles" with an interaction.attraction'),
    ("material.surface_energy",
     f"describes_bodies bodies.profile.kind=* {' '.join(f'!bodies.profile.kind={kind}' for kind in SPHERES)}",
     "not with this profile: JKR is for a sphere", "use a parabola or a circle, or length_unit"),
    counter_body,
    reduction,
    # What flat chains without ends need, and which scenes may have them
    ("bodies.profile.kind", "bodies.profile.kind=flat bodies.periodic=false",
     "needs bodies.periodic", 'write periodic = true, or use kind = "flat_punch", which has an edge'),
    ("bodies.periodic", "bodies.periodic=true bodies.profile.kind=* !bodies.profile.kind=flat",
     "not with a body that is not flat: a periodic body has no end",
     'use profile = {{ kind = "flat" }}, or leave periodic out'),
    ("bodies.periodic", "bodies.periodic=true kind !experiment.kind=slide",
     "only in a slide", 'remove it, or use kind = "slide"'),
    ("bodies.particles", "bodies.periodic=true bodies.particles=auto",
     "must be a number with bodies.periodic",
     "give a number: it does not follow from the contact of a periodic body"),
    periodic_lengths,
)
