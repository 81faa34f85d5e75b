"""The tab "Review": what waits for approval, what comes of each answer, and which checkpoints ask."""

from __future__ import annotations

import dataclasses

from behaviors.operator import Approve, Reject, ReviewParameters, ReviewRequest, SwitchReview
from lookstep.panel.desk import Desk
from lookstep.panel.snapshot import Snapshot
from lookstep.panel.words import describe_request


class ReviewTab:
    """Widgets to review plans; made inside the tab's context.

    Args:
        desk: where they put what they say.
    """

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        gui = desk.server.gui
        self._shown: ReviewRequest | None = None
        self._text = gui.add_markdown("Nothing waits for approval.")
        self._approve = gui.add_button("Approve", color="green", disabled=True)
        hint = "Plans again, with the parameters as they are then."
        self._reject = gui.add_button("Reject and plan again", color="red", hint=hint, disabled=True)
        desk.on_click(self._approve, lambda: self._decide(Approve))
        desk.on_click(self._reject, lambda: self._decide(Reject))
        self._switches = {}
        with gui.add_folder("Ask before it goes on"):
            for field in dataclasses.fields(ReviewParameters):
                switch = gui.add_checkbox(field.name.replace("_", " "), True, hint=field.metadata["meaning"])
                desk.on_change(switch, lambda asks, name=field.name: desk.send_event(SwitchReview(name, bool(asks))))
                self._switches[field.name] = switch

    def update(self, snapshot: Snapshot) -> None:
        """Show what waits, and which checkpoints ask."""
        request = snapshot.reviews[0] if snapshot.reviews else None
        self._text.content = describe_request(request)
        self._shown = request
        self._approve.disabled = self._reject.disabled = request is None
        for name, switch in self._switches.items():
            switch.value = bool(getattr(snapshot.parameters["review"], name))

    def _decide(self, decision: type[Approve] | type[Reject]) -> None:
        """Decide on what is shown: by its id, so that nothing else is meant."""
        request = self._shown
        if request is not None:
            self._desk.send_event(decision(request.checkpoint, request.item_id))
