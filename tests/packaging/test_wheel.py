"""The wheel as a user has it: built, installed with the locked dependencies, used away from the checkout."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("lookstep", "behaviors", "skills", "sim_envs", "strict_yaml")

pytestmark = [pytest.mark.wheel, pytest.mark.timeout(600)]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    uv("build", "--wheel", "--out-dir", folder, ROOT)
    (built,) = folder.glob("lookstep-*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """An environment with the wheel and what uv.lock pins for a user, and nothing of the checkout."""
    environment = tmp_path_factory.mktemp("installed") / "environment"
    requirements = environment.parent / "requirements.txt"
    uv("venv", "--python", f"{sys.version_info.major}.{sys.version_info.minor}", environment)
    uv("export", "--project", ROOT, "--frozen", "--no-emit-project", "--no-default-groups", "-o", requirements)
    uv("pip", "install", "--python", environment / "bin/python", "--require-hashes", "-r", requirements)
    uv("pip", "install", "--python", environment / "bin/python", "--no-deps", wheel)
    return environment / "bin"


def test_wheel_carries_every_source_model_type_marker_tree_and_config(wheel):
    with zipfile.ZipFile(wheel) as archive:
        carried = set(archive.namelist())
    expected = {str(path.relative_to(ROOT)) for package in PACKAGES for path in shipped_files(ROOT / package)}
    for folder in ("trees", "config"):
        expected |= {f"strict_yaml/shipped/{path.relative_to(ROOT)}" for path in shipped_files(ROOT / folder)}
    assert expected - carried == set()
    assert any(name.endswith("licenses/LICENSE") for name in carried)


def test_installed_packages_find_shipped_files_without_the_checkout(installed, tmp_path):
    program = f"""
import importlib
from pathlib import Path
for name in {PACKAGES}:
    module = importlib.import_module(name)
    assert Path(module.__file__).is_relative_to({str(installed.parent)!r}), module.__file__
from strict_yaml import shipped_folder
for folder in ("trees", "config"):
    assert shipped_folder(folder).is_relative_to({str(installed.parent)!r}) and shipped_folder(folder).is_dir()
"""
    call(installed / "python", "-c", program, cwd=tmp_path)


def test_installed_command_line_checks_a_shipped_tree_and_walks(installed, tmp_path):
    lookstep = installed / "lookstep"
    assert "demo" in call(lookstep, "--help", cwd=tmp_path)
    call(lookstep, "check", "look_and_step", cwd=tmp_path)
    call(lookstep, "run", "--course", "flat", "--goal", "0.6,0,0", "--json", "summary.json", cwd=tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["outcome"] == "goal_reached"


def uv(*arguments):
    # uv names itself in UV for what it runs.
    return call(os.environ.get("UV") or shutil.which("uv") or "uv", *arguments, cwd=ROOT)


def call(*command, cwd):
    """Run a command outside our own environment; a failure shows all that the command said."""
    environment = {name: text for name, text in os.environ.items() if name not in ("VIRTUAL_ENV", "PYTHONPATH")}
    words = [str(word) for word in command]
    result = subprocess.run(words, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 0, f"{command} exited {result.returncode}\n{result.stdout}\n{result.stderr}"
    return result.stdout


def shipped_files(folder):
    return [path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
