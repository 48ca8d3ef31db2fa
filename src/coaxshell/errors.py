"""The two things that can be wrong: the user's input, and the physics of a well-formed request."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input, told in the user's own terms on one line.

    The command line prints ``str(error)`` on stderr and exits with code 2.

    Parameters
    ----------
    where : str
        Dotted path of the offending field as the user wrote it, e.g. ``shells[0].layers[1].thickness``.
    problem : str
        The value found and what is wrong with it.
    remedy : str, optional
        What is allowed, or what to do instead.
    also : tuple of InputError
        What else is wrong with the same input, each without further ones; a form shows them all, a line of text the first.

    """

    def __init__(self, where: str, problem: str, remedy: str = "", also: tuple[InputError, ...] = ()) -> None:
        self.where = where
        self.problem = problem
        self.remedy = remedy
        self.also = also
        text = f"{where}: {problem}" if where else problem
        super().__init__(" ".join((text + (f"; {remedy}" if remedy else "")).split()))

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, str, tuple[InputError, ...]]]:
        """Travel between processes whole; an exception would by default be made again from its text alone."""
        return type(self), (self.where, self.problem, self.remedy, self.also)


class PhysicsWarning(UserWarning):
    """A run that is well formed but outside the range in which its answer can be trusted; carries both numbers and the remedy."""
