import shutil
from pathlib import Path

import pytest

from skills import kernel_locator
from skills.kernel_locator import source_hash

SOURCES = {
    "skills/a/top.py": "from skills.a.middle import f\n",
    "skills/a/middle.py": "import numpy\nfrom skills.b import LEAST\nfrom skills.a.top import g\n",
    "skills/a/__init__.py": "",
    "skills/b/__init__.py": "from skills.b.limits import LEAST\n",
    "skills/b/limits.py": "LEAST = 1\n",
    "skills/b/other.py": "MOST = 1\n",
}


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in SOURCES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(kernel_locator, "_ROOT", tmp_path)
    return tmp_path


def hash_of(checkout: Path, name: str) -> str:
    source_hash.cache_clear()
    kernel_locator._imports.cache_clear()
    return source_hash(checkout / name)


@pytest.mark.parametrize(
    "edited", ["skills/a/top.py", "skills/a/middle.py", "skills/b/__init__.py", "skills/b/limits.py"]
)
def test_a_source_and_whatever_it_imports_in_the_end_count(checkout: Path, edited: str):
    before = hash_of(checkout, "skills/a/top.py")
    (checkout / edited).write_text(SOURCES[edited] + "# edited\n")
    assert hash_of(checkout, "skills/a/top.py") != before


def test_what_is_not_imported_does_not_count(checkout: Path):
    before = hash_of(checkout, "skills/a/top.py"), hash_of(checkout, "skills/b/limits.py")
    (checkout / "skills/b/other.py").write_text("MOST = 2\n")
    (checkout / "skills/a/middle.py").write_text(SOURCES["skills/a/middle.py"])
    assert (hash_of(checkout, "skills/a/top.py"), hash_of(checkout, "skills/b/limits.py")) == before


def test_where_the_checkout_lies_does_not_count(checkout: Path, monkeypatch: pytest.MonkeyPatch):
    before = hash_of(checkout, "skills/a/top.py")
    elsewhere = checkout / "elsewhere"
    shutil.copytree(checkout / "skills", elsewhere / "skills")
    monkeypatch.setattr(kernel_locator, "_ROOT", elsewhere)
    assert hash_of(elsewhere, "skills/a/top.py") == before
