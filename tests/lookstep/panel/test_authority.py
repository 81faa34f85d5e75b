"""Who leads: one at a time, by order of coming, and nobody inherits control."""

from __future__ import annotations

import random

from lookstep.panel.authority import Authority


def test_the_first_client_leads_and_others_watch():
    authority = Authority()
    for client in (4, 7):
        authority.connect(client)
    assert authority.holds(4) and not authority.holds(7)


def test_control_is_handed_over_in_the_order_of_asking():
    authority = Authority()
    for client in (0, 1, 2):
        authority.connect(client)
    assert "asks" in authority.ask(2) and "asks" in authority.ask(1) and authority.ask(2) == ""
    assert authority.hand_over(1) == ""  # It is not his to give.
    authority.hand_over(0)
    assert authority.state.holder == 2 and authority.state.asking == (1,)


def test_nobody_inherits_control_from_a_client_that_goes():
    authority = Authority()
    for client in (0, 1):
        authority.connect(client)
    authority.ask(1)
    authority.disconnect(0)
    assert authority.state.holder is None and not authority.holds(1)
    assert "takes control" in authority.ask(1)
    assert authority.holds(1)


def test_who_reloads_a_page_alone_leads_again():
    authority = Authority()
    authority.connect(0)
    authority.disconnect(0)
    authority.connect(1)
    assert authority.holds(1)


def test_never_two_holders_whatever_clients_do():
    authority, dice = Authority(), random.Random(3)
    for _ in range(2000):
        client = dice.randrange(6)
        dice.choice((authority.connect, authority.disconnect, authority.ask, authority.hand_over))(client)
        state = authority.state
        assert sum(authority.holds(client) for client in range(6)) == (state.holder is not None)
        assert state.holder is None or state.holder in state.clients
        assert set(state.asking) <= set(state.clients) - {state.holder}
