"""The rules of the repository that no linter knows: what is tracked, what is locked, what the metadata promises."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest
from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.tags import Tag, compatible_tags, cpython_tags
from packaging.utils import canonicalize_name, parse_wheel_filename

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("lookstep", "behaviors", "skills", "sim_envs", "strict_yaml")
LONGEST_MODULE = 400
LARGEST_FILE_BYTES = 1_000_000
PUBLIC_INDEX = {"pypi.org", "files.pythonhosted.org"}
GLIBC_FLOOR = 28
PROMISED = [(minor, machine) for minor in (11, 12) for machine in ("x86_64", "aarch64")]

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
LOCK = tomllib.loads((ROOT / "uv.lock").read_text())


@pytest.fixture(scope="module")
def tracked():
    """Paths of all tracked files that the working tree still has."""
    # The checkout may belong to another user than the one who runs the tests.
    command = ["git", "-c", f"safe.directory={ROOT}", "-C", str(ROOT), "ls-files", "-z"]
    try:
        listing = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    except (FileNotFoundError, subprocess.CalledProcessError) as error:
        pytest.skip(f"not a git checkout: {error}")
    return [ROOT / name for name in listing.split("\0") if name and (ROOT / name).is_file()]


def test_no_tracked_file_is_over_one_megabyte(tracked):
    assert [path for path in tracked if path.stat().st_size > LARGEST_FILE_BYTES] == []


def test_no_module_is_too_long_for_one_concept(tracked):
    lengths = {path: path.read_text().count("\n") for path in tracked if path.suffix == ".py"}
    assert {path: length for path, length in lengths.items() if length > LONGEST_MODULE} == {}


def test_no_tracked_file_names_a_folder_of_someones_machine(tracked):
    private = re.compile(rf"(?<![\w.~])(?:/(?:home|root|Users)|{re.escape(str(ROOT))})/")
    named = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()[:80]}"
        for path in tracked
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1)
        if private.search(line)
    ]
    assert named == []


def test_every_package_says_that_it_is_typed():
    assert [name for name in PACKAGES if not (ROOT / name / "py.typed").is_file()] == []


def test_every_shipped_folder_is_tracked(tracked):
    folders = {path.relative_to(ROOT).parts[0] for path in tracked}
    assert {*PACKAGES, "trees", "config"} <= folders


@pytest.mark.parametrize("script", ["run", ".ci/run"])
def test_scripts_are_executable_and_parse(script):
    assert (ROOT / script).stat().st_mode & 0o111 == 0o111
    subprocess.run(["sh", "-n", str(ROOT / script)], check=True)


def test_readme_names_the_two_commands():
    readme = (ROOT / "README.md").read_text()
    assert "./run lookstep demo" in readme
    assert "./run pytest" in readme


def test_version_is_the_same_everywhere():
    version = PROJECT["project"]["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert next(entry["version"] for entry in LOCK["package"] if entry["name"] == "lookstep") == version


def test_lock_names_public_indexes_alone():
    hosts = set(re.findall(r"https?://([^/\"\s]+)", (ROOT / "uv.lock").read_text()))
    assert hosts <= PUBLIC_INDEX
    sources = [entry["source"] for entry in LOCK["package"] if entry["name"] != "lookstep"]
    assert [source for source in sources if source.keys() != {"registry"}] == []


def test_lock_holds_every_requirement_of_the_project():
    project = PROJECT["project"]
    wanted = [*project["dependencies"]]
    for group in (*project["optional-dependencies"].values(), *PROJECT["dependency-groups"].values()):
        wanted += group
    locked = {entry["name"]: entry["version"] for entry in LOCK["package"]}
    requirements = [Requirement(text) for text in wanted]
    unmet = [str(r) for r in requirements if not r.specifier.contains(locked[canonicalize_name(r.name)])]
    assert unmet == []


@pytest.mark.parametrize(("minor", "machine"), PROMISED)
def test_every_locked_package_has_a_wheel_for(minor, machine):
    """Neither a compiler nor a newer glibc is needed on any system that the metadata promises."""
    accepted = promised_tags(minor, machine)
    lacking = [
        f"{entry['name']} {entry['version']}"
        for entry in LOCK["package"]
        if entry["name"] != "lookstep" and needed_on(entry, minor, machine) and not has_wheel(entry, accepted)
    ]
    assert lacking == []


def promised_tags(minor: int, machine: str) -> set[Tag]:
    platforms = [f"manylinux_2_{glibc}_{machine}" for glibc in range(5, GLIBC_FLOOR + 1)]
    platforms += [f"{legacy}_{machine}" for legacy in ("manylinux1", "manylinux2010", "manylinux2014")]
    return {
        *cpython_tags((3, minor), platforms=platforms),
        *compatible_tags((3, minor), interpreter=f"cp3{minor}", platforms=platforms),
    }


def has_wheel(entry, accepted):
    names = [wheel["url"].rsplit("/", 1)[-1] for wheel in entry.get("wheels", [])]
    return any(not accepted.isdisjoint(parse_wheel_filename(name)[3]) for name in names)


def needed_on(entry, minor, machine):
    """Whether the lock uses this version of the package there; one locked in two versions carries markers."""
    environment = {"python_full_version": f"3.{minor}.0", "python_version": f"3.{minor}", "platform_machine": machine}
    markers = entry.get("resolution-markers")
    return markers is None or any(Marker(text).evaluate(environment) for text in markers)
