"""The wheel and the source distribution: built from this checkout, installed elsewhere, and used from another folder.

Run with `make test ARGS='-m package'`.
"""

import json
import re
import shutil
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("analysis", "lammps_inputs", "potentials", "workflow")
CHECKOUT = ("pyproject.toml", "hatch_build.py", "README.md", "LICENSE", ".gitignore")
LINKS = {f"src/contact1d/{name}" for name in FOLDERS}
UNUSED = ("__pycache__", "*.pyc")

pytestmark = pytest.mark.package


def python(*arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *map(str, arguments)], capture_output=True, text=True, check=False)


def pip(*arguments: object) -> subprocess.CompletedProcess[str]:
    return python("-m", "pip", "-q", "--disable-pip-version-check", *arguments)


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy without symbolic links, as an archive or Windows has it: each is a text file that holds its target."""
    copy = tmp_path_factory.mktemp("checkout")
    for name in CHECKOUT:
        shutil.copy(ROOT / name, copy)
    for name in FOLDERS:
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns(*UNUSED))
    package = copy / "src" / "contact1d"
    package.mkdir(parents=True)
    for path in (ROOT / "src" / "contact1d").iterdir():
        if path.is_symlink():
            (package / path.name).write_text(str(path.readlink()))
        elif path.is_file():
            shutil.copy(path, package)
    return copy


@pytest.fixture(scope="module")
def built(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Both archives, each of a checkout of its own kind: the wheel without links, the source with them."""
    folder = tmp_path_factory.mktemp("dist")
    for where, kind in ((checkout, "wheel"), (ROOT, "sdist")):
        done = subprocess.run(
            [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", str(folder)],
            cwd=where, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
    return {"wheel": next(folder.glob("*.whl")), "sdist": next(folder.glob("*.tar.gz"))}


def files_of(archive: Path) -> set[str]:
    """Files, without the folder that a source distribution is in."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as wheel:
            return set(wheel.namelist())
    with tarfile.open(archive) as source:
        return {name.partition("/")[2] for name in source.getnames()}


def checked_in(*folders: str) -> list[str]:
    listed = subprocess.run(["git", "ls-files", *folders], cwd=ROOT, capture_output=True, text=True, check=True)
    return listed.stdout.splitlines()


def test_both_hold_every_file_of_the_installed_folders_and_no_other(built: dict[str, Path]) -> None:
    package = [name for name in checked_in("src/contact1d") if name.endswith((".py", ".typed"))]
    source = {*checked_in(*FOLDERS), *package}
    installed = {"contact1d/" + name.removeprefix("src/contact1d/") for name in source}
    assert {name for name in files_of(built["wheel"]) if ".dist-info/" not in name} == installed
    assert files_of(built["sdist"]) == {*checked_in(), "PKG-INFO"} - LINKS


def test_a_wheel_of_the_source_distribution_is_that_of_the_checkout(built: dict[str, Path], tmp_path: Path) -> None:
    made = pip("wheel", "--no-deps", "--no-index", "--no-build-isolation", "-w", tmp_path, built["sdist"])
    assert made.returncode == 0, made.stderr
    assert next(tmp_path.glob("*.whl")).read_bytes() == built["wheel"].read_bytes()


def test_pip_installs_the_wheel_with_all_it_needs_and_it_runs_a_scene_in_another_folder(
    built: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The fresh environment has the dependencies that the wheel names, in the versions of requirements.lock."""
    monkeypatch.delenv("PYTHONPATH", raising=False)
    home, elsewhere, locked = tmp_path / "venv", tmp_path / "elsewhere", tmp_path / "locked.txt"
    elsewhere.mkdir()
    venv.create(home, with_pip=False)
    locked.write_text("\n".join(re.findall(r"^\S+==[^\\]+", (ROOT / "requirements.lock").read_text(), re.MULTILINE)))
    done = pip("--python", home, "install", "-c", locked, built["wheel"])
    assert done.returncode == 0, done.stderr
    shutil.copy(ROOT / "lammps_inputs" / "scenes" / "steel_on_glass.toml", elsewhere / "scene.toml")
    contact1d = home / "bin" / "contact1d"
    for command in ([contact1d, "run", "scene.toml", "--out", "out"], [contact1d, "report", "out"]):
        ran = subprocess.run(command, cwd=elsewhere, capture_output=True, text=True, check=False)
        assert ran.returncode == 0, ran.stdout + ran.stderr
    assert json.loads((elsewhere / "out" / "results.json").read_text())["status"] == "done"
    asked = [home / "bin" / "python", "-c", "import contact1d; print(contact1d.__version__, contact1d.__file__)"]
    found = subprocess.run(asked, cwd=elsewhere, capture_output=True, text=True, check=True).stdout
    version, file = found.strip().split(" ", 1)
    assert f"-{version}-" in built["wheel"].name
    assert Path(file).is_relative_to(home)


def test_an_editable_install_without_links_is_refused_in_one_sentence(checkout: Path, tmp_path: Path) -> None:
    done = pip("install", "--no-deps", "--no-build-isolation", "--target", tmp_path, "-e", checkout)
    assert done.returncode != 0
    assert "src/contact1d/analysis must be a symbolic link to analysis/" in done.stderr
    assert "Traceback" not in done.stderr
