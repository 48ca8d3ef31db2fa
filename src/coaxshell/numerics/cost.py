"""What a request costs, in bytes and seconds, and its refusal before it is begun where the memory is not there."""

from __future__ import annotations

from dataclasses import dataclass

from coaxshell.errors import InputError
from coaxshell.numerics.memory import VARIABLE, available, plenty, words_of

TOLD_FROM = 30.0
"""Seconds from which on a command tells at its start how long it will take."""
_PROCESS = 150e6
"""Bytes of a further process with all that it imports."""


@dataclass(frozen=True)
class Cost:
    """An estimate.

    Attributes
    ----------
    memory : float
        Bytes at the peak, beside what the process holds already.
    seconds : float
        On a machine of today that has nothing else to do: within a factor of 3.
    """

    memory: float
    seconds: float = 0.0

    def then(self, other: Cost) -> Cost:
        """Return the cost of both, one after the other, the first leaving nothing behind."""
        return Cost(max(self.memory, other.memory), self.seconds + other.seconds)

    def times(self, count: int, workers: int = 1) -> Cost:
        """Return the cost of so many alike, shared by so many processes."""
        at_once = max(1, min(count, workers))
        return Cost(self.memory if at_once == 1 else at_once * (self.memory + _PROCESS), self.seconds * count / at_once)

    @property
    def fits(self) -> bool:
        """Whether the memory is there."""
        return plenty(self.memory) or (free := available()) is None or self.memory <= free

    @property
    def duration(self) -> str:
        """The time in words, of two digits: ``"40 s"``, ``"3 min"``, ``"7 h"``."""
        for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
            if self.seconds >= 1.5 * length:
                return f"{float(f'{self.seconds / length:.2g}'):g} {unit}"
        return f"{float(f'{self.seconds:.2g}'):g} s"

    def require(self, what: str, remedy: str, where: str = "memory") -> None:
        """Refuse what does not fit into the memory that is free.

        Parameters
        ----------
        what : str
            The request in the user's words: "a run of 2 shells, orders 0 to 150 and 5,001 instants".
        remedy : str
            What makes it smaller.
        where : str
            What the error names.

        Raises
        ------
        InputError
            With the memory needed, that which is free, and the remedy.
        """
        if self.fits:
            return
        free = available()
        assert free is not None
        unless = f'{remedy}; or, to try nevertheless, set {VARIABLE}="{words_of(1.05 * self.memory)}"'
        raise InputError(where, f"{what} needs about {words_of(self.memory)}, and {words_of(free)} are free", unless)
