import json

import pytest
from rich.table import Table
from rich.text import Text

from lookstep.__main__ import main
from lookstep.bench.markdown import markdown
from lookstep.bench.perception import report
from lookstep.bench.perception.report import Extent
from lookstep.bench.tree import report as tree_report
from lookstep.commands.bench import SUBJECTS


@pytest.fixture
def least(monkeypatch):
    monkeypatch.setattr(report, "QUICK", Extent(scenes=1, frames=4, duration=0.6))
    monkeypatch.setattr("lookstep.bench.perception.measure.NOISES", {"standard": report.NOISES["standard"]})
    monkeypatch.setattr(report, "NOISES", {"standard": report.NOISES["standard"]})


def test_perception_writes_its_figures_for_programs_and_people(least, tmp_path, capsys):
    figures_file, table_file = tmp_path / "figures.json", tmp_path / "table.md"
    assert main(["bench", "perception", "--quick", "--json", str(figures_file), "--table", str(table_file)]) == 0
    figures = json.loads(figures_file.read_text())
    for stage in ("depth_ms", "depth_noise_ms", "extract_ms", "memory_ms", "lidar_ms", "height_map_ms", "baseline_ms"):
        assert 0.0 < figures[stage]["median"] <= figures[stage]["p99"]
    assert figures["baseline_ratio"] > 0.0
    for kind in ("quality", "contiguous", "baseline_quality", "baseline_contiguous"):
        quality = figures[kind]["standard"]
        assert {"recall", "iou", "label_iou", "false_area", "normal_deg_median", "normal_deg_p90"} <= set(quality)
        assert {"offset_mm_median", "offset_mm_p90", "faces"} <= set(quality)
        assert ("wrong_height" in quality) == ("contiguous" in kind)
    assert {"seeds", "machine", "versions", "wall_ms", "extract_parts_ms"} <= set(figures)
    assert "[ms]" in table_file.read_text()
    assert "| standard | lookstep |" in table_file.read_text()
    told = capsys.readouterr().out
    assert "recall" in told
    assert "…" not in told  # No cell is cut off on a terminal of 80 columns.


def test_tree_writes_its_figures_beside_those_of_plain_py_trees(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(tree_report, "_TICKS", 10)
    figures_file = tmp_path / "figures.json"
    assert main(["bench", "tree", "--quick", "--json", str(figures_file)]) == 0
    figures = json.loads(figures_file.read_text())
    assert figures["nodes"] == 60 and figures["ticks"] == 100
    assert min(figures[key] for key in ("tick_us_median", "written_tick_us_median", "plain_tick_us_median")) > 0.0
    assert figures["ratio"] > 0.0


@pytest.mark.parametrize("subject", SUBJECTS, ids=lambda subject: subject.NAME)
def test_every_subject_explains_itself_with_an_example(subject, capsys):
    with pytest.raises(SystemExit) as end:
        main(["bench", subject.NAME, "--help"])
    assert end.value.code == 0
    assert subject.EXAMPLE in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "SUBJECT"),
        (["percepton"], "invalid choice: 'percepton'"),
        (["perception", "--frames", "0"], "got '0', needs a whole number from 1"),
    ],
)
def test_what_cannot_be_measured_is_refused(arguments, message, capsys):
    with pytest.raises(SystemExit) as end:
        main(["bench", *arguments])
    assert end.value.code == 2
    assert message in capsys.readouterr().err


def test_files_that_cannot_be_written_are_refused_before_measuring(tmp_path, capsys):
    missing = tmp_path / "no" / "figures.json"
    assert main(["bench", "perception", "--json", str(missing)]) == 2
    assert "does not exist" in capsys.readouterr().err


def test_markdown_shows_title_cells_and_caption():
    table = Table(title=Text("time [ms]"), caption="one core")
    table.add_column(Text("stage [a]"))
    table.add_column("median", justify="right")
    table.add_row("depth", "4.00")
    expected = "**time [ms]**\n\n| stage [a] | median |\n| --- | ---: |\n| depth | 4.00 |\n\none core\n"
    assert markdown([table]) == expected
