"""Where a behavior tree is found by name."""

from __future__ import annotations

from pathlib import Path

from strict_yaml import Location, Problem, YamlError, nearest, shipped_folder


def tree_path(name: str) -> Path:
    """The file of a shipped tree by its name, or the file that the name says.

    Raises:
        YamlError: where there is neither.
    """
    folder = shipped_folder("trees")
    names = sorted(path.stem for path in folder.glob("*.yaml"))
    if name in names:
        return folder / f"{name}.yaml"
    path = Path(name)
    if path.suffix in (".yaml", ".yml") or path.exists():
        return path
    message = f'unknown tree "{name}"{nearest(name, names)} (shipped: {", ".join(names)}; or a .yaml file)'
    raise YamlError([Problem(Location("--tree", 0, 0), message)])
