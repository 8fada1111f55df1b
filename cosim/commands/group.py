"""The group of all commands: what is wrong with an argument is said in the project's words."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup

from cosim.unit.errors import InputError


class Commands(TyperGroup):
    """Passes errors of arguments on, with the text of the library that checked them replaced."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Take the words of a command line apart.

        Raises:
            InputError: An option has an empty value, as from a shell's variable that is not set: for a folder it would
                mean the working folder.
        """
        for word, value in zip(args, [*args[1:], "-"]):
            is_empty = value == "" or (word.endswith("=") and word.count("=") == 1)
            if word.startswith("--") and is_empty:
                raise InputError(word.rstrip("="), "", "its value is empty", "give a value, or leave the option out")
        return super().parse_args(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        """Carry out a command."""
        try:
            return super().invoke(ctx)
        except Exception as error:
            if error.__cause__ is not None and hasattr(error, "message"):
                _reword(error, error.__cause__)
            raise


def _reword(error: Any, cause: BaseException) -> None:
    from pydantic import ValidationError  # late: a command that goes well does without

    from cosim.faults import words

    if isinstance(cause, ValidationError):
        error.message = words(cause.errors()[0])
