"""What a record says as Markdown: the text of VALIDATION.md, and the short table of the README."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

from contact1d.workflow.pages.parts import paragraphs
from validation.judging.check import WIDE, Check
from validation.judging.markdown import prose, table
from validation.judging.words import judged, limits, ours, outcome, passed, reference, share, tolerance
from validation.paper.page import EVIDENCE, failures
from validation.paper.record import Record, StudyRecord

HEAD = """# Validation

Written by `contact1d reproduce`, which makes every quantitative statement of Geike and Popov, *Reduction of
three-dimensional contact problems to one-dimensional ones*, Tribology International 40 (2007), anew and judges each
by a rule that stands in its row. The same numbers with figures are in `reproduce.html`, and for programs in
`reproduce.json`. Nobody edits this file by hand; a row that fails stays in it.

PASS: the two agree. FAIL: they don't, or a run that the row rests on has a warning that the row does not answer.
DIFFERS: they are known to differ, a limit of the model; if they came to agree, that row would fail. A row that repeats
another, or that is true by construction, says so and is counted apart."""

READING = """Ours is value ± uncertainty, the uncertainty being the run's own estimate. LU and FU are the model's
units of length and force. A tolerance is relative to the reference unless it has a unit."""

NOT_VALIDATED = """## Not validated

Nothing above speaks for the following, and no number of this program should be trusted there without a check of its
own.

- **Random self-affine roughness.** The one-dimensional mapping is known to fail here even qualitatively (Lyashenko,
  Pastewka and Persson, *Tribology Letters* 52, 2013), so a run that agrees with the model says nothing about the
  surface.
- **Roughness of any kind within one contact.** All checks have one smooth profile; what a chain makes of several
  summits that share an elastic half-space has not been compared with anything.
- **Friction of a real pair of bodies.** The tangential contact on the rigid plane is held against Cattaneo and Mindlin,
  and what particles that slide on each other make of friction against the theories of such particles (`fig9`); no
  friction force that anybody measured has been compared with it.
- **Absolute time scales of dynamic runs.** Masses are free numbers, and the damping is chosen so that a run settles
  soon; the states of rest that it reaches are checked, how long it takes only against the model's own motion.
- **Heat in physical time.** Friction and detachment under heat are held against Smoluchowski's equation above, at
  velocities and loading rates in the model's own time; which laboratory rate one of them stands for the point above
  leaves open.
- **Units of time and mass in SI.** Two macroscopic numbers, work of adhesion and elastic modulus, fix the units of
  length and force only; a third, such as a density or a relaxation time, is not part of the identification.
- **Rate-dependent adhesion.** Bulk and interaction are elastic, and the drag is there to reach equilibrium, so
  whatever depends on the pulling speed belongs to the model and to no material.
- **Two bodies of different bulk stiffness.** Both bodies get the same springs and only the combined modulus is
  identified; how it would have to be shared between unlike bodies has not been looked at.
"""


def validation_markdown(record: Record, *more: str) -> str:
    """Return the text of VALIDATION.md: how it was made, every row, `more` sections, and what is not validated."""
    parts = [HEAD, _made(record), _outcome(record), _evidence(record.checks), "## Results", READING]
    for study in record.studies:
        parts += _study(study)
    return "\n\n".join([*parts, *(section.rstrip() for section in more), NOT_VALIDATED])


def readme_table(record: Record) -> str:
    """Return one row for each study: its name, what was asked, the result in words, PASS or FAIL."""
    rows = [(f"`{study.name}`", study.title, _result(study), _verdict(study.checks)) for study in record.studies]
    return table(("study", "asked", "result", "verdict"), rows)


def _made(record: Record) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in record.versions.items())
    runs = sum(study.runs for study in record.studies)
    return f"To make it again: `contact1d reproduce`. This text is from {runs} runs with {versions}."


def _outcome(record: Record) -> str:
    head = f"**{outcome(record.checks)}.**"
    if failed := failures(record):
        rows = [
            (f"`{f.study.name}`", f.check.name, ours(f.check), reference(f.check), tolerance(f.check)) for f in failed
        ]
        head += f" These fail:\n\n{table(('study', 'checked', 'ours', 'reference', 'tolerance'), rows).rstrip()}"
    return f"{head}\n\n{_wide(judged(record.checks))}"


def _wide(checks: Sequence[Check]) -> str:
    """How many rows allow much more than they reach, and for which reasons."""
    reasons = Counter(check.wide or "no reason given" for check in checks if check.is_wide)
    exact = sum(math.isinf(check.margin) for check in checks)
    head = f"{sum(reasons.values())} of {len(checks)} rows allow more than {WIDE:g} times what they reach"
    listed = [f"- {number} because {reason}" for reason, number in reasons.most_common()]
    head += f" ({exact} more are met exactly)" if exact else ""
    return "\n".join([f"{head}{':' if listed else '.'}", *([""] if listed else []), *listed])


def _evidence(checks: Sequence[Check]) -> str:
    rows = []
    for name, meaning in EVIDENCE.items():
        held = [check for check in judged(checks) if check.evidence == name]
        if held:
            differ = sum(check.verdict == "DIFFERS" for check in held)
            rows.append((name, meaning, str(len(held)), str(passed(held)), str(differ)))
    return "## Evidence\n\n" + table(("held against", "which is", "rows", "pass", "differ"), rows).rstrip()


def _study(study: StudyRecord) -> list[str]:
    head = f"### {prose(study.title)} (`{study.name}`)"
    said = [*paragraphs(f"The paper: {study.statement}"), *paragraphs(f"Found: {study.finding}")]
    rows = [
        (
            c.name,
            c.source,
            c.evidence,
            ours(c),
            reference(c),
            tolerance(c),
            limits(c),
            _badge(c.verdict) + (f", {c.standing}" if c.standing != "judged" else ""),
        )
        for c in study.checks
    ]
    names = ("checked", "against", "evidence", "ours", "reference", "tolerance", "limited by", "verdict")
    return [head, *map(prose, said), *([table(names, rows).rstrip()] if rows else [])]


def _result(study: StudyRecord) -> str:
    words = outcome(study.checks)
    deviations = [
        abs(c.ratio - 1.0)
        for c in judged(study.checks)
        if c.comparison in ("relative", "uncertainty") and c.ratio is not None and not c.differs
    ]
    worst = max(filter(math.isfinite, deviations), default=None)
    return words if worst is None else f"{words}; worst deviation {share(worst)}"


def _verdict(checks: Sequence[Check]) -> str:
    if not checks:
        return "–"
    found = {check.verdict for check in judged(checks)}
    return _badge(next(word for word in ("FAIL", "PASS", "DIFFERS") if word in found or word == "DIFFERS"))


def _badge(word: str) -> str:
    return f"**{word}**" if word.startswith("FAIL") else word
