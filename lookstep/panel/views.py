"""What stands beside the scene for looking only: sensor images, the tree, and what of the scene is shown."""

from __future__ import annotations

import numpy as np

from lookstep import shapes
from lookstep.panel import words
from lookstep.panel.desk import Desk
from lookstep.panel.scene import GROUPS
from lookstep.panel.snapshot import Snapshot
from lookstep.perception_pictures import depth_picture
from skills.regions import RegionExtraction, debug_image

_WIDTH = 320  # of a picture, at least half of it [px]
_BLANK = np.zeros((24, 32, 3), np.uint8)


class SensorView:
    """The depth image and what became of its pixels; made inside a container's context.

    Args:
        desk: whose server shows them.
    """

    def __init__(self, desk: Desk) -> None:
        gui = desk.server.gui
        self._depth = gui.add_image(_BLANK, label="Depth image: red is near", format="jpeg", jpeg_quality=70)
        self._regions = gui.add_image(_BLANK, label="Region extraction", format="jpeg", jpeg_quality=80)
        self._seen: object = None

    def update(self, snapshot: Snapshot) -> None:
        """Show the newest extraction."""
        extraction = snapshot.value(RegionExtraction)
        if extraction is None or extraction is self._seen:
            return
        self._seen = extraction
        stride = max(1, extraction.image.camera.width // _WIDTH)
        self._depth.image = depth_picture(extraction.image)[::stride, ::stride]
        self._regions.image = debug_image(extraction, stride, shapes.colors_by_place(extraction.regions))


class TreeView:
    """The behavior tree; made inside a container's context.

    Args:
        desk: whose server shows it.
    """

    def __init__(self, desk: Desk) -> None:
        self._html = desk.server.gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Show the nodes' states."""
        self._html.content = words.tree(snapshot)


class SceneSwitches:
    """What of the scene is shown; made inside a container's context.

    Args:
        desk: whose scene it is.
    """

    def __init__(self, desk: Desk) -> None:
        for name, visible in GROUPS.items():
            switch = desk.server.gui.add_checkbox(name, visible)
            desk.on_change(switch, lambda shown, name=name: desk.scene.show(name, bool(shown)))
