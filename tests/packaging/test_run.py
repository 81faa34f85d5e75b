"""`./run` on machines that lack this or that: the system's tools are stubs that say what they were asked to do."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SYSTEM_TOOLS = ("sh", "env", "readlink", "dirname", "grep", "cat", "cp", "mkdir", "true", "echo")

UV = """[ "$1" != --version ] || { echo "uv VERSION (linux)"; exit; }
echo "uv VERSION $*"
echo "in $PWD, VIRTUAL_ENV=${VIRTUAL_ENV-}, PYTHONPATH=${PYTHONPATH-}"
while [ "$1" != env ]; do shift; done
exec "$@"
"""
OLD_UV = UV.replace("VERSION", "0.4.30")
SHIM_WITHOUT_UV = "echo 'pyenv: uv: command not found' >&2; exit 127"


class Machine:
    """A checkout and a PATH on which the test decides what is installed; at first all that `./run` asks for but uv."""

    def __init__(self, folder):
        self.checkout, self.bin, store = folder / "a checkout", folder / "bin", folder / "store"
        for made in (self.checkout, self.bin, store):
            made.mkdir()
        shutil.copy(ROOT / "run", self.checkout / "run")
        for tool in SYSTEM_TOOLS:
            (self.bin / tool).symlink_to(shutil.which(tool))
        boot = self.checkout / ".boot/bin"
        write_script(store / "uv", UV.replace("VERSION", "0.13.9"))
        write_script(store / "python", f"cp '{store}/uv' '{boot}/uv'")
        self.has("python3", f"[ \"$1\" = -c ] || {{ mkdir -p '{boot}'; cp '{store}/python' '{boot}/python'; }}")
        self.has("ldconfig", "echo ' libgomp.so.1 (libc6,x86-64) => /lib/libgomp.so.1'")
        self.has("id", "echo 1000")
        self.has("apt-get", 'echo "apt-get $*" >&2')

    def has(self, tool, script):
        write_script(self.bin / tool, script)

    def lacks_libgomp_and_venv(self):
        self.has("ldconfig", "")
        self.has("python3", "exit 1")

    def run(self, *arguments, **variables):
        command = [str(self.checkout / "run"), *arguments]
        environment = {"PATH": str(self.bin), **variables}
        return subprocess.run(command, cwd=self.bin, env=environment, capture_output=True, text=True, check=False)


def write_script(path, text):
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def test_uv_on_the_path_is_used(machine):
    machine.has("uv", UV.replace("VERSION", "0.8.0"))
    assert machine.run("true").stdout.startswith("uv 0.8.0 run --project ")
    assert not (machine.checkout / ".boot").exists()


@pytest.mark.parametrize("uv", [None, OLD_UV, SHIM_WITHOUT_UV])
def test_uv_is_brought_into_the_checkout_where_none_fits(machine, uv):
    if uv:
        machine.has("uv", uv)
    result = machine.run("true")
    assert result.stdout.startswith(f"uv 0.13.9 run --project {machine.checkout} --frozen env -- true")
    assert "Fetching uv" in result.stderr
    assert machine.run("true").stderr == ""


def test_arguments_folder_and_exit_code_pass_through_unchanged(machine):
    result = machine.run("sh", "-c", 'echo "[$1][$2]"; exit 7', "sh", "two words", "*")
    assert result.returncode == 7
    assert f"in {machine.bin}," in result.stdout
    assert "[two words][*]" in result.stdout


def test_environment_of_another_project_does_not_leak_in(machine):
    result = machine.run("true", VIRTUAL_ENV="/elsewhere", PYTHONPATH="/opt/ros/packages")
    assert f"in {machine.bin}, VIRTUAL_ENV=, PYTHONPATH=\n" in result.stdout


def test_optional_parts_go_to_uv_and_options_of_the_command_do_not(machine):
    result = machine.run("--extra", "panel", "--group", "docs", "echo", "--extra", "mine")
    assert " --frozen --extra panel --group docs env -- echo --extra mine\n" in result.stdout
    assert result.stdout.endswith("\n--extra mine\n")


def test_plain_user_is_told_the_one_command(machine):
    machine.lacks_libgomp_and_venv()
    result = machine.run("true")
    assert result.returncode == 1
    assert "missing: libgomp1 python3-venv\n" in result.stderr
    assert (
        "  sudo sh -c 'apt-get update && apt-get install -y --no-install-recommends libgomp1 python3-venv'"
        in result.stderr
    )


def test_root_installs_what_is_missing_after_an_update(machine):
    machine.has("uv", UV.replace("VERSION", "0.8.0"))
    machine.lacks_libgomp_and_venv()
    machine.has("id", "echo 0")
    result = machine.run("true")
    assert result.returncode == 0
    *_, update, install = result.stderr.splitlines()
    assert (update, install) == ("apt-get update -qq", "apt-get install -y -qq --no-install-recommends libgomp1")


def test_failed_installation_is_told_and_ends_the_run(machine):
    machine.lacks_libgomp_and_venv()
    machine.has("id", "echo 0")
    machine.has("apt-get", "exit 100")
    result = machine.run("true")
    assert result.returncode == 1
    assert "apt-get could not install them: libgomp1 python3-venv" in result.stderr


def test_missing_python_is_among_what_is_installed(machine):
    (machine.bin / "python3").unlink()
    assert "missing: python3 python3-venv\n" in machine.run("true").stderr


def test_system_without_apt_is_told_what_it_lacks(machine):
    machine.lacks_libgomp_and_venv()
    (machine.bin / "apt-get").unlink()
    result = machine.run("true")
    assert result.returncode == 1
    assert "libgomp1 python3-venv" in result.stderr


@pytest.mark.parametrize(("arguments", "code"), [([], 2), (["--frozen"], 2), (["--extra"], 2), (["--help"], 0)])
def test_usage_names_the_two_commands(machine, arguments, code):
    result = machine.run(*arguments)
    said = result.stdout if code == 0 else result.stderr
    assert result.returncode == code
    assert "./run lookstep demo" in said
    assert "./run pytest" in said
