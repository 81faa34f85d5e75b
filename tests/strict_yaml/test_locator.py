import shutil
from pathlib import Path

import pytest

from strict_yaml import locator, shipped, shipped_folder


def test_a_checkout_has_its_files_beside_the_package():
    root = Path(__file__).resolve().parents[2]
    assert shipped_folder("config") == root / "config"
    assert shipped("config", "courses", "x.yaml") == root / "config" / "courses" / "x.yaml"


def test_a_wheel_has_its_files_inside_the_package(tmp_path, monkeypatch):
    package = tmp_path / "site-packages" / "strict_yaml"
    (package / "shipped" / "trees").mkdir(parents=True)
    module = shutil.copy(locator.__file__, package)
    monkeypatch.setattr(locator, "__file__", str(module))
    assert shipped_folder("trees") == package / "shipped" / "trees"


def test_an_unknown_folder_is_an_error():
    with pytest.raises(FileNotFoundError, match="no shipped folder 'nothing'"):
        shipped_folder("nothing")
