"""How pictures are kept: at the size at which pages show them, with no more shades than the eye tells apart."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image


def save(figure: Any, target: Path, *, dpi: float = 200.0, width: int | None = None, shades: int = 8) -> None:
    """Write a figure as PNG.

    Parameters
    ----------
    figure : Figure
    target : Path
    dpi : float
        Pixels per inch, unless `width` is given.
    width : int, optional
        Pixels across.
    shades : int
        Bits of each colour: fewer make smaller files of smooth fields.
    """
    image = _drawn(figure, width / figure.get_size_inches()[0] if width else dpi)
    (_fewer_shades(image, shades) if shades < 8 else image).save(target, optimize=True)


def save_beside(figures: Sequence[Any], target: Path, width: int) -> None:
    """Write several figures side by side as one PNG so many pixels across, their middles at one height."""
    images = [_drawn(one, width / sum(each.get_size_inches()[0] for each in figures)) for one in figures]
    sheet = Image.new("RGB", (sum(one.width for one in images), max(one.height for one in images)), "white")
    left = 0
    for one in images:
        sheet.paste(one, (left, (sheet.height - one.height) // 2))
        left += one.width
    sheet.save(target, optimize=True)


def _drawn(figure: Any, dpi: float) -> Image.Image:
    drawn = BytesIO()
    figure.savefig(drawn, format="png", dpi=dpi)
    return Image.open(drawn).convert("RGB")


def _fewer_shades(image: Image.Image, bits: int) -> Image.Image:
    """Keep so many bits of each colour; white stays white, and black black."""
    steps = 2**bits - 1
    return image.point([round(round(value * steps / 255) * 255 / steps) for value in range(256)] * 3)
