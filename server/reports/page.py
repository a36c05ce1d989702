"""A page that stands alone: pictures and style are inside."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from server.reports.tables import Table

STYLE = """
body{font:16px/1.55 system-ui,sans-serif;color:#1a1a1a;background:#fff;max-width:62rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.7rem;margin-bottom:.2rem}h2{font-size:1.25rem;margin-top:2.4rem;border-bottom:1px solid #ddd}
figure{margin:1.4rem 0}img{max-width:100%;height:auto}figcaption{color:#555;font-size:.9rem}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.88rem;margin:1rem 0}
th,td{padding:.35rem .6rem;border-bottom:1px solid #e3e3e3;text-align:left;vertical-align:top}
td.number{text-align:right;font-variant-numeric:tabular-nums}
.reproduced{color:#00694b;font-weight:600}.not-reproduced{color:#b02a00;font-weight:600}
.not-comparable{color:#555;font-weight:600}small{color:#555}
pre{overflow-x:auto;font-size:.85rem;padding:.6rem;background:#f4f4f4;border-radius:6px}summary{cursor:pointer}
.scroll td:first-child{white-space:nowrap}
@media (max-width:40rem){.scroll td:first-child{white-space:normal}
figure{overflow-x:auto}figure img{max-width:none;width:44rem}}
@media (prefers-color-scheme:dark){
body{color:#e6e6e6;background:#15181b}h2{border-color:#3a3f44}th,td{border-color:#33383d}
figcaption,small,.not-comparable{color:#aab2b9}pre{background:#1f2428}
.reproduced{color:#4fd0a5}.not-reproduced{color:#ff9466}
figure img{background:#fff;border-radius:6px;padding:6px;box-sizing:border-box}}
"""


@dataclass(frozen=True, slots=True)
class Picture:
    """name: of its file.  caption: what to see.  png: its bytes."""

    name: str
    caption: str
    png: bytes


def page(title: str, body: Sequence[str]) -> str:
    """body: pieces of HTML."""
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{STYLE}</style></head><body>\n" + "\n".join(body) + "\n</body></html>\n"
    )


def heading(text: str) -> str:
    return f"<h2>{escape(text)}</h2>"


def paragraph(text: str) -> str:
    return f"<p>{escape(text)}</p>"


def listing(items: Sequence[str]) -> str:
    return "<ul>" + "".join(f"<li>{escape(item)}</li>" for item in items) + "</ul>"


def picture(one: Picture) -> str:
    data = base64.b64encode(one.png).decode()
    return (
        f'<figure><img alt="{escape(one.caption)}" src="data:image/png;base64,{data}">'
        f"<figcaption>{escape(one.caption)}</figcaption></figure>"
    )


def table(content: Table) -> str:
    header, *rows = content
    head = "".join(f"<th>{escape(str(cell)).replace('_', ' ')}</th>" for cell in header)
    lines = "".join("<tr>" + "".join(_cell(cell) for cell in row) + "</tr>" for row in rows)
    return f'<div class="scroll"><table><tr>{head}</tr>{lines}</table></div>'


def _cell(cell: str | int | float) -> str:
    if isinstance(cell, str):
        verdict = cell.replace(" ", "-") if cell in ("reproduced", "not reproduced", "not comparable") else ""
        return f'<td class="{verdict}">{escape(cell)}</td>' if verdict else f"<td>{escape(cell)}</td>"
    return f'<td class="number">{cell}</td>'
