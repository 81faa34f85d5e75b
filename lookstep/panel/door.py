"""Who may come in: requests to the panel's server are looked at before anything else of them is.

A web page from anywhere may open a WebSocket to a server on this machine, and a name of its own may lead here, so
`Origin` must be the panel's own and on the loopback address `Host` must name it. On any other address a token is
needed as well: it comes once with the link, `/?token=...`, and then in a cookie.
"""

from __future__ import annotations

import hmac
import http
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, urlsplit

import websockets.asyncio.server
from websockets import Headers
from websockets.http11 import Request, Response

from lookstep.panel.address import Address, is_loopback

_COOKIE = "lookstep_token"
_LARGEST = 256 * 1024  # of one message from a client [bytes]
_PING, _PONG = 5.0, 15.0  # A client is asked so often, and gone that does not answer for so long [s].


@dataclass(frozen=True, slots=True)
class Answer:
    """What a request gets that is not let in.

    Attributes:
        status: HTTP status.
        text: the page.
        headers: besides those that every answer has.
    """

    status: int
    text: str
    headers: Mapping[str, str] = field(default_factory=dict)


def answer(path: str, headers: Mapping[str, str], address: Address) -> Answer | None:
    """What a request gets instead of the panel; None where it may come in.

    Args:
        path: of the request, with its query.
        headers: of the request, by their names.
        address: where the panel is served, and its token.
    """
    host = headers.get("Host", "")
    if is_loopback(address.host) and not is_loopback(_name(host)):
        return Answer(
            http.HTTPStatus.FORBIDDEN, f"Got host {host[:80]!r}; the panel answers to its own address only.\n"
        )
    origin = headers.get("Origin")
    if origin is not None and urlsplit(origin).netloc != host:
        return Answer(http.HTTPStatus.FORBIDDEN, "The request comes from another site.\n")
    if not address.token:
        return None
    given = parse_qs(urlsplit(path).query).get("token", [""])[0]
    if given and _equal(given, address.token):
        cookie = f"{_COOKIE}={address.token}; HttpOnly; SameSite=Strict; Path=/"
        return Answer(http.HTTPStatus.SEE_OTHER, "", {"Location": "/", "Set-Cookie": cookie})
    if _equal(_cookie(headers.get("Cookie", "")), address.token):
        return None
    return Answer(http.HTTPStatus.FORBIDDEN, "A token is needed: open the link that the terminal shows.\n")


@contextmanager
def guarded_door(address: Address) -> Iterator[None]:
    """Let servers that start meanwhile look at each request first, and drop clients that are gone without a word."""
    serve = websockets.asyncio.server.serve

    def guarded(handler: Any, host: str, port: int, *, process_request: Callable[..., Any], **options: Any) -> Any:
        def look(connection: Any, request: Request) -> Response | None:
            refused = answer(request.path, dict(request.headers.raw_items()), address)
            return process_request(connection, request) if refused is None else _response(refused)

        limits = {"max_size": _LARGEST, "ping_interval": _PING, "ping_timeout": _PONG}
        return serve(handler, host, port, process_request=look, **(options | limits))

    websockets.asyncio.server.serve = guarded  # type: ignore[assignment,misc]
    try:
        yield
    finally:
        websockets.asyncio.server.serve = serve  # type: ignore[misc]


def _response(refused: Answer) -> Response:
    body = refused.text.encode()
    lengths = {"Content-Length": str(len(body)), "Content-Type": "text/plain; charset=utf-8"}
    headers = Headers({**lengths, **refused.headers})
    return Response(refused.status, http.HTTPStatus(refused.status).phrase, headers, body)


def _name(host: str) -> str:
    """The name in a Host header."""
    return urlsplit(f"//{host}").hostname or ""


def _cookie(text: str) -> str:
    try:
        found = SimpleCookie(text).get(_COOKIE)
    except CookieError:
        return ""
    return "" if found is None else found.value


def _equal(given: str, token: str) -> bool:
    return hmac.compare_digest(given.encode(), token.encode())
