"""What a wrong or odd input is told: one sentence each, and what it says to do is tried and works.

Units, materials and files of profiles, in a scene in SI and in one in units of the model.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from typer.testing import CliRunner

from contact1d import Scene, SceneError, read_scene
from contact1d.__main__ import app
from contact1d.workflow.runs.plausibility import implausible
from contact1d.workflow.units import UNKNOWN, Scales
from tests.scenes import STEEL_ON_GLASS

SHIPPED = (Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "pull_off.toml").read_text(encoding="utf-8")
R, F, H = "bodies.profile.radius", "experiment.force", "bodies.spacing"
E, NU = "material.upper.youngs_modulus", "material.upper.poisson_ratio"
LENGTH, PRESSURE = "must be a length, such as 10 mm", "must be a pressure, such as 210 GPa"
SLIDE = 'experiment={ kind = "slide", normal_force = "1 N", distance = "1 µm" }'
TIMED = (SLIDE, "horizontal={}", "damping.coefficient=auto", 'plate.free=["x", "z"]', "cantilever.stiffness=1 N/m")
PARTICLES = ("bodies.lower=particles", "interaction.repulsion={ amplitude = '1 aJ', range = '1 µm' }")


@dataclass(frozen=True)
class Odd:
    """An input that is wrong, by what is `set` in a scene; its `sentence`; what is set besides to follow that."""

    set: tuple[str, ...]
    sentence: str
    remedy: tuple[str, ...]
    scene: str = STEEL_ON_GLASS
    key: str = ""


def odd(key: str, value: str, sentence: str, remedy: str, *before: str) -> Odd:
    """One value of one key is wrong."""
    return Odd((*before, f"{key}={value}"), sentence, (*before, f"{key}={remedy}"), key=key)


def doubt(key: str, value: str, sentence: str, remedy: str, *before: str) -> Odd:
    """One value of one key is allowed and looks wrong."""
    return Odd((*before, f"{key}={value}"), sentence, (*before, f"{key}={remedy}"))


WRONG = [
    # A quantity of another dimension.
    odd(F, "10 mm", "10 mm is a length", "10 N"),
    odd(F, "10 kg", "10 kg is a mass", "10 N"),
    odd(R, "10 mm²", "10 mm² is an area", "10 mm"),
    odd(R, "2 s", "2 s is a time", "10 mm"),
    odd(E, "210 GN", "210 GN is a force", "210 GPa"),
    odd(E, "210 N/mm", "210 N/mm is a force per length or energy per area", "210 N/mm²"),
    odd(NU, "0.3 GPa", "0.3 GPa is a pressure", "0.3"),
    odd("bodies.mass", "1 N", "1 N is a force", "1 ng"),
    odd("cantilever.velocity", "1 µm", "1 µm is a length", "1 µm/s",
        *TIMED, *PARTICLES, "bodies.mass=1 ng"),
    odd("interaction.repulsion.amplitude", "5 nm", "5 nm is a length", "1 aJ",
        *PARTICLES),
    Odd(('experiment={ kind = "path", displacements = ["1 µm", "2 N"] }',),
        f'experiment.displacements[1] = "2 N": {LENGTH}; 2 N is a force',
        ('experiment={ kind = "path", displacements = ["1 µm", "2 µm"] }',)),
    Odd(('experiment={ kind = "path", displacements = { from = 0, to = "1 N", steps = 4 } }',),
        f'experiment.displacements.to = "1 N": {LENGTH}; 1 N is a force',
        ('experiment={ kind = "path", displacements = { from = 0, to = "1 µm", steps = 4 } }',)),
    Odd(('bodies.profile={ kind = "cone", slope = "5 deg" }',),
        "5 deg is an angle: its tangent is 0.0874887",
        ('bodies.profile={ kind = "cone", slope = 0.0874887 }',)),
    # A unit that is none.
    odd(R, "10 mmm", "10 mmm has an unknown unit, mmm", "10 mm"),
    odd(E, "210 gpa", "210 gpa has an unknown unit, gpa; did you mean 210 GPa?", "210 GPa"),
    odd(E, "210 pa", "210 pa is a time; did you mean 210 Pa?", "210 GPa"),
    odd(R, "10 MM", "10 MM is another quantity; did you mean 10 mm?", "10 mm"),
    odd(R, "10 LU", "10 LU is in units of the model: write 10 without quotes and unit", "10",
        "material.length_unit=1 mm"),
    odd(R, "10 (mm", "10 (mm has a unit that cannot be read", "10 mm"),
    odd(R, "10 m**99", "10 m**99 has an invalid power of a unit", "10 mm"),
    odd(R, "10 mm # about", "10 mm # about has an unknown unit, #", "10 mm"),
    odd("noise.temperature", "300 K/m", "300 K/m is another quantity", "300 K",
        *PARTICLES, "damping.coefficient=auto", "plate={}", "noise.seed=1"),
    odd("noise.temperature", "300 delta_degC", "300 delta_degC is a "
        "relative scale: give a temperature in K or °C; levels (dB) are not allowed", "27 °C",
        *PARTICLES, "damping.coefficient=auto", "plate={}", "noise.seed=1"),
    # A number that is none.
    odd(R, "ten mm", 'must be a number greater than 0 (m); a number with its unit begins with a digit: "10 mm"',
        "10 mm"),
    odd(R, "10,5 mm", "10,5 mm has a comma in its number: write a decimal point, and no thousands separators",
        "10.5 mm"),
    odd(R, "1.0.5 mm", "1.0.5 mm has text after the number 1.0 that is not a unit", "1.05 mm"),
    odd(R, "1 000 mm", "1 000 mm has text after the number 1 that is not a unit", "1000 mm"),
    odd(R, "1e mm", "1e mm has an exponent that is not an integer", "1e1 mm"),
    odd(R, "1O mm", "1O mm has an unknown unit, O", "10 mm"),
    odd(R, "1e999 m", "1e999 m exceeds the range of floating-point numbers", "10 mm"),
    odd(R, "1e308 m", "1e308 m is beyond 1e+300, the largest number that is calculated with", "10 mm"),
    odd(R, "-10 mm", "must be greater than 0 (m)", "10 mm"),
    odd(H, "0 nm", 'must be greater than 0 (m), or "auto"', "4 µm"),
    odd(F, '"10"', 'must be a number (N); write a number without quotes, or with its unit: "10 N"', "10 N"),
    odd("bodies.particles", "30 µm", 'must be a whole number from 3 to 10000000, or "auto"; write a number without '
        "quotes and unit", "300"),
    # Numbers with units beside numbers without.
    odd(F, "10", f'is in FU, while {H} = "4 µm" has a unit, and nothing says what FU stands for; give it a unit as '
        'well, such as "10 N"; or give material.force_unit', "10 N"),
    Odd((f"{F}=10",), f'{F} = 10: is in FU, while {H} = "4 µm" has a unit, and nothing says what FU stands for; give '
        'it a unit as well, such as "10 N"; or give material.force_unit', (f"{F}=10", "material.force_unit=1 N")),
    Odd((f"{R}=10 µm",), f'{H} = 1.0: is in LU, while {R} = "10 µm" has a unit, and nothing says what LU and FU stand '
        'for; give it a unit as well, such as "10 mm"; so too bodies.bulk_stiffness, interaction.repulsion.amplitude '
        "and 5 more; or give material.length_unit and material.force_unit",
        (f"{R}=10 µm", "material={ length_unit = '1 nm', force_unit = '1 nN' }"), SHIPPED),
    Odd((*TIMED, *PARTICLES, "cantilever.velocity=1 µm/s"), f'bodies.mass = 1.0: is by default in MU, while {H} = '
        '"4 µm" has a unit, and nothing says what MU stands for; give it a unit as well, such as "1 ng"; or give '
        "material.mass_unit", (*TIMED, *PARTICLES, "cantilever.velocity=1 µm/s", "material.mass_unit=1 ng")),
    # Materials.
    odd(E, "0 GPa", "must be greater than 0 (Pa)", "210 GPa"),
    odd(NU, "30", "must be greater than -1 and at most 0.5", "0.3"),
    odd(NU, "60 %", "must be greater than -1 and at most 0.5", "30 %"),
    Odd(("material.contact_modulus=50 GPa",),
        'material.contact_modulus = "50 GPa": not together with upper or lower; give E*, or E and ν of both bodies',
        ("material={ contact_modulus = '50 GPa' }",)),
    Odd(("bodies.bulk_stiffness=100 N/m",), 'bodies.bulk_stiffness = "100 N/m": follows from the material here; write '
        '"auto"', ("bodies.bulk_stiffness=auto",)),
    Odd(("material={}",), "give a number, or material.upper and material.lower",
        ("material={}", "bodies.bulk_stiffness=1 MN/m")),
    Odd(("material.length_unit=1 N",), f'material.length_unit = "1 N": {LENGTH}; 1 N is a force',
        ("material.length_unit=1 nm",)),
    Odd((f"{R}=10 µm", "material={ contact_modulus = '1 GPa', surface_energy = '50 mJ/m²' }"),
        f'{R} = "10 µm": LU and FU follow from the run (material.surface_energy), so that units are not known before '
        "it; write a number in LU",
        (f"{R}=1000.0", "material={ contact_modulus = '1 GPa', surface_energy = '50 mJ/m²' }"), SHIPPED),
]  # fmt: skip
"""Values that are wrong."""

DOUBTFUL = [
    doubt(E, "210 Pa", "softer than any gel: was 210 GPa meant?", "210 GPa"),
    doubt(E, "210", "softer than any gel: was 210 GPa meant?", "210e9"),
    doubt(NU, "-0.3", "few materials have one below 0: check its sign", "0.3"),
    doubt(R, "50 m", "no ball of such a radius is smooth: check its unit", "50 mm"),
    doubt(R, "10 pm", "less than the width of two atoms: check its unit", "10 µm"),
    doubt("interaction.repulsion.range", "1 pm", "a tenth of an atom's radius: check its unit", "1 nm", *PARTICLES),
    doubt("noise.temperature", "3e5 K", "above any melting point: check its unit", "300 K",
        *PARTICLES, "damping.coefficient=auto", "plate={}", "noise.seed=1"),
    Odd(("material={ contact_modulus = '1 GPa', surface_energy = 50 }",),
        "where 0.02 to 3 are usual: check its unit",
        ("material={ contact_modulus = '1 GPa', surface_energy = '50 mJ/m²' }",), SHIPPED),
]  # fmt: skip
"""Values that are allowed and look wrong."""

FILES = {
    "unknown names": ("width,depth\n0,0\n1,1\n2,4\n3,9\n",
                      "the names of its 2 columns are not known; name the radius r",
                      "r,z\n0,0\n1,1\n2,4\n3,9\n"),
    "a name that is not known": ("r,y\n0,0\n1,1\n2,4\n3,9\n", "the names of its 2 columns are not known",
                                 "0,0\n1,1\n2,4\n3,9\n"),
    "two radii": ("r,radius,z\n0,0,0\n", "2 columns match r; give this name to one of them",
                  "r,old,z\n0,0,0\n1,1,1\n2,2,4\n3,3,9\n"),
    "columns without names": ("0,0,7\n1,1,7\n2,4,7\n3,9,7\n", "has 3 columns without names; name the radius r",
                              "r,z,t\n0,0,7\n1,1,7\n2,4,7\n3,9,7\n"),
    "swapped columns": ("r,z\n9,-3\n4,-2\n0,0\n4,2\n9,3\n", "the columns may be swapped; name them r and z",
                        "z,x\n9,-3\n4,-2\n1,-1\n0,0\n1,1\n4,2\n9,3\n"),
    "one unit": ("r [µm],z\n0,0\n1,1\n2,4\n3,9\n", "only one of radius and height has a unit",
                 "r [µm],z [nm]\n0,0\n1,1\n2,4\n3,9\n"),
    "a unit of force": ("r [µm],z [µN]\n0,0\n1,1\n2,4\n3,9\n", "the unit in the names is not a known length",
                        "r [µm],z [µm]\n0,0\n1,1\n2,4\n3,9\n"),
    "sides that differ": ("-2,8\n-1,2\n0,0\n1,1\n2,4\n", "these differ by 50% of its height", "0,0\n1,1\n2,4\n3,9\n"),
    "an apex off the middle": ("-1,4\n0,1\n1,0\n2,1\n3,4\n", "and their positions differ; shift it",
                               "-3,9\n-2,4\n-1,1\n0,0\n1,1\n2,4\n3,9\n"),
    "upside down": ("0,0\n1,-1\n2,-4\n3,-9\n", "heights are measured from the plane; change the sign",
                    "0,0\n1,1\n2,4\n3,9\n"),
    "decimal commas beside points": ("r;z\n0;0\n0,5;0.25\n1;1\n2;4\n",
                                     "line 3: r is not a number; write it with a decimal point",
                       "r;z\n0;0\n0.5;0.25\n1;1\n2;4\n"),
    "an empty cell": ("0,0\n1,\n2,4\n3,9\n4,16\n", "line 2: z is empty; leave out a line that has no value",
                      "0,0\n2,4\n3,9\n4,16\n"),
    "no axis": ("1,0\n2,1\n3,2\n4,3\n", "must begin at the radius 0, not 1", "0,0\n2,1\n3,2\n4,3\n"),
    "a radius twice": ("0,0\n1,1\n1,1\n2,4\n3,9\n", "radii must increase; 1e-06 follows 1e-06",
                       "0,0\n1,1\n2,4\n3,9\n"),
    "few points": ("0,0\n1,1\n", "must have at least 4 points", "0,0\n1,1\n2,4\n3,9\n"),
}  # fmt: skip
"""Files that are no profile: text, sentence, the text that the sentence asks for."""


@pytest.mark.parametrize("case", WRONG, ids=lambda case: case.sentence[:70])
def test_a_wrong_value_gets_its_sentence_and_the_remedy_works(case: Odd) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(case.scene, case.set)
    (problem,) = caught.value.problems
    assert case.sentence in str(problem)
    assert case.key in ("", problem.path)
    assert isinstance(read_scene(case.scene, case.remedy), Scene)


@pytest.mark.parametrize("wrong", ["interaction.attraction.range=0.5 µm", "interaction.attraction.amplitude=9 aJ"])
def test_ways_that_are_tried_have_units_where_the_scene_has(wrong: str) -> None:
    attraction = "interaction.attraction={ amplitude = '0.5 aJ', range = '2 µm' }"
    set_ = (*PARTICLES, attraction, wrong)
    with pytest.raises(SceneError) as caught:
        read_scene(STEEL_ON_GLASS, set_)
    (problem,) = caught.value.problems
    assert "LU" not in str(problem)
    assert all(str(value) in problem.hint for way in problem.ways for value in way.values())
    assert len(problem.ways) == 2
    for way in problem.ways:
        assert isinstance(read_scene(STEEL_ON_GLASS, [*set_, *(f"{key}={value}" for key, value in way.items())]), Scene)


def doubts(scene: Scene) -> str:
    """What is told of a scene when it runs."""
    known = scene.material is not None and scene.material.length_unit is not None
    return "; ".join(implausible(scene, Scales(1.0, 1.0) if known else UNKNOWN, {}).values())


@pytest.mark.parametrize("case", DOUBTFUL, ids=lambda case: case.sentence[:70])
def test_a_doubtful_value_is_told_and_the_remedy_is_not(case: Odd) -> None:
    assert case.sentence in doubts(read_scene(case.scene, case.set))
    assert doubts(read_scene(case.scene, case.remedy)) == ""


@pytest.mark.parametrize("name", FILES)
def test_an_odd_file_gets_its_sentence_and_the_remedy_works(name: str, tmp_path: Path) -> None:
    text, sentence, mended = FILES[name]
    units = () if "µm]" in text + mended else ("bodies.profile.scale=1 µm",)
    profile = (f"bodies.profile={{ kind = 'table', file = '{tmp_path / 'p.csv'}' }}", *units)
    (tmp_path / "p.csv").write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(STEEL_ON_GLASS, profile)
    assert len(caught.value.problems) == 1
    assert sentence in str(caught.value)
    (tmp_path / "p.csv").write_text(mended, encoding="utf-8")
    assert isinstance(read_scene(STEEL_ON_GLASS, profile), Scene)


def _socket(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(path.name)


def _large(path: Path) -> None:
    path.touch()
    os.truncate(path, 3 * 10**9)


UNREADABLE: dict[str, tuple[Callable[[Path], object], str]] = {
    "directory": (Path.mkdir, "is a directory; name a file in it"),
    "pipe": (os.mkfifo, "is not a regular file (a pipe or a device); save its content in a file"),
    "device": (lambda path: path.symlink_to("/dev/zero"), "is not a regular file"),
    "socket": (_socket, "is not a regular file"),
    "binary": (
        lambda path: path.write_bytes(b"title = 1\n\x80\xff"),
        "line 2 is not UTF-8 text; save the file as UTF-8",
    ),
    "large": (_large, "has 3000000000 bytes, and at most 8000000 are read; make it smaller"),
    "link to itself": (lambda path: path.symlink_to(path), "cannot be read: Too many levels of symbolic links"),
}
"""What makes a file that can't be read, and the sentence."""


def ended(*arguments: object) -> list[str]:
    """The lines of a command that ends because its input is wrong; nothing is written."""
    result = CliRunner().invoke(app, [*map(str, arguments), "--out", "out"])
    assert isinstance(result.exception, SystemExit)
    assert result.exit_code == 2
    assert not Path("out").exists()
    return result.output.splitlines()


@pytest.mark.parametrize("name", UNREADABLE)
def test_a_file_that_cannot_be_read_is_one_sentence(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a scene, as a profile, as a sweep and as the scene of a sweep; none is waited for."""
    make, sentence = UNREADABLE[name]
    monkeypatch.chdir(tmp_path)
    make(Path("odd"))
    Path("scene.toml").write_text(
        STEEL_ON_GLASS.replace('kind = "parabola", radius = "10 mm"', 'kind = "table", file = "odd"')
    )
    axes = '[[axes]]\nkey = "experiment.force"\nvalues = ["1 N"]\n'
    Path("sweep.toml").write_text(f'scene = "odd"\n{axes}')
    for command in (("run", "odd"), ("run", "scene.toml"), ("sweep", "odd"), ("sweep", "sweep.toml")):
        _, line = ended(*command)
        assert f"odd: {sentence}" in line


DEEP = [100, 300, 500, 50_000]
NESTED = {
    "dotted key": lambda depth: f"{'a.' * depth}a = 1",
    "quoted keys": lambda depth: " . ".join(["'a b'"] * (depth + 1)) + " = 1",
    "table": lambda depth: f"[{'a.' * depth}a]",
    "list": lambda depth: f"extra = {'[' * depth}{']' * depth}",
    "inline table": lambda depth: f"extra = {'{ a = ' * depth}1{' }' * depth}",
}


@pytest.mark.parametrize("depth", DEEP)
@pytest.mark.parametrize("kind", NESTED)
def test_what_is_nested_deeply_is_one_sentence(
    kind: str, depth: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a scene and in a sweep's [base]."""
    monkeypatch.chdir(tmp_path)
    text = NESTED[kind](depth)
    Path("scene.toml").write_text(f"{STEEL_ON_GLASS}\n{text}\n")
    Path("sweep.toml").write_text(f'[[axes]]\nkey = "experiment.force"\nvalues = ["1 N"]\n[base]\n{text}\n')
    for command in ("run", "sweep"):
        _, line = ended(command, f"{'scene' if command == 'run' else command}.toml")
        assert line.endswith("tables or lists are nested more than 100 deep; check for an extra dot or bracket")


def test_tables_that_are_nested_deeply_are_refused_from_python_as_well() -> None:
    table: object = 1
    for _ in range(500):
        table = {"a": [table]}
    with pytest.raises(SceneError, match="nested more than 100 deep"):
        read_scene({"title": table})
    with pytest.raises(SceneError, match="not a path of keys"):
        read_scene(STEEL_ON_GLASS).with_({"a." * 500 + "a": 1})


@pytest.mark.parametrize(
    ("added", "count"),
    [
        ("\n".join(f"k{i} = 1" for i in range(10_000)), 10_000),
        ("\n".join(f"[t{i}]" for i in range(1000)), 1000),
        (f"[output]\nstates = [{'1, ' * 500}]\nother = 1", 2),
    ],
    ids=["keys", "tables", "few"],
)
def test_of_many_problems_the_first_are_listed(
    added: str, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("many.toml").write_text(f"{STEEL_ON_GLASS}\n{added}\n")
    head, *lines = ended("run", "many.toml")
    assert head == f"many.toml: {count} problems"
    assert len(lines) == min(count, 21)
    assert (lines[-1] == f"  and {count - 20} more") is (count > 20)


def test_a_key_without_end_is_cut() -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(f"{STEEL_ON_GLASS}\n{'k' * 10**6} = 1\n")
    assert str(caught.value).endswith("k…: unknown key; allowed here: kind, force, method")
    assert len(str(caught.value)) < 1100


@pytest.mark.parametrize(("count", "sentence"), [(100_001, "has 100001 lines"), (2_000_000, "bytes, and at most")])
def test_a_profile_of_too_many_lines_is_refused_with_the_limit(count: int, sentence: str, tmp_path: Path) -> None:
    (tmp_path / "long.csv").write_text("".join(f"{i},{i}\n" for i in range(count)))
    with pytest.raises(SceneError) as caught:
        read_scene(
            STEEL_ON_GLASS, (f"bodies.profile={{ kind = 'table', file = '{tmp_path / 'long.csv'}', scale = '1 µm' }}",)
        )
    assert len(caught.value.problems) == 1
    assert sentence in str(caught.value)
