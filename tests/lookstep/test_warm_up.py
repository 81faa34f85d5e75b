"""What is compiled before the clock starts."""

import gc
import sys

from numba.core.dispatcher import Dispatcher

from lookstep.configuration import load_configuration
from lookstep.warm_up import compiled_mark, link_known, take_over, warm_up, warm_up_beside


def compiled() -> dict[str, int]:
    """For how many types each kernel is compiled."""
    found = {}
    for module in list(sys.modules.values()):
        for name, value in vars(module).items():
            if isinstance(value, Dispatcher) and value.__module__ == module.__name__:
                found[f"{module.__name__}.{name}"] = len(value.nopython_signatures)
    return found


def test_the_second_process_compiles_nothing_but_what_a_walk_uses():
    configuration = load_configuration()
    warm_up(configuration)
    of_a_walk = compiled()
    assert len(of_a_walk) > 100
    warm_up_beside(configuration)
    assert compiled() == of_a_walk


def test_what_is_compiled_is_known_and_the_collector_runs_again():
    warm_up(load_configuration())
    assert compiled_mark().exists()
    assert gc.isenabled()


def test_a_cache_takes_over_what_it_has_not_itself(tmp_path, monkeypatch):
    cache, beside = tmp_path / "cache", tmp_path / "cache" / "beside"
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(cache))
    for folder, files in (
        (cache / "a", ("f.nbi", "f.1.nbc")),
        (beside / "a", ("f.nbi", "f.1.nbc", "g.nbi", "g.1.nbc")),
    ):
        folder.mkdir(parents=True)
        for name in files:
            (folder / name).write_text(str(folder))
    take_over(beside)
    texts = {file.name: file.read_text() for file in (cache / "a").iterdir()}
    mine, others = str(cache / "a"), str(beside / "a")
    assert texts == {"f.nbi": mine, "f.1.nbc": mine, "g.nbi": others, "g.1.nbc": others}


def test_another_cache_knows_what_is_compiled_already(tmp_path, monkeypatch):
    cache, beside = tmp_path / "cache", tmp_path / "cache" / "beside"
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(cache))
    (cache / "a").mkdir(parents=True)
    (cache / "a" / "f.nbi").write_text("mine")
    link_known(beside)
    assert [file.read_text() for file in beside.rglob("*.nbi")] == ["mine"]
    take_over(beside)
    assert (cache / "a" / "f.nbi").read_text() == "mine"
