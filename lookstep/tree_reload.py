"""A tree file that is saved while the robot walks takes over when the operator sends the next goal."""

from __future__ import annotations

from collections.abc import Callable

from behaviors import SettingError, Tree, load_tree
from behaviors.operator import SendGoal
from lookstep.errors import UserError
from skills.parameters import ParameterError
from strict_yaml import YamlError


class TreeReload:
    """Watches the files of a tree.

    A file with problems changes nothing; they are told in the tree's log, each with its place.

    Args:
        tree: that may be taken over.
        prepare: is called for the tree when another has taken over.
    """

    def __init__(self, tree: Tree, prepare: Callable[[Tree], None] = lambda tree: None) -> None:
        self._tree = tree
        self._prepare = prepare

    def poll(self) -> None:
        """For between two ticks: take over where a goal has come and the files have changed."""
        if not any(isinstance(event, SendGoal) for event in self._tree.pending_events):
            return
        spec = self._tree.spec
        try:
            found = load_tree(spec.file)
            if found.sources == spec.sources:
                return
            self._tree.reload(found)
            self._prepare(self._tree)
        except (YamlError, SettingError, ParameterError, UserError) as error:
            for line in str(error).splitlines():
                self._tree.context.log(f"{spec.file} is not reloaded: {line}", level="warning")
            return
        self._tree.context.log(f"{spec.file} was saved and has taken over")
