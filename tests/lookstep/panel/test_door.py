"""Who may come in: on the loopback address the panel's own pages, elsewhere those who show the token."""

from __future__ import annotations

import pytest

from lookstep.panel.address import Address, is_loopback
from lookstep.panel.door import answer

LOCAL, OPEN = Address(), Address("192.168.1.5", 8765, "0123456789abcdef")
HERE, THERE = {"Host": "127.0.0.1:8765"}, {"Host": "192.168.1.5:8765"}


@pytest.mark.parametrize("host", ("127.0.0.1:8765", "localhost:8765", "[::1]:8765", "127.0.0.1"))
def test_the_machine_itself_may_come_in(host):
    assert answer("/", {"Host": host}, LOCAL) is None
    assert answer("/", {"Host": host, "Origin": f"http://{host}"}, LOCAL) is None


@pytest.mark.parametrize(
    "headers",
    (
        HERE | {"Origin": "http://evil.example"},
        HERE | {"Origin": "http://127.0.0.1:9999"},
        HERE | {"Origin": "null"},
        {"Host": "evil.example:8765"},
        {"Host": "evil.example:8765", "Origin": "http://evil.example:8765"},
        {},
    ),
    ids=str,
)
def test_pages_of_others_may_not(headers):
    refused = answer("/", headers, LOCAL)
    assert refused is not None and refused.status == 403


def test_the_token_comes_with_the_link_and_then_in_a_cookie():
    first = answer(f"/?token={OPEN.token}", THERE, OPEN)
    assert first is not None and first.status == 303 and first.headers["Location"] == "/"
    cookie = first.headers["Set-Cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    assert answer("/", THERE | {"Cookie": cookie.partition(";")[0]}, OPEN) is None


@pytest.mark.parametrize(
    ("path", "cookie"),
    (
        *(("/", ""), ("/?token=", ""), ("/?token=0123456789abcdeF", ""), ("/?token=%FF", "")),
        *(("/", "lookstep_token=wrong"), ("/", "lookstep_token="), ("/", "other=0123456789abcdef"), ("/", "\x00;;=")),
    ),
)
def test_without_the_token_nobody_comes_in(path, cookie):
    refused = answer(path, THERE | {"Cookie": cookie}, OPEN)
    assert refused is not None and refused.status == 403


def test_only_loopback_addresses_are_this_machine_alone():
    assert all(map(is_loopback, ("127.0.0.1", "127.3.4.5", "::1", "localhost")))
    assert not any(map(is_loopback, ("0.0.0.0", "::", "192.168.1.5", "example.org", "localhost.evil.example", "")))
