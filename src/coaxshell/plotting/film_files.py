"""Films as files: MP4 through the ffmpeg that imageio-ffmpeg brings, animated WebP through Pillow."""

from __future__ import annotations

import errno
import os
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.files import replacing
from coaxshell.plotting.saving import known_suffix

Bytes = npt.NDArray[np.uint8]

FILM_SUFFIXES = (".mp4", ".webp")
"""Kinds of file that a film can be written as."""

_WEBP = {"quality": 90, "method": 1, "loop": 0, "minimize_size": False, "kmin": 24, "kmax": 48}


def film_writer(path: Path) -> Callable[[Path, tuple[int, int], int, float, Iterator[Bytes]], None]:
    """Return the function that writes a film of this kind.

    Raises
    ------
    InputError
        The ending is unknown, or it is .mp4 and imageio-ffmpeg is not installed.
    """
    if known_suffix(path, FILM_SUFFIXES) == ".webp":
        return write_webp
    _ffmpeg()
    return write_mp4


def write_film(path: Path, size: tuple[int, int], count: int, fps: float, frames: Iterator[Bytes]) -> None:
    """Write frames to a film, whole or not at all.

    Parameters
    ----------
    path : Path
        The ending tells the kind, one of FILM_SUFFIXES.
    size : (int, int)
        Width and height of the frames, even numbers.
    count : int
        Number of frames.
    fps : float
        Frames per second.
    frames : iterator of ndarray of uint8, shape (height, width, 3)
    """
    writer = film_writer(path)
    with replacing(path) as partial:
        writer(partial, size, count, fps, frames)


def write_mp4(path: Path, size: tuple[int, int], count: int, fps: float, frames: Iterator[Bytes]) -> None:
    """Pipe raw frames to ffmpeg, which writes H.264 that every browser and player knows."""
    source = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}", "-r", f"{fps:g}", "-i", "-")
    coding = ("-an", "-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart")
    command = [_ffmpeg(), "-y", "-v", "error", *source, *coding, str(path)]
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=log, start_new_session=True)
        assert process.stdin is not None
        try:
            for frame in frames:
                process.stdin.write(np.ascontiguousarray(frame).data)
            process.stdin.close()
            process.wait()
        except BrokenPipeError:
            process.wait()  # its own complaint says more
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
            with suppress(BrokenPipeError):
                process.stdin.close()
        if process.returncode:
            log.seek(0)
            text = log.read().decode(errors="replace").strip()
            if os.strerror(errno.ENOSPC) in text:  # followed by its own consequences
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            raise OSError(f"ffmpeg: {text.splitlines()[-1] if text else f'exit code {process.returncode}'}")


def write_webp(path: Path, size: tuple[int, int], count: int, fps: float, frames: Iterator[Bytes]) -> None:
    """Write an animated WebP; frames are made as they are written, never all held."""
    options: dict[str, Any] = {**_WEBP, "duration": max(1, round(1000.0 / fps))}
    with path.open("wb") as file:
        _reel(size, count, frames).save(file, format="WEBP", save_all=True, **options)


def _reel(size: tuple[int, int], count: int, frames: Iterator[Bytes]) -> Any:
    """Return a Pillow image of many frames that takes each from an iterator when Pillow turns to it."""
    from PIL import Image

    class Reel(Image.Image):
        def __init__(self) -> None:
            super().__init__()
            self._im = Image.new("RGB", size).im
            self._mode, self._size = "RGB", size
            self.n_frames, self._at = count, -1

        def seek(self, frame: int) -> None:
            if frame == self._at + 1:
                self._im = Image.fromarray(next(frames)).im
                self._at = frame

        def tell(self) -> int:
            return max(self._at, 0)

    return Reel()


def _ffmpeg() -> str:
    try:
        import imageio_ffmpeg
    except ImportError:
        raise InputError(
            "output", "an .mp4 needs the package imageio-ffmpeg", 'install it: pip install "coaxshell[video]", or name a .webp file'
        ) from None
    try:
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except RuntimeError as error:
        raise InputError("output", f"an .mp4 needs ffmpeg ({error})", "name a .webp file, or set IMAGEIO_FFMPEG_EXE") from None
