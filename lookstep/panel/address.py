"""Where the panel is served."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Address:
    """Where the panel is served.

    Attributes:
        host: an address of this machine.
        port: 0 for any that is free.
        token: what a client must show; empty on the loopback address, where none is needed.
    """

    host: str = "127.0.0.1"
    port: int = 8765
    token: str = ""


def is_loopback(host: str) -> bool:
    """Whether an address is reached from this machine alone."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
