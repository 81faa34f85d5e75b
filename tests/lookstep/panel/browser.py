"""A browser for tests of the panel: the system's own, or the one that Playwright has installed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
# Drawn by the CPU, so that it works where there is no graphics card; as root, Chromium has no sandbox.
ARGUMENTS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")


class NoBrowserError(Exception):
    """There is no browser here; the message says what was looked for."""


@contextmanager
def browser() -> Iterator[Any]:
    """A headless Chromium.

    Raises:
        NoBrowserError: where there is none.
    """
    from playwright.sync_api import Error, sync_playwright

    named = os.environ.get("LOOKSTEP_BROWSER") or next(filter(None, map(shutil.which, NAMES)), None)
    with sync_playwright() as playwright:
        try:
            opened = playwright.chromium.launch(executable_path=named, args=list(ARGUMENTS))
        except Error as error:
            reason = str(error).splitlines()[0]
            raise NoBrowserError(
                f"no browser: looked for {', '.join(NAMES)}, LOOKSTEP_BROWSER and Playwright's own ({reason})"
            ) from error
        try:
            yield opened
        finally:
            opened.close()
