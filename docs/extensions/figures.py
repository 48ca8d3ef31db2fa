"""Find the figures that an example made. They live without a screen, so the gallery's own search for open windows misses them."""

from __future__ import annotations

from typing import Any
from weakref import WeakSet

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

_KEPT: WeakSet[Figure] = WeakSet()


def scrape(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Save each new figure among the example's names and return the reStructuredText that shows them."""
    paths = []
    for value in {id(one): one for one in block_vars["example_globals"].values() if isinstance(one, Figure)}.values():
        if value in _KEPT:
            continue
        _KEPT.add(value)
        path = next(block_vars["image_path_iterator"])
        value.savefig(path, dpi=110)
        paths.append(path)
    return str(figure_rst(paths, gallery_conf["src_dir"]))
