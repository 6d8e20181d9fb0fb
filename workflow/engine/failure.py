"""A failed run in one sentence: the error message of LAMMPS, the command, the phase, the step.

"ERROR on proc 0: … (src/run.cpp:1)\nLast input line: run 9" ──▶ "LAMMPS stopped: …, at: run 9"
"""

from __future__ import annotations

import re
from pathlib import Path

from contact1d.workflow.errors import Contact1dError

TOO_WIDE = "the bodies are much longer than the range of their forces"
TOO_LONG = "a run has too many timesteps to count"
NO_MEMORY = "there is not enough memory"
NOT_FINITE = "a position or a force is no longer finite"
MEANINGS = {
    r"Too many neighbor bins|Domain too large for neighbor bins|Cannot use neighbor bins": TOO_WIDE,
    r"(Illegal|Invalid) run command|Too many (timesteps|iterations)": TOO_LONG,
    r"Failed to (re)?allocate|bad_alloc|Too many (total|local) atoms|Too many atom": NO_MEMORY,
    r"Non-numeric|nan|Out of range atoms|Invalid pair table|must be finite": NOT_FINITE,
}
"""Error messages of LAMMPS for extreme numbers, and their meaning."""


class EngineError(Contact1dError, RuntimeError):
    """LAMMPS gave no result.

    Attributes:
        message: the cause, one sentence.
        phase: the phase of the experiment, as given to `Session.execute`.
        step: the timestep that LAMMPS had reached (after a crash or a kill: up to a fifth of a second earlier).
        folder: the run folder, whose files are kept.
        log_tail: the last 25 lines of its log, and the output of the process, up to 4000 bytes; "" for an error that
            this program found.
    """

    exit_code = 3

    def __init__(self, message: str, phase: str, step: int, folder: Path, log_tail: str) -> None:
        """Store the attributes; all of them are arguments of the exception, so that it can be pickled."""
        super().__init__(message, phase, step, folder, log_tail)
        self.message, self.phase, self.step, self.folder, self.log_tail = message, phase, step, folder, log_tail

    def __str__(self) -> str:
        """Return one line: "phase 'name', step n: message (files kept in folder)"."""
        return f"phase {self.phase!r}, step {self.step}: {self.message} (files kept in {self.folder})"


def plain_message(raw: str, log: str = "", commands: str = "") -> str:
    """Return LAMMPS's error text as "LAMMPS stopped: …, at: command", without location in the source and pointer to the
    manual.

    The command or formula is that which the text quotes, else the last line of the log that is one of `commands`;
    without any the text ends before ", at:". Of a few known errors, as that of lost atoms, the meaning comes first and
    LAMMPS's words follow in parentheses.

    Args:
        raw: the text of LAMMPS, with its prefix, source location and pointer to the manual.
        log: the log, to name the command if the text does not quote it: LAMMPS logs a line before it runs it.
        commands: the lines that were to be run, to tell commands from output in the log.
    """
    text, _, quoted = raw.partition("Last input line:")
    text = re.sub(r"For more information see \S+|\([\w./+-]+\.(?:cpp|h):\d+\)", "", text)
    text = " ".join(re.sub(r"^\s*ERROR(?: on proc \d+)?:", "", text).split()).rstrip(".")
    command = " ".join(quoted.strip().partition("\n")[0].split())
    if not command:
        known = {" ".join(line.split()) for line in re.sub(r"&[ \t]*\n", " ", commands).splitlines()} - {""}
        logged = (" ".join(line.split()) for line in reversed(log.splitlines()))
        command = next((line for line in logged if line in known), "")
    lost = re.match(r"Lost atoms: original (\d+) current (\d+)", text)
    if lost:
        text = f"{int(lost[1]) - int(lost[2])} of {lost[1]} atoms left the box ({text})"
    text = next((f"{meant} ({text})" for words, meant in MEANINGS.items() if re.search(rf"\b({words})\b", text)), text)
    return f"LAMMPS stopped: {text}" + (f", at: {command}" if command else "")
