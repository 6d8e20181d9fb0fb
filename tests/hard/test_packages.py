"""The wheel and the source distribution: built from this checkout, installed elsewhere, and used from another folder.

Run with `make test ARGS='-m package'`.
"""

import json
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("analysis", "lammps_inputs", "potentials", "workflow")
CHECKOUT = ("pyproject.toml", "hatch_build.py", "README.md", "LICENSE", ".gitignore")
BESIDE = (
    "tests", "validation", "docs", "CHANGELOG.md", "CONTRIBUTING.md", "VALIDATION.md", "CITATION.cff", "mkdocs.yml",
    "Makefile", "requirements.lock",
)  # fmt: skip
"""What the source distribution has besides."""
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
    assert files_of(built["sdist"]) == source | {*checked_in(*BESIDE), *CHECKOUT, "PKG-INFO"}


@pytest.mark.parametrize("kind", ["wheel", "sdist"])
def test_installed_elsewhere_it_runs_a_scene_from_another_folder(
    kind: str, built: dict[str, Path], tmp_path: Path
) -> None:
    home, elsewhere = tmp_path / "venv", tmp_path / "elsewhere"
    elsewhere.mkdir()
    venv.create(home, with_pip=False)
    site = Path(sysconfig.get_path("purelib", "venv", {"base": str(home)}))
    made = pip("wheel", "--no-deps", "--no-index", "--no-build-isolation", "-w", tmp_path, built[kind])
    assert made.returncode == 0, made.stderr  # of a wheel: a copy
    done = pip("--python", home, "install", "--no-deps", "--no-index", next(tmp_path.glob("*.whl")))
    assert done.returncode == 0, done.stderr
    # Its dependencies are those of this environment, whose own .pth file, the editable install, is not read from there.
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    scene = ROOT / "lammps_inputs" / "scenes" / "steel_on_glass.toml"
    shutil.copy(scene, elsewhere / "scene.toml")
    ran = subprocess.run(
        [home / "bin" / "contact1d", "run", "scene.toml", "--out", "out"],
        cwd=elsewhere, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert json.loads((elsewhere / "out" / "results.json").read_text())["status"] == "done"
    asked = [home / "bin" / "python", "-c", "import contact1d.analysis; print(contact1d.analysis.__file__)"]
    found = subprocess.run(asked, cwd=elsewhere, capture_output=True, text=True, check=True).stdout
    assert Path(found.strip()).is_relative_to(site)


def test_an_editable_install_without_links_is_refused_in_one_sentence(checkout: Path, tmp_path: Path) -> None:
    done = pip("install", "--no-deps", "--no-build-isolation", "--target", tmp_path, "-e", checkout)
    assert done.returncode != 0
    assert "src/contact1d/analysis must be a symbolic link to analysis/" in done.stderr
    assert "Traceback" not in done.stderr
