"""What data from outside may cost: the one table of bounds on texts, files and requests.

Outside data are quantities, names, scenario and study files, records, saved runs, links and bodies of the studio. Each is measured
against its bound before anything is parsed, allocated or computed. The documentation shows this table.
"""

from __future__ import annotations

from dataclasses import dataclass

from coaxshell.errors import InputError


@dataclass(frozen=True)
class Limit:
    """One bound.

    Attributes
    ----------
    value : int
        The largest that is accepted.
    unit : str
        What is counted: ``"characters"``, ``"bytes"``, ``"samples"``.
    what : str
        Whose size it bounds, in the user's words.
    """

    value: int
    unit: str
    what: str

    def check(self, size: int, where: str, remedy: str = "") -> None:
        """Refuse what is larger.

        Raises
        ------
        InputError
            With ``where``, the size found and the bound.
        """
        if size > self.value:
            raise InputError(where, f"{self.what} has {size:,} {self.unit}; at most {self.value:,} are read", remedy)


QUANTITY = Limit(100, "characters", "a quantity with its unit")
PATH = Limit(200, "characters", "a path of an entry")
EXPRESSION = Limit(300, "characters", "a metric, objective or constraint")

TABLE: tuple[Limit, ...] = (QUANTITY, PATH, EXPRESSION)
"""All bounds, in the order in which the documentation lists them."""
