"""Where the YAML files that come with the package lie: beside it in a checkout, inside it in an installed wheel."""

from __future__ import annotations

from pathlib import Path


def shipped_folder(name: str) -> Path:
    """The folder of shipped files of one kind, such as "trees" or "config".

    Raises:
        FileNotFoundError: where there is no such folder.
    """
    package = Path(__file__).resolve().parent
    checkout = package.parent
    folder = checkout / name if (checkout / "pyproject.toml").is_file() else package / "shipped" / name
    if not folder.is_dir():
        raise FileNotFoundError(f"no shipped folder {name!r}: {folder}")
    return folder


def shipped(*parts: str) -> Path:
    """The path of a shipped file, such as `shipped("trees", "look_and_step.yaml")`; it need not exist."""
    folder, *rest = parts
    return shipped_folder(folder).joinpath(*rest)
