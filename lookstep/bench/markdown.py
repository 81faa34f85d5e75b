"""Tables of figures as Markdown, so that the documentation shows what a command has measured."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table


def markdown(tables: Sequence[Table]) -> str:
    """All tables, one below the other, each under its title and above its caption."""
    return "\n".join(_table(table) for table in tables)


def _table(table: Table) -> str:
    header = [str(column.header) for column in table.columns]
    rule = ["---:" if column.justify == "right" else "---" for column in table.columns]
    rows = zip(*([str(cell) for cell in column.cells] for column in table.columns), strict=True)
    lines = [f"| {' | '.join(row)} |" for row in (header, rule, *rows)]
    above = [f"**{table.title}**", ""] if table.title else []
    below = ["", str(table.caption)] if table.caption else []
    return "\n".join((*above, *lines, *below, ""))
